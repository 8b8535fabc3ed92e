"""The stiff and extreme cases for a page, from what ``make extremes`` has written."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fcm.cli.columns import short

from .page import Section, Table

COLUMNS = ("scene", "points", "time [s]", "residual", "table", "exact", "estimate", "condition", "outcome")
ABOUT = (
    "One scene for each way in which numbers can go wrong. Residual: the unbalanced modal force, relative to "
    "the forces. Table: greatest difference of peaks and folds by the table and in closed form. Exact: "
    "greatest difference from the exact periodic motion over some points of the curve. Estimate: the most "
    "that the single harmonic is said to leave out at these points. Condition: greatest condition number of "
    "the Jacobian along the curve.",
)

Case = Mapping[str, Any]  # one of what ``make extremes`` writes


def read_cases(path: Path) -> list[Case]:
    """The rows of the file."""
    cases: list[Case] = json.loads(path.read_text(encoding="utf-8"))
    return cases


def section(path: Path) -> Section:
    """A line for each case of a file, and how many pass."""
    cases = read_cases(path)
    passed = sum(bool(case["passes"]) for case in cases)
    return Section(
        "Stiff and extreme cases",
        text=(*ABOUT, f"{passed} of {len(cases)} pass."),
        commands=("make extremes",),
        tables=(Table(COLUMNS, [_row(case) for case in cases]),),
    )


def failures(path: Path) -> list[tuple[str, str]]:
    """Names of the cases of a file that do not pass or are not complete, and why."""
    cases = read_cases(path)
    wrong = [(case["name"], "; ".join(case["faults"])) for case in cases if not case["passes"]]
    return wrong + [(c["name"], c["reason"]) for c in cases if c["passes"] and not c["complete"]]


def _row(case: Case) -> tuple[str, ...]:
    compared = [point for point in case["exact"] if point["difference"] is not None]
    outcome = "passes" if case["complete"] else "passes, says why it stops"
    return (
        case["name"], str(case["points"]), f"{case['seconds']:.2f}", short(case["residual"]),
        short(case["table"]), short(max((point["difference"] for point in compared), default=None)),
        short(max((point["truncation"] for point in compared), default=None)),
        short(case["condition"]), outcome if case["passes"] else "FAILS",
    )  # fmt: skip
