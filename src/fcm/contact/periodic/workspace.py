"""Kernels of periodic contacts that are made once: what uses them reads the results before another does."""

from __future__ import annotations

import threading
from functools import lru_cache

from fcm.contact.periodic.forces import PeriodicContact

MOST = 128  # kernels of a thread: a sweep's curves ask for further harmonics in some eighty sets


class _Kernels(threading.local):
    """Of each thread, by their harmonics."""

    def __init__(self) -> None:
        self.of = lru_cache(MOST)(_made)


def periodic_contact(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PeriodicContact:
    """The kernel of this thread for these harmonics of motions and of forces."""
    return _KERNELS.of(harmonics, outputs)


def _made(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PeriodicContact:
    return PeriodicContact(list(harmonics), list(outputs))


_KERNELS = _Kernels()
