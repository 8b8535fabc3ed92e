"""A curve of special points of a response, followed in both directions from one of its points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.tracking.extended_system import Condition, ExtendedSystem, Kind
from fcm.tracking.nonsmooth_continuation import follow_special_point
from fcm.tracking.options import TRACKING
from fcm.tracking.peak_check import is_top
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup

BoolArray = npt.NDArray[np.bool_]


class SpecialPointCurve(Frozen):
    """A curve of special points, in order along it."""

    condition: Condition
    points: tuple[TrackedPoint, ...]
    s: FloatArray  # (point,)
    frequency: FloatArray  # (point,) [rad/s]
    amplitude: FloatArray  # (point, dof)
    greatest: BoolArray  # (point,) false where a curve of peaks is a trough
    endings: tuple[Ending, Ending]

    @property
    def whole(self) -> bool:
        """Whether the curve was followed to its ends."""
        return all(ending.whole for ending in self.endings)

    def turns(self, cusp: float = TRACKING.curves.cusp_tolerance) -> list[tuple[int, str]]:
        """Points at which the number turns back, with their kinds; cusp is that of `CurveOptions`."""
        other = "peak and trough" if self.condition.kind is Kind.PEAK else "extreme"
        fold, turns = (
            self.condition.kind is Kind.FOLD,
            [i for i, point in enumerate(self.points) if point.turn],
        )
        return [(i, self._turn_of_fold(i, cusp) if fold else other) for i in turns]

    def _turn_of_fold(self, i: int, cusp: float) -> str:
        """Kind of a turn of a curve of folds: "cusp", where two folds meet with one tangent, or "isola".

        Along a curve of folds w . R_omega omega' + w . R_s s' = 0, with w the adjoint null vector. At a cusp
        w . R_omega is not 0, so that omega' vanishes with s' and the frequency turns back. At an isola
        w . R_omega vanishes: the response has an isolated point, or crosses itself, and the frequency passes
        on. At a corner only the signs of omega' beside it decide.
        """
        neighbours = [self.points[j].direction[-2] for j in (i - 1, i + 1) if 0 <= j < len(self.points)]
        if self.points[i].switch and len(neighbours) == 2:
            return "cusp" if neighbours[0] * neighbours[1] < 0.0 else "isola"
        still = abs(self.points[i].direction[-2]) < cusp * max(map(abs, neighbours), default=0.0)
        return "cusp" if still else "isola"


def both_ways(setup: TrackingSetup, condition: Condition, point: TrackedPoint) -> SpecialPointCurve:
    """The curve of special points through a point, followed in both directions."""
    tracked_points, ending = follow_special_point(setup, condition, point, True)
    endings = (ending, ending)
    if ending is not Ending.CLOSED:
        back, other = follow_special_point(setup, condition, point, False)
        turned = [replace(one, direction=-one.direction) for one in back[:0:-1]]
        tracked_points, endings = [*turned, *tracked_points], (other, ending)
    return recorded(setup, condition, tracked_points or [point], endings)


def recorded(
    setup: TrackingSetup,
    condition: Condition,
    tracked_points: list[TrackedPoint],
    endings: tuple[Ending, Ending],
) -> SpecialPointCurve:
    """The curve of tracked points with their reported quantities."""
    problem = setup.tracked(condition)
    return _joined(
        condition, tracked_points, [_reported(problem, point) for point in tracked_points], endings
    )


def with_points(
    setup: TrackingSetup, track: SpecialPointCurve, tracked_points: list[TrackedPoint]
) -> SpecialPointCurve:
    """The curve with further points; tracked_points include its own."""
    problem = setup.tracked(track.condition)
    own = zip(track.amplitude, track.greatest.tolist(), strict=True)
    known = {id(point): told for point, told in zip(track.points, own, strict=True)}
    told = [known.get(id(point)) or _reported(problem, point) for point in tracked_points]
    return _joined(track.condition, tracked_points, told, track.endings)


def _reported(problem: ExtendedSystem, point: TrackedPoint) -> tuple[FloatArray, bool]:
    """The amplitudes (dof,) at a point, and false if it is a trough."""
    problem.evaluate_scale(point.z)
    amplitude = problem.along(point.z)[1]
    return amplitude, problem.condition.kind is not Kind.PEAK or is_top(problem, point)


def _joined(
    condition: Condition,
    tracked_points: list[TrackedPoint],
    told: list[tuple[FloatArray, bool]],
    endings: tuple[Ending, Ending],
) -> SpecialPointCurve:
    z, (amplitude, greatest) = np.array([point.z for point in tracked_points]), zip(*told, strict=True)
    return SpecialPointCurve(
        condition, tuple(tracked_points), z[:, -1], z[:, -2], np.array(amplitude), np.array(greatest), endings
    )
