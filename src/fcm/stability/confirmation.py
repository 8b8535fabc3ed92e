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
from fcm.stability.multipliers import Multipliers
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.verdict import Verdict, growth_is_linear

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
        Of a row of them some are looked at, `ConfirmationOptions.point_interval` apart, and between two of
        these the middle, until all three agree and their growths lie on a line: then so does what is between
        them. None is where a contact has a law of its own.
    """
    found = np.zeros(len(z), dtype=np.bool_)
    if doubted.any() and not system.own_laws:
        looks = _ConfirmedPoints(system, z, options)
        for first, end in runs(doubted):
            parts = -(-(end - 1 - first) // options.confirmation.point_interval) or 1
            nodes = sorted({first + k * (end - 1 - first) // parts for k in range(parts + 1)})
            found[nodes[0]] = looks.confirms(nodes[0])
            for a, b in itertools.pairwise(nodes):
                looks.between(a, b, found)
    return found


class _ConfirmedPoints:
    """Points that are looked at, each once."""

    def __init__(self, system: System, z: FloatArray, options: StabilityOptions) -> None:
        found = multipliers_of(system, float(z[:, -1].max()), options)
        assert isinstance(found, Multipliers)
        self.multipliers, self.options = found, options
        self.many = len(system.scene.contacts) >= options.structure.many_contacts
        self.work, self.z, self.known = system.work, z, dict[int, Verdict]()

    def confirms(self, i: int) -> bool:
        """Whether the motion with further harmonics is found, and stable."""
        return self.at(i).stable == 1.0

    def at(self, i: int) -> Verdict:
        """Of the motion with further harmonics."""
        if i not in self.known:
            self.work.poll()
            self.known[i] = self.multipliers.confirmation(self.z[i], self.options.confirmation.max_addition)
        return self.known[i]

    def between(self, a: int, b: int, found: Mask) -> None:
        """Fill found after a point up to another."""
        if b - a == 1:
            found[b] = self.confirms(b)
            return
        middle = (a + b) // 2
        if growth_is_linear(self.at(a), self.at(middle), self.at(b), self.many, self.options):
            found[a + 1 : b + 1] = self.confirms(middle)
        else:
            self.between(a, middle, found)
            self.between(middle, b, found)
