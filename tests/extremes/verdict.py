"""Whether a row of the catalogue passes, and in plain words why not. A row passes if all of this holds:

- its curve is complete; or it stops where the amplitude has no limit,
  at a resonance that hardly anything damps;
- at every point the full modal equations are balanced: what is left is below 1e-9 of the forces, or below
  what a change of the displacements by 1e-13 is worth, to which points are corrected;
- table and closed form lead to the same peaks and folds, to 1e-6;
- it has stable points away from the folds, and at each of some of them an exact periodic motion is found,
  whose amplitude differs by less than five times the error that is estimated for leaving out the higher
  harmonics, or than 1e-6.
"""

from __future__ import annotations

from math import isfinite

from fcm.continuation import Status

from .beside import Beside
from .residual import BALANCED
from .row import Row

SAME = 1e-6  # peaks and folds by table and by closed form, relative
TRUNCATIONS, LINEAR = 5.0, 1e-6  # of the estimated error; where the response is linear


def faults(row: Row) -> list[str]:
    """Why a row does not pass; empty if it does."""
    return [fault for fault in (_incomplete(row), _unbalanced(row), _table(row), _exact(row)) if fault]


def excess(point: Beside) -> float:
    """Difference from the exact motion in units of what is allowed."""
    return point.difference / max(TRUNCATIONS * point.truncation, LINEAR)


def _incomplete(row: Row) -> str:
    if not row.complete and not row.reason.endswith(Status.UNBOUNDED.value):
        return f"not complete: {row.reason}"
    return ""


def _unbalanced(row: Row) -> str:
    if not row.points or row.residual <= BALANCED + row.tolerance:
        return ""
    return f"residual {row.residual:.1e}, allowed {BALANCED + row.tolerance:.1e}"


def _table(row: Row) -> str:
    if row.table <= SAME:
        return ""
    return f"peaks or folds by table and by closed form differ by {row.table:.1e}"


def _exact(row: Row) -> str:
    if row.points and not row.exact:
        return "not compared with the exact motion: no point is called stable"
    missing = [point for point in row.exact if not isfinite(point.difference)]
    if missing:
        where = ", ".join(f"{point.frequency:.6g}" for point in missing)
        estimate = max(point.truncation for point in missing)
        return (
            f"no exact motion found at {where} rad/s (estimated error of the single harmonic {estimate:.1g})"
        )
    far = [point for point in row.compared if excess(point) > 1.0]
    if not far:
        return ""
    worst = max(far, key=excess)
    return (
        f"differs from the exact motion by {worst.difference:.1e} at {worst.frequency:.6g} rad/s, "
        f"estimated {worst.truncation:.1e}"
    )
