"""Text output of a response run: tables of curves and jumps, and lines on cost and error."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from fcm.cli.columns import (
    ABSENT,
    BEYOND,
    DOES_NOT_STAY,
    EXACT_DOES_NOT_STAY,
    NOT_COMPLETE,
    STABILITY_NOT_YET_KNOWN,
    STABILITY_UNKNOWN,
    UNKNOWN,
    UNSTABLE,
    DofTable,
    aligned,
    greatest_of,
    not_complete,
    number,
    ranges,
    remedy_of_unknown_stability,
    share_of,
    short,
    stopped_early,
    swept,
)
from fcm.cli.jump_table import is_seen, jump_table, resolution_of, stable_table, unknown_stability_table
from fcm.cli.limits import SENTENCES
from fcm.quoting import listed
from fcm.rotational_dofs import MOST_DOFS, dof_unit, greatest_first, is_rotation

Curve = Mapping[str, Any]  # one of the summary's "curves"

_AT_REST = "0 the degree of freedom does not move, but for rounding"
_EDGE = "*"  # beside the frequency of a peak where the range ends
_NO_PEAK = (
    "at an end of the range, and no peak: of the worst blade the amplification may be greater than this, of "
    "the tuned ring less"
)
_ISOLATED = "^"  # beside the frequency of a peak on an isolated branch
_OF_ISOLATED = (
    f"{_ISOLATED} on an isolated branch: closed, and crossed by no other. A sweep comes to it by a jump, or "
    "never"
)
_UNKNOWN = (
    "- unknown error: with more harmonics no peak is near this one, or a higher one is elsewhere. "
    "More --harmonics, or --accuracy, may give it"
)
_THERE = "~"  # beside an error at the frequency of a peak, if the error of the peak is not known
_OF_THERE = (
    f"{_THERE} the error of the motion at that frequency. Of the peak it is unknown: with more harmonics "
    "none is near, or a higher one is elsewhere. More --harmonics, or --accuracy, may give it"
)
_OF_LEVELS = (
    "- unknown error: what more harmonics would change could not be estimated at this peak. "
    "More --harmonics may give it"
)
_BEYOND = (
    f"{BEYOND} the error is more than the peak, so that these harmonics do not suffice. Give more by "
    "--harmonics, or leave them to --accuracy"
)
_EVERY = "degrees of freedom with several peaks, in order of frequency:"
_RESIDUAL = "residual"  # heads a column of shares
_OF_RESIDUAL = "residual: the friction that stuck contacts keep may change the peak by up to this share of it"


def as_table(summary: Mapping[str, Any], unit: str) -> str:
    """Table of the curves, then tables of lower peaks, stable motions, jumps and unknown stability."""
    from fcm.plot.labels import short_names

    curves = summary["curves"]
    if not curves:
        return "no curve"
    names = list(short_names(curves[0]["parameters"]).values())
    if any("mode" in curve for curve in curves):
        from fcm.cli.nonlinear_mode import as_table as of_modes

        return of_modes(summary, names, unit)
    dofs, length = shown_dofs(summary), summary.get("units", {}).get("length", "")
    shown = _which_are_shown(summary, dofs)
    parts = [_curves(summary, names, dofs, unit, length, shown)]
    moving = [dof for dof in dofs if not all(_at_rest(curve, dof) for curve in curves)]
    of_each = {
        "lower peaks": _every_peak(curves, names, dofs, unit, length),
        "greatest stable motions": stable_table(curves, names, moving, unit),
        "jumps": jump_table(curves, names, moving, unit, resolution_of(summary)),
        "stretches of unknown stability": unknown_stability_table(
            curves, names, moving, unit, remedy_of_unknown_stability(summary)
        ),
    }
    peaks, *others = of_each.values()
    drawn = summary.get("scatter", ())
    parts += [peaks] if peaks and not drawn else []
    parts += filter(None, [_at_level_1(curves, names, dofs, length)])
    parts += [_blades(curves, names, unit, length)] if "blades" in curves[0] else []
    parts += filter(None, () if drawn else others)
    if drawn and (left_out := [what for what, table in of_each.items() if table]):
        parts.append(f"{', '.join(left_out)} of each draw: --json has them")
    parts += [_scatter(one, dofs, unit) for one in drawn]
    return "\n\n".join(parts)


def _every_peak(curves: Sequence[Curve], names: list[str], dofs: list[str], unit: str, length: str) -> str:
    """Table, by frequency, of the peaks of curves with several of a degree of freedom; empty if none has.

    The columns are those of the table of highest peaks.
    """
    rows, lower = [], 0
    several = [curve for curve in curves if any(curve.get("peaks", {}).get(dof) for dof in dofs)]
    for curve in several:
        every = [curve["peaks"].get(dof, []) for dof in dofs]
        kept_of = [greatest_of([one["amplitude"] or 0.0 for one in peaks], len(several)) for peaks in every]
        shown_of = [[peaks[k] for k in kept] for peaks, kept in zip(every, kept_of, strict=True)]
        lower += max(len(peaks) - len(kept) for peaks, kept in zip(every, kept_of, strict=True))
        for k in range(max(map(len, shown_of), default=0)):
            cells = [_cells_of_peak(peaks[k]) if k < len(peaks) else ["", "", ""] for peaks in shown_of]
            rows.append((swept(curve), cells, list[str]()))
    if not rows:
        return ""
    kept = [d for d in range(len(dofs)) if any(any(cells[d]) for _, cells, _ in rows)]
    rows = [(left, [cells[d] for d in kept], right) for left, cells, right in rows]
    shown = [_with_unit(dofs[d], length) for d in kept]
    left_out = f"\nand {lower} lower peak{'s' * (lower > 1)}: --json has all" if lower else ""
    return f"{_EVERY}\n{DofTable(names, shown, _peak_heads(unit), [], rows).text(last=0)}{left_out}"


def _at_level_1(curves: Sequence[Curve], names: list[str], dofs: list[str], length: str) -> str:
    """Table of the motions at the force level 1 on curves of levels; empty if there is none."""
    found = [(swept(curve), one) for curve in curves for one in curve.get("at_level_1", ())]
    if not found:
        return ""
    marks = {True: "", False: UNSTABLE, None: UNKNOWN}
    rows = []
    for left, one in found:
        mark = marks[one["stable"]]
        cells = [[number(one["amplitude"][dof]) + mark, short(one["error"][dof])] for dof in dofs]
        rows.append((left, cells, list[str]()))
    stable = {one["stable"] for _, one in found}
    meanings = ((False, f", {UNSTABLE} unstable"), (None, f", {UNKNOWN} of unknown stability"))
    title = "motions that are passed at the level 1" + "".join(
        text for one, text in meanings if one in stable
    )
    shown = [_with_unit(dof, length) for dof in dofs]
    return f"{title}:\n" + DofTable(names, shown, ["{}", "error"], [], rows).text(last=0)


def _peak_heads(over: str) -> list[str]:
    """Heads of the columns of peaks; `over` is the unit of the frequency, or the level."""
    return ["peak {}", f"at {over}", "error"]


def _error(peak: Mapping[str, Any]) -> str:
    """Error of a peak; if unknown, the error of the motion at its frequency, with a mark."""
    there = peak.get("error_at_frequency")
    if peak.get("error") is None and there is not None:
        return f"{short(there)}{_THERE}"
    return short(peak.get("error"))


def _cells_of_peak(peak: Mapping[str, Any]) -> list[str]:
    """Amplitude, frequency (or level, on a curve over levels) and error of a peak, with marks."""
    marks = (_EDGE if peak.get("at_edge") else "") + (_ISOLATED if peak.get("on_isolated_branch") else "")
    at = number(peak["level"] if "level" in peak else peak.get("frequency")) + marks
    return [number(peak.get("amplitude")) + _mark_of(peak), at, _error(peak)]


def _blades(curves: Sequence[Curve], names: list[str], unit: str, length: str) -> str:
    """Table of the worst blade of each curve of a mistuned ring, with its amplification."""
    head = ["worst", "amplitude", f"at {unit}", "tuned", f"at {unit}", "amplification"]
    rows = []
    for curve in curves:
        for name, one in curve["blades"].items():
            keys = ("amplitude", "frequency", "tuned_amplitude", "tuned_frequency", "amplification")
            cells = [number(one[key]) for key in keys]
            cells[1] += _EDGE * one["at_edge"]
            cells[3] += _EDGE * one["tuned_at_edge"]
            rows.append([*swept(curve), f"{_with_unit(name, length)} of sector {one['sector']}", *cells])
    every = [one for curve in curves for one in curve["blades"].values()]
    ends = any(one["at_edge"] or one["tuned_at_edge"] for one in every)
    return aligned([[*names, *head], *rows], left=0) + (f"\n{_EDGE} {_NO_PEAK}" if ends else "")


def _scatter(found: Mapping[str, Any], dofs: list[str], unit: str) -> str:
    """Percentiles over the curves of random draws, a line for each quantity.

    >>> _scatter({"curves": 0, "parameters": {}, "jumps": {}, "peak": {}}, [], "Hz")
    'no curve is complete, so that there are no percentiles'
    """
    jumps = {
        f"jump {sweep} at {unit}": one
        for sweep, one in found["jumps"].items()
        if one["share"] or one["untold"]
    }
    rows = []
    for dof in dofs if found["peak"] else ():
        for name, kind in ((f"peak {dof}", "amplitude"), (f"at {unit}", "frequency")):
            peak = found["peak"][dof]
            stays = _of_stable(peak) if kind == "amplitude" else ""
            rows.append([name, *_spread(peak, kind), stays])
            ends = list(zip(*peak["interval"].values(), strict=True)) if kind == "amplitude" else []
            if any(end is not None for both in ends for end in both):
                words = zip(("from", "to"), ends, strict=True)
                rows += [
                    [f"  {word}", "", *(_outwards(end, word) for end in each), "", ""] for word, each in words
                ]
    rows += [[name, *_spread(one, "frequency"), _of_how_many(one)] for name, one in jumps.items()]
    for dof, one in found.get("blades", {}).items():
        rows += [
            [f"worst {dof}", *_spread(one, "amplitude"), ""],
            [f"amplification {dof}", *_spread(one, "amplification"), ""],
        ]
    given = ", ".join(f"{key} = {value:.6g}" for key, value in found["parameters"].items())
    if not found["curves"]:
        return f"no curve is complete{f' with {given}' if given else ''}, so that there are no percentiles"
    head = f"percentiles of {found['curves']} curves{f' with {given}' if given else ''}"
    if not rows:
        return head
    beyond = found["curves_beyond"]
    heads = ["", "least", *(f"{percent} %" for percent in beyond), "greatest", ""]
    lines = [head, aligned([heads, *rows], left=1)]
    lacking = [row[0].strip() for row in rows if "-" in row[1:-1] and not _is_of_above(row)]
    if lacking:
        needs = ", ".join(
            f"{needed} for {low} and {high} %" if low != high else f"{needed} for {low} %"
            for (low, needed), high in zip(beyond.items(), reversed(beyond), strict=True)
            if float(low) <= float(high)
        )
        lines.append(f"- of {listed(lacking)}: a percentile of too few curves. It takes {needs}")
    if found["peak"] and dofs:
        lines.append(
            "each line is in its own order: a peak and a frequency of one column are not of one draw"
        )
        lines += _of_intervals(found, dofs)
        lines += _of_large_errors(found, dofs)
    if any(one["untold"] for one in jumps.values()):
        lines.append("unknown: stability is not known, and a sweep may jump")
    return "\n".join(lines)


def _is_of_above(row: Sequence[str]) -> bool:
    """Whether a line of percentiles has bounds, or the frequencies, of those of a line above."""
    return row[0].strip().partition(" ")[0] in ("from", "to", "at")


def _spread(found: Mapping[str, Any], what: str) -> list[str]:
    """Cells of a quantity's least, percentiles and greatest."""
    least, greatest = found[f"{what}_range"]
    return [number(least), *map(number, found[what].values()), number(greatest)]


