"""States and loads of the contacts of an interface at points of a curve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.mesh.pairing import PAIRING
from fcm.plot.dof import asked_for, greatest_column
from fcm.plot.errors import PlotError
from fcm.plot.labels import curve_label, short_names, staying, with_unit
from fcm.plot.pairs import direction_name, plane_view
from fcm.plot.read import (
    LEVEL,
    FloatArray,
    asked_beside,
    chosen_curve,
    floats,
    on_curve,
    opened,
    swept_units,
    swept_values,
)
from fcm.plot.reader_process import apart
from fcm.plot.solutions import Solution, solutions_at
from fcm.plot.style import COLUMN, LAYOUT, TWO_COLUMNS, house_style, new_figure
from fcm.quoting import quoted
from fcm.results.contact_states import STATES, contact_states

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

_NEEDED = ("frequency", "amplitude", "contact", "regime", "dissipated_energy")
_OPTIONAL = ("stable", "contact_position", "level", "modal_amplitude", "steady_state")
CONTACT_LOADS = (("dissipated_energy", "energy in a cycle"), ("slip_path", "slip path in a cycle"),
          ("greatest_normal_force", "greatest normal force"))  # fmt: skip
STATES_OF_CONTACTS = (  # word, colour and mark: told apart without colours, too
    (STATES[0], "#0072B2", "o"),
    (STATES[1], "#E69F00", "^"),
    (STATES[2], "#D55E00", "s"),
    (STATES[3], "#FFFFFF", "o"),
)
_SIZE = (4.0, 60.0)  # [point^2] of a mark, for many contacts and for few
_SHARE = 0.7  # of the distance of two marks is filled by them
_BAR, _ABOVE = 1.2, 0.35  # [inch] beside the panels for a bar of colours, and above each
_HEIGHTS = (3.5, 11.0)  # [inch] of a figure
_ROW = "contact"  # the axis of contacts without places
NONE = ("#808080", "x")  # colour and mark of a contact whose value is none


class InterfaceFile(Frozen):
    """Data of a response file on its contacts."""

    path: Path
    unit: str
    contacts: tuple[str, ...]
    dofs: tuple[str, ...]
    frequency: FloatArray  # (curve, point) in the file's unit, or levels of the forces
    amplitude: FloatArray  # (curve, point, dof)
    stable: FloatArray  # (curve, point) 1, 0 or NaN
    states: npt.NDArray[np.str_]  # (curve, point, contact)
    contact_loads: FloatArray  # (3, curve, point, contact): energy, slip path, greatest normal force
    units: tuple[str, str, str]  # of contact_loads, where the file says them
    places: FloatArray | None = None  # (contact, 2) in the plane of the contacts, where the file says them
    axes: tuple[str, str] = ("X", "Y")  # what these two coordinates are
    names: tuple[str, ...] = ()  # of the curves of a sweep, by their swept values
    swept: tuple[Mapping[str, float], ...] = ()  # these values, by their short names
    modal_amplitude: FloatArray | None = None  # (curve, point) of nonlinear modes
    asked: tuple[str, ...] = ()  # degrees of freedom that the scene asks for, if it says so
    steady: FloatArray | None = None  # (curve, point) 0 where a nonlinear mode has no steady state


class InterfacePoint(Frozen):
    """All contacts at one point of a curve.

    state (contact,) counts from 0: `sticks`, `slips`, `slips and opens`, `open`.
    """

    frequency: float
    stable: float
    state: npt.NDArray[np.intp]
    contact_loads: FloatArray  # (3, contact)
    curve: str = ""  # its name, where there are several
    swept: Mapping[str, float] = field(default_factory=dict)  # of a sweep, by short names
    modal_amplitude: float | None = None  # of a nonlinear mode, which is neither stable nor unstable
    asked: str = ""  # the place asked for, if the nearest point is not at it
    solution: Solution | None = None  # which of those that the curve has at this place


@apart
def read_interface(path: Path) -> InterfaceFile:
    """Read what ``fcm respond -o`` has written; PlotError if the file says nothing of its contacts."""
    names = tuple(name for name, _ in CONTACT_LOADS)
    with opened(path, "a response with contacts", (*_NEEDED, *names[1:], "dof"), _OPTIONAL) as data:
        variables = data.variables
        contacts, dofs = (
            tuple(str(one) for one in np.atleast_1d(variables[name][:])) for name in ("contact", "dof")
        )
        frequency, amplitude = floats(variables["frequency"]), floats(variables["amplitude"])
        states = np.asarray(variables["regime"][:]).astype(str)
        contact_loads = np.stack([floats(variables[name]) for name in names])
        stable = floats(variables["stable"]) if "stable" in variables else np.full(frequency.shape, np.nan)
        unit = str(getattr(data, "frequency_unit", "rad/s"))
        if "level" in variables:
            frequency, unit = floats(variables["level"]), LEVEL
        modal = floats(variables["modal_amplitude"]) if "modal_amplitude" in variables else None
        steady = floats(variables["steady_state"]) if "steady_state" in variables else None
        places, axes = _places(variables)
        energy, slip, normal = (str(getattr(variables[name], "units", "")) for name in names)
        swept = swept_values(variables)
        asked = asked_for(getattr(data, "output", ""), dofs)
        units_of = swept_units(variables, swept)
    if not contacts:
        raise PlotError(f"{path}: its scene has no contacts")
    units = energy, slip, normal
    values = [{key: float(one[k]) for key, one in swept.items()} for k in range(len(frequency))]
    curves = tuple(curve_label(one, units=units_of) for one in values) if swept else ()
    of_contacts = (
        contacts,
        dofs,
        frequency,
        amplitude,
        stable,
        states,
        contact_loads,
        units,
        places,
        axes,
        curves,
    )
    short = short_names(swept)
    named = tuple({short[key]: value for key, value in one.items()} for one in values) if swept else ()
    return InterfaceFile(path, unit, *of_contacts, named, modal, asked, steady)


def _places(variables: Any) -> tuple[FloatArray | None, tuple[str, str]]:
    """Coordinates of the contacts in their plane, and names of these; None if a contact has no position."""
    if "contact_position" not in variables:
        return None, InterfaceFile.axes
    found = floats(variables["contact_position"])
    if not np.isfinite(found).all() or not len(found):
        return None, InterfaceFile.axes
    along = plane_view(found)
    places: FloatArray = found @ along.T
    return places, (direction_name(along[0]), direction_name(along[1]))


def points_of(
    file: InterfaceFile,
    at: Sequence[float],
    curve: int | None = None,
    amplitude: Sequence[float] = (),
    solution: int | None = None,
) -> list[InterfacePoint]:
    """The points of a curve nearest to each frequency or level, or to each modal amplitude.

    Each solution at a place has a point, or only the numbered `solution`; see `solutions_at`. Without a
    place, the point is that of the greatest amplitude, of the scene's output if it has one. For nonlinear
    modes, points with a steady state come first.

    Raises
    ------
    PlotError
        If the curve, a frequency, a modal amplitude or the solution is not in the file, or the file has
        several curves and none is chosen.
    """
    curve = chosen_curve(file.path, curve, len(file.frequency))
    if not np.isfinite(file.frequency[curve]).any():
        raise PlotError(f"{file.path}: curve {curve} has no points")
    if amplitude and file.modal_amplitude is None:
        raise PlotError(f"{file.path}: --amplitude is of nonlinear modes (fcm respond --mode); take --at")
    column = greatest_column(file.dofs, file.amplitude.reshape(-1, len(file.dofs)), file.asked)
    height = file.amplitude[curve, :, column]
    if not at and not amplitude:
        if file.steady is not None and (held := (file.steady[curve] != 0.0) & np.isfinite(height)).any():
            height = np.where(held, height, np.nan)
        return [_point(file, curve, int(np.nanargmax(height)))]
    if file.modal_amplitude is not None and amplitude:
        along, places, option, digits = file.modal_amplitude[curve], amplitude, "--amplitude", 4
    else:
        along, places, option, digits = file.frequency[curve], at, "--at", 6
    found = []
    for place in places:
        unit = file.unit if option == "--at" else ""
        for one in solutions_at(along, _on_curve(file, along, place, option), height, solution):
            beside = asked_beside(place, float(along[one.point]), unit, digits)
            found.append(replace(_point(file, curve, one.point), asked=beside, solution=one))
    return found


def _on_curve(file: InterfaceFile, along: FloatArray, asked: float, option: str) -> float:
    """The place asked for along a curve; PlotError if it is beyond."""
    place = on_curve(along, asked)
    if np.isnan(place):
        low, high = np.nanmin(along), np.nanmax(along)
        unit = "" if option != "--at" else f" {file.unit}"
        help_ = "; --amplitude takes modal amplitudes" * (
            option == "--at" and file.modal_amplitude is not None
        )
        raise PlotError(f"{option} {asked:g}: the curve goes from {low:g} to {high:g}{unit}{help_}")
    return place


def _point(file: InterfaceFile, curve: int, k: int) -> InterfacePoint:
    words = file.states[curve, k]
    state = contact_states(words)
    omega, stable = float(file.frequency[curve, k]), float(file.stable[curve, k])
    several = len(file.names) > 1
    named = (file.names[curve], file.swept[curve]) if several else ("", {})
    modal = None if file.modal_amplitude is None else float(file.modal_amplitude[curve, k])
    return InterfacePoint(omega, stable, state, file.contact_loads[:, curve, k], *named, modal)


def place_of(file: InterfaceFile, point: InterfacePoint) -> str:
    """The frequency or the level of a point, its modal amplitude, and which of several solutions it is."""
    which = f", {point.solution}" if point.solution is not None and point.solution.among > 1 else ""
    if file.unit == LEVEL:
        return f"{LEVEL} {point.frequency:.6g}{which}"
    modal = "" if point.modal_amplitude is None else f", modal amplitude {point.modal_amplitude:.4g}"
    return f"{point.frequency:.6g} {file.unit}{modal}{which}"


def stays_at(point: InterfacePoint) -> str:
    """Text on the stability of a point; empty if that of a nonlinear mode's point is unknown."""
    said = staying(point.stable)
    return "" if np.isnan(point.stable) and point.modal_amplitude is not None else said


