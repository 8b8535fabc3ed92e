"""Tables of the Fourier coefficients on an atlas of coordinates: building, storing, looking up, measuring."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fcm.lazy_import import on_demand

if TYPE_CHECKING:
    from fcm.table.build import build_table
    from fcm.table.lookup import Table

__all__ = ["Table", "TableError", "build_table", "open_table"]

_HOME = {"Table": "lookup", "build_table": "build"}  # not needed to open a table

__getattr__ = on_demand(__name__, _HOME)


class TableError(ValueError):
    """Raised for a file that is not a sound table; the message says which file and why."""


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
    from fcm.table import shipped

    if path is None and (table := shipped.read(shipped.DEFAULT)) is not None:
        return table
    from fcm.table import store
    from fcm.table.lookup import Table

    return Table(*store.load(shipped.DEFAULT if path is None else path))
