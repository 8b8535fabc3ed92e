"""Connection of the smooth pieces of a curve of special points: along corners, across them, past kinks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray
from fcm.tracking.corner import Corner, nearest_onsets
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.kinks import Circle
from fcm.tracking.onset_functions import values
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup, kinks


class CornerCrossing:
    """Continues a curve of special points along corners of the response, across them, and past kinks.

    z: the present point; t: the unit tangent there in the problem's scale; points: all points so far; first:
    the first step length of the next piece.
    """

    z: FloatArray
    t: FloatArray
    points: list[TrackedPoint]

    def __init__(self, setup: TrackingSetup, condition: Condition) -> None:
        self.setup, self.condition, self.options = setup, condition, setup.options.pieces
        self.smooth = setup.tracked(condition)
        self.low, self.high = setup.system.scene.frequency_range
        self.turns = condition.kind in (Kind.FOLD, Kind.PEAK)
        self.values = sorted({*setup.span, *setup.user_values})
        self.kinks, self.first = kinks(setup), self.options.step.initial_step
        self.held = np.eye(self.smooth.n + 2)[-1]
        self.switch_equations(None)

    def switch_equations(self, at: Condition | None) -> None:
        """Switch to the equation of a corner, or (None) to that of the smooth curve."""
        self.corner = None if at is None else Corner(self.smooth, at)
        self.newton = Newton(self.smooth if self.corner is None else self.corner.problem)

    def _holds(self) -> bool:
        """Whether the point found is on the tracked curve; at a corner, if that is the special point."""
        return self.corner is None or self.corner.holds(np.array(self.newton.z))

    def solve(self, guess: FloatArray, row: FloatArray) -> bool:
        self.newton.z[:], self.newton.row[:] = guess, row
        return bool(self.newton.correct(self.options.reach)) and bool(np.isfinite(self.newton.z).all())

    def measure_at(self, z: FloatArray) -> None:
        """Set the scale, and the row that closes the tangent equations, at a point."""
        self.smooth.evaluate_scale(z)
        if self.corner is not None:
            self.corner.problem.offset = 0.0
            self.corner.problem.row[:] = self.smooth.row
            self.corner.problem.evaluate_scale(z)
        self.newton.scale[:] = self.smooth.scale

    def accept(self) -> None:
        """Continue from the point that Newton's method has found."""
        self._go_to(np.array(self.newton.z), np.asarray(self.newton.tangent) * np.asarray(self.newton.scale))

    def _go_to(self, z: FloatArray, direction: FloatArray) -> None:
        """Continue from a point with a direction in the units of z."""
        self.z = np.array(z)
        self.measure_at(self.z)
        t = direction / np.asarray(self.newton.scale)
        self.t = t / np.linalg.norm(t)

    def point_at(self, z: FloatArray, t: FloatArray) -> TrackedPoint:
        at = None if self.corner is None else self.corner.at
        return TrackedPoint(z, t * np.asarray(self.newton.scale), at)

    def _signs(self, z: FloatArray) -> FloatArray:
        """Signs of the onset functions of all contacts."""
        varied = self.smooth.varied
        varied.set_parameter(float(z[-1]))
        return np.sign(values(varied.balance.laws, z, varied.harmonics, self.setup.options))

    def _leaves(self) -> bool:
        """Whether the tangent leads out of the span at one of its ends."""
        low, high = self.setup.span
        near = self.options.kink_length * self.smooth.span
        return bool(
            (self.t[-1] < 0.0 and self.z[-1] <= low + near)
            or (self.t[-1] > 0.0 and self.z[-1] >= high - near)
        )

    def _corners_near(self, z: FloatArray) -> Iterator[Condition]:
        """Yield the corners of the response near a point, the nearest first."""
        if self.turns:
            for off, at in nearest_onsets(
                self.smooth.varied, z, np.array(self.newton.scale), self.setup.options
            ):
                if off > self.options.corner_distance:
                    break
                yield at

    def _past_kink(self, z: FloatArray, row: FloatArray) -> FloatArray:
        """A point just beyond a kink."""
        beyond: FloatArray = z + self.options.kink_length * self.smooth.span * row
        return beyond

    def _pass_kink(self) -> bool | Ending:
        """Continue just beyond a kink that the curve has reached."""
        row = np.sign(self.t[-1]) * self.held
        if self.solve(self._past_kink(self.z, row), row) and self._holds():
            self.accept()
            return True
        return self._pass_on_circle()

    def _continue_from_here(self) -> bool | Ending:
        """Continue where the equations cease to hold or no step succeeds; else return how the curve ends."""
        return self._reach_corner() or self._pass_on_circle()

    def _reach_corner(self) -> bool | Ending:
        """Reach a corner of the response, and track or cross it; False if there is none ahead.

        It returns how the curve ends if it ends before the corner.
        """
        if self.corner is not None:
            return False
        z, before, known = self.z, float(self.t[-1]), list(self.points)
        came = self.t * np.asarray(self.newton.scale)
        for at in self._corners_near(z):
            self.switch_equations(at)
            self.measure_at(z)
            assert self.corner is not None
            self.corner.problem.evaluate(z)
            side = int(self.corner.problem.residual[-1] > 0.0)
            there = self.corner.special_root(z, side)
            if there is None or not self._is_ahead(there):
                continue
            self._retreat_before(there)
            ending = self._keep_until(there, at)
            if isinstance(ending, Ending):
                return ending
            if ending and self._leave_corner(there, side, came, before):
                return True
            self.points[:] = known
        self.switch_equations(None)
        self.measure_at(z)
        return False

    def _retreat_before(self, corner: FloatArray) -> None:
        """Drop points just beyond a corner: steps shorter than its uncertainty may have passed it."""
        scale = np.asarray(self.newton.scale)
        while (
            len(self.points) > 1
            and 0.0 <= (self.points[-1].z - corner) / scale @ self.t < self.options.reached_distance
        ):
            self.points.pop()

    def _keep_until(self, corner: FloatArray, at: Condition) -> Ending | bool:
        """Apply `_keep_values` up to a corner, with the equations of the smooth curve."""
        if not any(self._values_between(self.z, corner)):
            return True
        self.switch_equations(None)
        self.measure_at(self.z)
        ending = self._keep_values(self.options.corner_distance, corner)
        self.switch_equations(at)
        self.measure_at(self.z)
        return ending

    def _is_ahead(self, corner: FloatArray) -> bool:
        """Whether a corner lies in the direction of the curve."""
        off = (corner - self.z) / np.asarray(self.newton.scale)
        far = float(np.linalg.norm(off))
        return far < self.options.corner_distance and (
            far < self.options.reached_distance or bool(off @ self.t > self.options.min_cosine_ahead * far)
        )

    def _leave_corner(self, there: FloatArray, side: int, came: FloatArray, before: float) -> bool:
        """Continue from a corner reached from a side: along it, or on its other side."""
        assert self.corner is not None
        if abs(self.corner.sides(there)[1 - side]) > self.options.max_jump:
            return self._along(there, came, before)
        exact = self.corner.special_root(there, None)
        return exact is not None and self._beyond(exact, came, before, 1 - 2 * side)

    def _along(self, z: FloatArray, came: FloatArray, before: float) -> bool:
        """Continue along the corner, in the direction in which it is the special point."""
        assert self.corner is not None
        found = self.corner.nearest(z)
        if found is None:
            return False
        scale, t = np.array(self.newton.scale), found[1]
        ways = [t, -t] if t @ (came / scale) > 0.0 else [-t, t]
        for way in ways:
            if self.solve(z + scale * self.options.departure_lengths[1] * way, way) and self._holds():
                self.newton.z[:], self.newton.tangent[:] = z, way
                self.accept()
                self.first = self.options.step.initial_step
                self.points.append(replace(self.point_at(z, way), switch=True, turn=before * way[-1] < 0.0))
                return True
        return False

    def _beyond(self, z: FloatArray, came: FloatArray, before: float, sign: int) -> bool:
        """Continue with the smooth curve on the side of a corner where its onset function has a sign."""
        corner = self.corner
        assert corner is not None
        for leap in self.options.departure_lengths:
            self.switch_equations(corner.at)
            self.measure_at(z)
            there = self.corner.special_root(z, None, sign * leap) if self.corner is not None else None
            if there is None:
                continue
            self.switch_equations(None)
            self.measure_at(there)
            row = (there - z) / np.asarray(self.newton.scale)
            if self.solve(there, row / np.linalg.norm(row)) and self.newton.moved < self.options.max_move:
                self.accept()
                if sign * (corner.rise(self.z) @ self.t) < 0.0:  # two peaks are close to each other there:
                    self.t = -self.t  # the chord between them points back across the corner
                self.first = leap
                turn = bool(before * self.t[-1] < 0.0)
                self.points += [TrackedPoint(z, came, None, turn, switch=True), self.point_at(self.z, self.t)]
                return True
        self.switch_equations(corner.at)
        self.measure_at(z)
        return False

    def _leave_along_smooth(self) -> bool | Ending:
        """Leave a corner that ceases to be the special point, along the smooth curve.

        The curve continues on the side that has the special point ahead. If the other side has one behind,
        the curve has come from there.
        """
        assert self.corner is not None
        z, before = self.z, float(self.t[-1])
        came = self.t * np.asarray(self.newton.scale)
        scale, found = np.array(self.newton.scale), list[tuple[float, int, FloatArray]]()
        for side in (0, 1):
            if (there := self.corner.special_root(z, side)) is not None:
                found.append((float((there - z) / scale @ self.t), side, there))
        here = self.options.least_departure
        for _, side, there in sorted(found, key=lambda one: (one[0] < here, abs(one[0]))):
            if self._beyond(there, came, before, 2 * side - 1):
                return True
        return Ending.STALLED

    def _pass_on_circle(self) -> bool | Ending:
        """Find the way on from a kink, on circles about the point; else return how the curve ends.

        Where a contact changes its state with continuous derivatives, second derivatives jump, and so does
        the tangent of a curve of folds or peaks. Where first derivatives jump, the response has a corner.
        """
        problem, ending = self.smooth if self.corner is None else self.corner.problem, Ending.STALLED
        for radius in self.options.kink_radii:
            back = self._back(radius)
            if back is None:
                break
            for change in Circle(problem, self.z, self.t, radius).changes(back):
                if change.jump:
                    ending = Ending.CORNER
                elif (taken := self.turn_to(change.z, radius)) is not None:
                    return taken
        return ending

    def _back(self, radius: float) -> FloatArray | None:
        """The point behind on the curve at a distance, by the chord; None if the curve is shorter."""
        scale, near = np.asarray(self.newton.scale), self.z
        for point in reversed(self.points):
            far = float(np.linalg.norm((point.z - self.z) / scale))
            if far > radius:
                short = float(np.linalg.norm((near - self.z) / scale))
                return near + (point.z - near) * ((radius - short) / (far - short))
            near = point.z
        return None

    def turn_to(self, there: FloatArray, radius: float) -> bool | Ending | None:
        """Continue to a point on a circle; None if it is not on the curve."""
        came, last = float(self.t[-1]), self.points[-1]
        row = (there - self.z) / np.asarray(self.newton.scale)
        row /= np.linalg.norm(row)
        if not self.solve(there, row) or self.newton.moved > self.options.radius_tolerance * radius:
            return None
        if np.asarray(self.newton.tangent) @ row < self.options.min_radial_cosine:
            return None
        z, t = np.array(self.newton.z), np.array(self.newton.tangent)
        self.points[-1] = replace(last, turn=last.turn or came * t[-1] < 0.0)
        ending = self._keep_values(radius, z)
        if ending is True:
            self.points.append(self.point_at(z, t))
            self._go_to(z, self.points[-1].direction)
            self.first = radius
            return True
        return ending or None

    def _keep_values(self, step: float, other: FloatArray) -> Ending | bool:
        """Add the points at special values on the short way to a point; return how the curve ends there.

        If it does not end, return True; False if a special value that was passed could not be landed on.
        """
        one, known = self.z, len(self.points)
        for part, i, value in sorted(self._values_between(one, other)):
            ending = self._ends(i, value, other[i] - one[i])
            guess, row = one + part * (other - one), np.zeros(one.size)
            guess[i], row[i] = value, np.sign(other[i] - one[i])
            if not self.solve(guess, row) or self.newton.moved > step:
                del self.points[known:]
                return False
            point = self.point_at(np.array(self.newton.z), np.array(self.newton.tangent))
            point.z[i] = value
            self.points.append(replace(point, user_point=i == -1))
            if ending is not None:
                return ending
        return True

    def _values_between(self, one: FloatArray, other: FloatArray) -> Iterator[tuple[float, int, float]]:
        """Yield special values between two points: the part of the way, the index in z, and the value.

        They are the requested values of s, and the ends of the frequency range.
        """
        for i, wanted in ((-1, self.values), (-2, [self.low, self.high])):
            for value in wanted:
                if (value - one[i]) * (value - other[i]) < 0.0 or value == other[i] != one[i]:
                    yield (value - one[i]) / (other[i] - one[i]), i, value

    def _ends(self, i: int, value: float, rise: float) -> Ending | None:
        """The ending of the curve where s (-1) or the frequency (-2) passes a value, rising or falling."""
        low, high = self.setup.span if i == -1 else (self.low, self.high)
        if value != (high if rise > 0.0 else low):
            return None
        return Ending.SPAN if i == -1 else Ending.RANGE
