"""Points of the curve of periodic solutions: corrected onto it, with its direction and orientation there.

The unknowns are z = (q, q', f, omega), without the friction forces that are always zero; every length is in
units of a scale, the size of the motion and the range of frequencies. The equations are the closure of one
period. They are continuous, and smooth but for the surfaces on which regimes begin.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fcm.motion.errors import SimulationError
from fcm.orbit.periodic import TOLERANCE
from fcm.orbit.shooting import Shooting, Shot
from fcm.scene.model import FloatArray, Scene

MOST_CORRECTIONS = 8
ROUGH = 100.0  # times TOLERANCE: closed as well as rounding lets it, if no step improves it


@dataclass(frozen=True)
class Point:
    """A periodic solution with the direction of the curve; all (unknown + 1,), the frequency last."""

    z: FloatArray
    scale: FloatArray
    tangent: FloatArray  # unit vector in units of scale
    orientation: float  # sign of the determinant of the equations bordered by the tangent
    shot: Shot


class Equations:
    """The closure of one period of a scene."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.span = scene.frequency_range[1] - scene.frequency_range[0]
        self.shooting = Shooting(scene)
        self.free = self.shooting.free

    @property
    def periods(self) -> int:
        """How many periods have been computed."""
        return self.shooting.periods

    def shot(self, z: FloatArray) -> Shot | None:
        """The period from z; None where there is none."""
        if not (np.isfinite(z).all() and z[-1] > 0.0):
            return None
        try:
            return self.shooting.residual(z[:-1], float(z[-1]))
        except SimulationError:
            return None

    def scale(self, shot: Shot) -> FloatArray:
        """Units in which the curve is measured: the size of the motion, the range of frequencies.

        Velocities are in units of displacement times the mode's own frequency, so that the higher harmonics
        count by their displacements.
        """
        system, scale = shot.system, shot.scale.copy()
        y = shot.segments.largest()
        rates = np.maximum(self.scene.modal.frequency, system.omega)
        length = max(y[system.q].max(), (y[system.p] / rates).max(), 1e-300)
        scale[system.q], scale[system.p] = length, length * rates
        return np.append(scale[self.free] * np.sqrt(self.free.size), self.span)

    def bordered(self, shot: Shot, scale: FloatArray, row: FloatArray) -> FloatArray:
        """The derivative of the closure bordered by a row, in units of scale."""
        by_state = shot.by_state[np.ix_(self.free, self.free)]
        columns = np.column_stack((by_state, shot.by_frequency[self.free]))
        return np.vstack((columns * scale / scale[:-1, None], row))

    def correct(
        self, guess: FloatArray, scale: FloatArray, row: FloatArray, within: float = np.inf
    ) -> Point | None:
        """The point of the curve in the plane through a guess whose normal is row, in units of scale.

        None if Newton's method does not find it, or finds none within that distance of the guess.
        """
        z, before = guess, np.inf
        for _ in range(MOST_CORRECTIONS):
            shot = self.shot(z)
            if shot is None:
                return None
            closed = shot.residual <= TOLERANCE or 0.5 * before < shot.residual <= ROUGH * TOLERANCE
            right = np.zeros((z.size, 2))
            right[:-1, 0] = -shot.gap[self.free] / scale[:-1]
            right[-1] = row @ ((guess - z) / scale), 1.0
            matrix = self.bordered(shot, scale, row)
            solution = _solved(matrix, right)
            away = _distance(z, guess, scale)
            if solution is None or away > (within if closed else 2.0 * within):
                return None
            if closed:
                tangent = solution[:, 1] / np.linalg.norm(solution[:, 1])
                return Point(z, scale, tangent, float(np.linalg.slogdet(matrix)[0]), shot)
            z, before = z + solution[:, 0] * scale, shot.residual
        return None

    def direction(
        self, z: FloatArray, scale: FloatArray, along: FloatArray, orientation: float
    ) -> FloatArray | None:
        """Direction with that orientation of the curve through z, or near it; along is not normal to it."""
        shot = self.shot(z)
        if shot is None:
            return None
        matrix = self.bordered(shot, scale, along)
        solution = _solved(matrix, np.eye(z.size)[:, -1:])
        if solution is None:
            return None
        # the sign of the determinant is that with the direction itself as the row
        sense = float(np.linalg.slogdet(matrix)[0]) * orientation
        direction: FloatArray = sense * solution[:, 0] / np.linalg.norm(solution)
        return direction


def rescaled(equations: Equations, point: Point) -> Point:
    """The same point in units of its own motion."""
    scale = equations.scale(point.shot)
    tangent = point.tangent * point.scale / scale
    return replace(point, scale=scale, tangent=tangent / np.linalg.norm(tangent))


def level(size: int, sense: float = 1.0) -> FloatArray:
    """The row that keeps the frequency."""
    row = np.zeros(size)
    row[-1] = sense
    return row


def _distance(z: FloatArray, other: FloatArray, scale: FloatArray) -> float:
    return float(np.linalg.norm((z - other) / scale))


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray | None:
    """The solution of a linear system; None where it has none."""
    try:
        solution = np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        return None
    return solution if np.isfinite(solution).all() else None
