"""What a response run says to a reader: a table of its curves, and a line or two of cost and error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

_MOST_DOFS = 4  # whose peaks fit beside each other on a line


def as_table(summary: Mapping[str, Any], unit: str) -> str:
    """One line a curve: what was swept, the peaks, the folds, the points, whether it is whole, its time."""
    from fcm.plot.labels import short_names

    curves = summary["curves"]
    if not curves:
        return "no curve"
    parameters = list(curves[0]["parameters"])
    dofs = list(curves[0]["peak"])[:_MOST_DOFS]
    header = list(short_names(parameters).values())
    header += [text for dof in dofs for text in (f"peak {dof}", f"at {unit}")]
    header += ["points", "time [s]", f"folds at {unit}", ""]
    return "\n".join(_aligned([header, *(_row(curve, parameters, dofs) for curve in curves)]))


def _row(curve: Mapping[str, Any], parameters: Sequence[str], dofs: Sequence[str]) -> list[str]:
    cells = [f"{curve['parameters'][name]:.6g}" for name in parameters]
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
    table, harmonic = (_worst(curves, key) for key in ("table_error", "truncation_error"))
    errors = []
    if summary.get("method") != "closed-form" and table is not None:
        errors.append(f"{table:.1e} by the table, corrected at every point")
    if harmonic is not None:
        errors.append(f"{harmonic:.1e} by leaving out higher harmonics")
    lines.append("largest relative error: " + ("; ".join(errors) or "not known"))
    return "\n".join(lines)


def _worst(curves: Sequence[Mapping[str, Any]], key: str) -> float | None:
    return max((curve[key] for curve in curves if curve.get(key) is not None), default=None)


def incomplete(summary: Mapping[str, Any]) -> str:
    """How many curves stopped early; empty if none."""
    curves = summary["curves"]
    stopped = sum(not curve["complete"] for curve in curves)
    return f"{stopped} of {len(curves)} curves not complete" if stopped else ""


def _number(value: float | None) -> str:
    """Six digits, or a dash for a number that does not exist."""
    return "-" if value is None else f"{value:#.6g}"
