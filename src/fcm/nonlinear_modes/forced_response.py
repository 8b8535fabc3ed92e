r"""Response near a resonance from a nonlinear mode (single nonlinear mode theory).

Near a resonance the motion is that of the mode, with the frequency omega and the damping ratio D that it has
at the amplitude a. Forces at the frequency W with the modal force p = |sum_i conj(Q_i) F_i| give

    |omega^2 - W^2 + 2 i D omega W| a = p

This is exact for a linear structure with one mode, and accurate if no other mode is near.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from fcm.continuation import Path, Segment
from fcm.model.scene import FloatArray
from fcm.nonlinear_modes.backbone import Mode, mode_at


def modal_force(mode: Mode) -> FloatArray:
    """Modal force p (point,) of the scene's forces at level 1, at the mode's own omega."""
    first, dofs = mode.system.harmonics.index(1), mode.system.linear.dofs
    total = np.zeros(mode.omega.size, dtype=np.complex128)
    for force in mode.system.scene.forces:
        on_mode = mode.Q[:, first].conj() @ (dofs @ force.direction)
        total += on_mode * force.amplitude * mode.omega**force.power * np.exp(1j * force.phase)
    return np.abs(total)


def resonant_level(mode: Mode) -> FloatArray:
    """Force level (point,) at which the resonance, the maximum of a, has the amplitude of the point.

    It is 2 D omega^2 sqrt(1 - D^2) a / p; infinite if the scene's forces have no modal force.
    """
    D = np.clip(mode.damping, 0.0, 1.0)
    need = 2.0 * D * mode.omega**2 * np.sqrt(1.0 - D * D) * mode.amplitude
    force = modal_force(mode)
    return np.where(force > 0.0, need / np.where(force > 0.0, force, 1.0), np.inf)


def flanks(mode: Mode, level: float = 1.0) -> FloatArray:
    """Frequencies W (point, 2) below and above resonance at which forces of a level give the amplitude.

    NaN where no frequency gives it.
    """
    square, D = mode.omega**2, mode.damping
    middle = square * (1.0 - 2.0 * D * D)
    under = (level * modal_force(mode) / mode.amplitude) ** 2 - (2.0 * D * square) ** 2 * (1.0 - D * D)
    half = np.sqrt(np.where(under >= 0.0, under, np.nan))
    both = np.stack((middle - half, middle + half), axis=1)
    found: FloatArray = np.sqrt(np.where(both > 0.0, both, np.nan))
    return found


def resonances(mode: Mode, level: float = 1.0) -> Mode | None:
    """The points of the mode at which it is in resonance with forces of a level; None if there are none."""
    return _where(mode, resonant_level, level)


def at_amplitude(mode: Mode, amplitude: float) -> Mode | None:
    """The points of the mode with a modal amplitude; None if the mode does not reach it."""
    return _where(mode, lambda one: one.amplitude, amplitude)


def _where(mode: Mode, quantity: Callable[[Mode], FloatArray], value: float) -> Mode | None:
    """The points at which a quantity of the mode has a value; None if there are none."""
    along = quantity(mode)
    if not along.size:
        return None
    above, last = along > value, along.size - 2
    at_end = np.isclose(along[[0, -1]], value, rtol=mode.problem.options.same_end, atol=0.0)
    z = [mode.path.z[i] for i in (0, -1) if at_end[i]]
    for i in np.flatnonzero(above[1:] != above[:-1]).tolist():
        if not (i == 0 and at_end[0]) and not (i == last and at_end[1]):
            found = _between(mode, i, quantity, value)
            z += [] if found is None else [found]
    return _points(mode, np.array(z)) if z else None


def _between(mode: Mode, i: int, quantity: Callable[[Mode], FloatArray], value: float) -> FloatArray | None:
    """Point of the mode between two neighbours at which a quantity has a value; None if there is none."""
    curve = Segment(mode.problem, mode.path, i)

    def off(part: float) -> float:
        if not 0.0 < part < 1.0:
            return float(quantity(mode)[i + round(part)] - value)
        if not curve.find(part):
            raise ArithmeticError
        return float(quantity(_points(mode, curve.z[None]))[0] - value)

    try:
        curve.find(float(brentq(off, 0.0, 1.0, xtol=mode.problem.options.resonance)))
    except ArithmeticError:  # no such point of the curve
        return None
    return curve.z


def _points(mode: Mode, z: FloatArray) -> Mode:
    none = np.zeros(len(z))
    path = Path(z, np.zeros_like(z), none.astype(np.int64), none, mode.path.status, 0)
    return mode_at(mode.system, mode.problem, path)