def _outwards(end: float | None, word: str) -> str:
    """An end of an interval with three digits, rounded outwards.

    >>> _outwards(3.1419, "from"), _outwards(3.1419, "to"), _outwards(5e-05, "to"), _outwards(None, "to")
    ('3.14', '3.15', '5.00e-05', '-')
    """
    if end is None:
        return "-"
    from decimal import ROUND_CEILING, ROUND_FLOOR, Context  # for these numbers alone

    digits = Context(prec=3, rounding=ROUND_FLOOR if word == "from" else ROUND_CEILING)
    return f"{float(digits.create_decimal(repr(end))):#.3g}"


def _of_intervals(found: Mapping[str, Any], dofs: Sequence[str]) -> list[str]:
    """Lines on the meaning of the intervals of percentiles of peaks, and on percentiles of too few draws."""
    peaks = [found["peak"][dof] for dof in dofs]
    ends = [end for peak in peaks for both in peak["interval"].values() for end in both]
    lines, count, sure = [], found["curves"], f"{100.0 * found['confidence']:g} %"
    if any(end is not None for end in ends):
        known = [peak["greatest_error"] for peak in peaks if peak["greatest_error"] is not None]
        unknown = max(peak["error_unknown"] for peak in peaks)
        errors = [f"{_amount(max(known))} at most"] if max(known, default=0.0) else []
        errors += [f"unknown of {unknown} of {count}"] if unknown else []
        counted = f". They count the errors of peaks, {', '.join(errors)}" if errors else ""
        lines.append(f"from, to: bounds of all possible draws' percentile, with {sure} confidence{counted}")
    draws = count + found["left_out"]
    if draws > count:
        lines.append(
            f"{draws - count} of {draws} draws have no complete curve. The percentiles are without "
            "them, and may be too low where their peaks are high; the bounds count them as unknown"
        )
    unbounded = [
        percent
        for percent, needed in found["curves_needed"].items()
        if draws >= needed and any(None in peak["interval"][percent] for peak in peaks)
    ]
    if unbounded:
        lines.append(
            f"the bounds of {listed(unbounded)} % are unknown where there is a -: without the draws whose "
            "errors are unknown, too few are left"
        )
    short_of = {percent: needed for percent, needed in found["curves_needed"].items() if draws < needed}
    if short_of:
        named = listed(list(short_of))
        few = f"{draws} draw is" if draws == 1 else f"{draws} draws are"
        needed = max(short_of.values())
        lines.append(f"{few} too few for both bounds of {named} %: {needed} are needed")
    return lines