def greatest_takers(file: InterfaceFile, point: InterfacePoint, most: int) -> list[tuple[str, ...]]:
    """A row for each of the contacts that take most energy; none for a contact that takes none.

    A row has the name, state, energy, its share, slip path, greatest normal force, and the place if known.
    """
    energy = np.nan_to_num(point.contact_loads[0])
    total = float(energy.sum()) or 1.0
    order = np.argsort(-energy, kind="stable")[: min(most, np.count_nonzero(energy))]
    return [
        (
            file.contacts[i],
            STATES_OF_CONTACTS[point.state[i]][0],
            f"{energy[i]:.4g}",
            f"{100.0 * energy[i] / total:.1f} %",
            *(f"{value:.4g}" for value in point.contact_loads[1:, i]),
            *([] if file.places is None else ["{:.6g}, {:.6g}".format(*file.places[i])]),
        )
        for i in order.tolist()
    ]


def counted_states(point: InterfacePoint) -> str:
    """How many contacts are in each state, as ``sticks: 8, slips: 2``."""
    count = np.bincount(point.state, minlength=len(STATES_OF_CONTACTS))
    return ", ".join(
        f"{state[0]}: {number}" for state, number in zip(STATES_OF_CONTACTS, count, strict=True) if number
    )


@apart
def read_places(path: Path, contacts: Sequence[str]) -> FloatArray:
    """Read coordinates (contact, 2) from a text file with a line NAME X Y for each contact.

    Commas or blanks separate the three; # begins a remark.

    Raises
    ------
    PlotError
        Lists the mistakes: malformed lines, unknown or repeated names, contacts without a line.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise PlotError(f"{path}: not a text of lines NAME X Y") from None
    places, wrong = dict[str, tuple[float, float]](), list[str]()
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].replace(",", " ").split()
        if not words:
            continue
        try:
            name, x, y = words[0], float(words[1]), float(words[2])
            if len(words) != 3 or not (np.isfinite(x) and np.isfinite(y)):
                raise ValueError
        except (ValueError, IndexError):
            wrong.append(
                f"line {number}: {quoted(line.strip())} is not a name and two numbers, as in: p1 0.0 0.5"
            )
            continue
        if name not in contacts:
            wrong.append(f"line {number}: the response has no contact {quoted(name)}")
        elif name in places:
            wrong.append(f"line {number}: {name} has a line already")
        places[name] = (x, y)
    missing = [name for name in contacts if name not in places]
    if missing and not wrong:
        more = f" and {len(missing) - 3} others" if len(missing) > 3 else ""
        wrong.append(f"no line for {', '.join(missing[:3])}{more}")
    if wrong:
        rest = [f"{len(wrong) - LAYOUT.mistakes} more of this kind"] if len(wrong) > LAYOUT.mistakes else []
        raise PlotError("\n".join(f"{path}: {one}" for one in [*wrong[: LAYOUT.mistakes], *rest]))
    return np.array([places[name] for name in contacts])


def draw_interface(
    file: InterfaceFile,
    points: Sequence[InterfacePoint],
    places: FloatArray | None = None,
    axes: tuple[str, str] = InterfaceFile.axes,
) -> Figure:
    """The figure: panels for the states, and for energy, slip path and normal force; a column for each point.

    places (contact, 2) are the coordinates of the contacts, and axes their names; without them, the contacts
    stand in a row in their order. Contacts on a line have bars along it; others have coloured marks.
    """
    line = None if places is None else _line(places, axes)
    with house_style():
        if places is None:
            return _in_row(file, points, np.arange(1.0, len(file.contacts) + 1.0), _ROW)
        if line is not None:
            return _in_row(file, points, line[0], with_unit(line[1], file.units[1]))
        return _in_plane(file, points, places, axes)


def _line(places: FloatArray, axes: tuple[str, str]) -> tuple[FloatArray, str] | None:
    """Coordinates along the line on which all contacts lie, and its name; None if there is no such line."""
    _, sizes, directions = np.linalg.svd(places - places.mean(axis=0), full_matrices=True)
    if len(places) > 2 and sizes[1] > PAIRING.line_tolerance * sizes[0]:
        return None
    along = directions[0] * np.sign(directions[0][np.abs(directions[0]).argmax()])
    along = np.where(np.abs(along) < PAIRING.normal_tolerance, 0.0, along)
    return places @ along, direction_name(along, axes)


def _in_row(file: InterfaceFile, points: Sequence[InterfacePoint], at: FloatArray, label: str) -> Figure:
    """Contacts on a line: their states on levels, their values as bars."""
    count = len(points)
    few = count == 1 and len(at) <= LAYOUT.few_contacts
    width = TWO_COLUMNS if count > 1 else COLUMN if few else LAYOUT.width
    figure = new_figure(width, LAYOUT.row_of_contacts)
    grid = figure.subplots(1 + len(CONTACT_LOADS), count, sharex=True, sharey="row", squeeze=False)
    between = np.diff(np.unique(at))
    step = float(between.min()) if between.size else 1.0
    low, high = float(at.min()) - step, float(at.max()) + step
    thick = min(0.8 * step, LAYOUT.thickest_bar * (high - low))
    size = float(np.clip((_SHARE * 72.0 * (width - _BAR) / count * step / (high - low)) ** 2, *_SIZE))
    for column, point in enumerate(points):
        for k, (_, colour, mark) in enumerate(STATES_OF_CONTACTS):
            here = point.state == k
            grid[0, column].scatter(
                at[here], np.full(here.sum(), k), c=colour, marker=mark, s=size, edgecolors="black",
                linewidths=0.4,
            )  # fmt: skip
        grid[0, column].set_title(_head(file, point), fontsize=8)
    for row, ((_, title), unit) in enumerate(zip(CONTACT_LOADS, file.units, strict=True)):
        values = np.array([point.contact_loads[row] for point in points])
        low_value, high_value, kind = _heights(values)
        for column in range(count):
            grid[1 + row, column].bar(at, values[column], width=thick, color="#404040")
            grid[1 + row, column].set_yscale(kind)
            grid[1 + row, column].set_ylim(low_value, high_value)
            if not values[column].any():
                grid[1 + row, column].text(
                    0.5, 0.5, "none", transform=grid[1 + row, column].transAxes, ha="center", va="center"
                )
        if not values.any():
            grid[1 + row, 0].set_yticks([0.0])
        grid[1 + row, 0].set_ylabel("\n".join((title, f"({unit})" * bool(unit))), parse_math=False)
    grid[0, 0].set_yticks(range(len(STATES_OF_CONTACTS)), [word for word, *_ in STATES_OF_CONTACTS])
    grid[0, 0].set_ylim(-0.6, len(STATES_OF_CONTACTS) - 0.4)
    grid[0, 0].set_xlim(low, high)
    room = 72.0 * (width - _BAR) / count * step / (high - low)  # [point] from one contact to the next
    _name_contacts(grid, file.contacts, at, room, label)
    return figure


def _heights(values: FloatArray) -> tuple[float, float, str]:
    """Limits and kind of the axis of bars, which is logarithmic if `_scale` is."""
    from matplotlib.colors import LogNorm

    scale = _scale(values)
    low, high = float(scale.vmin or 0.0), float(scale.vmax or 1.0)
    if isinstance(scale, LogNorm):  # room below, so that the least has a bar
        return low / LAYOUT.decade**0.5, high * 1.05 * (high / low) ** 0.05, "log"
    return 0.0, 1.05 * high, "linear"


def _name_contacts(grid: Any, names: Sequence[str], at: FloatArray, room: float, label: str) -> None:
    """Label the ticks with the contacts' names, upright or turned as there is room; else with numbers."""
    from matplotlib.ticker import MaxNLocator

    height, of_line = float(LAYOUT.small_text), label != _ROW
    ticks = [f"{name}\n{place:.4g}" for name, place in zip(names, at.tolist(), strict=True)]
    ticks = ticks if of_line else list(names)
    longest = max(len(line) for tick in ticks for line in tick.split("\n"))
    upright = LAYOUT.letter_width * height * (longest + 1) <= room
    turned = LAYOUT.line_distance * height * (2 if of_line else 1) <= room
    for axes in grid[-1]:
        if upright or turned:
            axes.set_xticks(at, ticks, rotation=0 if upright else 90, fontsize=height, parse_math=False)
        elif not of_line:
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel(f"{_ROW}, at {label}" if of_line and (upright or turned) else label)


