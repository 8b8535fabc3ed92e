"""Tables of the Fourier coefficients: an atlas of coordinates, built from the closed form, stored, looked up."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fcm.table import build, measure, store
from fcm.table.lookup import Table
from fcm.table.store import TableError

__all__ = ["Table", "TableError", "build_table", "open_table"]


def open_table(path: str | Path | None = None) -> Table:
    """Open a table made by `fcm tabulate` or `build_table`; the shipped one if path is None.

    Raises
    ------
    TableError
        If the file is missing, not a table, of another layout, or damaged.

    Examples
    --------
    >>> table = open_table()
    >>> print(round(float(table(0.5, 0.0, 0.0)[1]), 4))
    0.5
    """
    separation, slip, error = store.load(path)
    return Table(separation, slip, error)


def build_table(
    path: str | Path,
    resolution: build.Resolution = build.PRESETS["default"],
    progress: Any = None,
    points: int = measure.POINTS,
) -> Table:
    """Build a table from the closed form, measure its error, write it to path and return it."""
    separation, slip = build.charts(resolution, progress)
    error = measure.measure(Table(separation, slip), points, progress=progress)
    store.save(path, separation, slip, error)
    return open_table(path)
