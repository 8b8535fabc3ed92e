"""Which rows are known to pass: a text file of names, one a line; what follows # is for readers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .row import Row
from .verdict import faults


def read_known(path: Path) -> set[str]:
    """The names in the file."""
    lines = (line.partition("#")[0].strip() for line in path.read_text(encoding="utf-8").splitlines())
    return {line for line in lines if line}


def changes(rows: Sequence[Row], known: set[str]) -> tuple[list[str], list[str]]:
    """Rows that passed and no longer do, and those that pass for the first time."""
    passing = {row.name: not faults(row) for row in rows}
    lost = [name for name, passes in passing.items() if not passes and name in known]
    return lost, [name for name, passes in passing.items() if passes and name not in known]