def _of_large_errors(found: Mapping[str, Any], dofs: Sequence[str]) -> list[str]:
    """Line that the errors of peaks are too large to rely on the percentiles; empty if they are not."""
    worst = max(found["peak"][dof]["greatest_error"] or 0.0 for dof in dofs)
    if worst <= SENTENCES.doubtful_error:
        return []
    return [
        f"percentiles are not to be relied on: peaks err by up to {share_of(worst)}, and such a peak may be "
        "of no motion. Draw again with more harmonics, or --accuracy, before another number is chosen"
    ]


def _of_stable(peak: Mapping[str, Any]) -> str:
    """Shares of the peaks that are unstable or of unknown stability, as text."""
    shares = ((peak["unstable"], "unstable"), (peak["untold"], "of unknown stability"))
    return ", ".join(f"{100.0 * share:.0f} % {what}" for share, what in shares if share)


def _of_how_many(jump: Mapping[str, Any]) -> str:
    """Clause on the share of curves that the percentiles of a jump cover, and the share unknown."""
    unknown = f", unknown of {100.0 * jump['untold']:.0f} %" if jump["untold"] else ""
    return f"of {100.0 * jump['share']:.0f} % of the curves{unknown}"


def _minimised(summary: Mapping[str, Any]) -> list[str]:
    """The degrees of freedom whose peaks an [optimum] minimises."""
    return [name.partition(".")[2] for one in summary.get("optimum", ()) for name in one["minimise"]]


