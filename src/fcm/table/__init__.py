"""Tables of the Fourier coefficients: an atlas of coordinates; built, stored, looked up, measured."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fcm.table import store
from fcm.table.lookup import Table
from fcm.table.store import TableError

if TYPE_CHECKING:
    from fcm.table.build import build_table

__all__ = ["Table", "TableError", "build_table", "open_table"]


def open_table(path: str | Path | None = None) -> Table:
    """Open a table made by `fcm tabulate` or `build_table`; the shipped one if path is None.

    Raises
    ------
    TableError
        If the file is missing, not a table, of another layout, or damaged; a ValueError.

    Examples
    --------
    >>> table = open_table()
    >>> F_b, F_s, F_c = table(0.5, 0.0, 0.0)
    >>> print(f"{F_s:.4f} {F_c:.4f}")
    0.5000 0.3183
    >>> table.error["max"] < 2e-4
    True
    """
    return Table(*store.load(path))


def __getattr__(name: str) -> Any:
    if name == "build_table":  # needs the closed form and more, which look-up does not
        return import_module("fcm.table.build").build_table
    raise AttributeError(f"module 'fcm.table' has no attribute {name!r}")
