"""The table of jumps: where a slow sweep of the frequency leaves a curve's stable part, or may do so."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fcm.cli.columns import UNKNOWN, aligned, number, swept

_LOST = "\n- the curve has no stable part there to land on"
_MAY_JUMP = (
    f"\n{UNKNOWN} between these it is not told whether the motion is stable: it may jump there already"
)


def jump_table(curves: Sequence[Mapping[str, Any]], names: list[str], dofs: list[str], unit: str) -> str:
    """A line for each jump, and for each way of a sweep on which there may be one; empty if none."""
    moves = [text for dof in dofs for text in (f"{dof} before", f"{dof} after")]
    rows = [[*names, f"jump at {unit}", *moves, "sweep"]]
    for curve in curves:
        rows += [[*swept(curve), *cells] for cells in _rows(curve, dofs)]
    if len(rows) == 1:
        return ""
    lost = any("-" in row[len(names) :] for row in rows)
    unsure = any(UNKNOWN in row for row in rows)
    return aligned(rows, left=1) + (_LOST if lost else "") + (_MAY_JUMP if unsure else "")


def _rows(curve: Mapping[str, Any], dofs: list[str]) -> list[list[str]]:
    """The lines of one curve, as first the upward, then the downward sweep meets them."""
    found = [(one["sweep"], one["frequency"], _jump(one, dofs)) for one in curve.get("jumps", ())]
    found += [(one["sweep"], one["from"], _untold(one, dofs)) for one in curve.get("stability_untold", ())]
    ups = sorted((one for one in found if one[0] == "up"), key=lambda one: one[1])
    downs = sorted((one for one in found if one[0] != "up"), key=lambda one: -one[1])
    return [[*cells, sweep] for sweep, _, cells in ups + downs]


def _jump(one: Mapping[str, Any], dofs: list[str]) -> list[str]:
    moves = [number(one[side].get(dof)) for dof in dofs for side in ("before", "after")]
    return [number(one["frequency"]), *moves]


def _untold(one: Mapping[str, Any], dofs: list[str]) -> list[str]:
    moves = [text for dof in dofs for text in (number(one["before"].get(dof)), UNKNOWN)]
    ends = dict.fromkeys((number(one["from"]), number(one["to"])))  # one, where six digits tell no more
    return [" to ".join(ends) + UNKNOWN, *moves]
