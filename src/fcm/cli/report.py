"""What a response run reports: a table to read, a line of cost and error, JSON for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fcm.response import Response

_MOST_DOFS = 4  # whose peaks fit beside each other on a line


def as_json(value: Any) -> str:
    """JSON that every reader accepts: what is not a number is null."""
    return json.dumps(_plain(value), indent=2, allow_nan=False)


def _plain(value: Any) -> Any:
    """The value in Python's own types, without NaN and infinities."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):  # a numpy array or number
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def as_table(summary: Mapping[str, Any], unit: str) -> str:
    """One line a curve: what was swept, the peaks, the folds, the points, whether it is whole, its time."""
    curves = summary["curves"]
    if not curves:
        return "no curve"
    parameters = list(curves[0]["parameters"])
    dofs = list(curves[0]["peak"])[:_MOST_DOFS]
    header = [_short(name) for name in parameters]
    header += [text for dof in dofs for text in (f"peak {dof}", f"at {unit}")]
    header += ["points", "time [s]", f"folds at {unit}", ""]
    return "\n".join(_aligned([header, *(_row(curve, parameters, dofs) for curve in curves)]))


def _row(curve: Mapping[str, Any], parameters: Sequence[str], dofs: Sequence[str]) -> list[str]:
    cells = [_number(curve["parameters"][name]) for name in parameters]
    for dof in dofs:
        peak = curve["peak"].get(dof) or {}
        cells += [_number(peak.get("amplitude")), _number(peak.get("frequency"))]
    folds = "  ".join(_number(fold) for fold in curve["folds"]) or "none"
    return [*cells, str(curve["points"]), f"{curve['seconds']:.3f}", folds, _state(curve)]


def _state(curve: Mapping[str, Any]) -> str:
    return "" if curve["complete"] else f"NOT COMPLETE: {curve.get('reason') or 'it stopped early'}"


def _aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Columns of equal width: numbers to the right, the last two to the left."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    left = len(widths) - 2
    return [
        "  ".join(
            cell.rjust(width) if i < left else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def cost_and_error(summary: Mapping[str, Any]) -> str:
    """What the run cost and how wrong it is, in a line or two."""
    curves = summary["curves"]
    points = sum(curve["points"] for curve in curves)
    count = f"{len(curves)} curve{'' if len(curves) == 1 else 's'}"
    lines = [f"{count}, {points} points in {summary['seconds']:.2f} s"]
    errors = []
    for key, what in (("table_error", "of the table"), ("truncation_error", "of the single harmonic")):
        worst = max((_finite(curve.get(key)) for curve in curves), default=-math.inf)
        if worst >= 0:
            errors.append(f"{worst:.1e} {what}")
    lines.append("largest relative error: " + (", ".join(errors) or "not known"))
    return "\n".join(lines)


def incomplete(response: Response) -> str:
    """Which curves stopped early; empty if none."""
    stopped = sum(not curve.complete for curve in response.curves)
    return f"{stopped} of {len(response.curves)} curves not complete" if stopped else ""


def _finite(value: float | None) -> float:
    return float(value) if value is not None and math.isfinite(value) else -math.inf


def _number(value: float | None) -> str:
    return "-" if value is None or not math.isfinite(value) else f"{value:.6g}"


def _short(name: str) -> str:
    return name.rpartition(".")[2]
