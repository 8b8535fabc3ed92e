r"""Continues a curve of special points past a point at which its equations have a kink.

The solutions of the balance at all frequencies and values of s are a surface, and the condition of a special
point is zero along lines on it. Where a contact begins to slip, open or close within its cycle, the slopes of
its forces jump, or change as a root does, and so does that condition. The line then goes on in another
direction, or along the jump, which no derivative on this side of the kink predicts. So the changes of its
sign are looked for on a small circle on the surface about the point. One is where the curve came from,
another is where it goes on.
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
        """All changes of sign of the condition but that nearest to the way back, the furthest from it first.

        None where there is no motion on a part of the circle.
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
        except ValueError:  # of the search for a zero, at an angle where there is no motion
            return []
        found.sort(key=lambda one: float(np.cos(one.angle - came)))
        return found[:-1]

    def special(self, angle: float) -> float:
        """Value of the special-point condition at an angle."""
        return self.at(angle)[1]

    def at(self, angle: float) -> tuple[FloatArray, float]:
        """The point at an angle, 0 is straight ahead, and the condition there; NaN where there is none.

        It is sought across the plane of the circle.
        """
        z = self.z + self.radius * self.scale * (np.array([np.cos(angle), np.sin(angle)]) @ self.axes)
        for _ in range(self.options.max_iterations):
            try:
                residual, matrix, special = self.problem.surface(z)
                step = np.linalg.solve(np.concatenate((matrix, self.axes)), np.append(-residual, (0.0, 0.0)))
            except np.linalg.LinAlgError:  # the response has no one direction there
                break
            if np.linalg.norm(step) < self.options.tolerance:
                return z, special
            z = z + self.scale * step
        return z, np.nan

    def _change(self, low: float, high: float, most: float) -> CircleCrossing:
        """The change of sign of the condition between two angles."""
        angle = float(
            brentq(
                self.special, low, high, xtol=self.options.angle_tolerance, rtol=self.options.angle_tolerance
            )
        )
        sides = [self.at(angle + side * self.options.angle_tolerance) for side in (-1.0, 1.0)]
        jump = max(abs(special) for _, special in sides) > self.options.jump_fraction * most
        return CircleCrossing(angle, self.at(angle)[0], jump)
