"""The rows of the catalogue as a table of text and as numbers for programs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from fcm.cli.columns import aligned
from fcm.results.summary import without_nan

from .row import Row
from .verdict import excess, faults

HEADER = ["scene", "points", "time [s]", "residual", "tolerance", "table"]
HEADER += ["exact", "estimate", "found", "condition", ""]
LEGEND = """\
residual   unbalanced modal force, relative to the forces; tolerance: what 1e-13 of the displacements is worth
table      greatest difference of peaks and folds by the table and by the closed form
exact      difference from the exact periodic motion, at the point where it is largest against its
estimate   of what the single harmonic leaves out; found: at how many of the points tried it exists
condition  greatest condition number of the Jacobian along the curve"""


def as_text(rows: Sequence[Row]) -> str:
    """One line a scene, the legend, then why some do not pass."""
    table = aligned([HEADER, *(_cells(row) for row in rows)], left=1)
    wrong = [f"{row.name}: {'; '.join(faults(row))}" for row in rows if faults(row)]
    stopped = [f"{row.name}: {row.reason}" for row in rows if not row.complete and not faults(row)]
    parts = [table, LEGEND]
    parts += ["passes without being complete:\n  " + "\n  ".join(stopped)] if stopped else []
    parts += ["does not pass:\n  " + "\n  ".join(wrong)] if wrong else []
    count = f"{len(rows) - len(wrong)} of {len(rows)} pass"
    return "\n\n".join([*parts, count])


def _cells(row: Row) -> list[str]:
    worst = max(row.compared, key=excess, default=None)
    exact = ["-", "-"] if worst is None else [_short(worst.difference), _short(worst.truncation)]
    found = f"{len(row.compared)} of {len(row.exact)}" if row.exact else "-"
    state = "FAILS" if faults(row) else "passes" if row.complete else "passes, says why it stops"
    numbers = [_short(row.residual), _short(row.tolerance), _short(row.table)]
    cells = [row.name, str(row.points), f"{row.seconds:.2f}", *numbers]
    return [*cells, *exact, found, _short(row.condition), state]


def _short(value: float) -> str:
    return f"{value:.1e}" if np.isfinite(value) else "-"


def as_data(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """The rows for JSON; a number that does not exist is None."""
    return [without_nan({**asdict(row), "passes": not faults(row), "faults": faults(row)}) for row in rows]
