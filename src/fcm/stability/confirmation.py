"""Whether motions that nothing else vouches for are stable with further harmonics balanced, too.

A solution is called stable by the multipliers of a motion that errs by what its harmonics leave out. Where
the pair of the curve does not tell how much that is, or it is much, the motion with further harmonics is
balanced itself, at the same frequency. If that is near, stable, and hardly another by the harmonics beyond
those, the solution is what it is taken for.

Where the error is known and great, the motion with further harmonics is far, and no Newton method leads there
from the solution. But what told the error does, a motion with more harmonics at that frequency; or the curve
of these motions, from beside the solutions next to it.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.harmonic_balance.consecutive_points import runs
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.classification import UNKNOWN, Classification, growth_is_linear
from fcm.stability.floquet import multipliers_of
from fcm.stability.known_motions import KnownMotions
from fcm.stability.multipliers import Multipliers
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.spaced_points import SpacedPoints

Mask = npt.NDArray[np.bool_]


class Confirmation(Frozen):
    """Points that are confirmed as stable with further harmonics.

    stable (point,): whether there is a stable motion with further harmonics near it. limited: whether there
    would have been more to look at than the most points of many contacts.
    """

    stable: Mask
    limited: bool = False


def confirmed_stable(
    system: System,
    z: FloatArray,
    to_confirm: Mask,
    far: Mask | None = None,
    options: StabilityOptions = STABILITY,
    motions: KnownMotions | None = None,
) -> Confirmation:
    """Whether the points to_confirm (point,) have a stable motion with further harmonics near them.

    Parameters
    ----------
    system : System
    z : (point, unknown + 1)
        Points of a curve of its balance, in order, found stable.
    to_confirm : (point,) bool
        Those to be confirmed.
    far : (point,) bool, optional
        Those, to be confirmed or not, at whose frequency the same branch has a motion with more harmonics.
        Where none is found from the solution, it is sought along the branch from the points beside them.
    options : StabilityOptions, optional
        Of a row of points some are confirmed, `ConfirmationOptions.point_interval` apart, or of many contacts
        its ends. Between two of these the middle follows, until all three agree and their growths lie on a
        line; then so do the points between them. None is confirmed where a contact has a law of its own.
    motions : KnownMotions, optional
        Of the same branch with more harmonics, from which those of the far points are sought first.
    """
    found = np.zeros(len(z), dtype=np.bool_)
    far = np.zeros_like(to_confirm) if far is None else far
    if system.own_laws or not (to_confirm | far).any():
        return Confirmation(found)
    points = ConfirmedPoints(system, z, options, far, motions)
    for first, end in runs(to_confirm):
        nodes = points.nodes(first, end - 1)
        found[nodes[0]] = points.confirms(nodes[0])
        for a, b in itertools.pairwise(nodes):
            points.between(a, b, found)
    for first, end in runs(far & ~found):
        if points.is_far(first):
            points.along(first - 1, end - 1, found)
        if points.is_far(end - 1):
            points.along(end, first, found)
    return Confirmation(found, points.limited)


class ConfirmedPoints:
    """Confirmations of points, each computed once."""

    def __init__(
        self,
        system: System,
        z: FloatArray,
        options: StabilityOptions,
        far: Mask | None = None,
        motions: KnownMotions | None = None,
    ) -> None:
        found = multipliers_of(system, float(z[:, -1].max()), options)
        assert isinstance(found, Multipliers)
        self.multipliers, self.options = found, options
        self.many = len(system.scene.contacts) >= options.structure.many_contacts
        self.system, self.work, self.z, self.motions = system, system.work, z, motions
        self.spaced = SpacedPoints(z, self.many)
        self.far = np.zeros(len(z), dtype=np.bool_) if far is None else far
        self.known = dict[int, tuple[Classification, FloatArray | None]]()  # classifications, and of what
        self.evaluations_left = options.confirmation.max_fraction_of_many * len(z) if self.many else math.inf
        self.limited = False  # whether more were asked for

    def nodes(self, first: int, last: int) -> list[int]:
        """Points from one to another that are looked at first; of many contacts, as a look takes long, the
        ends alone, as what is between them tells whether there is need of more."""
        if self.many:
            return sorted({first, last})
        return self.spaced.nodes(first, last, self.options.confirmation.point_interval)

    def confirms(self, i: int) -> bool:
        """Whether the motion with further harmonics is found, and stable."""
        return self.at(i).stable == 1.0

    def is_far(self, i: int) -> bool:
        """Whether no motion with further harmonics that tells is found from a point."""
        return math.isnan(self.at(i).growth)

    def at(self, i: int) -> Classification:
        """The classification of the motion with further harmonics; unknown where there are no evaluations
        left."""
        if i not in self.known:
            if not self._may_look():
                return UNKNOWN
            self.known[i] = self._classify(i), self.multipliers.refined_solution
        return self.known[i][0]

    def _classify(self, i: int) -> Classification:
        """The classification of a point with further harmonics.

        It is that of the motion to which the one known at its frequency leads, or else the point itself.
        """
        z = self.z[i]
        motion = (
            self.motions.interpolate(self.system, z) if self.motions is not None and self.far[i] else None
        )
        if self.motions is not None and motion is not None:
            found = self.multipliers.continued(z, motion, self.motions.harmonics)
            if self.multipliers.refined_solution is not None:
                return found
        return self.multipliers.confirmation(z)

    def _may_look(self) -> bool:
        """Whether another evaluation is left; if so it is taken."""
        self.limited |= self.evaluations_left < 1.0
        if self.limited:
            return False
        self.evaluations_left -= 1.0
        self._poll()
        return True

    def _poll(self) -> None:
        """Poll for an interruption, with many contacts: a look takes long.

        Multipliers of few may be those of another curve then.
        """
        if self.many:
            self.work.poll()

    def between(self, a: int, b: int, found: Mask) -> None:
        """Fill found (point,) after point a up to point b."""
        if b - a == 1:
            found[b] = self.confirms(b)
            return
        middle = self.spaced.middle(a, b)
        if growth_is_linear(self.at(a), self.at(middle), self.at(b), self.many, self.options):
            found[a + 1 : b + 1] = self.confirms(middle)
        else:
            self.between(a, middle, found)
            self.between(middle, b, found)

    def along(self, near: int, last: int, found: Mask) -> None:
        """Fill found (point,) up to the last point, as far as a motion leads that confirms the one near.

        If that does not, the next point away from there is tried.

        The frequency changes one way from there to the last point. The way to the next is shortened until the
        motion is found, and lengthened then.
        """
        options, way = self.options.confirmation, 1 if last >= near else -1
        at = next((i for i in self._away(near, -way) if self.confirms(i)), None)
        if at is None:
            return
        last, motion = self._before_turn(at, last), self.known[at][1]
        step = options.point_interval
        while motion is not None and (last - at) * way > 0 and self._may_look():
            ahead = at + way * min(step, abs(last - at))
            if self.multipliers.continued(self.z[ahead], motion).stable == 1.0:
                found[min(at + way, ahead) : max(at + way, ahead) + 1] = True
                at, motion, step = ahead, self.multipliers.refined_solution, 2 * step
            elif abs(ahead - at) == 1:
                return
            else:
                step = max(abs(ahead - at) // 2, 1)

    def _away(self, near: int, way: int) -> list[int]:
        """Points from one on, each farther than the one before, up to where the frequency turns back."""
        if not 0 <= near < len(self.z):
            return []
        steps = (0, *(2**k for k in range(self.options.confirmation.point_interval.bit_length())))
        most = abs(self._before_turn(near, 0 if way < 0 else len(self.z) - 1) - near)
        return [near + way * step for step in steps if step <= most]

    def _before_turn(self, at: int, last: int) -> int:
        """The last point, or the one before that at which the frequency turns back on the way to it."""
        way = 1 if last >= at else -1
        change = np.sign(np.diff(self.z[at : last + way if last + way >= 0 else None : way, -1]))
        turns = np.flatnonzero(change != change[0]) if change.size else change
        return at + way * int(turns[0]) if turns.size else last
