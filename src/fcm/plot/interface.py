"""What the contacts of an interface do at points of a curve: which stick, slip or open; what they bear."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.plot.errors import PlotError
from fcm.plot.labels import curve_label, short_names, with_unit
from fcm.plot.pairs import plane_view
from fcm.plot.read import FloatArray, floats, opened, swept_units, swept_values
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT, TWO_COLUMNS, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

_NEEDED = ("frequency", "amplitude", "contact", "regime", "dissipated_energy")
CONTACT_LOADS = (("dissipated_energy", "energy in a cycle"), ("slip_path", "slip path in a cycle"),
          ("greatest_normal_force", "greatest normal force"))  # fmt: skip
STATES_OF_CONTACTS = (  # word, colour and mark: told apart without colours, too
    ("sticks", "#0072B2", "o"),
    ("slips", "#E69F00", "^"),
    ("slips and opens", "#D55E00", "s"),
    ("open", "#FFFFFF", "o"),
)
_SIZE = (4.0, 60.0)  # [point^2] of a mark, for many contacts and for few
_SHARE = 0.7  # of the distance of two marks is filled by them
_BAR, _ABOVE = 1.2, 0.35  # [inch] beside the panels for a bar of colours, and above each
_HEIGHTS = (3.5, 11.0)  # [inch] of a figure


@dataclass(frozen=True)
class InterfaceFile:
    """What a response file has on its contacts."""

    path: Path
    unit: str
    contacts: tuple[str, ...]
    dofs: tuple[str, ...]
    frequency: FloatArray  # (curve, point) in the file's unit
    amplitude: FloatArray  # (curve, point, dof)
    stable: FloatArray  # (curve, point) 1, 0 or NaN
    states: npt.NDArray[np.str_]  # (curve, point, contact)
    contact_loads: FloatArray  # (3, curve, point, contact): energy, slip path, greatest normal force
    units: tuple[str, str, str]  # of these, where the file says them
    places: FloatArray | None = None  # (contact, 2) in the plane of the contacts, where the file says them
    names: tuple[str, ...] = ()  # of the curves of a sweep: the values of each
    swept: tuple[Mapping[str, float], ...] = ()  # these values, by their short names
    forced: bool = True  # whether its curves are no nonlinear modes


@dataclass(frozen=True)
class InterfacePoint:
    """All contacts at one point of a curve; state (contact,) numbers `sticks`, `slips`, `slips and opens`,
    `open`."""

    frequency: float
    stable: float
    state: npt.NDArray[np.intp]
    contact_loads: FloatArray  # (3, contact)
    curve: str = ""  # its name, where there are several
    swept: Mapping[str, float] = field(default_factory=dict)  # of a sweep, by short names
    forced: bool = True  # and no nonlinear mode, which is neither stable nor unstable


@apart
def read_interface(path: Path) -> InterfaceFile:
    """Read what ``fcm respond -o`` has written; PlotError if the file says nothing of its contacts."""
    names = tuple(name for name, _ in CONTACT_LOADS)
    with opened(
        path, "a response with contacts", (*_NEEDED, *names[1:], "dof"), ("stable", "contact_position")
    ) as data:
        variables = data.variables
        contacts, dofs = (
            tuple(str(one) for one in np.atleast_1d(variables[name][:])) for name in ("contact", "dof")
        )
        frequency, amplitude = floats(variables["frequency"]), floats(variables["amplitude"])
        states = np.asarray(variables["regime"][:]).astype(str)
        contact_loads = np.stack([floats(variables[name]) for name in names])
        stable = floats(variables["stable"]) if "stable" in variables else np.full(frequency.shape, np.nan)
        unit = str(getattr(data, "frequency_unit", "rad/s"))
        places = _places(variables)
        energy, slip, normal = (str(getattr(variables[name], "units", "")) for name in names)
        swept, forced = swept_values(variables), "modal_amplitude" not in variables
        units_of = swept_units(variables, swept)
    if not contacts:
        raise PlotError(f"{path}: its scene has no contacts")
    units = energy, slip, normal
    values = [{key: float(one[k]) for key, one in swept.items()} for k in range(len(frequency))]
    curves = tuple(curve_label(one, units=units_of) for one in values) if swept else ()
    of_contacts = contacts, dofs, frequency, amplitude, stable, states, contact_loads, units, places, curves
    short = short_names(swept)
    named = tuple({short[key]: value for key, value in one.items()} for one in values) if swept else ()
    return InterfaceFile(path, unit, *of_contacts, named, forced)


def _places(variables: Any) -> FloatArray | None:
    """Where the contacts are in their plane; None where the file does not say that of all."""
    if "contact_position" not in variables:
        return None
    found = floats(variables["contact_position"])
    if not np.isfinite(found).all() or not len(found):
        return None
    along, centre = plane_view(found)
    places: FloatArray = (found - centre) @ along.T
    return places


def points_of(file: InterfaceFile, at: Sequence[float], curve: int = 0) -> list[InterfacePoint]:
    """The point of a curve nearest to each frequency; of several solutions there the highest that is not
    unstable, or the highest. Without a frequency the point of the greatest amplitude.

    Raises
    ------
    PlotError
        If the curve or a frequency is not in the file.
    """
    if not 0 <= curve < len(file.frequency):
        last = len(file.frequency) - 1
        raise PlotError(f"{file.path}: there is no curve {curve}; it has the curves 0 to {last}")
    frequency = file.frequency[curve]
    height = np.nanmax(np.where(np.isfinite(file.amplitude[curve]), file.amplitude[curve], -1.0), axis=1)
    if not np.isfinite(frequency).any():
        raise PlotError(f"{file.path}: curve {curve} has no points")
    if not at:
        return [_point(file, curve, int(height.argmax()))]
    low, high = float(np.nanmin(frequency)), float(np.nanmax(frequency))
    found = []
    for one in at:
        if not low <= one <= high:
            raise PlotError(f"--at {one:g}: the curve goes from {low:g} to {high:g} {file.unit}")
        before, after = frequency[:-1], frequency[1:]
        passed = np.flatnonzero((np.minimum(before, after) <= one) & (one <= np.maximum(before, after)))
        nearer = passed + (np.abs(after[passed] - one) < np.abs(before[passed] - one))
        if not nearer.size:  # a point alone, or beside a gap
            nearer = np.array([int(np.nanargmin(np.abs(frequency - one)))])
        stays = file.stable[curve, nearer] != 0.0
        nearer = nearer[stays] if stays.any() else nearer
        found.append(_point(file, curve, int(nearer[height[nearer].argmax()])))
    return found


def _point(file: InterfaceFile, curve: int, k: int) -> InterfacePoint:
    words = file.states[curve, k]
    opens = np.array(["S" in word for word in words])
    slips = np.array([bool(set(word) - set("ES")) for word in words])
    always = words == "S"
    state = np.where(always, 3, np.where(opens, 2, np.where(slips, 1, 0)))
    omega, stable = float(file.frequency[curve, k]), float(file.stable[curve, k])
    several = len(file.names) > 1
    named = (file.names[curve], file.swept[curve]) if several else ("", {})
    return InterfacePoint(
        omega, stable, state.astype(np.intp), file.contact_loads[:, curve, k], *named, file.forced
    )


def greatest_takers(file: InterfaceFile, point: InterfacePoint, most: int) -> list[tuple[str, ...]]:
    """A row for each of the contacts that take most energy, if any: name, state, energy, its share, slip
    path and greatest normal force."""
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
        )
        for i in order.tolist()
    ]


@apart
def read_places(path: Path, contacts: Sequence[str]) -> FloatArray:
    """Coordinates (contact, 2) of a text file with a line for each contact: its name, then two numbers,
    parted by commas or blanks; what follows # is a remark.

    Raises
    ------
    PlotError
        With all that is wrong: lines that are none, names that are no contacts, contacts without a line.
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
            wrong.append(f"line {number}: {line.strip()!r} is not a name and two numbers, as in: p1 0.0 0.5")
            continue
        if name not in contacts:
            wrong.append(f"line {number}: the response has no contact {name!r}")
        elif name in places:
            wrong.append(f"line {number}: {name} has a line already")
        places[name] = (x, y)
    missing = [name for name in contacts if name not in places]
    if missing and not wrong:
        more = f" and {len(missing) - 3} others" if len(missing) > 3 else ""
        wrong.append(f"no line for {', '.join(missing[:3])}{more}")
    if wrong:
        raise PlotError("\n".join(f"{path}: {one}" for one in wrong))
    return np.array([places[name] for name in contacts])