def shown_dofs(summary: Mapping[str, Any]) -> list[str]:
    """Degrees of freedom shown: those with the greatest peaks, and those minimised, in the file's order.

    If the scene asks for some by `output`, only these and those minimised are shown. Rotations, which have
    another unit, come after all displacements.
    """
    curves, minimised = summary["curves"], _minimised(summary)

    def peak(dof: str) -> float:
        found = ((curve["peak"].get(dof) or {}).get("amplitude") for curve in curves)
        return max((value for value in found if value is not None), default=0.0)

    asked = summary.get("output", ())
    dofs = [dof for dof in curves[0]["peak"] if not asked or dof in asked or dof in minimised]
    order = greatest_first(dofs, [peak(dof) for dof in dofs])
    chosen = sorted(order, key=lambda d: dofs[d] not in minimised)[:MOST_DOFS]
    return [dofs[d] for d in sorted(chosen)]


def _curves(
    summary: Mapping[str, Any], names: list[str], dofs: list[str], unit: str, length: str, shown: str
) -> str:
    """Table of swept values, peaks, points, time and folds of each curve, and whether it is complete."""
    from fcm.results.result import NOT_BEGUN

    curves: Sequence[Curve] = summary["curves"]
    over = "level" if "level_folds" in curves[0] else unit
    least, visited = 0.0 if over == "level" else resolution_of(summary), visited_frequencies(curves)
    folds_of = {id(curve): _seen_folds(curve, dofs, least) for curve in curves}
    judged = [curve for curve in curves if curve.get("cause") != "interrupted"]
    ranges_of = [dof for dof in dofs if any(_residual(curve, dof) != "0" for curve in judged)]
    balanced = ["harmonics"] if any("harmonics" in curve for curve in curves) else []
    begun = [curve for curve in curves if curve.get("reason") != NOT_BEGUN]
    broken = [""] if any(not curve["complete"] for curve in begun) else []
    table = DofTable(
        names,
        [_with_unit(dof, length) for dof in dofs],
        [
            f"{'greatest' if visited else 'peak'} {{}}",
            *_peak_heads(over)[1:],
            *([_RESIDUAL] if ranges_of else []),
        ],
        [*balanced, "points", "time [s]", f"folds at {over}", *broken],
        [
            _curve_row(curve, folds_of[id(curve)], dofs, ranges_of, bool(balanced), bool(broken))
            for curve in begun
        ],
    )
    lines = [table.text(last=1 + len(broken))]
    lines += not_complete(begun, names)
    if left := len(curves) - len(begun):
        why = NOT_BEGUN if left == 1 else NOT_BEGUN.replace("it was", "they were")
        lines.append(f"{left} more curve{'s' * (left > 1)} {NOT_COMPLETE}: {why}")
    if visited:
        lines.append(f"greatest of {visited}: no peak was looked for, so how much higher one is is unknown")
    if any(hooks for _, hooks in folds_of.values()):
        lines.append(f"close pairs: folds less than {least:.2g} {unit} apart, too near to be seen in a sweep")
    if shown:
        lines.append(f"shown: {shown}")
    if any(_at_rest(curve, dof) for curve in curves for dof in dofs):
        lines.append(_AT_REST)
    if any(_at_edge(curve, dof) for curve in curves for dof in dofs):
        beyond = "beyond it the curve may rise further"
        helps = ". fcm plot modes SCENE lists the resonances" if over == unit else ""
        lines.append(f"{_EDGE} at an end of the range: {beyond}{helps}")
    lower = _lower_peaks(curves, dofs)
    highest = [curve["peak"].get(dof) or {} for curve in curves for dof in dofs]
    if any(peak.get("on_isolated_branch") for peak in [*highest, *lower]):
        lines.append(_OF_ISOLATED)
    marks = {_stability(curve, dof) for curve in curves for dof in dofs} | set(map(_mark_of, lower))
    if UNSTABLE in marks:
        lines.append(
            f"{UNSTABLE} {EXACT_DOES_NOT_STAY if summary.get('method') == 'exact' else DOES_NOT_STAY}"
        )
    lost = [
        dof
        for dof in dofs
        if any(_stability(curve, dof) and nowhere_stable(curve, curve["peak"][dof]) for curve in curves)
    ]
    if lost:
        lines.append(
            f"{', '.join(lost)}: no stable motion was found at the frequency of the peak, so no steady "
            "amplitude is known there"
        )
    if UNKNOWN in marks:
        of_judged = [curve["peak"].get(dof) or {} for curve in judged for dof in dofs]
        looked = UNKNOWN in map(_mark_of, [*of_judged, *_lower_peaks(judged, dofs)])
        remedy = remedy_of_unknown_stability(summary)
        lines.append(f"{UNKNOWN} {STABILITY_UNKNOWN + remedy if looked else STABILITY_NOT_YET_KNOWN}")
    if ranges_of:
        unknown = any(_residual(curve, dof) == "-" for curve in curves for dof in ranges_of)
        lines.append(_OF_RESIDUAL + (", - unknown" if unknown else ""))
    each = [*highest, *lower]
    if any((one.get("error") or 0.0) > 1.0 for one in each):
        lines.append(_BEYOND)
    if any(
        _unknown_error(curve, dof) for curve in curves for dof in dofs if curve.get("cause") != "interrupted"
    ):
        there = [
            "error_at_frequency" in curve["peak"][dof]
            for curve in curves
            for dof in dofs
            if _unknown_error(curve, dof)
        ]
        lines += [_OF_THERE] if any(there) else []
        if not all(there):
            lines.append(_UNKNOWN if over == unit else _OF_LEVELS)
    return "\n".join(lines)


