"""Periodic motions as a continuation problem: the closure of one period of the exact motion."""

from __future__ import annotations

from typing import TYPE_CHECKING
from zlib import crc32

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import solution_near
from fcm.continuation.problem import Problem
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.period_derivative import displacement_rates
from fcm.shooting.residual import Shooting, Shot
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State

if TYPE_CHECKING:
    from fcm.shooting.orbit_record import OrbitRecord


def correct_at_frequency(newton: Newton, z: FloatArray, reach: float = 1.0) -> bool:
    """Correct z by Newton's method at its frequency; return whether it converges. newton.z has the result."""
    if solution_near(newton, z, reach=reach) is None:
        return False
    newton.z[-1] = z[-1]
    return True


class OrbitProblem(Problem):
    """The closure of one period, z = (q, q', f, omega) at the forces' angle 0, without f that are always 0.

    The residual is that of `Shooting`: continuous, and smooth while the sequence of states over the period
    stays the same. This sequence is the label of a point. Most changes of it hardly affect the curve; where a
    new slip begins, the curve may have a corner.

    Parameters
    ----------
    scene : Scene
        The width of its `frequency_range` is the unit of frequencies.
    repeats : int
        Periods of the force after which the motion closes.
    options : ShootingOptions, optional
        Tolerances and limits of all computations with the problem.

    Examples
    --------
    >>> import numpy as np
    >>> import fcm
    >>> from fcm.shooting import periodic
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> problem, orbit = OrbitProblem(scene), periodic(scene, 1.3)
    >>> problem.evaluate(problem.z(orbit.state, 1.3))
    0
    >>> bool(abs(np.asarray(problem.residual)).max() < 1e-9), problem.jacobian.shape
    (True, (5, 6))
    """

    def __init__(self, scene: Scene, repeats: int = 1, options: ShootingOptions = SHOOTING) -> None:
        self.options = options
        self.scene, self.shooting, self.repeats = scene, Shooting(scene, repeats), repeats
        self.free = self.shooting.free
        super().__init__(self.free.size, 1, len(scene.modal.dofs))
        self.labelled = True
        self.span = scene.frequency_range[1] - scene.frequency_range[0]
        self.periods = 0  # number of periods computed
        self._block, self._all = np.ix_(self.free, self.free), self.free.size == self.shooting.size
        self._residual, self._jacobian = np.asarray(self.residual), np.asarray(self.jacobian)
        self._output, self._growth = np.asarray(self.output), np.asarray(self.growth)
        self._scale, self._root = np.asarray(self.scale), float(np.sqrt(self.free.size))
        self._shots: dict[bytes, Shot | None] = {}
        self._numbers = 0  # number of floats in them
        self.samples: dict[bytes, OrbitRecord] = {}  # records of points, see `recorded`
        self._rates = scene.modal.frequency

    def z(self, state: State, omega: float) -> FloatArray:
        """The unknowns of a state at the forces' angle 0, and the frequency [rad/s]."""
        return np.append(self.shooting.unknowns(state), omega)

    def shot(self, z: FloatArray) -> Shot | None:
        """The period that begins at z, cached; None if it cannot be computed."""
        z = np.asarray(z)
        key = z.tobytes()
        shot = self._shots.get(key)
        if shot is None and key not in self._shots:
            shot = self._made(z)
            if self._numbers > self.options.orbit.max_cached:
                self.forget()
            self._numbers += 0 if shot is None else int(shot.segments.y.size) + 3 * shot.x.size**2
            self._shots[key] = shot
        return shot

    @property
    def full(self) -> bool:
        """Whether the cache is so full that its periods may be dropped in the next step."""
        return 2 * self._numbers > self.options.orbit.max_cached

    def forget(self) -> None:
        """Drop all cached periods."""
        self._shots, self._numbers = {}, 0

    def _made(self, z: FloatArray) -> Shot | None:
        self.periods += self.repeats
        try:
            return self.shooting.residual(z[:-1], float(z[-1]))
        except SimulationError:
            return None

    def evaluate(self, z: FloatArray) -> int:
        """Fill residual and Jacobian at z, see `Problem`; nan if the period cannot be computed."""
        shot, jacobian = self.shot(z), self._jacobian
        if shot is None:
            jacobian[:] = self._residual[:] = np.nan
        elif self._all:
            self._residual[:], jacobian[:, :-1], jacobian[:, -1] = (
                shot.closure,
                shot.by_state,
                shot.by_parameter,
            )
        else:
            self._residual[:], jacobian[:, :-1] = shot.closure[self.free], shot.by_state[self._block]
            jacobian[:, -1] = shot.by_parameter[self.free]
        return 0

    def evaluate_residual(self, z: FloatArray) -> int:
        """Fill the residual at z, see `Problem`."""
        shot = self.shot(z)
        self._residual[:] = np.nan if shot is None else shot.closure[self.free]
        return 0

    def evaluate_scale(self, z: FloatArray) -> int:
        """Fill the units at z: the size of the motion, and the width of the frequency range.

        Units of modal velocities are those of displacements times the modes' natural frequencies, or omega if
        that is more. So higher harmonics count by their displacements.
        """
        shot = self.shot(z)
        if shot is None:
            return 0
        system, scale = shot.system, shot.scale.copy()
        rates = np.maximum(self._rates, system.omega)
        length = shot.segments.length_by(rates)
        scale[system.q], scale[system.p] = length, length * rates
        self._scale[:-1], self._scale[-1] = scale[self.free] * self._root, self.span
        return 0

    def evaluate_margins(self, z: FloatArray) -> int:
        """Fill the margin with the label of the states, see the class; unchanged without a period."""
        shot = self.shot(z)
        if shot is not None:
            self.margin[0] = _label(shot, self.options)
        return 0

    def evaluate_outputs(self, z: FloatArray, direction: FloatArray) -> int:
        """Fill the amplitudes, half the peak-to-peak, and their growth along direction.

        The rate of an extreme is that of the displacement at its instant.
        """
        shot = self.shot(z)
        output, growth = self._output, self._growth
        output[:] = growth[:] = 0.0
        if shot is None:
            return 0
        shapes = self.scene.modal.shapes
        least, greatest, places = shot.scanned.displaced
        amplitude = 0.5 * (greatest - least)
        moves = amplitude > self.options.orbit.min_amplitude * amplitude.max(initial=0.0)
        way = np.zeros(self.shooting.size)
        way[self.free] = np.asarray(direction)[:-1]
        rates = displacement_rates(shot.system, shot.segments, places, way, float(direction[-1]))
        change = 0.5 * ((rates[least.size :] - rates[: least.size]) * shapes.T).sum(axis=1)
        output[:], growth[:] = np.where(moves, amplitude, 0.0), np.where(moves, change, 0.0)
        return 0


def _label(shot: Shot, options: ShootingOptions = SHOOTING) -> float:
    """A checksum of the states over the period, from its start, and of the contacts at a slip limit.

    A transition that passes the start of the period is a corner of the friction force there only.
    """
    states = shot.segments.lasting(shot.duration, options.orbit.min_duration * shot.duration)
    limited = bytes([choice.contact for choice in shot.chosen if choice.limited])
    return float(crc32(states + limited))
