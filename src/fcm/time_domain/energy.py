"""The energy balance of a motion: work of the forces, dissipation and stored energy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.model.scene import Contact, FloatArray
from fcm.time_domain.constant_matrices import sines_and_cosines
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.measures import Powers
from fcm.time_domain.state import entry
from fcm.time_domain.trajectory import Motion


class Energy(NamedTuple):
    """Energy balance over a motion: `work` = `slip` + `damping` + `stored`, up to rounding."""

    work: float  # of the external forces
    slip: float  # dissipated by friction, integral of f dw
    damping: float  # dissipated by the modes
    stored: float  # change of the kinetic and elastic energy, contacts included
    turnover: float  # integral of the magnitudes of all powers, to which the error is relative

    @property
    def error(self) -> float:
        """Imbalance of the energy relative to the turnover; absolute if the turnover is 0."""
        missing = abs(self.work - self.slip - self.damping - self.stored)
        return missing / self.turnover if self.turnover > 0.0 else missing


def energy(motion: Motion) -> Energy:
    """Energy balance over a motion, by Gauss quadrature that is exact to rounding.

    Examples
    --------
    >>> import fcm
    >>> from fcm.time_domain import simulate
    >>> balance = energy(simulate(fcm.load_scene("yang1998-n5"), 1.3, 10))
    >>> balance.slip > 0 and balance.error < 1e-12
    True
    """
    work = slip = damping = turnover = 0.0
    for cycle in motion.cycles:
        parts = powers_of(cycle)
        work, slip, damping = work + parts.work, slip + parts.slip, damping + parts.damping
        turnover += parts.turnover
    first, last = motion.cycles[0], motion.cycles[-1]
    end, _ = entry(last.system, motion.end)
    stored = _stored(last.system, end) - _stored(first.system, np.asarray(first.segments.y)[0])
    return Energy(work, slip, damping, stored, turnover + abs(stored))


def powers_of(cycle: Cycle) -> Powers:
    """Integrals over a cycle of the powers of forces, slip and damping."""
    system, modal = cycle.system, cycle.system.scene.modal
    damper = 2.0 * modal.mass * modal.damping * modal.frequency
    powers = Powers(system.flows, sines_and_cosines(system.wave), system.static, damper)
    system.run(powers, cycle.segments)
    return powers


def _stored(system: EquationsOfMotion, y: FloatArray) -> float:
    """Kinetic and elastic energy and the potential of the preload, without energy dissipated by slip."""
    modal = system.scene.modal
    q, p = y[system.q], y[system.p]
    total = 0.5 * float(modal.mass @ (p * p + (modal.frequency * q) ** 2))
    for j, (contact, f, n) in enumerate(zip(system.contacts, y[system.f], system.loads(y), strict=True)):
        total += 0.5 * f * f / contact.k_u if contact.k_u > 0.0 else 0.0
        total += _normal_energy(contact, float(system.normal[j] @ q), float(n))
    return float(total)


def _normal_energy(contact: Contact, v: float, n: float) -> float:
    """Potential of the normal force max(n, 0) - max(n_0, 0) as a function of v, 0 at v = 0."""
    if contact.k_v == 0.0:
        return 0.0
    if contact.n_0 <= 0.0:
        return 0.5 * max(n, 0.0) ** 2 / contact.k_v
    if n >= 0.0:
        return 0.5 * contact.k_v * v * v
    return -contact.n_0 * (0.5 * contact.n_0 / contact.k_v + v)
