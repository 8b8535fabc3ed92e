"""Kernels of contacts in the plane, made once: what uses them reads the results before another does."""

from __future__ import annotations

import threading
from functools import lru_cache

from fcm.contact.plane.forces import PlanarContact

MOST = 128  # kernels of a thread


class _Kernels(threading.local):
    """Of each thread, by their harmonics."""

    def __init__(self) -> None:
        self.of = lru_cache(MOST)(_made)


def planar_contact(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PlanarContact:
    """The kernel of this thread for these harmonics of motions and of forces."""
    return _KERNELS.of(harmonics, outputs)


def _made(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PlanarContact:
    return PlanarContact(list(harmonics), list(outputs))


_KERNELS = _Kernels()
