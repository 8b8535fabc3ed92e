"""Threads of the linear algebra: one, for the matrices here are small and many.

Threads that wait for one another made a large scene ten times slower on a machine with other work.
"""

from __future__ import annotations

import os

_VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def one_by_default() -> None:
    """One thread in this process, unless the user has set another number; before numpy is imported."""
    for name in _VARIABLES:
        os.environ.setdefault(name, "1")


def one_each() -> dict[str, str]:
    """What the environment of a process says that has one core for itself."""
    return dict.fromkeys(_VARIABLES, "1")
