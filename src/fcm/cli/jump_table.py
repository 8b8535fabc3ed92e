"""Tables of jumps, where a slow sweep of the frequency leaves a curve's stable part.

Where stability is unknown, a sweep may jump; another table lists these ranges.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from fcm.cli.columns import UNKNOWN, DofTable, greatest_of, number, short, swept
from fcm.cli.limits import SENTENCES

_LOST = "\n- the curve has no stable part there to land on"
_UNKNOWN = f"\n{UNKNOWN} after a jump: stability is unknown there"
# sweep, its start, cells between those of swept values and degrees of freedom, cells of the latter
Row = tuple[str, float, list[str], list[list[str]]]


def jump_table(
    curves: Sequence[Mapping[str, Any]], names: list[str], dofs: list[str], unit: str, resolution: float = 0.0
) -> str:
    """Table with a line for each jump; empty if there is none. Jumps too small to be seen are only counted.

    resolution: width of a range, in the unit, below which nothing is seen.
    """

    seen = [
        [one for one in curve.get("jumps", ()) if is_seen(one, curve, dofs, resolution)] for curve in curves
    ]
    count = sum(map(bool, seen))
    shown = [[jumps[k] for k in greatest_of([_step(one, dofs) for one in jumps], count)] for jumps in seen]

    repeats = any(_periods(one) for jumps in shown for one in jumps)

    def row(one: Mapping[str, Any]) -> Row:
        cells = [[number(one["before"].get(dof)), _landing(one, dof)] for dof in dofs]
        where = [number(one["frequency"]), *([_periods(one) or "1"] if repeats else [])]
        return one["sweep"], one["frequency"], where, cells

    found = _rows(curves, shown, row)
    small = sum(len(curve.get("jumps", ())) for curve in curves) - sum(map(len, seen))
    others = sum(map(len, seen)) - len(found)
    left_out = ""
    if small:
        left_out = f"{small} jump{'s' * (small > 1)} too small to be seen: by less than "
        left_out += f"{100.0 * SENTENCES.small_jump:g} %"
        left_out += (
            f", or over less than {resolution:.2g} {unit} without a stable motion" if resolution else ""
        )
    if not found:
        return left_out
    lost = any("-" in cells for _, each, _ in found for cells in each)
    unknown = any(UNKNOWN in after for _, each, _ in found for _, after in each)
    heads = [f"jump at {unit}", *(["periods"] if repeats else [])]
    table = DofTable([*names, *heads], dofs, ["{} before", "{} after"], ["sweep"], found)
    more = f"\nand {others} more jump{'s' * (others > 1)}, by less: --json has all" if others else ""
    more += f"\nand {left_out}" if left_out else ""
    return table.text(last=1) + _LOST * lost + _UNKNOWN * unknown + more


def _landing(jump: Mapping[str, Any], dof: str) -> str:
    """The amplitude after a jump, marked if the stability of that motion is unknown."""
    after = jump["after"].get(dof)
    return number(after) + UNKNOWN * (after is not None and jump.get("after_stable", True) is None)


def _periods(jump: Mapping[str, Any]) -> str:
    """Periods of the force after which the motions before and after a jump repeat; empty if both are one.

    >>> _periods({"periods": [1, 1]}), _periods({"periods": [2, 1]}), _periods({"periods": [2, 0]})
    ('', '2 to 1', '2 to -')
    """
    before, after = jump.get("periods", (1, 1))
    alone = before in (0, 1) and (after == 1 or any(one is None for one in jump.get("after", {}).values()))
    return "" if alone else f"{before or '-'} to {after or '-'}"


def resolution_of(summary: Mapping[str, Any]) -> float:
    """Width, in the unit of the frequencies, below which nothing is seen; 0 if no range is swept."""
    low, high = summary.get("range", (0.0, 0.0))
    return SENTENCES.resolution * float(high - low)


def is_seen(
    jump: Mapping[str, Any], curve: Mapping[str, Any], dofs: Sequence[str], resolution: float
) -> bool:
    """Whether a jump is seen: an amplitude changes, or none is known over more than the resolution."""
    if any(jump["after"].get(dof) is not None for dof in dofs):
        return any(_change(jump["before"], jump["after"], dof) > SENTENCES.small_jump for dof in dofs)
    beyond = _beyond_gap(jump, curve, resolution)
    return beyond is None or any(_change(jump["before"], beyond, dof) > SENTENCES.small_jump for dof in dofs)


def _beyond_gap(
    jump: Mapping[str, Any], curve: Mapping[str, Any], resolution: float
) -> Mapping[str, float] | None:
    """Amplitudes beyond a gap without stable motion that is narrower than the resolution; None without one.

    They are the amplitudes at which the opposite sweep reaches the gap.
    """
    upwards = jump["sweep"] == "up"
    for low, high in curve.get("no_stable_motion", ()):
        near, far = (low, high) if upwards else (high, low)
        if high - low < resolution and abs(jump["frequency"] - near) < resolution:
            for other in curve.get("jumps", ()):
                if other["sweep"] != jump["sweep"] and abs(other["frequency"] - far) < resolution:
                    found: Mapping[str, float] = other["before"]
                    return found
    return None


def _step(jump: Mapping[str, Any], dofs: Sequence[str]) -> float:
    """The greatest change of an amplitude; infinite if the curve has no stable part to land on."""
    ends = [(jump["before"].get(dof), jump["after"].get(dof)) for dof in dofs]
    if any(after is None for _, after in ends):
        return float("inf")
    return max(abs(float(after) - float(before or 0.0)) for before, after in ends)


def _change(before: Mapping[str, Any], after: Mapping[str, Any], dof: str) -> float:
    """Change of an amplitude by a jump, relative to the greater one."""
    one, other = float(before.get(dof) or 0.0), float(after.get(dof) or 0.0)
    return abs(one - other) / (max(one, other) or 1.0)


def stable_table(curves: Sequence[Mapping[str, Any]], names: list[str], dofs: list[str], unit: str) -> str:
    """Table of the greatest stable motions of curves with a peak not known to be stable; or ''."""
    rows = []
    for curve in curves:
        peaks = [(curve["peak"].get(dof) or {}).get("greatest_stable") for dof in dofs]
        if any(peaks):
            rows.append((swept(curve), [_stays(one) for one in peaks], list[str]()))
    if not rows:
        return ""
    said = (
        "greatest stable motions where a peak is not known to be stable; others may be greater. Errors are "
        "at that frequency:"
    )
    return f"{said}\n{DofTable(names, dofs, ['stable {}', f'at {unit}', 'error'], [], rows).text(last=0)}"


def _stays(one: Mapping[str, Any] | None) -> list[str]:
    """The cells of a greatest stable motion; empty if the peak itself is stable."""
    return (
        ["", "", ""] if not one else [number(one["amplitude"]), number(one["frequency"]), short(one["error"])]
    )


def unknown_stability_table(
    curves: Sequence[Mapping[str, Any]], names: list[str], dofs: list[str], unit: str, remedy: str
) -> str:
    """Table of the windows in which a sweep meets motions of unknown stability; empty if there are none.

    Narrow windows are only counted.

    remedy : text on what may show the stability
    """
    every = [one for curve in curves for one in curve.get("stability_untold", ())]
    narrow = sum(map(_is_narrow, every))
    wide = [[one for one in curve.get("stability_untold", ()) if not _is_narrow(one)] for curve in curves]
    count = sum(map(bool, wide))
    shown = [
        [windows[k] for k in greatest_of([abs(one["to"] - one["from"]) for one in windows], count)]
        for windows in wide
    ]
    windows = (
        f"window{'s' * (narrow > 1)} narrower than {100.0 * SENTENCES.narrow_window:g} % of the frequency"
    )

    def row(one: Mapping[str, Any]) -> Row:
        ends = [number(one["from"]), number(one["to"])]
        return one["sweep"], one["from"], ends, [[number(one["before"].get(dof))] for dof in dofs]

    cells = _rows(curves, shown, row)
    if not cells:
        said = f"stability is unknown, and a sweep may jump, in {narrow} {windows}"
        return said if narrow else ""
    table = DofTable([*names, f"from {unit}", "to"], dofs, ["{} there"], ["sweep"], cells)
    said = f"between these frequencies stability is unknown, and a sweep may jump; {remedy}:"
    others = sum(map(len, wide)) - len(cells)
    more = f"\nand between {others} more, which are nearer: --json has all" if others else ""
    more += f"\nand in {narrow} more {windows}" if narrow else ""
    return f"{said}\n{table.text(last=1)}{more}"


def _is_narrow(window: Mapping[str, Any]) -> bool:
    return bool(abs(window["to"] - window["from"]) < SENTENCES.narrow_window * window["from"])


def _rows(
    curves: Sequence[Mapping[str, Any]],
    shown: Sequence[Sequence[Mapping[str, Any]]],
    row: Callable[[Mapping[str, Any]], Row],
) -> list[tuple[list[str], list[list[str]], list[str]]]:
    """The shown rows of all curves; for each curve in the order of the upward, then the downward sweep."""
    found = []
    for curve, own in zip(curves, shown, strict=True):
        rows = list(map(row, own))
        ups = sorted((one for one in rows if one[0] == "up"), key=lambda one: one[1])
        downs = sorted((one for one in rows if one[0] != "up"), key=lambda one: -one[1])
        found += [([*swept(curve), *where], each, [sweep]) for sweep, _, where, each in ups + downs]
    return found
