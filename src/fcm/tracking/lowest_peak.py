"""Search for the least peak over a range of one number, on the envelope of the highest followed peaks.

The envelope of followed peaks is nowhere above the response. So its lowest point is the least peak if the
response traced there has no higher peak; else that peak is followed as well. Response curves are traced only
at such points, at both ends of the range, and in gaps where no peak was followed. A gap whose peaks are far
above the least is skipped. Some peaks, of motions with many states, cannot be followed. Then only response
curves decide, see `by_trials`.
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

    checked: whether response curves confirm that it is the least.
    """

    best: EnvelopeMinimum | None
    curves: tuple[SpecialPointCurve, ...]
    checked: bool
    harmonics: tuple[int, ...]


@dataclass
class LowestPeakSearch:
    """The search for the least peak of one scene and its targets, with the curves known so far."""

    system: System
    line: ParameterLine
    span: tuple[float, float]
    targets: Sequence[Target]
    options: SearchOptions = SEARCH
    steps: KeptSteps = field(default_factory=KeptSteps)
    curves: list[SpecialPointCurve] = field(default_factory=list)
    pieces: list[MonotonePiece] = field(default_factory=list)  # of the curves that count for the targets
    visited_values: dict[float, PieceHeight] = field(
        default_factory=dict
    )  # greatest height of the response at each traced value
    known_points: dict[float, list[tuple[Condition, PieceHeight]]] = field(
        default_factory=dict
    )  # all special points at each traced value
    visited: set[float] = field(default_factory=set)  # values at which high peaks were also followed

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
        """Find the least peak, starting from curves with fewer harmonics, or from both ends of the range."""
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
                    break  # else new peaks beyond the end of the followed one may be higher
                continue
            if seen:
                break  # a higher peak there could not be followed
        checked = checked and not self._unknown(best) and not self._lower(best)
        return LowestPeak(best, tuple(self.curves), checked, self.system.harmonics)

    def best(self) -> EnvelopeMinimum | None:
        """The least value of the envelope, after visiting gaps and values with a lower response."""
        while True:
            best = envelope_minimum(self.setup, self.pieces)
            new = [s for s in (*self._unknown(best), *self._lower(best)) if s not in self.visited]
            if not new or len(self.visited_values) >= self.options.max_visits:
                return best
            for value in new:
                self.visit(value)

    def _unknown(self, best: EnvelopeMinimum | None) -> list[float]:
        """Values in gaps without a followed peak, except where all peaks are far above the least."""
        return [
            s
            for s in uncovered_values(self.setup, self.pieces, self.visited)
            if best is None or self._is_near(s, best)
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
        """Values at which the traced response is lower than the least value of the envelope."""
        below = 0.0 if best is None else best.value * (1.0 - self.options.height_tolerance)
        return [s for s, top in self.visited_values.items() if 0.0 < top.value < below]

    def _beyond_end(self, best: EnvelopeMinimum | None) -> list[float]:
        """Values just beyond the end of a followed peak, if the least value lies at this end."""
        if best is None or best.kind != "corner":
            return []
        near = self.setup.options.envelope.bracket * (self.span[1] - self.span[0])
        ends = (end for piece in self.pieces for end in ((piece.s[0], -near), (piece.s[-1], near)))
        beyond = (float(end + step) for end, step in ends if abs(end - best.s) < near)
        return [s for s in beyond if self.span[0] < s < self.span[1]]

    def least_traced(self) -> tuple[FloatArray, EnvelopeMinimum] | None:
        """The least peak of the responses traced so far, and its number; None if none has a peak."""
        peaks = {s: top for s, top in self.visited_values.items() if top.value > 0.0}
        if not peaks:
            return None
        s = min(peaks, key=lambda value: peaks[value].value)
        return self.line.values(s), EnvelopeMinimum(s, peaks[s].value, (peaks[s],), INCOMPLETE)

    @property
    def responses(self) -> int:
        """Number of responses traced so far."""
        return len(self.visited_values)

    def visit(self, value: float) -> float:
        """Trace the response at a value, follow its unknown high peaks, and return its greatest height."""
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
        """Special points of the response at a value that may be the greatest, with their heights."""
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
        """Follow the curve through a point, unless it is known."""
        if not any(passes(curve, condition, point, self.setup) for curve in self.curves):
            key = f"curve of {condition} through {point.z.tolist()}"
            curve = self._step(key, SpecialPointCurve, partial(both_ways, self.setup, condition, point))
            self.curves.append(curve)
            for target in self.targets:
                self.pieces += pieces_of(self.setup, [curve], target)

    def _step(self, key: str, kind: type[T], step: Callable[[], T]) -> T:
        return self.steps(f"{self.system.harmonics} {self.span} {key}", kind, step)

    def height(self, condition: Condition, z: FloatArray) -> PieceHeight:
        """Greatest height of the targets for which a point counts; 0 if there is none."""
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
        """Follow curves found with fewer harmonics, starting from their ends and their middle."""
        for curve in known.curves:
            for i in sorted({0, len(curve.points) // 2, len(curve.points) - 1}):
                z = self.system.extended(curve.points[i].z, known.harmonics)
                z[-1] = np.clip(z[-1], *self.span)  # an end may lie a rounding beyond it
                point = land(self.setup, curve.condition, z) if curve.greatest[i] else None
                if point is not None:
                    self.follow(curve.condition, point)
