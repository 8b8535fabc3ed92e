"""Stability along a curve: it changes at folds, and where a flip or a pair crosses the unit circle.

Between two folds the number of real multipliers above +1 keeps its parity, which the sign of the balance's
determinant gives. Where it is odd, the motion is unstable, and nothing is computed. Where it is even, the
other multipliers decide. They are computed at enough points to see that the growth keeps its sign. Where a
change of stability may hide between neighbours, places between them are classified, too (`windows`).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path
from fcm.continuation.events import SignChange
from fcm.frozen import Frozen
from fcm.harmonic_balance.consecutive_points import runs
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.along_branch import PathClassification
from fcm.stability.bifurcation_functions import predicted_minimum
from fcm.stability.classification import Bifurcation, flip_function, growth_is_linear
from fcm.stability.inserted_points import InsertedPoint, MultiplierCrossing, with_points
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.spaced_points import SpacedPoints

IntArray = npt.NDArray[np.intp]

__all__ = ["Bifurcation", "InsertedPoint", "MultiplierCrossing", "Stability", "stability", "with_points"]


class Stability(Frozen):
    """Stability of the points of a path, and where it changes.

    stable (point,): 1 where small disturbances die out, 0 where one grows, nan where it is unknown.
    """

    stable: FloatArray
    crossings: tuple[MultiplierCrossing, ...]
    evaluations: int  # of multipliers
    inside: tuple[InsertedPoint, ...] = ()  # of windows between two points

    @property
    def inserted(self) -> list[InsertedPoint]:
        """Points to be added to the path, in order."""
        return sorted((*self.crossings, *self.inside), key=lambda one: one.place)


def stability(
    system: System,
    path: Path,
    beyond: npt.NDArray[np.bool_] | None = None,
    options: StabilityOptions = STABILITY,
    without_neighbour: npt.NDArray[np.bool_] | None = None,
    to_confirm: npt.NDArray[np.bool_] | None = None,
) -> Stability:
    """Stability of the points of a path followed in the frequency, and where it changes between folds.

    A fold counts to the stable side, a crossing to neither. A point is nan if the balanced harmonics and the
    finer motion, which has the next harmonics that their forces make, disagree.

    beyond (point,) marks points too far from the motion: nan where the determinant allows stability.
    without_neighbour (point,) marks points that have no solution with more harmonics near them; a doubtful
    classification there stays unknown. to_confirm (point,) marks points that further balanced harmonics must
    confirm as stable later (see `fcm.stability.confirmation`); here the finer motion alone is enough.
    """
    none = np.zeros(path.z.shape[0], dtype=np.bool_)
    known = PathClassification(
        system, path, none if without_neighbour is None else without_neighbour, options, to_confirm
    )
    search = _BifurcationSearch(system, path, options, known)
    return search.run(none if beyond is None else beyond)


class _BifurcationSearch:
    def __init__(
        self, system: System, path: Path, options: StabilityOptions, classified: PathClassification
    ) -> None:
        self.path, self.options, self.classified = path, options, classified
        self.many = len(system.scene.contacts) >= self.options.structure.many_contacts
        self.spaced = SpacedPoints(path.z, self.many)
        self.step_span = (
            options.sampling.interval_many_contacts
            if self.many
            else options.sampling.interval_several_harmonics
        )
        if len(system.harmonics) == 1:
            self.step_span = options.sampling.interval_one_harmonic

    def run(self, beyond: npt.NDArray[np.bool_]) -> Stability:
        even = self._is_even()
        stable = np.where(even & beyond, np.nan, 0.0)
        crossings: list[MultiplierCrossing] = []
        for first, end in runs(even & ~beyond):
            last = end - 1
            self._judge(first, last)
            if not self.many:
                self._search_windows(first, last)
            places = self.classified.places_between(first, last)
            at = np.array([int(t) for t in places if t == int(t)])
            known = np.array([self.classified[i].stable for i in at.tolist()])
            # a point that was not classified takes the result of the nearest that was: its neighbours agree
            stable[first : last + 1] = known[_nearest_index(at, first, last)]
            stable[self.classified.unconfirmed(stable, first, last)] = math.nan
            found = list(self._crossings(places))
            for one in found:
                for way in (range(one.after, first - 1, -1), range(one.after + 1, end)):
                    stable[list(self._confirmed_after(stable, way))] = math.nan
            crossings += found
        return Stability(
            stable, tuple(crossings), self.classified.evaluations, tuple(self._inserted_points(stable))
        )

    def _is_even(self) -> npt.NDArray[np.bool_]:
        """Whether the number of real multipliers above 1 is even; folds count as even."""
        even: npt.NDArray[np.bool_] = (self.path.parity > 0.0) | self.classified.fold
        return even

    def _judge(self, first: int, last: int) -> None:
        """Classify enough points of a run to see whether stability changes in it."""
        angle = self.classified.rotation[first : last + 1]
        passed = np.floor((angle - angle[0]) / self.options.sampling.max_phase)
        some = self.spaced.nodes(first, last, self.step_span)
        nodes = {*some, *(first + 1 + (passed[1:] != passed[:-1]).nonzero()[0]).tolist()}
        if self.many:  # at a fold no doubt is reported: its neighbour is classified, too
            neighbours = (i + way for i, way in ((first, 1), (last, -1)) if self.classified.fold[i])
            nodes |= {i for i in neighbours if first < i < last}
        self.classified.classify_points(sorted(nodes))
        self._refine_between(list(itertools.pairwise(sorted(nodes))))

    def _search_windows(self, first: int, last: int) -> None:
        """Search each interval between classified places of a run for a hidden window."""
        places = self.classified.places_between(first, last)
        for k, (a, b) in enumerate(itertools.pairwise(places)):
            self._bisect(places[max(k - 1, 0) : k], (a, b), places[k + 2 : k + 3], 0)

    def _bisect(
        self, before: list[float], ends: tuple[float, float], after: list[float], divided: int
    ) -> None:
        """Divide the interval between two places as long as a window may be hidden in it."""
        t = (
            self._uncertain_place(before, ends, after, divided)
            if divided < self.options.windows.max_divisions
            else None
        )
        if t is None or not ends[0] < t < ends[1]:
            return
        one, found, other = (self.classified[place].stable for place in (ends[0], t, ends[1]))
        if found in (one, other) or math.isnan(found):
            self._bisect(before, (ends[0], t), [ends[1]], divided + 1)
            self._bisect([ends[0]], (t, ends[1]), after, divided + 1)
            return
        self.classified.classify_points(sorted({int(t), math.ceil(t)}))
        self._refine_between([(math.ceil(ends[0]), int(t)), (math.ceil(t), int(ends[1]))])

    def _uncertain_place(
        self, before: list[float], ends: tuple[float, float], after: list[float], divided: int
    ) -> float | None:
        """Find and classify a place between two at which stability may differ; None if there is none."""
        one, other = self.classified[ends[0]], self.classified[ends[1]]
        if (
            one.is_linear
            or other.is_linear
            or max(one.growth, other.growth) < self.options.sampling.sufficient_decay
        ):
            return None
        if max(len(one.values), len(other.values)) > self.options.windows.max_multipliers:
            return None
        if math.isnan(one.stable) != math.isnan(other.stable):
            return self._window_edge(*ends)
        if one.stable != other.stable or (one.stable == 1.0 and not self._may_meet(*ends)):
            return None
        classified, seen = self.classified, self.classified.multiplier_sample
        alike = [t for t in (*before, *ends, *after) if classified[t].stable == one.stable]
        low, high = (seen(t) for t in ends)
        length = predicted_minimum(
            low, high, [seen(t) for t in alike if not classified[t].is_linear], divided, self.options
        )
        # no window if the finer motion classifies it like the ends, whatever the balanced harmonics say
        return None if length is None else self.classified.find(length, sufficient=(one.stable,))

    def _window_edge(self, a: float, b: float) -> float | None:
        """Find and classify the middle between a known and an unknown place, a possible edge of a window.

        None if there is no reason to look there, or it is not found.
        """
        classified = self.classified
        apart = self.options.windows.edge_distance < b - a <= 1.0
        if classified.grows(a) == classified.grows(b) or not apart or not classified.same_on_both_sides(a):
            return None
        return classified.find(
            0.5 * (classified.multiplier_sample(a).length + classified.multiplier_sample(b).length)
        )

    def _may_meet(self, a: float, b: float) -> bool:
        """Whether two multipliers may meet between two stable places."""
        nearest = self.classified.meeting_angle(a) + self.classified.meeting_angle(b)
        return (
            nearest
            < self.options.windows.angle_factor * self.classified.rotation_between(a, b)
            + self.options.windows.angle_margin
        )

    def _inserted_points(self, stable: FloatArray) -> Iterator[InsertedPoint]:
        """Yield places whose known stability differs from that of both neighbouring points."""
        for t, one in self.classified.between.items():
            before, after = stable[int(t) : int(t) + 2].tolist()
            if before == after != one.stable and not math.isnan(one.stable):
                yield one

    def _refine_between(self, ways: list[tuple[int, int]]) -> None:
        """Bisect between classified points until no change of stability or of the growth's sign can hide.

        With many contacts, the finer motion alone is enough between two stable points if it is stable, too:
        both ends are confirmed, and it shows whether anything has changed between them.
        """
        seen = self.classified
        while ways:
            wide = [(a, self.spaced.middle(a, b), b) for a, b in ways if b - a > 1 and self._may_differ(a, b)]
            alike = {middle for a, middle, b in wide if self.many and seen[a].stable == seen[b].stable == 1.0}
            seen.classify_points(sorted(alike), (1.0,))
            seen.classify_points([middle for _, middle, _ in wide])
            bent = (
                (a, middle, b)
                for a, middle, b in wide
                if not growth_is_linear(seen[a], seen[middle], seen[b], self.many, self.options)
            )
            ways = [half for a, middle, b in bent for half in ((a, middle), (middle, b))]

    def _may_differ(self, a: int, b: int) -> bool:
        """Whether a point between two classified ones may differ from both.

        With many contacts, all points between two unknown ones count as unknown.
        """
        one, other = self.classified[a], self.classified[b]
        if self.many and math.isnan(one.stable) and math.isnan(other.stable):
            return False
        return not (one.is_linear and other.is_linear)

    def _crossings(self, places: list[float]) -> Iterator[MultiplierCrossing]:
        """Yield the crossings between consecutive places of known stability.

        The growth has to change its sign once, within one step. Places of unknown stability between them
        count if their growth is known.
        """
        known = [t for t in places if not math.isnan(self.classified[t].growth)]
        if len({self.classified.grows(t) for t in known}) < 2:
            return
        told = [k for k, t in enumerate(known) if not math.isnan(self.classified[t].stable)]
        for first, last in itertools.pairwise(told):
            ways = itertools.pairwise(known[first : last + 1])
            changes = [(a, b) for a, b in ways if self.classified.grows(a) != self.classified.grows(b)]
            if len(changes) == 1 and math.ceil(changes[0][1]) == int(changes[0][0]) + 1:
                found = self._crossing(*changes[0])
                if found is not None:
                    yield found

    def _confirmed_after(self, stable: FloatArray, way: range) -> Iterator[int]:
        """Yield points after a crossing until further balanced harmonics, which may move it, confirm one."""
        for i in way:
            if stable[i] != stable[way[0]] or self.classified.confirmed(i, stable[i]):
                return
            yield i

    def _crossing(self, a: float, b: float) -> MultiplierCrossing | None:
        """Locate the crossing where the growth changes sign between two places; None if it is not found."""
        first, found, sufficient = int(a), None, self.classified.sufficient_between(a, b)
        curve = self.classified.curve(first)
        before, after = (
            max(self.classified[t].growth, self.options.sampling.sufficient_decay) for t in (a, b)
        )
        kind = self.classified[a if before > 0.0 else b].kind
        flips = tuple(flip_function(self.classified[t].values) for t in (a, b))
        by_flip = kind is Bifurcation.PERIOD_DOUBLING and flips[0] * before > 0.0 > flips[0] * flips[1]
        if by_flip:
            before, after = flips
        bracket = self.options.sampling.sign_change
        sides = SignChange(a - first, b - first, before, after, True, bracket)
        sampling = self.options.sampling
        fine = sampling.tolerance_many_contacts if self.many else sampling.tolerance
        narrow = fine if sufficient else max(fine, sampling.confirmed_tolerance)
        for _ in range(self.options.sampling.max_evaluations):
            at = sides.at
            if sides.width < narrow or (found is not None and sides.converged(fine)) or not curve.find(at):
                break
            classified = self.classified.classify(curve.z, sufficient)
            if math.isnan(classified.growth):
                break
            growth = max(classified.growth, self.options.sampling.sufficient_decay)
            now = flip_function(classified.values) if by_flip else growth
            kind = classified.kind if growth > 0.0 else kind
            found = MultiplierCrossing(first + at, curve.z, curve.direction, curve.orientation, kind=kind)
            if abs(growth) < self.options.sampling.growth_tolerance:
                break
            sides.update(at, now)
        return found


def _nearest_index(at: IntArray, first: int, last: int) -> IntArray:
    """Index of the element of at nearest to each number from first to last; at contains both ends."""
    return np.rint(np.interp(np.arange(first, last + 1), at, np.arange(at.size))).astype(np.intp)
