"""Limits linear algebra to one thread, since the matrices are small and many.

Threads that wait for each other made a large scene ten times slower on a machine with other work.
"""

from __future__ import annotations

import os
import sys
import threading
from functools import lru_cache

TYPE_CHECKING = False
if TYPE_CHECKING:
    from contextlib import AbstractContextManager
    from typing import Any

_VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def one_by_default() -> None:
    """Sets one thread for this process, unless the user has set a number; call before numpy is imported."""
    for name in _VARIABLES:
        os.environ.setdefault(name, "1")


def one_each() -> dict[str, str]:
    """Environment variables that limit a process to one thread."""
    return dict.fromkeys(_VARIABLES, "1")


def one_here() -> AbstractContextManager[object]:
    """`one_thread()` for use as a library; no limit if the environment already sets a number of threads.

    The environment of the command does so.
    """
    from contextlib import nullcontext

    return nullcontext() if any(name in os.environ for name in _VARIABLES) else one_thread()


class one_thread:  # noqa: N801
    """``with one_thread():`` limits linear algebra to one thread after numpy has been imported.

    The limit applies to the whole process: the first Python thread to enter sets it, the last to leave
    restores the old one.
    """

    _lock, _inside = threading.Lock(), 0
    _limits: Any = None

    def __enter__(self) -> None:
        with self._lock:
            one_thread._inside += 1
            if one_thread._inside == 1:
                one_thread._limits = _limited()

    def __exit__(self, *_: object) -> None:
        with self._lock:
            one_thread._inside -= 1
            if one_thread._inside == 0 and one_thread._limits is not None:
                one_thread._limits.restore_original_limits()


def _limited() -> Any:
    return _libraries(len(sys.modules)).limit(limits=1, user_api="blas")


@lru_cache(maxsize=1)
def _libraries(_: int) -> Any:
    """The linear algebra libraries that this process has loaded, cached by the number of imported modules.

    The search takes a millisecond, and is repeated only after further imports.
    """
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
