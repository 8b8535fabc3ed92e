"""Peaks and folds tracked over a number: the design peak, and the window with several solutions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.frozen import Frozen
from fcm.plot.curve_names import name_at_side
from fcm.plot.dof import asked_for, column_of, leading_column
from fcm.plot.errors import PlotError
from fcm.plot.labels import frequency_label, staying, symbols, with_unit
from fcm.plot.options import READ
from fcm.plot.peak import ring_at
from fcm.plot.read import FloatArray, floats, opened
from fcm.plot.reader_process import apart
from fcm.plot.style import (
    LAYOUT,
    has_decades,
    house_style,
    logarithmic_axis,
    new_figure,
    sequence_colours,
    swept_axis,
)
from fcm.plot.summary import summary_of
from fcm.rotational_dofs import dof_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NEEDED = ("tracked_number", "tracked_frequency", "tracked_amplitude", "tracked_turn", "track_what", "dof")
_ALSO = ("tracked_trough", "tracked_stable")
_OPTIMUM = (
    "optimum_number",
    "optimum_peak",
    "optimum_frequency",
    "optimum_stable",
    "optimum_higher_peak",
    "optimum_kind",
)
_MARK, _SHADE, _TRIED = "#c03020", "#c0d4ea", "0.4"
_WIDTH, _BELOW = 1.1, 0.9  # [point] of a line; added for each line drawn above it


class DrawnTrack(Frozen):
    """One tracked curve without its padding."""

    what: str
    number: FloatArray  # (point,)
    frequency: FloatArray  # (point,) in the file's unit
    amplitude: FloatArray  # (point, dof)
    turn: FloatArray  # (point,) 1 where the number turns back
    trough: FloatArray  # (point,) 1 where the tracked extremum is a trough, no peak
    stable: FloatArray  # (point,) 1 where the motion is stable, 0 where unstable, NaN where unknown
    swept: tuple[float, ...] = ()  # values of the curve of the scene that it belongs to


class DrawnTracking(Frozen):
    """All tracked curves of a file, and the optimum if there is one."""

    key: str
    dofs: tuple[str, ...]
    frequency_unit: str
    tracks: tuple[DrawnTrack, ...]
    optimum: tuple[float, float] | None = None  # the number, and the peak
    stays: str = ""  # text on the stability at the optimum
    length: str = ""
    unit: str = ""  # of the number
    at_bound: bool = False  # whether the optimum is at an end of the range of the number
    tried: FloatArray = field(
        default_factory=lambda: np.empty((0, 2))
    )  # (value, 2) number, and greatest peak there
    swept: Mapping[str, str] = field(default_factory=dict)  # keys of what was swept, with their units
    asked: tuple[str, ...] = ()  # degrees of freedom that the scene asks for, if it says so


@apart
def read_tracked(path: Path) -> DrawnTracking | None:
    """Read what ``fcm respond`` has written with --track or for an [optimum]; None for another file."""
    with opened(path, "a response file", (), (*_NEEDED, *_ALSO, *_OPTIMUM)) as data:
        variables = data.variables
        if any(name not in variables for name in _NEEDED):
            return None
        names = (*_NEEDED[:4], _ALSO[0])
        number, frequency, amplitude, turn, trough = (floats(variables[name]) for name in names)
        stable = floats(variables["tracked_stable"]) if "tracked_stable" in variables else np.ones_like(turn)
        of_sweep = [
            one for name, one in variables.items() if name.startswith("track_") and hasattr(one, "key")
        ]
        values = np.array([floats(one) for one in of_sweep]).reshape(len(of_sweep), len(number))
        whats = [str(one) for one in np.atleast_1d(variables["track_what"][:])]
        tracks = []
        for i, what in enumerate(whats):
            there = np.isfinite(number[i])
            columns = (one[i][there] for one in (number, frequency, amplitude, turn, trough, stable))
            track = DrawnTrack(what, *columns)
            tracks.append(replace(track, swept=tuple(values[:, i].tolist())))
        optimum, stays = None, ""
        if "optimum_peak" in variables and variables["optimum_peak"].shape == (1,):
            number_at, peak = (floats(variables[name]) for name in _OPTIMUM[:2])
            if not number_at.size:
                raise ValueError("its optimum has no number")
            optimum = (float(number_at[0, 0]), float(peak[0]))
            stays = _stays(variables)
            if "optimum_higher_peak" in variables:
                higher = float(floats(variables["optimum_higher_peak"])[0])
                stays += f" (and one of {higher:.4g} that was not followed)"
        kind = np.atleast_1d(variables["optimum_kind"][:]).tolist() if "optimum_kind" in variables else []
        dofs = tuple(str(name) for name in np.atleast_1d(variables["dof"][:]))
        return DrawnTracking(
            str(getattr(variables["tracked_number"], "key", "")),
            dofs,
            str(getattr(data, "frequency_unit", "rad/s")),
            tuple(tracks),
            optimum,
            stays,
            str(getattr(variables["tracked_amplitude"], "units", "")),
            str(getattr(variables["tracked_number"], "units", "")),
            kind == ["bound"],
            _tried(data) if optimum else np.empty((0, 2)),
            {str(one.key): str(getattr(one, "units", "")) for one in of_sweep},
            asked_for(getattr(data, "output", ""), dofs),
        )


def _tried(data: Any) -> FloatArray:
    """Numbers (value, 2) tried in the search for an optimum, each with its greatest peak."""
    try:
        (found,) = summary_of(data).get("optimum", [{}])
        tried = np.array(found.get("tried", []), dtype=np.float64).reshape(-1, 2)
    except (AttributeError, TypeError) as error:
        raise ValueError("its summary has no optimum that was tried") from error
    if not (np.abs(tried) <= READ.max_number).all():
        raise ValueError("its optimum was tried at what is no number")
    return tried


def _stays(variables: Any) -> str:
    """Sentence on the stability of the motion at the optimum, or at its equal peaks."""
    if "optimum_stable" not in variables:
        return ""
    told = floats(variables["optimum_stable"])[0][np.isfinite(floats(variables["optimum_frequency"])[0])]
    return staying(0.0 if (told == 0.0).any() else float(told.min(initial=1.0)))


def draw_tracked(drawn: DrawnTracking, dof: str | None = None, folds: bool = False) -> Figure:
    """Draw frequencies of folds with shaded windows; or height and frequency of peaks or onsets.

    Folds are drawn if the file has any; PlotError if `folds` is set and it has none.
    """
    is_fold = [track.what == "fold" for track in drawn.tracks]
    if folds and not any(is_fold):
        raise PlotError("the file holds no folds that were tracked; run fcm respond with --track folds")
    if any(is_fold):
        return _draw_folds(drawn)
    return _draw_peaks(drawn, dof)


def _draw_folds(drawn: DrawnTracking) -> Figure:
    tracks = [track for track in drawn.tracks if track.what == "fold"]
    with house_style():
        figure = new_figure(LAYOUT.width, LAYOUT.height)
        axes = figure.subplots()
        colours = _colours_of_sweep(tracks)
        for number, frequency in _windows(tracks):
            axes.fill(number, frequency, color=_SHADE, linewidth=0.0, zorder=0)
        for track in tracks:
            _line(axes, track, track.frequency, colours.get(track.swept, "black"))
            at = track.turn == 1.0
            axes.plot(track.number[at], track.frequency[at], "o", markersize=3.5, color=_MARK, zorder=3)
        axes.set_ylabel(frequency_label(drawn.frequency_unit).replace("Frequency", "Frequency of folds"))
        _name_number(axes, drawn, tracks)
        dots = "; dots: a window ends" if any((track.turn == 1.0).any() for track in tracks) else ""
        axes.set_title(f"shaded: several solutions{dots}", loc="right", fontsize=8)
        _name_lines(axes, tracks)
        _name_swept(figure, drawn, colours)
    return figure


def _windows(tracks: Sequence[DrawnTrack]) -> list[tuple[FloatArray, FloatArray]]:
    """Numbers and frequencies around the windows with several solutions.

    A curve that returns to its first number encloses a window. The other curves go from end to end: sorted
    by frequency, each two of one swept value have a window between them.
    """
    found, across = list[tuple[FloatArray, FloatArray]](), dict[tuple[float, ...], list[DrawnTrack]]()
    for track in tracks:
        if np.isclose(track.number[0], track.number[-1]):
            found.append((track.number, track.frequency))
        else:
            across.setdefault(track.swept, []).append(track)
    for group in across.values():
        rising = sorted(group, key=lambda track: float(track.frequency.mean()))
        for low, high in zip(rising[::2], rising[1::2], strict=False):
            if len(group) % 2 == 0 and np.allclose(_ends(low), _ends(high)):
                step = 1 if np.isclose(low.number[0], high.number[-1]) else -1
                found.append(
                    (
                        np.concatenate((low.number, high.number[::step])),
                        np.concatenate((low.frequency, high.frequency[::step])),
                    )
                )
    return found


def _ends(track: DrawnTrack) -> tuple[float, float]:
    return float(track.number.min()), float(track.number.max())


def _draw_peaks(drawn: DrawnTracking, dof: str | None) -> Figure:
    dof = None if dof is None else drawn.dofs[column_of(drawn.dofs, dof)]
    peaks = [one for one in drawn.tracks if one.what.startswith("peak of ")] or list(drawn.tracks)
    onsets = not any(one.what.startswith("peak of ") for one in peaks)
    if onsets:  # onsets belong to contacts, not to degrees of freedom
        heights_of = np.concatenate([one.amplitude for one in peaks])
        dof = drawn.dofs[leading_column(drawn.dofs, dof, heights_of, drawn.asked)]
    if of_sweep := _colours_of_sweep(
        peaks
    ):  # the colours show swept values, so that one degree of freedom is drawn
        dof = dof or peaks[0].what.removeprefix("peak of ")
    wanted = [one for one in peaks if dof is None or one.what == f"peak of {dof}"] or peaks
    with house_style():
        figure = new_figure(LAYOUT.width, 1.3 * LAYOUT.height)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        names = list(dict.fromkeys(track.what for track in wanted))
        unnamed = list(names)
        # thick lines below thin ones: nearly equal peaks would hide one another
        widths = {name: _WIDTH + _BELOW * k for k, name in enumerate(reversed(names))}
        colours = (
            {id(track): of_sweep[track.swept] for track in wanted} if of_sweep else _colours(wanted, names)
        )
        heights: list[tuple[float, float]] = []
        drawn_tracks: list[DrawnTrack] = []
        for track in wanted:
            name = dof or track.what.removeprefix("peak of ")
            column = drawn.dofs.index(name) if name in drawn.dofs else 0
            height = np.where(track.trough == 1.0, np.nan, track.amplitude[:, column])
            frequency = np.where(track.trough == 1.0, np.nan, track.frequency)
            ends = height[track.trough != 1.0]
            if ends.size:
                heights.append((float(ends.min()), float(ends.max())))
                drawn_tracks.append(track)
            label = track.what if track.what in unnamed else None  # once for all its curves
            unnamed = [one for one in unnamed if one != label]
            for axes, values, text in ((upper, height, label), (lower, frequency, None)):
                _line(axes, track, values, colours[id(track)], text, widths[track.what])
        tried = len(drawn.tried) > 0 and len(wanted) == len(
            peaks
        )  # trials hold the greatest of several peaks
        if tried:
            upper.plot(*drawn.tried.T, "x", color=_TRIED, markersize=4.0)
        of_one = {dof or track.what.removeprefix("peak of ") for track in wanted} & set(drawn.dofs)
        one = of_one.pop() if len(of_one) == 1 else ""
        unit = dof_unit(one, drawn.length) if one else drawn.length
        height_called, frequency_called = "Peak amplitude", "Peak frequency"
        if onsets:
            height_called, frequency_called = "Amplitude", "Frequency"
            kinds = names if len(names) == 1 else dict.fromkeys(name.partition(" of ")[0] for name in names)
            title = f"at the onset of {' and '.join(kinds)}"
            upper.set_title(title, loc="left", fontsize=8, parse_math=False)
        named = f"{height_called} of {one}" if one else height_called
        upper.set_ylabel(with_unit(named, unit), parse_math=False)
        lower.set_ylabel(frequency_label(drawn.frequency_unit).replace("Frequency", frequency_called))
        of_note = _of_note(drawn_tracks, heights) if heights else []
        of_note += drawn.tried[:, 1].tolist() if tried else []
        if of_note and has_decades(of_note):
            logarithmic_axis(upper)
        if len(names) > 1:
            figure.legend(*upper.get_legend_handles_labels(), loc="outside right upper")
        _name_swept(figure, drawn, of_sweep)
        _name_lines(lower, wanted, tried)
        _name_number(lower, drawn, wanted)
        _mark_optimum(upper, lower, drawn)
    return figure


def _colours(tracks: Sequence[DrawnTrack], names: Sequence[str]) -> dict[int, str]:
    """Colour of each track, by its id: one per name, or one per track if all share a name.

    Colours per track show which height and which frequency belong together.
    """
    if len(names) > 1:
        of_name = dict(zip(names, sequence_colours(len(names)), strict=True))
        return {id(track): of_name[track.what] for track in tracks}
    rising = sorted(tracks, key=lambda track: float(np.nanmin(track.frequency, initial=np.inf)))
    return {id(track): colour for track, colour in zip(rising, sequence_colours(len(rising)), strict=True)}


def _colours_of_sweep(tracks: Sequence[DrawnTrack]) -> dict[tuple[float, ...], str]:
    """A colour for the curves of each swept value; empty if nothing was swept."""
    swept = list(dict.fromkeys(track.swept for track in tracks))
    return dict(zip(swept, sequence_colours(len(swept)), strict=True)) if len(swept) > 1 else {}


def _name_swept(figure: Figure, drawn: DrawnTracking, colours: Mapping[tuple[float, ...], str]) -> None:
    """Writes the swept values beside the axes, in their colours."""
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=colour) for colour in colours.values()]
    swept = [dict(zip(drawn.swept, values, strict=True)) for values in colours]
    if lines:
        name_at_side(figure, lines, swept, drawn.swept)


def _line(
    axes: Axes, track: DrawnTrack, y: FloatArray, colour: str, label: str | None = None, width: float = _WIDTH
) -> None:
    """Draw a track: solid where stable, dashed where unstable, dotted where its stability is unknown."""
    stable = track.stable == 1.0
    axes.plot(track.number, np.where(stable, y, np.nan), color=colour, linewidth=width, label=label)
    for there, style in ((track.stable == 0.0, "--"), (np.isnan(track.stable), ":")):
        reach = there.copy()  # to the neighbours, so that no gap is left
        reach[1:] |= there[:-1]
        reach[:-1] |= there[1:]
        if there.any():
            axes.plot(track.number, np.where(reach, y, np.nan), style, color=colour, linewidth=width)


def _name_lines(axes: Axes, tracks: Sequence[DrawnTrack], tried: bool = False) -> None:
    """Explain colours, dashed and dotted lines, gaps, ends and crosses, where there are some."""
    stable = np.concatenate([track.stable[track.trough != 1.0] for track in tracks])
    peaks = {track.what for track in tracks if track.what != "fold"}
    alike = len(peaks) == len({track.swept for track in tracks}) == 1
    said = ["a colour for each peak"] if len(tracks) > 1 and alike else []
    said += ["dashed: no motion stays there"] if (stable == 0.0).any() else []
    said += ["dotted: stability unknown"] if np.isnan(stable).any() else []
    said += ["gap: it is no peak but a trough"] if any(_has_gap(track) for track in tracks) else []
    said += (
        ["a line ends where its peak does, or could not be followed"] if peaks and _end_within(tracks) else []
    )
    said += ["crosses: peaks that were tried, as not all could be followed"] if tried else []
    if said:
        lines = said[:1]
        for one in said[1:]:
            joined = f"{lines[-1]}; {one}"
            lines = [*lines[:-1], joined] if len(joined) <= LAYOUT.meaning_letters else [*lines, one]
        axes.set_title("\n".join(lines), loc="left", fontsize=8)


def _has_gap(track: DrawnTrack) -> bool:
    """Whether a trough lies between two parts that are peaks; a trough up to an end leaves no gap."""
    at = np.flatnonzero(track.trough != 1.0)
    return at.size > 0 and int(at[-1] - at[0]) >= at.size


def _end_within(tracks: Sequence[DrawnTrack]) -> bool:
    """Whether a line of a peak ends between the ends of the axis."""
    seen = [track.number[track.trough != 1.0] for track in tracks if (track.trough != 1.0).any()]
    every = np.concatenate([track.number for track in tracks])
    low, high = float(every.min()), float(every.max())
    ends = np.array([(one[0], one[-1]) for one in seen])
    beside = np.minimum(ends - low, high - ends)
    return bool((beside > LAYOUT.seen_end * (high - low)).any())


def _of_note(tracks: Sequence[DrawnTrack], heights: Sequence[tuple[float, float]]) -> list[float]:
    """Lowest and highest values that decide if an axis is logarithmic, without those of short low lines."""
    every = np.concatenate([track.number for track in tracks])
    long = [np.ptp(track.number) > LAYOUT.short_track * np.ptp(every) for track in tracks]
    top = max(high for _, high in heights)
    return [
        end
        for one, is_long in zip(heights, long, strict=True)
        if is_long or LAYOUT.decade * one[1] > top
        for end in one
    ]


def _name_number(axes: Axes, drawn: DrawnTracking, tracks: Sequence[DrawnTrack]) -> None:
    (symbol,), key = symbols([drawn.key], {drawn.key: drawn.unit}), drawn.key
    known = symbols([key]) != [key]
    axes.set_xlabel(f"{symbol}  ({key})" if known else symbol, parse_math=known)
    axes.minorticks_on()
    numbers = np.concatenate([track.number for track in tracks])
    swept_axis(axes, float(numbers.min()), float(numbers.max()))


def _mark_optimum(upper: Axes, lower: Axes, drawn: DrawnTracking) -> None:
    """A ring around the least peak, a thin line down to its frequency, and its values above."""
    if drawn.optimum is None:
        return
    x, y = drawn.optimum
    ring_at(upper, lower, x, y, _MARK)
    (symbol,) = symbols([drawn.key])
    at, least = f"{symbol} = {x:.5g} {drawn.unit}".rstrip(), f"{y:.5g} {drawn.length}".rstrip()
    bound = ", a bound: beyond it there may be less" if drawn.at_bound else ""
    said = f"least peak {least} at {at}{drawn.stays}{bound}"
    upper.set_title(said, loc="right", fontsize=8, color=_MARK)