def _head(file: InterfaceFile, point: InterfacePoint) -> str:
    """Heading of a panel: which point of which curve it shows."""
    place = place_of(file, point).replace(", ", "\n")  # a film strip has narrow panels
    asked = f"\n{point.asked}" if point.asked else ""
    return (f"{point.curve}\n" if point.curve else "") + f"{place}{stays_at(point)}{asked}"


def _in_plane(
    file: InterfaceFile, points: Sequence[InterfacePoint], places: FloatArray, names: tuple[str, str]
) -> Figure:
    """Contacts in a plane: marks at their places; a point alone has its four panels in a square."""
    count = len(points)
    rows, columns = (2, 2) if count == 1 else (1 + len(CONTACT_LOADS), count)
    figure = new_figure(TWO_COLUMNS, _height(places, TWO_COLUMNS, rows, columns))
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    panels = grid.reshape(-1, count)  # (quantity, point)
    size, none = _size(places, TWO_COLUMNS, columns), False
    for column, point in enumerate(points):
        for k, (_, colour, mark) in enumerate(STATES_OF_CONTACTS):
            panels[0, column].scatter(
                *places[point.state == k].T, c=colour, marker=mark, s=size, edgecolors="black", linewidths=0.4
            )
        panels[0, column].set_title(_head(file, point), fontsize=8)
        if len(places) <= LAYOUT.named_contacts:
            low, high = _limits(places)
            scale_of = 72.0 * (TWO_COLUMNS - _BAR) / columns / float((high - low)[0])  # [point] for a length
            _write_names(panels[0, column], file.contacts, places, size, scale_of)
    for row, ((_, title), unit) in enumerate(zip(CONTACT_LOADS, file.units, strict=True)):
        values = np.array([point.contact_loads[row] for point in points])
        scale = _scale(values)
        for axes, one in zip(panels[1 + row], values, strict=True):
            none |= _valued(axes, places, one, scale, size)
        _bar(figure, panels[1 + row, -1], scale)
        panels[1 + row, 0].set_title(with_unit(title, unit), loc="left", fontsize=8, parse_math=False)
    (left, lower), (right, upper) = _limits(places)
    for axes in grid.flat:
        axes.set_aspect("equal")
        axes.set_xlim(left, right)
        axes.set_ylim(lower, upper)
    for direction, name in zip("xy", names, strict=True):
        getattr(figure, f"sup{direction}label")(with_unit(name, file.units[1]), fontsize=8)
    _legend(figure, points, none)
    return figure


