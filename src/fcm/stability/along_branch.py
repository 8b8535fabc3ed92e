"""Classifications along a path: of points, by their numbers, and of places between these.

A place between is the number of the point that it follows, and the part of the way to the next.
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
EITHER = (0.0, 1.0)  # what the finer motion says is enough, stable or not


class PathClassification:
    """Classifications of the points of a path, of places between them, and how many were computed.

    without_neighbour (point,): beside which no solution with more harmonics is near. to_confirm (point,): of
    which it is enough that the finer motion says that they are stable. rotation (point,) [rad]: by how much
    multipliers that are not small have turned up to each point, about.
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
        self._places: list[float] = []  # with a classification, in order
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

        It is asked for only where a window may be hidden.
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
        """Classify several points and keep the results; `sufficient` as of `Multipliers.classify`."""
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
        """The classification of a solution, not kept; `sufficient` as of `Multipliers.classify`."""
        self.evaluations += 1
        return self.multipliers.classify(z, sufficient=sufficient)

    def confirmed(self, i: int, stable: float) -> bool:
        """Whether a point is as stable as told (1 or 0) with the further harmonics balanced, too."""
        known = self._classified.get(i)
        if known is not None and known.rebalanced:
            return known.stable == stable
        self.evaluations += 1
        return self.multipliers.confirms(self.path.z[i], stable)

    def unconfirmed(self, stable: FloatArray, first: int, last: int) -> list[int]:
        """The points from first to last that alone are told, between two that are not, and not confirmed."""
        told = ~np.isnan(stable[first : last + 1])
        lone = first + 1 + (told[1:-1] & ~told[:-2] & ~told[2:]).nonzero()[0]
        return [i for i in lone.tolist() if not self.confirmed(i, stable[i])]

    def places_between(self, first: int, last: int) -> list[float]:
        """The places from one point to another of which there is a classification, in order."""
        return self._places[bisect_left(self._places, first) : bisect_right(self._places, last)]

    def same_on_both_sides(self, a: float) -> bool:
        """Whether the known classifications nearest to the place a, before and after, are the same."""
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
        """The `sufficient` of `Multipliers.classify` for finding where growth changes sign between places.

        EITHER, if the finer motion alone says the same of these as their classifications.
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
        """Angle [rad] by which multipliers at a place have to turn until two of them meet."""
        if t not in self._meeting_angles:
            self._meeting_angles[t] = meeting_angle(self._classified[t], self.options)
        return self._meeting_angles[t]

    def rotation_between(self, a: float, b: float) -> float:
        """Angle [rad] by which multipliers turn, about, between points around two places."""
        return float(self.rotation[math.ceil(b)] - self.rotation[int(a)])

    def curve(self, k: int) -> Segment:
        """The segment of the curve from a point to the next."""
        return Segment(self._system.reset_balance(), self.path, k)

    def find(self, length: float, sufficient: Sequence[float] = ()) -> float | None:
        """The place at a length, if it is found between two points; it has a classification then."""
        k = int(np.searchsorted(self.length, length)) - 1
        t = k + float((length - self.length[k]) / (self.length[k + 1] - self.length[k]))
        curve = self.curve(k)
        if not k < t < k + 1 or not curve.find(t - k):
            return None
        classified = self._keep(t, self.classify(curve.z, sufficient))
        self.between[t] = InsertedPoint(t, curve.z, curve.direction, curve.orientation, classified.stable)
        return t


def _rotation(system: System, path: Path, options: StabilityOptions = STABILITY) -> FloatArray:
    """The rotation of `PathClassification`; 0 where there are so many multipliers that two are always about
    to meet."""
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
