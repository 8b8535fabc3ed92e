"""Confirm stable solutions of unknown or large error by balancing further harmonics.

The multipliers that classify a solution as stable err by what its harmonics leave out. If the embedded pair
does not estimate this error, or it is large, the further harmonics are balanced, too, at the same frequency.
The solution is confirmed if that motion is near and stable, and harmonics beyond those hardly change it.

If the error is known and large, that motion is too far for Newton's method from the solution. The corrector
then starts from the motion with more harmonics at that frequency, by which the error was estimated. Otherwise
it follows the curve of such motions, from the one at a neighbouring solution.
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

    stable (point,): whether a stable motion with further harmonics is near. limited: whether the evaluations
    allowed with many contacts did not suffice.
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
        Points to be confirmed.
    far : (point,) bool, optional
        Points, to be confirmed or not, at whose frequency the same branch has a motion with more harmonics.
        If Newton's method does not find it from the solution, it is sought along the branch from neighbours.
    options : StabilityOptions, optional
        In a run of points, the confirmed nodes are `ConfirmationOptions.point_interval` apart, or with many
        contacts only its ends. The middle between two nodes is confirmed next, until all three agree and
        their growths lie on a line; the points between them then take that result. No point is confirmed if
        a contact has a law of its own.
    motions : KnownMotions, optional
        Motions of the same branch with more harmonics, from which the far points are sought first.
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
        self.known = dict[int, tuple[Classification, FloatArray | None]]()  # with the classified motions
        self.evaluations_left = options.confirmation.max_fraction_of_many * len(z) if self.many else math.inf
        self.limited = False  # whether more were needed

    def nodes(self, first: int, last: int) -> list[int]:
        """The points from first to last that are confirmed first: with many contacts only the ends.

        An evaluation of many contacts takes long, and the middle shows whether more are needed.
        """
        if self.many:
            return sorted({first, last})
        return self.spaced.nodes(first, last, self.options.confirmation.point_interval)

    def confirms(self, i: int) -> bool:
        """Whether the motion with further harmonics is found, and stable."""
        return self.at(i).stable == 1.0

    def is_far(self, i: int) -> bool:
        """Whether no conclusive motion with further harmonics is found from a point."""
        return math.isnan(self.at(i).growth)

    def at(self, i: int) -> Classification:
        """The classification of the motion with further harmonics; UNKNOWN if no evaluations are left."""
        if i not in self.known:
            if not self._may_look():
                return UNKNOWN
            self.known[i] = self._classify(i), self.multipliers.refined_solution
        return self.known[i][0]

    def _classify(self, i: int) -> Classification:
        """Classify the motion with further harmonics at a point.

        Newton's method starts from the motion known at its frequency, or else from the point itself.
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
        """Whether another evaluation is left; if so, count it as used."""
        self.limited |= self.evaluations_left < 1.0
        if self.limited:
            return False
        self.evaluations_left -= 1.0
        self._poll()
        return True

    def _poll(self) -> None:
        """Poll for an interruption if there are many contacts, whose evaluations take long.

        With few contacts other curves share the workspace, and might change it during the poll.
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
        """Fill found (point,) towards the last point, by following the motion that confirms the point near.

        If near is not confirmed, points farther away from last are tried. The motion is followed only up to
        where the frequency turns back. A step is halved until the motion is found, and then doubled.
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
        """The point near and others at growing distances from it, up to where the frequency turns back."""
        if not 0 <= near < len(self.z):
            return []
        steps = (0, *(2**k for k in range(self.options.confirmation.point_interval.bit_length())))
        most = abs(self._before_turn(near, 0 if way < 0 else len(self.z) - 1) - near)
        return [near + way * step for step in steps if step <= most]

    def _before_turn(self, at: int, last: int) -> int:
        """The last point, or the point on the way to it at which the frequency turns back."""
        way = 1 if last >= at else -1
        change = np.sign(np.diff(self.z[at : last + way if last + way >= 0 else None : way, -1]))
        turns = np.flatnonzero(change != change[0]) if change.size else change
        return at + way * int(turns[0]) if turns.size else last
