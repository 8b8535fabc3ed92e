"""All curves of special points of a response over a range of a number, each followed once."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Protocol, TypeVar

import numpy as np

from fcm.continuation.follow import Progress
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.tracking.curve import SpecialPointCurve, both_ways
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.known_curves import passes
from fcm.tracking.nonsmooth_continuation import land
from fcm.tracking.peak_check import is_top
from fcm.tracking.start_points import special_points
from fcm.tracking.tracked_point import TrackedPoint, TrackingSetup

T = TypeVar("T")


class CachedSteps(Protocol):
    """A function that runs a costly step or returns its saved result; the order identifies steps."""

    def __call__(self, step: Callable[[], T], /) -> T: ...


def uncached(step: Callable[[], T], /) -> T:
    """Run a step; a `CachedSteps` without a cache."""
    return step()


class TrackedCurves(Frozen):
    """All curves of special points, and the points that could not be followed."""

    curves: tuple[SpecialPointCurve, ...]
    problems: tuple[str, ...] = ()
    lost: tuple[tuple[Condition, FloatArray], ...] = ()  # special points of responses, on none of the curves
    interrupted: bool = False  # there may be more curves
    uncertain: tuple[
        tuple[float, float], ...
    ] = ()  # values and frequencies where branches may have been missed


def tracked_curves(
    setup: TrackingSetup,
    conditions: list[Condition],
    starts: tuple[float, ...] = (),
    progress: Progress | None = None,
    once: CachedSteps = uncached,
) -> TrackedCurves:
    """Follow the curves of conditions, from special points of response curves at some values of s.

    Onsets that appear only between two such values are found along the curves of the highest peaks. After an
    interruption the finished curves are returned. once runs each costly step. Of setup, the system, the line,
    the span and the options count; the step is the scene's, and the inner values of s are user values.
    """
    values = sorted({*np.linspace(*setup.span, setup.options.curves.start_values).tolist(), *starts})
    setup = TrackingSetup(
        setup.system,
        setup.line,
        setup.span,
        tuple(values[1:-1]),
        setup.system.scene.max_step,
        options=setup.options,
    )
    made, stopped = _CurveCollection(setup, once), False
    try:
        _follow_all(made, values, conditions, progress)
    except KeyboardInterrupt:
        stopped = True
    lost = () if stopped else tuple(made.lost())
    return TrackedCurves(tuple(made.curves), tuple(made.problems), lost, stopped, tuple(made.uncertain_at))


def _follow_all(
    made: _CurveCollection, values: list[float], conditions: list[Condition], progress: Progress | None
) -> None:
    """Follow the curves from special points of response curves at some values of s."""
    system, line = made.setup.system, made.setup.line
    for number, value in enumerate(values):
        if progress is not None:
            progress(number / len(values))
        there = system.with_scene(line.scene(system.scene, value))
        special = made.once(partial(special_points, there, conditions, made.setup.options))
        if special.faults:
            made.problems.append(f"at {value:.6g}: {special.faults}")
        made.uncertain_at += [(value, omega) for omega in special.uncertain]
        made.from_points([(condition, np.append(z, value)) for condition, z in special.points])
    onsets = [condition for condition in conditions if condition.kind is Kind.ONSET]
    if onsets:
        made.from_points(made.once(partial(_met_by_peaks, made.setup, onsets)))


class _CurveCollection:
    """The curves followed so far."""

    def __init__(self, setup: TrackingSetup, once: CachedSteps = uncached) -> None:
        self.setup, self.once = setup, once
        self.curves: list[SpecialPointCurve] = []
        self.problems: list[str] = []
        self.uncertain_at: list[tuple[float, float]] = []
        self.missed: list[tuple[Condition, FloatArray]] = []  # points at which no curve could begin

    def from_points(self, points: list[tuple[Condition, FloatArray]]) -> None:
        """Follow curves from those points z = (x, omega, s) that no curve has passed."""
        for condition, z in points:
            point = land(self.setup, condition, z)
            if point is None or not self._is_top(condition, point):
                self.missed.append((condition, z))
            if point is not None and not any(
                passes(one, condition, point, self.setup) for one in self.curves
            ):
                self.curves.append(self.once(partial(both_ways, self.setup, condition, point)))

    def lost(self) -> list[tuple[Condition, FloatArray]]:
        """Points at which no curve could begin and that no other curve has passed."""
        return [
            (condition, z)
            for condition, z in self.missed
            if not any(self._passes(curve, condition, z) for curve in self.curves)
        ]

    def _passes(self, curve: SpecialPointCurve, condition: Condition, z: FloatArray) -> bool:
        """Whether a curve has a point at the same value of the number, and nearly the same frequency."""
        low, high = self.setup.span
        there = np.abs(curve.s - z[-1]) < self.setup.options.curves.value_tolerance * (high - low)
        near = np.abs(curve.frequency[there] / z[-2] - 1.0) < self.setup.options.curves.frequency_tolerance
        return curve.condition == condition and bool(near.any())

    def _is_top(self, condition: Condition, point: TrackedPoint) -> bool:
        """Whether a point landed on as a peak is no trough: next to a peak at a corner there may be one."""
        if condition.kind is not Kind.PEAK:
            return True
        problem = self.setup.tracked(condition)
        problem.evaluate_scale(point.z)
        return is_top(problem, point)


def _met_by_peaks(setup: TrackingSetup, onsets: list[Condition]) -> list[tuple[Condition, FloatArray]]:
    """Points of curves of peaks at which an onset function changes its sign.

    The curves are those of a few peaks in the middle of the span.
    """
    middle = setup.system.with_scene(setup.line.scene(setup.system.scene, 0.5 * sum(setup.span)))
    peaks = [Condition(Kind.PEAK, d) for d in range(len(middle.scene.modal.dofs))]
    points = special_points(middle, peaks, setup.options).points
    problem = setup.tracked(onsets[0])
    made = _CurveCollection(setup)
    for condition, z in points[: setup.options.curves.max_peaks]:
        made.from_points([(condition, np.append(z, 0.5 * sum(setup.span)))])
    found = []
    for tracked_points in (curve.points for curve in made.curves):
        for onset in onsets:
            value = np.array([problem.onset_at(point.z, onset) for point in tracked_points])
            for i in np.flatnonzero(value[:-1] * value[1:] <= 0.0):
                found.append((onset, np.array(tracked_points[i + int(abs(value[i + 1]) < abs(value[i]))].z)))
    return found