def _write_names(axes: Axes, names: Sequence[str], places: FloatArray, size: float, scale: float) -> None:
    """The names of contacts above or below their marks, towards the middle of the panel.

    If names would overlap, those of pairs such as lap_7 become their numbers. A name that still overlaps one
    before it is left out. scale: points of print for a length of 1.
    """
    low, high = _limits(places)
    beside = 0.5 * size**0.5 + 2.0  # [point]
    written = list(names)
    if not all(_have_room(written, places, scale)):
        written = [name.rpartition("_")[2] if name.rpartition("_")[2].isdigit() else name for name in names]
    for name, place, has_room in zip(written, places, _have_room(written, places, scale), strict=True):
        if not has_room:
            continue
        half = 0.5 * LAYOUT.letter_width * LAYOUT.small_text * len(name) / scale
        side = "left" if place[0] - half < low[0] else "right" if place[0] + half > high[0] else "center"
        up = float((place - low)[1] / (high - low)[1])
        axes.annotate(
            name, place, (0.0, beside if up < 0.5 else -beside), textcoords="offset points",
            ha=side, va="bottom" if up < 0.5 else "top", fontsize=LAYOUT.small_text, parse_math=False,
        )  # fmt: skip


def _have_room(names: Sequence[str], places: FloatArray, scale: float) -> list[bool]:
    """Whether each name, at the height of its mark, is clear of the earlier ones that have room."""
    taken = list[tuple[float, float, float]]()  # middle, height and half width [point]
    found = list[bool]()
    line = LAYOUT.line_distance * LAYOUT.small_text
    for name, (x, y) in zip(names, (scale * places).tolist(), strict=True):
        half = 0.5 * LAYOUT.letter_width * LAYOUT.small_text * (len(name) + 1)
        found.append(not any(abs(x - u) < half + w and abs(y - v) < line for u, v, w in taken))
        if found[-1]:
            taken.append((x, y, half))
    return found


