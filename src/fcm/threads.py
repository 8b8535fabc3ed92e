"""Threads of the linear algebra: one, for the matrices here are small and many.

Threads that wait for one another made a large scene ten times slower on a machine with other work.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

_VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def one_by_default() -> None:
    """One thread in this process, unless the user has set another number; before numpy is imported."""
    for name in _VARIABLES:
        os.environ.setdefault(name, "1")


@contextmanager
def one_in_children() -> Iterator[None]:
    """One thread in each process that is started meanwhile."""
    before = {name: os.environ.get(name) for name in _VARIABLES}
    os.environ.update(dict.fromkeys(_VARIABLES, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