def draw_interface(
    file: InterfaceFile, points: Sequence[InterfacePoint], places: FloatArray | None = None
) -> Figure:
    """The figure: a column for each point; a row for the states, and for energy, slip path and normal force.

    places (contact, 2): where each contact is; None: in a row, in their order.
    """
    count, titles = len(points), [f"{name}" for _, name in CONTACT_LOADS]
    with house_style():
        width = TWO_COLUMNS if count > 1 else LAYOUT.width
        figure = new_figure(width, 6.4 if places is None else _height(places, width, count))
        grid = figure.subplots(
            1 + len(CONTACT_LOADS),
            count,
            sharex=True,
            sharey="row" if places is None else True,
            squeeze=False,
        )
        size = _size(len(file.contacts), places, width, count)
        for column, point in enumerate(points):
            _states(grid[0, column], point, places, size)
            unknown = ", stability unknown" if point.forced else ""
            stays = {0.0: ", unstable", 1.0: ""}.get(point.stable, unknown)
            head = f"{point.curve}\n" if point.curve else ""
            grid[0, column].set_title(f"{head}{point.frequency:.6g} {file.unit}{stays}", fontsize=8)
        for row, (title, unit) in enumerate(zip(titles, file.units, strict=True)):
            values = np.array([point.contact_loads[row] for point in points])
            top = float(np.nanmax(values, initial=0.0)) or 1.0
            scale = _scale(values)
            label = f"{title} [{unit}]" if unit else title
            for column in range(count):
                axes = grid[1 + row, column]
                if places is None:
                    axes.bar(np.arange(1, len(file.contacts) + 1), values[column], width=0.8, color="#404040")
                    axes.set_ylim(0.0, 1.05 * top)
                else:
                    _valued(axes, places, values[column], scale, size)
            if places is None:
                grid[1 + row, 0].set_ylabel(label, parse_math=False)
            else:
                _bar(figure, grid[1 + row, -1], scale)
                grid[1 + row, 0].set_title(label, loc="left", fontsize=8, parse_math=False)
        _finish(figure, grid, points, places)
        if places is not None and places is file.places:
            where = with_unit("Distance from the middle of the contacts, in their plane", file.units[1])
            figure.supxlabel(where, fontsize=8)
    return figure


