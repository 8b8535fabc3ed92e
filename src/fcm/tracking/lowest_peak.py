"""The least peak over a range of one number: follow the highest peaks, look where they are lowest, again.

What was followed is nowhere above the response. So where the response, traced at the lowest point of what was
followed, has nothing higher than that, this is the least of all; else the higher peak is followed, too.
Ordinary curves are traced only at such points, at both ends of the range, and in the middle of a part where
nothing was followed. If all is far above the least there, it is not sought in that part. A higher or a lower
peak may be one that cannot be followed, of a motion with many states. Then only ordinary curves tell, see
`by_trials`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TypeVar

import numpy as np

from fcm.at_rest import at_rest
from fcm.continuation.follow import Progress
from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.tracking.curve import SpecialPointCurve, both_ways
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.kept_steps import KeptSteps
from fcm.tracking.known_curves import passes
from fcm.tracking.nonsmooth_continuation import land
from fcm.tracking.options import SEARCH, SearchOptions
from fcm.tracking.parameter_line import ParameterLine
from fcm.tracking.peak_envelope import (
    INCOMPLETE,
    EnvelopeMinimum,
    MonotonePiece,
    PieceHeight,
    Target,
    envelope_minimum,
    pieces_of,
    uncovered_values,
)
from fcm.tracking.start_points import SpecialPoints, special_points
from fcm.tracking.tracked_point import TrackedPoint, TrackingSetup

T = TypeVar("T")
MIN_HEIGHT = PieceHeight(0.0, 0.0, np.zeros(0), -1)


class LowestPeak(Frozen):
    """The least peak of a search, or None, with the curves that were followed.

    checked: whether it is known to be least.
    """

    best: EnvelopeMinimum | None
    curves: tuple[SpecialPointCurve, ...]
    checked: bool
    harmonics: tuple[int, ...]


@dataclass
class LowestPeakSearch:
    """The search for the least peak of one scene and its targets, with the curves that are known."""

    system: System
    line: ParameterLine
    span: tuple[float, float]
    targets: Sequence[Target]
    options: SearchOptions = SEARCH
    steps: KeptSteps = field(default_factory=KeptSteps)
    curves: list[SpecialPointCurve] = field(default_factory=list)
    pieces: list[MonotonePiece] = field(default_factory=list)  # of these, that count for the targets
    visited_values: dict[float, PieceHeight] = field(
        default_factory=dict
    )  # the greatest of the responses that were traced
    known_points: dict[float, list[tuple[Condition, PieceHeight]]] = field(
        default_factory=dict
    )  # and all of them
    visited: set[float] = field(default_factory=set)  # where what was met was followed, too

    def __post_init__(self) -> None:
        step = self.system.scene.max_step
        self.setup = TrackingSetup(
            self.system, self.line, self.span, (), step, peaks_only=True, options=self.options.tracking
        )

    def conditions(self) -> list[Condition]:
        """Conditions of the special points that may be greatest: peaks, and ends of the range."""
        found = [Condition(Kind.PEAK, dof) for dof in sorted({target.dof for target in self.targets})]
        if any(target.ends for target in self.targets):
            found += [Condition(Kind.END, omega=w) for w in self.system.scene.frequency_range]
        return found

    def run(self, known: LowestPeak | None = None, progress: Progress | None = None) -> LowestPeak:
        """The least peak; from what was found with fewer harmonics, or else from both ends of the range."""
        checked = False
        if progress is not None:
            progress(0.0)
        if known is None:
            for value in self.span:
                self.visit(value)
        else:
            self.refine_curves(known)
        for count in range(self.options.max_visits):
            if progress is not None:
                progress(count / (count + 2.0))
            best = self.best()
            if best is None:
                break
            before = len(self.curves)
            fine = self.setup.options.envelope.value_tolerance * (self.span[1] - self.span[0])
            seen = [one.value for value, one in self.visited_values.items() if abs(value - best.s) <= fine]
            top = seen[0] if seen else self.visit(best.s)
            checked = top <= best.value * (1.0 + self.options.height_tolerance)
            if checked and (
                top >= best.value * (1.0 - self.options.height_tolerance) or len(self.curves) == before
            ):
                beyond = [s for s in self._beyond_end(best) if s not in self.visited]
                for value in beyond:
                    self.visit(value)
                if not beyond:
                    break  # else a higher one is there; or lower ones, where the followed one ends
                continue
            if seen:
                break  # a higher one that could not be followed
        checked = checked and not self._unknown(best) and not self._lower(best)
        return LowestPeak(best, tuple(self.curves), checked, self.system.harmonics)

    def best(self) -> EnvelopeMinimum | None:
        """The least value of the envelope, after following curves wherever none was followed."""
        while True:
            best = envelope_minimum(self.setup, self.pieces)
            new = [s for s in (*self._unknown(best), *self._lower(best)) if s not in self.visited]
            if not new or len(self.visited_values) >= self.options.max_visits:
                return best
            for value in new:
                self.visit(value)

    def _unknown(self, best: EnvelopeMinimum | None) -> list[float]:
        """Values about which nothing is followed, but for those where all is far above the least."""
        return [
            s for s in uncovered_values(self.setup, self.pieces) if best is None or self._is_near(s, best)
        ]

    def _is_near(self, s: float, best: EnvelopeMinimum) -> bool:
        if (
            s not in self.visited_values
            and s not in self.span
            and len(self.visited_values) < self.options.max_visits
        ):
            self.greatest_at(s)
        return (
            s not in self.visited_values
            or 0.0 < self.options.high_fraction * self.visited_values[s].value <= best.value
        )

    def _lower(self, best: EnvelopeMinimum | None) -> list[float]:
        """Values at which the response was traced and is lower than the least of what was followed."""
        below = 0.0 if best is None else best.value * (1.0 - self.options.height_tolerance)
        return [s for s, top in self.visited_values.items() if 0.0 < top.value < below]

    def _beyond_end(self, best: EnvelopeMinimum | None) -> list[float]:
        """Values next to a least that is at the end of what was followed, where that may have been lost."""
        if best is None or best.kind != "corner":
            return []
        near = self.setup.options.envelope.bracket * (self.span[1] - self.span[0])
        ends = (end for piece in self.pieces for end in ((piece.s[0], -near), (piece.s[-1], near)))
        beyond = (float(end + step) for end, step in ends if abs(end - best.s) < near)
        return [s for s in beyond if self.span[0] < s < self.span[1]]

    def least_traced(self) -> tuple[FloatArray, EnvelopeMinimum] | None:
        """The least peak of the responses traced until now, and its number; None where none has a peak."""
        peaks = {s: top for s, top in self.visited_values.items() if top.value > 0.0}
        if not peaks:
            return None
        s = min(peaks, key=lambda value: peaks[value].value)
        return self.line.values(s), EnvelopeMinimum(s, peaks[s].value, (peaks[s],), INCOMPLETE)

    @property
    def responses(self) -> int:
        """Number of responses traced until now."""
        return len(self.visited_values)

    def visit(self, value: float) -> float:
        """Trace the response at a value, and follow what is high and not known; returns its greatest
        height."""
        self.visited.add(value)
        found = self.greatest_at(value)
        top = self.visited_values[value].value
        for condition, height in found:
            point = (
                land(self.setup, condition, height.z)
                if height.value >= self.options.high_fraction * top
                else None
            )
            if point is not None:
                self.follow(condition, point)
        return top

    def greatest_at(self, value: float) -> list[tuple[Condition, PieceHeight]]:
        """Special points of the response at a value that may be greatest, with their heights."""
        if value not in self.known_points:
            here = self.system.with_scene(self.line.scene(self.system.scene, value))
            points = self._step(
                f"points at {value!r}",
                SpecialPoints,
                partial(special_points, here, self.conditions(), self.setup.options),
            ).points
            self.known_points[value] = found = [
                (one, self.height(one, np.append(z, value))) for one, z in points
            ]
            self.visited_values[value] = max(
                (height for _, height in found), key=lambda one: one.value, default=MIN_HEIGHT
            )
        return self.known_points[value]

    def follow(self, condition: Condition, point: TrackedPoint) -> None:
        """The curve through a point, if it is not known."""
        if not any(passes(curve, condition, point, self.setup) for curve in self.curves):
            key = f"curve of {condition} through {point.z.tolist()}"
            curve = self._step(key, SpecialPointCurve, partial(both_ways, self.setup, condition, point))
            self.curves.append(curve)
            for target in self.targets:
                self.pieces += pieces_of(self.setup, [curve], target)

    def _step(self, key: str, kind: type[T], step: Callable[[], T]) -> T:
        return self.steps(f"{self.system.harmonics} {self.span} {key}", kind, step)

    def height(self, condition: Condition, z: FloatArray) -> PieceHeight:
        """Height of the greatest target at a point; 0 where it is none of them."""
        problem = self.setup.tracked(condition)
        problem.evaluate_scale(z)
        amplitude = problem.along(z)[1]
        amplitude = np.where(at_rest(amplitude), 0.0, amplitude)
        heights = [
            PieceHeight(float(amplitude[t.dof]), 0.0, z, t.dof)
            for t in self.targets
            if condition.which == t.dof or (condition.kind is Kind.END and t.ends)
        ]
        return max(heights, key=lambda one: one.value, default=MIN_HEIGHT)

    def refine_curves(self, known: LowestPeak) -> None:
        """Follow curves found with fewer harmonics from both their ends and their middle."""
        for curve in known.curves:
            for i in sorted({0, len(curve.points) // 2, len(curve.points) - 1}):
                z = self.system.extended(curve.points[i].z, known.harmonics)
                point = land(self.setup, curve.condition, z) if curve.greatest[i] else None
                if point is not None:
                    self.follow(curve.condition, point)