def visited_frequencies(curves: Sequence[Curve]) -> str:
    """Number of frequencies visited, as text, if no curve was followed; else empty.

    >>> visited_frequencies([{"visited": 5}, {"visited": 4}]), visited_frequencies([{"points": 9}])
    ('5 frequencies', '')
    """
    count = max(curve.get("visited", 0) for curve in curves)
    return f"{count} frequenc{'y' if count == 1 else 'ies'}" if count else ""


def _which_are_shown(summary: Mapping[str, Any], dofs: list[str]) -> str:
    """Clause on how the shown degrees of freedom are chosen; empty where all are shown."""
    every, asked = summary["curves"][0]["peak"], summary.get("output", ())
    if len(every) == len(dofs):
        return ""
    least = ", and what is minimised" if {*_minimised(summary)} - {*asked} else ""
    if 0 < len(asked) <= len(dofs):
        return f"those of output{least}; {len(every)} degrees of freedom are in the results"
    turning = ", displacements before rotations" if any(map(is_rotation, every)) else ""
    return f"the {len(dofs)} of {len(every)} degrees of freedom with the greatest peaks{least}{turning}"


def _with_unit(dof: str, length: str) -> str:
    unit = dof_unit(dof, length)
    return f"{dof} [{unit}]" if unit else dof