def _scale(values: FloatArray) -> Normalize:
    """Colours of the values of all columns: by their logarithm where a column would be dark beside another.

    Of a logarithmic scale what is 0 or far below the greatest value has no place.
    """
    from matplotlib.colors import LogNorm, Normalize

    top = float(np.nanmax(values, initial=0.0))
    if np.nanmax(values, axis=1, initial=0.0).min() >= LAYOUT.dark * top:  # also where all are 0
        return Normalize(0.0, top or 1.0)
    least = float(np.nanmin(values, where=values > LAYOUT.least_colour * top, initial=top))
    return LogNorm(min(least, 0.1 * top), top)


def _valued(axes: Axes, places: FloatArray, values: FloatArray, scale: Normalize, size: float) -> None:
    """Marks coloured by their values; those below the scale are white."""
    seen = values >= (scale.vmin or 0.0)
    edge: dict[str, Any] = {"edgecolors": "#808080", "linewidths": 0.3, "s": size}
    x, y = places.T
    axes.scatter(x[~seen], y[~seen], c="white", **edge)
    axes.scatter(x[seen], y[seen], c=values[seen], cmap="viridis", norm=scale, **edge)


def _bar(figure: Figure, beside: Axes, scale: Normalize) -> None:
    """The bar of colours as high as the panel that it stands beside."""
    from matplotlib.cm import ScalarMappable

    width = LAYOUT.bar_width / (72.0 * beside.get_position().width * figure.get_size_inches()[0])
    figure.colorbar(ScalarMappable(scale, "viridis"), cax=beside.inset_axes((1.0 + width, 0.0, width, 1.0)))