def _legend(figure: Figure, points: Sequence[InterfacePoint], none: bool) -> None:
    """The states, with the number of contacts where there is one point; and the mark of no value."""
    from matplotlib.lines import Line2D

    edge: dict[str, Any] = {"markeredgecolor": "black", "markeredgewidth": 0.4}
    marks, words = list[Line2D](), list[str]()
    for k, (word, colour, mark) in enumerate(STATES_OF_CONTACTS):
        number = int(sum((point.state == k).sum() for point in points))
        marks.append(Line2D([], [], color=colour, marker=mark, linestyle="", **edge))
        words.append(f"{word} ({number})" if len(points) == 1 else word)
    if none:
        colour, mark = NONE
        marks.append(Line2D([], [], color=colour, marker=mark, linestyle=""))
        words.append("none, or below the colours")
    figure.legend(marks, words, loc="outside upper center", ncols=len(words))


def _scale(values: FloatArray) -> Normalize:
    """Colour scale for all columns; logarithmic if a linear one would leave a column dark beside another.

    Columns without a positive value do not count. A logarithmic scale leaves out values that are 0 or far
    below the greatest.
    """
    from matplotlib.colors import LogNorm, Normalize

    tops = np.nanmax(values, axis=1, initial=0.0)
    top = float(tops.max())
    if tops[tops > 0.0].min(initial=np.inf) >= LAYOUT.dark * top:  # also where all are 0
        return Normalize(0.0, top or 1.0)
    least = float(np.nanmin(values, where=values > LAYOUT.least_colour * top, initial=top))
    return LogNorm(min(least, 0.1 * top), top)


