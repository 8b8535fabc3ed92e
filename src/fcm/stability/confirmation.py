"""Whether motions that nothing else vouches for are stable with further harmonics balanced, too.

A solution is called stable by the multipliers of a motion that errs by what its harmonics leave out. Where
the pair of the curve does not tell how much that is, or it is much, the motion with further harmonics is
balanced itself, at the same frequency. If that is near, stable, and hardly another by the harmonics beyond
those, the solution is what it is taken for.
"""

from __future__ import annotations

import itertools

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.runs import runs
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.floquet import multipliers_of
from fcm.stability.options import STABILITY, StabilityOptions

Mask = npt.NDArray[np.bool_]


def confirmed_stable(
    system: System, z: FloatArray, doubted: Mask, options: StabilityOptions = STABILITY
) -> Mask:
    """Which of the doubted points (point,) have a stable motion with further harmonics near them.

    Parameters
    ----------
    system : System
    z : (point, unknown + 1)
        Points of a curve of its balance, in order, found stable.
    doubted : (point,) bool
        Those that are to be confirmed.
    options : StabilityOptions, optional
        Of a row of them some are looked at, `ConfirmationOptions.point_interval` apart; between two that
        are confirmed all are, between others those beside them by bisection. None is where a contact has a
        law of its own.
    """
    found = np.zeros(len(z), dtype=np.bool_)
    if doubted.any() and not system.own_laws:
        looks = _ConfirmedPoints(system, z, options)
        for first, end in runs(doubted):
            parts = -(-(end - 1 - first) // options.confirmation.point_interval) or 1
            nodes = sorted({first + k * (end - 1 - first) // parts for k in range(parts + 1)})
            found[nodes[0]] = looks.at(nodes[0])
            for a, b in itertools.pairwise(nodes):
                looks.between(a, b, found)
    return found


class _ConfirmedPoints:
    """Points that are looked at, each once."""

    def __init__(self, system: System, z: FloatArray, options: StabilityOptions) -> None:
        self.multipliers = multipliers_of(system, float(z[:, -1].max()), options)
        self.max_addition = options.confirmation.max_addition
        self.work, self.z, self.known = system.work, z, dict[int, bool]()

    def at(self, i: int) -> bool:
        """Whether the motion with further harmonics is found, and stable."""
        if i not in self.known:
            self.work.poll()
            self.known[i] = self.multipliers.confirms(self.z[i], 1.0, self.max_addition)
        return self.known[i]

    def between(self, a: int, b: int, found: Mask) -> None:
        """Fill found after a point up to another."""
        if self.at(a) == self.at(b):
            found[a + 1 : b + 1] = self.at(b)
        elif b - a > 1:
            self.between(a, (a + b) // 2, found)
            self.between((a + b) // 2, b, found)
        else:
            found[b] = self.at(b)
