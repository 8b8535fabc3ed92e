"""Floquet multipliers of any solution of a system; the last workspace is used again."""

from __future__ import annotations

import threading

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.hill import HillMultipliers
from fcm.stability.multipliers import Multipliers
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.quasi_static_modes import quasi_static_modes

ComplexArray = npt.NDArray[np.complex128]


class _LastMultipliers(threading.local):
    """The workspace for multipliers that each thread used last, with its key."""

    def __init__(self) -> None:
        self.key: tuple[object, ...] = ()
        self.multipliers: Multipliers | None = None


_WORKSPACES = _LastMultipliers()


def multipliers_of(
    system: System, highest: float, options: StabilityOptions = STABILITY
) -> Multipliers | HillMultipliers:
    """The workspace that computes the multipliers of a system's solutions.

    The system may be a structure or a sector of a ring. The last workspace is used again if it is small and
    only the contacts differ, as in a sweep. If a contact has a law of its own, Hill's method is used.
    """
    if system.own_laws:
        return HillMultipliers(system, options)
    if system.scene.ring is not None:
        from fcm.stability.ring_multipliers import RingMultipliers

        return RingMultipliers(system, highest, options=options)
    linear = system.linear
    if 2 * linear.natural.size + len(system.scene.contacts) > options.structure.max_cached:
        return Multipliers(system, highest, options=options)
    far = quasi_static_modes(linear.natural, highest, system.harmonics, system.scene.planar, options)
    key = (*linear.numbers, system.harmonics, options, far.tobytes())
    if _WORKSPACES.multipliers is None or _WORKSPACES.key != key:
        _WORKSPACES.key, _WORKSPACES.multipliers = key, Multipliers(system, highest, options=options)
    _WORKSPACES.multipliers.take(system)
    return _WORKSPACES.multipliers


def multipliers(system: System, z: FloatArray, options: StabilityOptions = STABILITY) -> ComplexArray:
    """Floquet multipliers of a solution, the greatest first.

    Parameters
    ----------
    system : System
    z : (unknown + 1,)
        A point of a path: displacements of the contacts, and the frequency [rad/s].
    options : StabilityOptions, optional
        Tolerances and limits.

    Returns
    -------
    (multiplier,) complex array
        Factors by which small disturbances of the motion grow within one period. Disturbed are the modal
        displacements and velocities, and the memory of contacts that stick when the period begins. Contacts
        that never slip keep their memory, which is not listed. Empty if a number is not finite.

    Notes
    -----
    In a structure with more than 24 modes, some follow the contacts without delay, and have no multipliers:
    those above 6 times the excitation and 1.5 times the highest harmonic of the balance. Their share of the
    flexibility is then wrong by (omega_disturbance / omega_mode)^2.

    Examples
    --------
    >>> import fcm
    >>> from fcm.branches.force_level import solutions
    >>> system = System(fcm.load_scene("yang1998-n5"), (1, 2, 3))
    >>> (z,) = solutions(system, 1.3).solutions
    >>> abs(multipliers(system, z)).max().round(2)
    np.float64(0.88)
    """
    values = multipliers_of(system, float(z[-1]), options).of(np.ascontiguousarray(z, dtype=np.float64))
    return np.array(sorted(values or [], key=abs, reverse=True), dtype=np.complex128)