def _at_edge(curve: Curve, dof: str) -> bool:
    """Whether a peak is where the range ends."""
    return bool((curve["peak"].get(dof) or {}).get("at_edge"))


def _at_rest(curve: Curve, dof: str) -> bool:
    """Whether a degree of freedom does not move."""
    return (curve["peak"].get(dof) or {}).get("amplitude") == 0.0


def _lower_peaks(curves: Sequence[Curve], dofs: Sequence[str]) -> list[Mapping[str, Any]]:
    """All peaks of the degrees of freedom that have several."""
    return [one for curve in curves for dof in dofs for one in curve.get("peaks", {}).get(dof, ())]


def _stability(curve: Curve, dof: str) -> str:
    """Mark beside the highest peak of a degree of freedom, if it is not known to be stable."""
    return _mark_of(curve["peak"].get(dof) or {})


def _mark_of(peak: Mapping[str, Any]) -> str:
    if not peak.get("amplitude") or "stable" not in peak or peak["stable"]:
        return ""
    return UNKNOWN if peak["stable"] is None else UNSTABLE


def _unknown_error(curve: Curve, dof: str) -> bool:
    """Whether the error of a peak of a balance is not known."""
    peak = curve["peak"].get(dof) or {}
    return "harmonics" in curve and bool(peak.get("amplitude")) and peak.get("error") is None


def _residual(curve: Curve, dof: str) -> str:
    """The share of a peak by which residual friction may change it: "0" below a thousandth of a percent."""
    peak = curve["peak"].get(dof) or {}
    change = peak.get("residual_change", 0.0)
    if change is None:
        return "-" if curve.get("may_not_be_unique") and peak.get("amplitude") else "0"
    return share_of(change)


def _curve_row(
    curve: Curve,
    seen: tuple[list[float | None], int],
    dofs: list[str],
    ranges_of: list[str],
    balanced: bool,
    broken: bool,
) -> tuple[list[str], list[list[str]], list[str]]:
    each = []
    for dof in dofs:
        peak = curve["peak"].get(dof) or {}
        cells = ["0", "-", "-"] if _at_rest(curve, dof) else _cells_of_peak(peak)
        if ranges_of:
            cells.append(_residual(curve, dof) if dof in ranges_of else ABSENT)
        each.append(cells)
    right = [ranges(curve["harmonics"]) if "harmonics" in curve else "-"] if balanced else []
    folds = _folds(*seen)
    state = ([NOT_COMPLETE] if not curve["complete"] else [""]) if broken else []
    return swept(curve), each, [*right, str(curve["points"]), f"{curve['seconds']:.3f}", folds, *state]


def _seen_folds(curve: Curve, dofs: list[str], least: float) -> tuple[list[float | None], int]:
    """The folds of a curve without its hooks, and the number of folds in hooks.

    A hook is a pair of folds too close to be seen, at which no jump is.
    """
    folds = list(curve.get("level_folds", curve["folds"]))
    jumps = [one["frequency"] for one in curve.get("jumps", ()) if is_seen(one, curve, dofs, least)]
    kept: list[float | None] = []
    for one in folds:
        last = kept[-1] if kept else None
        narrow = last is not None and one is not None and abs(last - one) < least
        if narrow and not any(abs(at - end) < least for at in jumps for end in (last or at, one or at)):
            kept.pop()
        else:
            kept.append(one)
    return kept, len(folds) - len(kept)


