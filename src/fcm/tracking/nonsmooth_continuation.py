"""Continuation of a special point in a number of its scene, by connected smooth pieces.

Each piece is followed by `fcm.continuation.follow`. It ends where its equations cease to hold: at a value of
the number where they have a kink, at a corner of the response, or where another extreme of the cycle becomes
the greatest. `CornerCrossing` continues from there, as described in `corner_crossing` and `kinks`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fcm.continuation import End, Events, FollowOptions, Mark, Path, Status, follow
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.tracking.corner_crossing import CornerCrossing
from fcm.tracking.extended_system import Condition
from fcm.tracking.peak_check import is_top, overtaken
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup


def follow_special_point(
    setup: TrackingSetup, condition: Condition, start: TrackedPoint, forward: bool
) -> tuple[list[TrackedPoint], Ending]:
    """Follow the curve of special points from start, with s rising (forward) or falling at first."""
    return SmoothPieces(setup, condition).run(start, forward)


def land(setup: TrackingSetup, condition: Condition, z: FloatArray) -> TrackedPoint | None:
    """The special point near z = (x, omega, s) at the same s, at a corner if one is special; else None."""
    return SmoothPieces(setup, condition).land(z)


class _End(Frozen):
    """An end of a smooth piece: a function of z, negative where the equations do not hold, and the way on."""

    holds: End
    then: Callable[[], bool | Ending]


class SmoothPieces(CornerCrossing):
    """Follows the smooth pieces of one curve of special points, one after the other."""

    def land(self, z: FloatArray) -> TrackedPoint | None:
        """The point near z = (x, omega, s) at the same s, see the function `land`."""
        point = self._landed(z)
        if point is not None and overtaken(self.smooth, point.z):
            point = self._landed(
                point.z
            )  # as the peak of those extremes that are the greatest of the cycle there
            if point is not None and overtaken(self.smooth, point.z):
                return None
        return point

    def _landed(self, z: FloatArray) -> TrackedPoint | None:
        self.measure_at(z)
        for at in self._corners_near(z):
            self.switch_equations(at)
            self.measure_at(z)
            if (
                self.solve(z, self.held)
                and self.newton.moved < self.options.corner_distance
                and self._holds()
            ):
                return self._held(z)
        self.switch_equations(None)
        self.measure_at(z)
        if self.solve(z, self.held) and self.newton.moved < self.options.max_correction:
            return self._held(z)
        return None

    def _held(self, z: FloatArray) -> TrackedPoint:
        """The point found with s held; s is restored exactly."""
        self.newton.z[-1] = z[-1]
        return self.point_at(np.array(self.newton.z), np.array(self.newton.tangent))

    def run(self, start: TrackedPoint, forward: bool) -> tuple[list[TrackedPoint], Ending]:
        """Follow the curve from a point, see `follow_special_point`."""
        self.switch_equations(start.corner)
        self.measure_at(start.z)
        row, z = self.held if forward else -self.held, np.array(start.z)
        if z[-1] in self.kinks:
            z = self._past_kink(z, row)
        if not self.solve(z, row):
            return [], Ending.STALLED
        self.newton.z[-1] = z[-1]
        self.accept()
        first, heading = self.z, self.t * np.asarray(self.newton.scale)
        self.points = [self.point_at(self.z, self.t)]
        if z[-1] != start.z[-1]:
            self.points.insert(0, start)
        if self._leaves():
            return self.points, Ending.SPAN
        for _ in range(self.options.max_pieces):
            known = len(self.points)
            ending = self._piece()
            if self.setup.peaks_only:
                turned = [i for i in range(known, len(self.points)) if self.points[i].turn]
                if turned:
                    return self.points[: turned[0] + 1], Ending.TURNED
            at = self._closed(first, heading, known) if known > 2 else None
            if at is not None:
                last = self.points[at - 1].z
                same = (
                    np.linalg.norm((last - first) / np.asarray(self.newton.scale))
                    < self.options.step.min_step
                )
                return [*self.points[: at - bool(same)], self.points[0]], Ending.CLOSED
            if (
                ending is Ending.STALLED
                and np.linalg.norm(self._off(self.z - first)) < self.options.short_step
            ):
                return self.points[:1], ending  # only short steps about a kink, without progress
            if isinstance(ending, Ending) or len(self.points) > self.options.max_points:
                return self.points, ending if isinstance(ending, Ending) else Ending.LONG
        return self.points, Ending.LONG

    def _piece(self) -> bool | Ending:
        """Follow a piece to its end; return true if the curve continues, else how it ends."""
        problem, s = self.newton.problem, float(self.z[-1])
        low = max([k for k in self.kinks if k < s] + [self.setup.span[0]])
        high = min([k for k in self.kinks if k > s] + [self.setup.span[1]])
        ends = self._ends_of_piece()
        events = Events(
            values=self.setup.user_values,
            ends=[end.holds for end in ends],
            last=Mark.FOLD if self.setup.peaks_only else 0,
        )
        slow, short = self.first < self.options.short_step, 0.999 * self.options.short_step
        control = (
            replace(self.options.step, max_steps=self.options.short_steps)
            if slow
            else replace(self.options.step, min_step=short)
        )
        options = FollowOptions(max_step=self.setup.step, step=replace(control, initial_step=self.first))
        direction = self.t * np.asarray(self.newton.scale)
        path = follow(problem, self.z, (low, high), events, options, direction=direction)
        if not len(path.z):
            return self._continue_from_here()
        self._keep(path)
        if path.status in (Status.COMPLETE, Status.RETURNED):
            return Ending.SPAN if self.z[-1] in self.setup.span else self._pass_kink()
        if path.status is Status.CLOSED:
            return Ending.CLOSED
        if path.status is Status.EVENT:
            return Ending.TURNED if path.ended_by < 0 else ends[path.ended_by].then()
        if path.status is Status.TOO_LONG and slow:
            self.first = self.options.max_factor * float(np.linalg.norm(self._off(path.z[-1] - path.z[-2])))
            return True
        if path.status is Status.STALLED:
            return self._continue_from_here() if slow else self._slowly()
        return Ending.LONG

    def _slowly(self) -> bool | Ending:
        """Continue after steps that were too long: at a corner of the response ahead, or by short steps."""
        ending = self._reach_corner()
        if not ending:
            self.first = 0.25 * self.options.short_step
        return ending or True

    def _ends_of_piece(self) -> list[_End]:
        """Ends of a piece: those of the frequency range; for a smooth piece other extremes and corners."""
        ends = [
            _End(End(lambda z: z[-2] - self.low), lambda: self._at_end_of_range(self.low)),
            _End(End(lambda z: self.high - z[-2]), lambda: self._at_end_of_range(self.high)),
        ]
        if self.corner is not None:
            corner = self.corner
            return [*ends, _End(End(lambda z: 2.0 * corner.holds(z) - 1.0), self._leave_along_smooth)]
        ends.append(_End(End(lambda z: 1.0 - 2.0 * overtaken(self.smooth, z)), self._overtaken))
        if self.turns:
            signs = self._signs(self.z)
            same = End(
                lambda z: 1.0 - 2.0 * (self._signs(z) * signs < 0.0).any(), 0.25 * self.options.short_step
            )
            ends.append(_End(same, self._slowly))
            smooth = End(lambda z: 1.0 - 2.0 * self.smooth.jumps(z), self.options.reached_distance)
            ends.append(_End(smooth, lambda: self._reach_corner() or Ending.CORNER))
        return ends

    def _keep(self, path: Path) -> None:
        """Append the points of a path but the first, and move to the last."""
        at = None if self.corner is None else self.corner.at
        for z, way, mark in zip(path.z[1:], path.direction[1:], path.mark[1:].tolist(), strict=True):
            user_point = z[-1] in self.values and bool(mark & (Mark.USER_POINT | Mark.END))
            self.points.append(TrackedPoint(z, way, at, turn=bool(mark & Mark.FOLD), user_point=user_point))
        self._go_to(path.z[-1], path.direction[-1])
        self.first = self.options.step.initial_step

    def _off(self, way: FloatArray) -> FloatArray:
        """A difference of two points in the problem's scale."""
        off: FloatArray = way / np.asarray(self.newton.scale)
        return off

    def _at_end_of_range(self, omega: float) -> Ending:
        """End the curve exactly at an end of the frequency range."""
        row = np.zeros(self.z.size)
        row[-2] = np.sign(self.t[-2]) or 1.0
        guess = np.array(self.z)
        guess[-2] = omega
        if self.solve(guess, row) and self.newton.moved < self.options.step.initial_step:
            point = self.point_at(np.array(self.newton.z), np.array(self.newton.tangent))
            point.z[-2] = omega
            self.points[-1] = replace(point, turn=self.points[-1].turn, user_point=self.points[-1].user_point)
        return Ending.RANGE

    def _overtaken(self) -> Ending:
        """End the curve where other extremes than those of the peak become the greatest of the cycle.

        There the amplitude has a kink that is a trough: the curve of a peak meets it, and that of a trough is
        replaced by it.
        """
        return Ending.MET if is_top(self.smooth, self.points[-1]) else Ending.TROUGH

    def _closed(self, first: FloatArray, heading: FloatArray, known: int) -> int | None:
        """Index of the first point that passes the start of the curve in its direction, or None.

        known: number of points that are not examined.
        """
        scale = np.asarray(self.newton.scale)
        heading = heading / scale
        heading = heading / np.linalg.norm(heading)
        for i in range(max(known, 3), len(self.points)):
            one, other = ((point.z - first) / scale for point in self.points[i - 1 : i + 1])
            length = np.linalg.norm(other - one)
            if min(np.linalg.norm(one), np.linalg.norm(other)) > length:
                continue
            way = self.points[i].direction / scale
            if one @ heading < 0.0 <= other @ heading and way @ heading > 0.5 * np.linalg.norm(way):
                return i
        return None
