"""The system without preloads and gaps, to whose response that of ever larger motions tends.

The forces of a contact are homogeneous in its motion and its preload: s times both gives s times the forces.
So at the force level s the response is s times that with preloads n_0 / s. At levels so high that preloads
and gaps do not matter, its peaks are those without any. A branch that is isolated from small motions may have
its top there, and the force level leads to it only near that frequency.
"""

from __future__ import annotations

import threading
from dataclasses import replace

from fcm.branches.force_level import LEVEL_REACH
from fcm.branches.options import LEVEL_CURVE
from fcm.branches.trace import FoundPeak, traced
from fcm.harmonic_balance.system import System


def without_preload(system: System) -> System | None:
    """The system with a few harmonics, and without preloads, gaps, static loads and friction of [start].

    None if no contact with a preload or gap can open. None, too, for many contacts, of which hardly any
    opens, and for contact laws of its own, whose forces need not be homogeneous.
    """
    scene = system.scene
    many = len(scene.contacts) >= system.option(LEVEL_REACH).min_contacts
    opens = any(one.k_v > 0.0 and one.n_0 != 0.0 for one in scene.contacts)
    if many or system.own_laws or not opens:
        return None
    contacts = tuple(replace(one, n_0=0.0, slider=()) for one in scene.contacts)
    few = system.harmonics[: system.option(LEVEL_CURVE).reliable_harmonics]
    found = system.of(replace(scene, contacts=contacts, loads=())).with_harmonics(few)
    found.work.poll = system.work.poll
    return found


class _LastPeaks(threading.local):
    """The peaks that each thread found last, with their key: a sweep of preloads shares them."""

    key: tuple[object, ...] = ()
    peaks: tuple[FoundPeak, ...] = ()


_LAST = _LastPeaks()


def peaks_without_preload(system: System) -> tuple[FoundPeak, ...]:
    """Peaks of the response of the system `without_preload`; empty if there is no such system."""
    free = without_preload(system)
    if free is None:
        return ()
    scene = free.scene
    contacts = tuple((one.mu, one.k_u, one.k_v) for one in scene.contacts)
    key = (free.linear.numbers, contacts, free.harmonics, scene.frequency_range, scene.max_step)
    if _LAST.key != key:
        _LAST.key, _LAST.peaks = key, traced(free).own_peaks
    return _LAST.peaks
