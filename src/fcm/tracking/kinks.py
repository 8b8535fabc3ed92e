r"""Search for the continuation of a curve of special points past a kink of its equations.

The solutions of the balance at all frequencies and values of s form a surface, and the special-point
condition is zero along lines on it. Where a contact begins to slip, open or close within its cycle, the
derivatives of its forces jump, or change like a square root, and so does this condition. The line then
continues in another direction, or along the jump, which no derivative on this side of the kink predicts. So
sign changes of the condition are located on a small circle on the surface about the point. One is where the
curve came from, another is where it continues.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from fcm.model.scene import FloatArray
from fcm.tracking.extended_system import ExtendedSystem


class CircleCrossing(NamedTuple):
    """A change of sign of the condition on a circle, by a jump or through zero."""

    angle: float  # from straight ahead
    z: FloatArray
    jump: bool


class Circle:
    """A circle on the surface of the balance's solutions, about a point of a curve with a direction."""

    def __init__(self, problem: ExtendedSystem, z: FloatArray, t: FloatArray, radius: float) -> None:
        self.problem, self.z, self.radius, self.options = problem, z, radius, problem.options.kink
        self.scale = np.array(problem.scale)
        plane = np.linalg.svd(problem.surface(z)[1])[2][-2:]
        ahead = plane @ t
        ahead /= np.linalg.norm(ahead)
        self.axes = np.stack((ahead @ plane, np.array([-ahead[1], ahead[0]]) @ plane))

    def changes(self, back: FloatArray) -> list[CircleCrossing]:
        """The sign changes of the condition, those farthest from the direction of back first.

        The one nearest to it, where the curve came from, is left out. Empty if a part of the circle has no
        solution.
        """
        way = self.axes @ ((back - self.z) / self.scale)
        came = float(np.arctan2(way[1], way[0]))
        closest, widest = self.options.min_angle, self.options.max_angle
        aside = np.append(np.geomspace(closest, widest, 6), np.arange(2.0 * widest, np.pi, 0.25))
        angles = came + np.concatenate((aside, 2.0 * np.pi - aside[::-1], [2.0 * np.pi + closest]))
        values = np.array([self.special(angle) for angle in angles])
        if not np.isfinite(values).all():
            return []
        try:
            found = [
                self._change(angles[i], angles[i + 1], float(np.abs(values).max()))
                for i in np.flatnonzero(values[:-1] * values[1:] < 0.0)
            ]
        except ValueError:  # from brentq, at an angle without a solution
            return []
        found.sort(key=lambda one: float(np.cos(one.angle - came)))
        return found[:-1]

    def special(self, angle: float) -> float:
        """Value of the special-point condition at an angle."""
        return self.at(angle)[1]

    def at(self, angle: float) -> tuple[FloatArray, float]:
        """The point at an angle (0 is straight ahead), and the condition there; NaN without a solution.

        Newton's method moves it normal to the plane of the circle.
        """
        z = self.z + self.radius * self.scale * (np.array([np.cos(angle), np.sin(angle)]) @ self.axes)
        for _ in range(self.options.max_iterations):
            try:
                residual, matrix, special = self.problem.surface(z)
                step = np.linalg.solve(np.concatenate((matrix, self.axes)), np.append(-residual, (0.0, 0.0)))
            except np.linalg.LinAlgError:  # the response has no unique tangent there
                break
            if np.linalg.norm(step) < self.options.tolerance:
                return z, special
            z = z + self.scale * step
        return z, np.nan

    def _change(self, low: float, high: float, most: float) -> CircleCrossing:
        """The sign change of the condition between two angles."""
        angle = float(
            brentq(
                self.special, low, high, xtol=self.options.angle_tolerance, rtol=self.options.angle_tolerance
            )
        )
        sides = [self.at(angle + side * self.options.angle_tolerance) for side in (-1.0, 1.0)]
        jump = max(abs(special) for _, special in sides) > self.options.jump_fraction * most
        return CircleCrossing(angle, self.at(angle)[0], jump)