def _folds(folds: Sequence[float | None], hooks: int = 0) -> str:
    """Folds of a curve as text: all, or the number and range of many; and the number in close pairs.

    >>> _folds([]), _folds([1.0, 2.0]), _folds([1.0, 4.0, 2.0, 3.0, 5.0])
    ('none', '1.00000  2.00000', '5: 1.00000 to 5.00000')
    >>> _folds([1.0, 2.0], 4), _folds([], 2)
    ('1.00000  2.00000, 4 in close pairs', '2 in close pairs')
    """
    narrow = f"{hooks} in close pairs" if hooks else ""
    if len(folds) <= SENTENCES.folds:
        every = "  ".join(map(number, folds))
        return ", ".join(filter(None, [every, narrow])) or "none"
    known = [one for one in folds if one is not None]
    ends = f"{len(folds)}: {number(min(known, default=None))} to {number(max(known, default=None))}"
    return ", ".join(filter(None, [ends, narrow]))


def nowhere_stable(curve: Curve, peak: Mapping[str, Any]) -> bool:
    """Whether a peak lies where no stable motion was found."""
    at = peak.get("frequency")
    return at is not None and any(low <= at <= high for low, high in curve.get("no_stable_motion", ()))


def cost_and_error(summary: Mapping[str, Any]) -> str:
    """One or two lines on the cost of a run and its error."""
    curves = summary["curves"]
    points = sum(curve["points"] for curve in curves)
    begun = sum(curve["points"] > 0 for curve in curves)
    of = f"{begun} of " if begun < len(curves) else ""
    count = f"{of}{len(curves)} curve{'' if len(curves) == 1 else 's'}"
    harmonic = _worst(curves, "truncation_error")
    errors = []
    if summary.get("method") == "exact":
        harmonic = None
        if (closure := _worst(curves, "closure_error")) is not None:
            errors.append(f"{closure:.1e} by which a period does not close{_of_lower_peaks(summary)}")
    if harmonic is not None:
        unknown = any(_unknown_error(curve, dof) for curve in curves for dof in curve["peak"])
        shown = shown_dofs(summary)  # the table has their peaks
        peaks, lower, others = [], [0.0], []
        for curve in curves:
            told = {dof: one for dof, one in curve["peak"].items() if one and one.get("error")}
            greatest = max((one["amplitude"] for one in told.values()), default=0.0) or 1.0
            peaks += [one["error"] for dof, one in told.items() if dof in shown]
            several = (one for dof in shown for one in curve.get("peaks", {}).get(dof, ()))
            lower += [one["error"] for one in several if one.get("error")]
            others += [one["error"] * one["amplitude"] / greatest for one in told.values()]
        harmonic = max([harmonic, *others])  # also where what lies around is unknown
        if harmonic > 0.0 or not unknown:  # the 0 of a motion at rest says nothing of peaks
            of_all = f"{harmonic:.1e}"
            if peaks:
                alone = _amount(max(peaks))
                of_peaks = f"{alone} of peaks"
                if max(lower) > max(peaks):
                    of_peaks = alone = f"{alone} of the greatest peaks, {_amount(max(lower))} of lower ones"
                beside = (
                    " (beside folds)" if harmonic > 1.0 and any(one.get("folds") for one in curves) else ""
                )
                of_any = f"{_amount(harmonic)} of the greatest amplitude at any point{beside}"
                of_all = alone
                if max(peaks) < harmonic:
                    of_all = f"{of_peaks} and {of_any}{_where(summary, harmonic)}"
            but = ", and of some peaks unknown" if unknown else ""
            errors.append(f"{of_all}, by the harmonics left out{but}{_known_of_modes(curves)}")
        if places := [
            (at, dof) for dof, one in _peaks_of(curves, shown) if (at := one.get("frequency_error"))
        ]:
            off, dof = max(places)
            of = f" of {dof}" if len(shown) > 1 else ""
            errors.append(f"{off:.1e} in the frequency of the greatest peak{of}")
    return (
        f"{count}, {points} points in {summary['seconds']:.2f} s\n"
        f"largest relative error: {'; '.join(errors) or 'not known'}"
    )


def of_table(summary: Mapping[str, Any]) -> str:
    """Line on how far solutions by the table alone are from the points of curves, which do not use it; or ''.

    >>> of_table({"method": "table", "curves": [{"harmonics": [1], "table_error": 2.9e-5}]})
    'the table: solutions by it alone would be off by up to 2.9e-05; these points are not'
    """
    tabled = [one for one in summary["curves"] if len(one.get("harmonics", ())) < 2]  # more never use it
    table = _worst(tabled, "table_error")
    if summary.get("method") != "table" or not table or summary.get("directions"):
        return ""
    return f"the table: solutions by it alone would be off by up to {table:.1e}; these points are not"


