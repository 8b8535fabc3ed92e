"""Classifications of the points of a path, and of places between them.

A place is a float: the number of the point before it, plus the fraction of the way to the next point.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right, insort
from collections.abc import Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fcm.continuation import Mark, Path, Segment
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.bifurcation_functions import MultiplierSample, multiplier_sample
from fcm.stability.classification import Classification, meeting_angle
from fcm.stability.floquet import multipliers_of
from fcm.stability.inserted_points import InsertedPoint
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.quasi_static_modes import quasi_static_modes
from fcm.stability.spaced_points import path_lengths

Mask = npt.NDArray[np.bool_]
EITHER = (0.0, 1.0)  # the finer motion alone is enough, whether it is stable or not


class PathClassification:
    """Classifications of points of a path and of places between them, and the number of evaluations.

    without_neighbour (point,) marks points that have no solution with more harmonics near them. to_confirm
    (point,) marks points that the finer motion alone may classify as stable. rotation (point,) [rad] is the
    approximate angle by which multipliers that are not small have turned up to each point.
    """

    def __init__(
        self,
        system: System,
        path: Path,
        without_neighbour: Mask | None = None,
        options: StabilityOptions = STABILITY,
        to_confirm: Mask | None = None,
    ) -> None:
        self.path, self.evaluations, self.options = path, 0, options
        self.without_neighbour = (
            np.zeros(len(path.z), dtype=np.bool_) if without_neighbour is None else without_neighbour
        )
        self.to_confirm = np.zeros(len(path.z), dtype=np.bool_) if to_confirm is None else to_confirm
        self._classified: dict[float, Classification] = {}
        self.between: dict[float, InsertedPoint] = {}
        self._places: list[float] = []  # those with a classification, in order
        self.multipliers = multipliers_of(system, float(path.parameter.max(initial=0.0)), self.options)
        self.fold = (path.mark & Mark.FOLD) != 0
        self.rotation = _rotation(system, path, self.options)
        self._system, self._multiplier_sample, self._meeting_angles = (
            system,
            dict[float, MultiplierSample](),
            dict[float, float](),
        )

    @cached_property
    def length(self) -> FloatArray:
        """Length along the path up to each point (point,).

        It is computed only if a window may be hidden.
        """
        return path_lengths(self.path.z)

    def __getitem__(self, t: float) -> Classification:
        return self._classified[t]

    def at(self, i: int) -> Classification:
        """The classification of a point, computed once."""
        if i not in self._classified:
            self.classify_points((i,))
        return self._classified[i]

    def classify_points(self, points: Sequence[int], sufficient: Sequence[float] = ()) -> None:
        """Classify several points and keep the results; `sufficient` as in `Multipliers.classify`."""
        new = [i for i in points if i not in self._classified]
        to_confirm = [i for i in new if self.to_confirm[i]]
        for some, accepted in (
            ([i for i in new if not self.to_confirm[i]], sufficient),
            (to_confirm, (*sufficient, 1.0)),
        ):
            if not some:
                continue
            self.evaluations += len(some)
            z, fold = [self.path.z[i] for i in some], self.fold[some].tolist()
            found = self.multipliers.classify_all(z, fold, self.without_neighbour[some].tolist(), accepted)
            for i, classified in zip(some, found, strict=True):
                self._keep(i, classified)

    def _keep(self, t: float, classified: Classification) -> Classification:
        if t not in self._classified:
            insort(self._places, t)
        self._classified[t] = classified
        return classified

    def classify(self, z: FloatArray, sufficient: Sequence[float] = ()) -> Classification:
        """Classify a solution without keeping the result; `sufficient` as in `Multipliers.classify`."""
        self.evaluations += 1
        return self.multipliers.classify(z, sufficient=sufficient)

    def confirmed(self, i: int, stable: float) -> bool:
        """Whether a point keeps the given stability (1 or 0) when the further harmonics are balanced, too."""
        known = self._classified.get(i)
        if known is not None and known.rebalanced:
            return known.stable == stable
        self.evaluations += 1
        return self.multipliers.confirms(self.path.z[i], stable)

    def unconfirmed(self, stable: FloatArray, first: int, last: int) -> list[int]:
        """The unconfirmed points between first and last that are known and have two unknown neighbours."""
        told = ~np.isnan(stable[first : last + 1])
        lone = first + 1 + (told[1:-1] & ~told[:-2] & ~told[2:]).nonzero()[0]
        return [i for i in lone.tolist() if not self.confirmed(i, stable[i])]

    def places_between(self, first: int, last: int) -> list[float]:
        """The places from one point to another that have a classification, in order."""
        return self._places[bisect_left(self._places, first) : bisect_right(self._places, last)]

    def same_on_both_sides(self, a: float) -> bool:
        """Whether the nearest known classifications before and after the place a are the same."""
        k = bisect_left(self._places, a)
        before = next((t for t in reversed(self._places[: k + 1]) if self._is_known(t)), None)
        after = next((t for t in self._places[k + 1 :] if self._is_known(t)), None)
        if before is None or after is None:
            return False
        return self._classified[before].stable == self._classified[after].stable

    def _is_known(self, t: float) -> bool:
        return not math.isnan(self._classified[t].stable)

    def grows(self, t: float) -> bool:
        """Whether a disturbance grows at a place with a classification."""
        return self._classified[t].growth > 0.0

    def sufficient_between(self, *places: float) -> Sequence[float]:
        """The `sufficient` of `Multipliers.classify` for locating a sign change of the growth between places.

        It is EITHER if the finer motion alone has the known sign of the growth at all of these, else empty.
        """
        for t in places:
            fine = self.classify(self._z(t), EITHER)
            if fine.rebalanced or (fine.growth > 0.0) != self.grows(t):
                return ()
        return EITHER

    def _z(self, t: float) -> FloatArray:
        return self.between[t].z if t in self.between else self.path.z[int(t)]

    def multiplier_sample(self, t: float) -> MultiplierSample:
        """The `MultiplierSample` of a place with a classification."""
        if t not in self._multiplier_sample:
            k, part = int(t), t - int(t)
            length = self.length[k] + (part * (self.length[k + 1] - self.length[k]) if part else 0.0)
            self._multiplier_sample[t] = multiplier_sample(float(length), self._classified[t], self.options)
        return self._multiplier_sample[t]

    def meeting_angle(self, t: float) -> float:
        """Least angle [rad] by which multipliers at a place have to turn until two of them meet."""
        if t not in self._meeting_angles:
            self._meeting_angles[t] = meeting_angle(self._classified[t], self.options)
        return self._meeting_angles[t]

    def rotation_between(self, a: float, b: float) -> float:
        """Approximate angle [rad] by which multipliers turn between the points that enclose two places."""
        return float(self.rotation[math.ceil(b)] - self.rotation[int(a)])

    def curve(self, k: int) -> Segment:
        """The segment of the curve from a point to the next."""
        return Segment(self._system.reset_balance(), self.path, k)

    def find(self, length: float, sufficient: Sequence[float] = ()) -> float | None:
        """Find and classify the place at a length; None if it is not found between two points."""
        k = int(np.searchsorted(self.length, length)) - 1
        t = k + float((length - self.length[k]) / (self.length[k + 1] - self.length[k]))
        curve = self.curve(k)
        if not k < t < k + 1 or not curve.find(t - k):
            return None
        classified = self._keep(t, self.classify(curve.z, sufficient))
        self.between[t] = InsertedPoint(t, curve.z, curve.direction, curve.orientation, classified.stable)
        return t


def _rotation(system: System, path: Path, options: StabilityOptions = STABILITY) -> FloatArray:
    """The rotation of `PathClassification`: the phase of the fastest mode that is not damped out.

    It is 0 if there are so many multipliers that two are always about to meet.
    """
    linear, omega = system.linear, path.parameter
    near = ~quasi_static_modes(
        linear.natural,
        float(omega.max(initial=0.0)),
        [int(h) for h in system.harmonics],
        system.scene.planar,
        options,
    )
    lasting = (
        np.exp(-2.0 * np.pi * linear.damping * linear.natural / omega.min(initial=np.inf))
        > options.classification.small_multiplier
    )
    few = 2 * near.sum() + len(system.scene.contacts) <= options.windows.max_multipliers
    fastest = float(linear.natural[lasting & near].max(initial=0.0)) if few else 0.0
    angle = 2.0 * np.pi * fastest / omega
    return np.concatenate(([0.0], np.cumsum(np.abs(angle[1:] - angle[:-1]))))