def _valued(axes: Axes, places: FloatArray, values: FloatArray, scale: Normalize, size: float) -> bool:
    """Draw marks coloured by value, crosses for 0 or below the scale; return whether there are crosses."""
    seen = (values > 0.0) & (values >= (scale.vmin or 0.0))
    x, y = places.T
    colour, mark = NONE
    axes.scatter(x[~seen], y[~seen], c=colour, marker=mark, s=0.5 * size, linewidths=0.8)
    axes.scatter(
        x[seen], y[seen], c=values[seen], cmap="viridis", norm=scale, edgecolors="#808080", linewidths=0.3,
        s=size,
    )  # fmt: skip
    return not seen.all()


def _bar(figure: Figure, beside: Axes, scale: Normalize) -> None:
    """Draw the colour bar beside a panel, as high as that panel."""
    from matplotlib.cm import ScalarMappable

    width = LAYOUT.bar_width / (72.0 * beside.get_position().width * figure.get_size_inches()[0])
    figure.colorbar(ScalarMappable(scale, "viridis"), cax=beside.inset_axes((1.0 + width, 0.0, width, 1.0)))


def _limits(places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The lower left and the upper right of the interface with room for marks around it."""
    low, high = places.min(axis=0), places.max(axis=0)
    room = LAYOUT.interface_room * float((high - low).max())
    return low - room, high + room


def _size(places: FloatArray, width: float, columns: int) -> float:
    """Size [point^2] of a mark, so that neighbouring marks do not touch."""
    low, high = _limits(places)
    between = np.linalg.norm(places[:, None] - places, axis=-1)
    np.fill_diagonal(between, np.inf)
    panel = 72.0 * (width - _BAR) / columns  # its width [point]
    apart = panel * float(np.median(between.min(axis=1)) / (high - low)[0])
    return float(np.clip((_SHARE * apart) ** 2, *_SIZE))


def _height(places: FloatArray, width: float, rows: int, columns: int) -> float:
    """Height [inch] of the figure at which panels with one scale in both directions fill it."""
    low, high = _limits(places)
    across, up = (high - low).tolist()
    panel = (width - _BAR) / columns * up / across
    return float(np.clip((panel + _ABOVE) * rows + 2.0 * _ABOVE, *_HEIGHTS))
