"""Shooting: the closure of the motion over one period, and its derivatives."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Scene, has_friction
from fcm.shooting.floquet_multipliers import floquet_of
from fcm.shooting.period_derivative import period_derivative
from fcm.shooting.residual_traction import Choice, one_sided_slips, resting, stuck_of, traction_choices
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import Displaced, Scanned, displaced, scanned
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.flow import STICKING
from fcm.time_domain.simulation import march_from
from fcm.time_domain.state import State


class Shot:
    """The motion over some periods from x = (q, q', f), and its closure.

    Parameters
    ----------
    system : EquationsOfMotion
    x : (unknown,)
    resting : (contact,), optional
        Wanted slip motions w of contacts that always stick; by default they are free.
    periods : int
        Periods of the force after which the motion is to repeat.
    """

    def __init__(
        self, system: EquationsOfMotion, x: FloatArray, resting: FloatArray | None = None, periods: int = 1
    ) -> None:
        self.system, self.x, self.resting, self.periods = system, x, resting, periods
        self.duration = periods * system.period  # [s]
        self.segments, end = march_from(system, x, self.duration)
        self.closure, self.chosen = end[: system.unknowns] - x, list[Choice]()
        self._derivatives: tuple[FloatArray, FloatArray, FloatArray] | None = None
        if resting is not None:
            self._choose(resting)

    def _choose(self, resting: FloatArray) -> None:
        """Replace the closure of contacts that always stick by the distance from their chosen w."""
        first, seen = self.system.f.start, self.segments.seen()
        self.chosen = traction_choices(self.system, self.segments, resting, stuck_of(self.system, seen))
        for choice in self.chosen:
            self.closure[first + choice.contact] = choice.gap
        for contact, missing in one_sided_slips(self.system, self.segments, seen):
            self.closure[first + contact] -= missing

    @cached_property
    def scale(self) -> FloatArray:
        """Size (unknown,) of each entry of x."""
        scale: FloatArray = self.segments.scale(self.system.per_unit, self.system.tuned())
        return scale

    @cached_property
    def residual(self) -> float:
        """The closure error, relative to the size of the motion."""
        return float(np.abs(self.closure / self.scale).max(initial=0.0))

    @property
    def state(self) -> State:
        """State at the start of the motion."""
        system = self.system
        return State(self.x[system.q], self.x[system.p], self.x[system.f])

    @property
    def cycle(self) -> Cycle:
        """The motion over the periods as one cycle."""
        return Cycle(self.system, 0.0, self.duration, 0.0, self.segments)

    @cached_property
    def sequence(self) -> bytes:
        """States of the contacts in each segment: the closure is smooth while they stay the same."""
        return np.asarray(self.segments.states).tobytes()

    @property
    def derivative(self) -> FloatArray:
        """Derivative of the state after the period by x: (unknown, unknown)."""
        return self._differentiated()[0]

    @property
    def by_state(self) -> FloatArray:
        """Derivative of the closure by x: (unknown, unknown)."""
        return self._differentiated()[1]

    @property
    def by_parameter(self) -> FloatArray:
        """Derivative of the closure by the frequency or by the level of the forces: (unknown,)."""
        return self._differentiated()[2]

    def _differentiated(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Derivatives of the end of the motion, of the closure, and by the parameter; computed once."""
        if self._derivatives is None:
            end, rate = period_derivative(self.system, self.segments, self.duration)
            gap, first = end.copy(), self.system.f.start
            gap.reshape(-1)[:: self.x.size + 1] -= 1.0
            for choice in self.chosen:
                gap[first + choice.contact], rate[first + choice.contact] = choice.row, choice.rate
            self._derivatives = end, gap, rate
        return self._derivatives

    @cached_property
    def scanned(self) -> Scanned:
        """Extremes of all reported quantities of the motion."""
        return scanned(self.system, self.segments)

    @cached_property
    def extremes(self) -> Displaced:
        """Least and greatest displacement of each degree of freedom."""
        return displaced(self.system, self.segments)

    @property
    def amplitude(self) -> FloatArray:
        """Amplitude of each degree of freedom, half the peak-to-peak: (dof,)."""
        half: FloatArray = 0.5 * (self.extremes.greatest - self.extremes.least)
        return half

    @cached_property
    def held_distances(self) -> FloatArray:
        """Relative distance (held,) of each held contact from its slip limit, or from closing.

        Negative if it passes the limit.
        """
        least, greatest = self.scanned.part(self.system.parts.limits)
        most = greatest[::3]
        share: FloatArray = least.reshape(-1, 3).min(axis=1) / np.where(most > 0.0, most, 1.0)
        return share

    @cached_property
    def other_multipliers(self) -> npt.NDArray[np.complex128]:
        """Floquet multipliers without the trivial ones of contacts.

        These are 1 for a contact that always sticks (its w stays), and for one that stays closed without
        friction (its f = 0 stays); and 0 for a slider that forgets its position.
        """
        return floquet_of(self.system).multipliers(self.segments, self.duration)

    @cached_property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """All Floquet multipliers, the greatest first; with the 1 and 0 of `other_multipliers`."""
        values = np.zeros(self.x.size, dtype=np.complex128)
        ones = sum(states == 1 << STICKING for states in self.segments.seen())
        values[: self.other_multipliers.size] = self.other_multipliers
        values[self.other_multipliers.size : self.other_multipliers.size + ones] = 1.0
        return values[np.argsort(-np.abs(values), kind="stable")]


class Shooting:
    """Periodic motions of a scene as roots of a residual, at any frequency.

    With several periods these are the motions that repeat after this number or after a divisor of it.

    The unknowns are (q, q', f) at the forces' angle 0, without friction forces that are always zero; `free`
    has their indices. The residual is continuous, and smooth while the sequence of states stays the same.

    Examples
    --------
    >>> import fcm
    >>> from fcm.shooting import periodic
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> problem, orbit = Shooting(scene), periodic(scene, 1.3)
    >>> shot = problem.residual(problem.unknowns(orbit.state), 1.3)
    >>> shot.by_state.shape, shot.by_parameter.shape, bool(shot.residual < 1e-11)
    ((5, 5), (5,), True)
    """

    def __init__(self, scene: Scene, periods: int = 1) -> None:
        self.scene, self.resting, self.each = scene, resting(scene), periods
        carries = np.array([has_friction(contact) for contact in scene.contacts], dtype=bool)
        self.free = np.flatnonzero(np.concatenate((np.ones(2 * scene.modal.mass.size, dtype=bool), carries)))
        self.size = 2 * scene.modal.mass.size + len(scene.contacts)
        self.periods = 0  # number of periods computed
        self._system: EquationsOfMotion | None = None

    def system(self, omega: float) -> EquationsOfMotion:
        """The system of the scene at a frequency [rad/s]."""
        if self._system is None or self._system.omega != omega:
            self._system = (
                EquationsOfMotion(self.scene, omega) if self._system is None else self._system.at(omega)
            )
        return self._system

    def unknowns(self, state: State) -> FloatArray:
        """The unknowns of a state at the forces' angle 0."""
        whole: FloatArray = np.concatenate((state.q, state.velocity, state.friction))
        return whole[self.free]

    def residual(
        self, unknowns: FloatArray, omega: float, level: float = 1.0, by_level: bool = False
    ) -> Shot:
        """The shot from a state at a frequency and a level of the forces, which may be the parameter.

        Raises
        ------
        SimulationError
            If the period cannot be computed.
        """
        x = np.zeros(self.size)
        x[self.free] = unknowns
        self.periods += self.each
        system = self.system(omega)
        if level != 1.0 or by_level:
            system = system.at_level(level, by_level)
        return Shot(system, x, self.resting, self.each)
