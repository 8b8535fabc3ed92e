"""Kernels of contacts, shared within a thread: read the results before other code evaluates the kernel."""

from __future__ import annotations

import threading
from functools import lru_cache
from typing import TYPE_CHECKING

from fcm.contact.options import KERNELS
from fcm.contact.periodic.cycle import PeriodicContact

if TYPE_CHECKING:
    from fcm.contact.plane.cycle import PlanarContact


class _Kernels(threading.local):
    """The kernels of each thread, by their harmonics."""

    def __init__(self) -> None:
        self.on_a_line = lru_cache(KERNELS.max_kernels)(_periodic)
        self.in_a_plane = lru_cache(KERNELS.max_kernels)(_planar)


def periodic_contact(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PeriodicContact:
    """This thread's kernel of contacts on a line, for given harmonics of motions and of forces."""
    return _KERNELS.on_a_line(harmonics, outputs)


def planar_contact(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PlanarContact:
    """This thread's kernel of contacts in a plane, for given harmonics of motions and of forces."""
    return _KERNELS.in_a_plane(harmonics, outputs)


def _periodic(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PeriodicContact:
    return PeriodicContact(list(harmonics), list(outputs))


def _planar(harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> PlanarContact:
    from fcm.contact.plane.cycle import PlanarContact  # most scenes have no contacts in a plane

    return PlanarContact(list(harmonics), list(outputs))


_KERNELS = _Kernels()
