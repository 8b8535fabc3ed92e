"""The harmonics of the reference of a curve, and its balance."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Sequence

import numpy as np

from fcm.accuracy.options import PAIR, PairOptions
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.scene.options import LIMITS


def reference_harmonics(
    harmonics: Sequence[int], share: FloatArray, ports: int, options: PairOptions = PAIR
) -> tuple[int, ...]:
    """Harmonics of the reference of a curve with given harmonics, chosen by `PairOptions`.

    Parameters
    ----------
    share : array (harmonic,)
        Effect without feedback of each harmonic left out, from harmonic 1 on: the spectrum of the exact
        forces times the receptance, at the points that matter.
    ports : int
        Number of ports: the directions of motion of all contacts.

    Examples
    --------
    >>> import numpy as np
    >>> reference_harmonics((1,), np.zeros(50), 2)
    (1, 2, 3, 4, 5)
    >>> named = np.zeros(50)
    >>> named[11] = 0.01
    >>> reference_harmonics((1, 2), named, 2)
    (1, 2, 3, 4, 5, 6, 7, 8, 12)
    """
    has, count = set(harmonics), len(harmonics)
    allowed = max(options.max_unknowns // (2 * max(ports, 1)) - count, options.min_added)
    total = float(share.sum())
    order = [int(k) + 1 for k in np.argsort(-share, kind="stable") if share[k] > options.min_share * total]
    highest = min(options.harmonics_factor * count, count + options.max_added)
    low = range(1, min(max(highest, options.min_harmonic), LIMITS.harmonics + options.max_added) + 1)
    named = [h for h in order if h not in low][: options.max_named]
    # in order of priority, if not all are allowed: the most important one, then the lowest
    wanted = dict.fromkeys((*order[:1], *low, *named))
    more = [h for h in wanted if h not in has][:allowed]
    return tuple(sorted(has.union(more)))


class _BalanceCache(threading.local):
    """Cache of each thread: the prolongations used last, by structure and harmonics."""

    def __init__(self) -> None:
        self.by_key: OrderedDict[tuple[object, ...], Prolongation] = OrderedDict()


_BALANCES = _BalanceCache()


def prolongation_to(system: System, more: tuple[int, ...], options: PairOptions = PAIR) -> Prolongation:
    """The prolongation from points of a system to those of its reference, from the cache if possible.

    A cached one is reset for the present contacts. It has one owner until `keep_for_next` returns it.
    """
    made = _BALANCES.by_key.pop(_key(system, more, options), None) if _is_shareable(system) else None
    if made is None:
        made = Prolongation(
            system.with_harmonics(more).new_balance(),
            list(system.harmonics),
            list(more),
            options.newton_tolerance,
        )
    else:
        contacts = system.scene.contacts
        made.reset(list(system.harmonics), [(c.mu, c.k_u, c.k_v, c.n_0) for c in contacts])
    made.newton.poll = system.work.poll
    return made


def keep_for_next(
    prolongation: Prolongation, system: System, more: tuple[int, ...], options: PairOptions = PAIR
) -> None:
    """Return the prolongation made by `prolongation_to` for the same arguments to the cache."""
    prolongation.newton.poll = None
    if _is_shareable(system):
        _BALANCES.by_key[_key(system, more, options)] = prolongation
        while len(_BALANCES.by_key) > options.max_kept:
            _BALANCES.by_key.popitem(last=False)


def _is_shareable(system: System) -> bool:
    """Whether prolongations may be cached: no ring, no strain at rest, and no contact laws of its own."""
    return system.scene.ring is None and not system.scene.strained and not system.own_laws


def _key(system: System, more: tuple[int, ...], options: PairOptions) -> tuple[object, ...]:
    of_scene = (*system.linear.numbers, system.scene.frequency_range, system.scene.reported)
    return (*of_scene, system.harmonics, more, options.newton_tolerance)