def _limits(places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The lower left and the upper right of the interface with room for marks around it."""
    low, high = places.min(axis=0), places.max(axis=0)
    room = LAYOUT.interface_room * float((high - low).max()) or 1.0
    return low - room, high + room


def _size(contacts: int, places: FloatArray | None, width: float, count: int) -> float:
    """Of a mark [point^2]: so that those in a row, or next to one another in the plane, do not touch."""
    panel = 72.0 * (width - _BAR) / count  # its width [point]
    if places is None or len(places) < 2:
        apart = panel / contacts
    else:
        low, high = _limits(places)
        between = np.linalg.norm(places[:, None] - places, axis=-1)
        np.fill_diagonal(between, np.inf)
        apart = panel * float(np.median(between.min(axis=1)) / (high - low)[0])
    return float(np.clip((_SHARE * apart) ** 2, *_SIZE))


def _height(places: FloatArray, width: float, count: int) -> float:
    """Of the figure [inch], so that panels of one scale in both directions fill it."""
    low, high = _limits(places)
    across, up = (high - low).tolist()
    panel = (width - _BAR) / count * up / across
    return float(np.clip((panel + _ABOVE) * (1 + len(CONTACT_LOADS)) + _ABOVE, *_HEIGHTS))


def _states(axes: Axes, point: InterfacePoint, places: FloatArray | None, size: float) -> None:
    """Marks by state; in a row one level for each."""
    number = np.arange(1, len(point.state) + 1)
    for k, (_, colour, mark) in enumerate(STATES_OF_CONTACTS):
        here = point.state == k
        x, y = (number[here], np.full(here.sum(), k)) if places is None else places[here].T
        axes.scatter(x, y, c=colour, marker=mark, s=size, edgecolors="black", linewidths=0.4)


def _finish(figure: Figure, grid: Any, points: Sequence[InterfacePoint], places: FloatArray | None) -> None:
    from matplotlib.lines import Line2D

    if places is not None:
        (left, lower), (right, upper) = _limits(places)
        for axes in grid.flat:
            axes.set_aspect("equal")
            axes.set_xlim(left, right)
            axes.set_ylim(lower, upper)
    if places is None:
        grid[0, 0].set_yticks(range(len(STATES_OF_CONTACTS)), [word for word, *_ in STATES_OF_CONTACTS])
        grid[0, 0].set_ylim(-0.6, len(STATES_OF_CONTACTS) - 0.4)
        for axes in grid[-1]:
            axes.set_xlabel("contact")
        return
    marks = [
        Line2D([], [], color=colour, marker=mark, linestyle="", markeredgecolor="black", markeredgewidth=0.4)
        for _, colour, mark in STATES_OF_CONTACTS
    ]
    words = [
        f"{word} ({int(sum((point.state == k).sum() for point in points))})" if len(points) == 1 else word
        for k, (word, *_) in enumerate(STATES_OF_CONTACTS)
    ]
    figure.legend(marks, words, loc="outside upper center", ncols=len(STATES_OF_CONTACTS))
