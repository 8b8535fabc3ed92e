"""Points of the curve of periodic solutions: corrected onto it, with its direction and orientation there.

The unknowns are z = (q, q', f, omega), without the friction forces that are always zero; every length is in
units of a scale, the size of the motion and the range of frequencies. The equations are the closure of one
period. They are continuous, and smooth but for the surfaces on which regimes begin.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fcm.scene.model import FloatArray, Scene
from fcm.simulate.errors import SimulationError
from fcm.simulate.periodic import TOLERANCE, Shot
from fcm.simulate.system import System, has_friction

MOST_CORRECTIONS = 8
ROUGH = 100.0  # times TOLERANCE: closed as well as rounding lets it, if no step improves it
FREQUENCY_STEP = 1e-7  # of the difference quotient by frequency, relative
KEPT_SYSTEMS = 4
MOVED = 1e-3  # distance over which that quotient serves Newton's method


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
        modes, contacts = scene.modal.mass.size, len(scene.contacts)
        carries = np.array([has_friction(contact) for contact in scene.contacts], dtype=bool)
        self.free = np.flatnonzero(np.concatenate((np.ones(2 * modes, dtype=bool), carries)))
        self.size = 2 * modes + contacts
        self._systems: dict[float, System] = {}
        self.periods = 0  # that have been computed

    def shot(self, z: FloatArray) -> Shot | None:
        """The period from z; None where there is none."""
        if not (np.isfinite(z).all() and z[-1] > 0.0):
            return None
        x = np.zeros(self.size)
        x[self.free] = z[:-1]
        self.periods += 1
        try:
            return Shot(self._system(float(z[-1])), x, choose=True)
        except SimulationError:
            return None

    def _system(self, omega: float) -> System:
        """The scene at a frequency; the last few are kept, for Newton's method while it is held."""
        if omega not in self._systems:
            if len(self._systems) == KEPT_SYSTEMS:
                del self._systems[next(iter(self._systems))]
            self._systems[omega] = System(self.scene, omega)
        return self._systems[omega]

    def unknowns(self, shot: Shot) -> FloatArray:
        """z of a shot."""
        return np.append(shot.x[self.free], shot.system.omega)

    def scale(self, shot: Shot) -> FloatArray:
        """Units in which the curve is measured: the size of the motion, the range of frequencies.

        Velocities are in units of displacement times the mode's own frequency, so that the higher harmonics
        count by their displacements.
        """
        system, scale = shot.system, shot.scale.copy()
        y = np.abs([segment.y for segment in shot.segments]).max(axis=0)
        rates = np.maximum(self.scene.modal.frequency, system.omega)
        length = max(y[system.q].max(), (y[system.p] / rates).max(), 1e-300)
        scale[system.q], scale[system.p] = length, length * rates
        return np.append(scale[self.free] * np.sqrt(self.free.size), self.span)

    def by_frequency(self, shot: Shot) -> FloatArray:
        """Derivative of the closure by the frequency, on the shot's own side of a corner: (unknown,)."""
        rate, z = np.zeros(self.free.size), self.unknowns(shot)
        for sense in (1.0, -1.0):
            delta = np.zeros_like(z)
            delta[-1] = sense * FREQUENCY_STEP * z[-1]
            near = self.shot(z + delta)
            if near is not None:
                rate = (near.gap - shot.gap)[self.free] / delta[-1]
                if _sequence(near) == _sequence(shot):
                    break
        for choice in shot.chosen:
            if not choice.limited:  # w = 0 at every frequency, though the neighbour may just slip
                rate[np.searchsorted(self.free, 2 * shot.system.modes + choice.contact)] = 0.0
        return rate

    def bordered(self, shot: Shot, rate: FloatArray, scale: FloatArray, row: FloatArray) -> FloatArray:
        """The derivative of the closure, with the rate by frequency, bordered by a row; in units of scale."""
        columns = np.column_stack((shot.closure[np.ix_(self.free, self.free)], rate))
        return np.vstack((columns * scale / scale[:-1, None], row))

    def correct(
        self, guess: FloatArray, scale: FloatArray, row: FloatArray, within: float = np.inf
    ) -> Point | None:
        """The point of the curve in the plane through a guess whose normal is row, in units of scale.

        None if Newton's method does not find it, or finds none within that distance of the guess.
        """
        z, before = guess, np.inf
        rate = np.zeros(guess.size - 1)  # by frequency; not needed while that is held
        known: FloatArray = guess  # where the rate is from
        regimes: list[str] = []
        for _ in range(MOST_CORRECTIONS):
            shot = self.shot(z)
            if shot is None:
                return None
            z = self.unknowns(shot)
            closed = shot.residual <= TOLERANCE or 0.5 * before < shot.residual <= ROUGH * TOLERANCE
            old = regimes != _sequence(shot) or _distance(z, known, scale) > (0.0 if closed else MOVED)
            if old and (closed or row[:-1].any()):
                rate, known, regimes = self.by_frequency(shot), z, _sequence(shot)
            right = np.zeros((z.size, 2))
            right[:-1, 0] = -shot.gap[self.free] / scale[:-1]
            right[-1] = row @ ((guess - z) / scale), 1.0
            matrix = self.bordered(shot, rate, scale, row)
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
        matrix = self.bordered(shot, self.by_frequency(shot), scale, along)
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


def _sequence(shot: Shot) -> list[str]:
    return [segment.states for segment in shot.segments]


def _distance(z: FloatArray, other: FloatArray, scale: FloatArray) -> float:
    return float(np.linalg.norm((z - other) / scale))


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray | None:
    """The solution of a linear system; None where it has none."""
    try:
        solution = np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        return None
    return solution if np.isfinite(solution).all() else None
