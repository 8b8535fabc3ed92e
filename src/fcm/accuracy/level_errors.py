"""Errors and stability of the points of a curve over the force level.

A solution at a force level is also one at the level 1 of forces as many times as large. Its stability depends
only on its motion. Its error is found by balancing the harmonics left out, too, at the same frequency and
level.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.accuracy.contact_load_errors import relative
from fcm.accuracy.options import PAIR, VALIDITY, PairOptions
from fcm.accuracy.reference_harmonics import reference_harmonics
from fcm.harmonic_balance.contact_cycles import contact_loads_along
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.residual_spectrum import FurtherHarmonics
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.floquet import multipliers_of


class LevelPoints(NamedTuple):
    """Points of a curve over the force level.

    z (point, unknown + 1), level (point,), amplitude (point, dof), contact_loads (point, contact, 4), and
    parity (point,), see `Path.parity`.
    """

    z: FloatArray
    level: FloatArray
    amplitude: FloatArray
    contact_loads: FloatArray
    parity: FloatArray


def stable_at_levels(system: System, z: FloatArray, parity: FloatArray) -> FloatArray:
    """Stability of the points z (point, unknown + 1) of a curve over the force level: 1, 0, or NaN (unknown).

    parity (point,) is that of the curve, see `Path.parity`.
    """
    if not system.scene.contacts:
        return np.ones(len(z))
    of = multipliers_of(system, float(z[:, -1].max()))
    even = parity > 0.0
    return np.array([of.classify(one).stable if here else 0.0 for one, here in zip(z, even, strict=True)])


def errors_at_levels(
    system: System, points: LevelPoints, options: PairOptions = PAIR
) -> tuple[FloatArray, FloatArray]:
    """Relative errors of amplitudes and contact loads against the reference at the same force levels.

    NaN where the reference is not found, as beside folds that it does not have there.
    """
    z, level, amplitude, contact_loads, parity = points
    further = FurtherHarmonics(system)
    error, contact_load_errors = np.zeros_like(amplitude), np.zeros_like(contact_loads)
    bent = np.flatnonzero(~further.linear(z))
    if not bent.size:
        return error, contact_load_errors
    share = further.shares(z[bent], amplitude[bent]).max(axis=0)
    more = reference_harmonics(system.harmonics, share, system.layout.ports, options)
    if more == system.harmonics:
        error[bent], contact_load_errors[bent] = np.nan, np.nan
        return error, contact_load_errors
    there, of_reference = _balanced(system, system.with_harmonics(more), z[bent], level[bent], parity[bent])
    now, size = amplitude[bent], amplitude[bent].max(axis=1, keepdims=True)
    change = np.abs(there - now)
    far = (change > VALIDITY.max_change * size).any(axis=1)
    change[far], of_reference[far] = np.nan, np.nan
    error[bent] = change / np.where(now > 0.0, now, 1.0)
    contact_load_errors[bent] = relative(
        of_reference - contact_loads[bent], contact_loads[bent], contact_loads.max(axis=0), options
    )
    return error, contact_load_errors


def _balanced(
    system: System, finer: System, z: FloatArray, level: FloatArray, parity: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Amplitudes (point, dof) and contact loads (point, contact, 4) balanced with the harmonics of `finer`.

    NaN where Newton's method finds no solution whose number of real multipliers above 1 has the parity of the
    point.
    """
    raised, front = finer.level_problem
    newton, found = front.newton, np.zeros((len(z), raised.unknowns + 1))
    known = np.zeros(len(z), dtype=np.bool_)
    for i, one in enumerate(z):
        raised.begin(float(one[-1]))
        newton.z[:] = finer.extended(one, system.harmonics)
        newton.z[-1] = level[i]
        raised.evaluate_scale(newton.z)
        newton.scale[:] = raised.scale
        newton.row[:] = 0.0
        newton.row[-1] = 1.0
        even = parity[i] > 0.0
        known[i] = newton.correct(1.0) and (newton.orientation * np.sign(newton.tangent[-1]) > 0.0) == even
        found[i] = newton.z
        found[i, -1] = one[-1]
    amplitude = reported_at(finer, found, level=level).amplitude
    contact_loads = contact_loads_along(finer, found)
    amplitude[~known], contact_loads[~known] = np.nan, np.nan
    return amplitude, contact_loads
