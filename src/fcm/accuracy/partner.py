"""The harmonics of the partner of a curve, and its balance."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Sequence

import numpy as np

from fcm.accuracy.options import PAIR, PairOptions
from fcm.harmonic_balance.normal_plane_prolongation import Lifted
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.scene.options import LIMITS


def partner_of(
    harmonics: Sequence[int], share: FloatArray, ports: int, options: PairOptions = PAIR
) -> tuple[int, ...]:
    """Harmonics of the partner of a curve that has some, as of `PairOptions`.

    Parameters
    ----------
    share : array (harmonic,)
        What each would do that is left out, from the first on: the spectrum of the exact forces times the
        receptance, of the points that matter.
    ports : int
        Directions in which all contacts move.

    Examples
    --------
    >>> import numpy as np
    >>> partner_of((1,), np.zeros(50), 2)
    (1, 2, 3, 4, 5)
    >>> named = np.zeros(50)
    >>> named[11] = 0.01
    >>> partner_of((1, 2), named, 2)
    (1, 2, 3, 4, 5, 6, 7, 8, 12)
    """
    has, count = set(harmonics), len(harmonics)
    allowed = max(options.unknowns // (2 * max(ports, 1)) - count, options.fewest)
    total = float(share.sum())
    order = [int(k) + 1 for k in np.argsort(-share, kind="stable") if share[k] > options.share * total]
    highest = min(options.times * count, count + options.most)
    low = range(1, min(max(highest, options.least), LIMITS.harmonics + options.most) + 1)
    named = [h for h in order if h not in low][: options.named]
    # where not all can be had what matters most comes first, then the lowest
    wanted = dict.fromkeys((*order[:1], *low, *named))
    more = [h for h in wanted if h not in has][:allowed]
    return tuple(sorted(has.union(more)))


class _Kept(threading.local):
    """The balances that each thread used last, by what they are for."""

    def __init__(self) -> None:
        self.of: OrderedDict[tuple[object, ...], Lifted] = OrderedDict()


_KEPT = _Kept()


def lifted_of(system: System, more: tuple[int, ...]) -> Lifted:
    """From points of a system to those of its partner; as if it were new: in a sweep the contacts are
    others. Nobody else has it until it is given back, see `give_back`."""
    made = _KEPT.of.pop(_key(system, more), None) if _plain(system) else None
    if made is None:
        return Lifted(system.with_harmonics(more).balance(), list(system.harmonics), list(more), PAIR.enough)
    contacts = system.scene.contacts
    made.take(list(system.harmonics), [(c.mu, c.k_u, c.k_v, c.n_0) for c in contacts])
    return made


def give_back(lifted: Lifted, system: System, more: tuple[int, ...]) -> None:
    """Keep what `lifted_of` the same has made for the next curve."""
    if _plain(system):
        _KEPT.of[_key(system, more)] = lifted
        if len(_KEPT.of) > PAIR.kept:
            _KEPT.of.popitem(last=False)


def _plain(system: System) -> bool:
    """Whether the next curve may have the same structure, seen by other contacts."""
    return system.scene.ring is None and not system.scene.loads and not system.own_laws


def _key(system: System, more: tuple[int, ...]) -> tuple[object, ...]:
    return (*system.linear.numbers, system.scene.frequency_range, system.harmonics, more)