def _peaks_of(curves: Sequence[Curve], dofs: Collection[str]) -> list[tuple[str, dict[str, Any]]]:
    """The known greatest peaks of some degrees of freedom, as pairs (dof, peak)."""
    return [(dof, one) for curve in curves for dof, one in curve["peak"].items() if one and dof in dofs]


def _of_lower_peaks(summary: Mapping[str, Any]) -> str:
    """Remark that lower peaks of exact curves are only points, not searched between points; or ''.

    >>> _of_lower_peaks({"curves": [{"peak": {"u": {}}, "peaks": {"u": [{}, {}]}}], "output": ["u"]})
    ', at the points; lower peaks are the highest of these, and what lies between points is not estimated'
    """
    shown = shown_dofs(summary)
    if not any(len(curve.get("peaks", {}).get(dof, ())) > 1 for curve in summary["curves"] for dof in shown):
        return ""
    return (
        ", at the points; lower peaks are the highest of these, and what lies between points is not estimated"
    )


def _amount(error: float) -> str:
    """An error as text for a sentence."""
    return short(error).replace(BEYOND, "more than 100 %")


def _known_of_modes(curves: Sequence[Curve]) -> str:
    """Remark on the points of nonlinear modes at which the error is known, if not at all; or ''.

    >>> mode = {"modal_amplitude": [1e-6, 1e-4], "error_known": {"points": 1, "modal_amplitude": 1e-5}}
    >>> _known_of_modes([{"points": 62, "mode": mode}])
    ', estimated at 1 of 62 points. Beyond the modal amplitude 1e-05 it is unknown'
    """
    modes = [one["mode"] for one in curves if one.get("mode")]
    points = sum(one["points"] for one in curves if one.get("mode"))
    known = sum(mode["error_known"]["points"] for mode in modes)
    if known in (0, points):
        return ""
    ends = [(one["error_known"]["modal_amplitude"], max(one["modal_amplitude"])) for one in modes]
    short_of = [known_to for known_to, end in ends if known_to is not None and known_to < end]
    beyond = f". Beyond the modal amplitude {min(short_of):.4g} it is unknown" if short_of else ""
    return f", estimated at {known} of {points} points{beyond}"


def _where(summary: Mapping[str, Any], error: float) -> str:
    """Clause on the frequency at which a curve's error is greatest; empty if that is unknown."""
    at = [one.get("truncation_error_at") for one in summary["curves"] if one.get("truncation_error") == error]
    return f", most at {at[0]:.6g} {summary['frequency_unit']}" if at and at[0] is not None else ""


def incomplete(summary: Mapping[str, Any]) -> str:
    """How many curves stopped early, and how many were not begun; empty if none.

    >>> none = {"complete": False, "points": 0, "cause": "interrupted"}
    >>> incomplete({"curves": [{"complete": False, "points": 8}, none, none]})
    '1 of 3 curves stopped early; 2 were not begun'
    >>> incomplete({"curves": [{"complete": True}, none]})
    '1 of 2 curves was not begun'
    """
    from fcm.results.cause import Cause

    curves = summary["curves"]
    stopped = [curve for curve in curves if not curve["complete"]]
    interrupted = Cause.INTERRUPTED.name.lower()
    none = sum(curve.get("points") == 0 and curve.get("cause") == interrupted for curve in stopped)
    begun = stopped_early(len(stopped) - none, len(curves))
    if not none or len(curves) == 1:
        return begun or stopped_early(none, len(curves))
    never = f"{'was' if none == 1 else 'were'} not begun"
    return f"{begun}; {none} {never}" if begun else f"{none} of {len(curves)} curves {never}"


def all_lost_to_defects(summary: Mapping[str, Any]) -> bool:
    """Whether a defect of fcm lost every curve: the program failed, not the calculation."""
    from fcm.results.cause import Cause

    curves = summary["curves"]
    return bool(curves) and all(curve.get("cause") == Cause.DEFECT.name.lower() for curve in curves)


def _worst(curves: Sequence[Curve], key: str) -> float | None:
    return max((curve[key] for curve in curves if curve.get(key) is not None), default=None)
