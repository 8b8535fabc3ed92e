"""Tables of jumps, where a slow sweep of the frequency leaves a curve's stable part; and of where that is not
known, as it is not told whether the motion is stable."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from fcm.cli.columns import DofTable, number, short, swept
from fcm.cli.limits import SENTENCES

_LOST = "\n- the curve has no stable part there to land on"
# the sweep, where it begins, the cells between swept values and degrees of freedom, the cells of these
Row = tuple[str, float, list[str], list[list[str]]]


def jump_table(curves: Sequence[Mapping[str, Any]], names: list[str], dofs: list[str], unit: str) -> str:
    """A line for each jump; empty if there is none."""

    def rows(curve: Mapping[str, Any]) -> list[Row]:
        return [
            (
                one["sweep"],
                one["frequency"],
                [number(one["frequency"])],
                [[number(one[side].get(dof)) for side in ("before", "after")] for dof in dofs],
            )
            for one in curve.get("jumps", ())
        ]

    found = _rows(curves, rows)
    if not found:
        return ""
    lost = any("-" in cells for _, each, _ in found for cells in each)
    table = DofTable([*names, f"jump at {unit}"], dofs, ["{} before", "{} after"], ["sweep"], found)
    return table.text(last=1) + (_LOST if lost else "")


def stable_table(curves: Sequence[Mapping[str, Any]], names: list[str], dofs: list[str], unit: str) -> str:
    """A line for each curve of which a peak is not known to be stable: the greatest motions that are."""
    rows = []
    for curve in curves:
        peaks = [(curve["peak"].get(dof) or {}).get("greatest_stable") for dof in dofs]
        if any(peaks):
            rows.append((swept(curve), [_stays(one) for one in peaks], list[str]()))
    if not rows:
        return ""
    said = "the greatest motions known to stay, where a peak does not, or may not; others may be greater:"
    return f"{said}\n{DofTable(names, dofs, ['stable {}', f'at {unit}', 'error'], [], rows).text(last=0)}"


def _stays(one: Mapping[str, Any] | None) -> list[str]:
    """The cells of a greatest stable motion; empty where the peak itself is one."""
    return (
        ["", "", ""] if not one else [number(one["amplitude"]), number(one["frequency"]), short(one["error"])]
    )


def untold_table(curves: Sequence[Mapping[str, Any]], names: list[str], dofs: list[str], unit: str) -> str:
    """A line for each way of a sweep on which it is not told whether the motion is stable; empty if none.

    Narrow windows are counted.
    """
    every = [one for curve in curves for one in curve.get("stability_untold", ())]
    narrow = sum(map(_is_narrow, every))

    def rows(curve: Mapping[str, Any]) -> list[Row]:
        return [
            (
                one["sweep"],
                one["from"],
                [number(one["from"]), number(one["to"])],
                [[number(one["before"].get(dof))] for dof in dofs],
            )
            for one in curve.get("stability_untold", ())
            if not _is_narrow(one)
        ]

    windows = (
        f"window{'s' * (narrow > 1)} narrower than {100.0 * SENTENCES.narrow_window:g} % of the frequency"
    )
    cells = _rows(curves, rows)
    if not cells:
        said = f"stability is unknown, and a sweep may jump, in {narrow} {windows}"
        return said if narrow else ""
    table = DofTable([*names, f"from {unit}", "to"], dofs, ["{} there"], ["sweep"], cells)
    said = "between these stability is unknown, and a sweep may jump; more harmonics may tell:"
    more = f"\nand in {narrow} more {windows}" if narrow else ""
    return f"{said}\n{table.text(last=1)}{more}"


def _is_narrow(window: Mapping[str, Any]) -> bool:
    return bool(abs(window["to"] - window["from"]) < SENTENCES.narrow_window * window["from"])


def _rows(
    curves: Sequence[Mapping[str, Any]], rows: Callable[[Mapping[str, Any]], list[Row]]
) -> list[tuple[list[str], list[list[str]], list[str]]]:
    """The rows of all curves, of each as first the upward, then the downward sweep meets them."""
    found = []
    for curve in curves:
        ups = sorted((one for one in rows(curve) if one[0] == "up"), key=lambda one: one[1])
        downs = sorted((one for one in rows(curve) if one[0] != "up"), key=lambda one: -one[1])
        found += [([*swept(curve), *where], each, [sweep]) for sweep, _, where, each in ups + downs]
    return found
