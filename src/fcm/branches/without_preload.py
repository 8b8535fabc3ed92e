"""The system without preloads and gaps, to whose response that of larger and larger motions tends.

The forces of a contact are homogeneous in its motion and its preload: with s times both they are s times as
large. So at a level s of the forces the response is s times that with preloads n_0 / s. Beyond the levels at
which preloads and gaps matter its peaks are those without any. A branch that is isolated from small motions
may have its top there, and the level of the forces leads to it near that frequency alone.
"""

from __future__ import annotations

import threading
from dataclasses import replace

from fcm.branches.force_level import LEVEL_REACH
from fcm.branches.options import LEVEL_CURVE
from fcm.branches.trace import FoundPeak, traced
from fcm.harmonic_balance.system import System


def without_preload(system: System) -> System | None:
    """The system with a few of its harmonics and no preload, gap, static load or friction of [start]; None if
    it is no other.

    Nor is there one of many contacts, of which hardly any opens, or with laws of one's own, whose forces need
    not be homogeneous.
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
    """Those that each thread found last, with what they are of: of a sweep of preloads all have the same."""

    key: tuple[object, ...] = ()
    peaks: tuple[FoundPeak, ...] = ()


_LAST = _LastPeaks()


def peaks_without_preload(system: System) -> tuple[FoundPeak, ...]:
    """Peaks of the response of the system `without_preload`."""
    free = without_preload(system)
    if free is None:
        return ()
    scene = free.scene
    contacts = tuple((one.mu, one.k_u, one.k_v) for one in scene.contacts)
    key = (free.linear.numbers, contacts, free.harmonics, scene.frequency_range, scene.max_step)
    if _LAST.key != key:
        _LAST.key, _LAST.peaks = key, traced(free).own_peaks
    return _LAST.peaks
