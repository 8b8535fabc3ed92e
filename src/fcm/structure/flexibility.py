"""The flexibility of the modes left out, represented by a few modes of high frequency.

Seen through loads P and displacements P^T x, the response of the modes left out is P^T (K - w^2 M)^-1 P minus
the part of the kept modes. It is sought in a block Krylov space. The first block holds the residual
attachment modes, the static displacements under P without the part of the kept modes (MacNeal, Rubin). The
next block holds the static displacements under the inertia of the first, and so on. Galerkin's method in this
space gives modes of mass 1, orthogonal to the kept ones. With b blocks the first 2 b terms of the response's
series in w^2 are exact.

The error is bounded, not estimated. Below the first mode left out, lambda_h, the operator is positive
definite on the space left out. There K - w^2 M >= (lambda_h - w^2) / (lambda_h - s) (K - s M), with the shift
s < 0 at which the stiffness is factorised. So with the residual r of Galerkin's solution u for one load p,

    0 <= error of p^T u <= r^T (K - s M)^-1 r (lambda_h - s) / (lambda_h - w^2),

and between two different loads the error is at most the geometric mean of their errors (Cauchy, Schwarz).

If all modes have the same damping ratio z, the modes left out damp as well. Their response p^T u to a load p
has the imaginary part -2 z w m_3, where m_s = sum (phi_i^T p)^2 / w_i^s over the modes left out. The modes
that represent them have the true m_2, m_4 (from two blocks on also m_6), but another m_3. The true m_3
satisfies

    m_4^(3/2) / m_6^(1/2) <= m_3 <= (m_2 m_4)^(1/2),    m_6 <= m_4 / lambda_h

(the logarithm of m_s is convex). For a resonance of the loss factor 2 z, with all of its energy there, the
relative error of the damping is at most w / m_2 times the distance of m_3 from these limits.

Rows without mass respond instantly, as no mode does. A mode at w_far, far above all frequencies of interest,
represents them; its response at w is too large by the relative amount (w / w_far)^2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.linalg

from fcm.frozen import Frozen
from fcm.structure.eigen import (
    OPTIONS,
    FactoredStructure,
    FloatArray,
    Modes,
    energy_of,
    shifted,
    unit_columns,
)
from fcm.structure.options import FLEXIBILITY, FlexibilityOptions


class Flexibility(Frozen):
    """Modes that represent those left out, and bounds of the error of their response."""

    modes: Modes
    bound: float  # of the receptance between the loads, relative to their static one; inf if there is none
    damping: float  # bound of the relative error of a resonance's damping, if all modes have one ratio


class Truncation(Frozen):
    """A structure of which only the lowest modes are kept, with the frequencies that limit its use."""

    structure: FactoredStructure
    kept: Modes
    omega: float  # [rad/s] the highest angular frequency of interest
    beyond: float  # [rad^2/s^2] squared frequency of the first mode left out: a lower limit of all of them
    options: FlexibilityOptions = FLEXIBILITY


def flexibility(truncation: Truncation, loads: FloatArray) -> Flexibility:
    """Modes that represent the response of the modes left out, under loads (row, load)."""
    truncation = _with_shift_for_static(truncation)
    structure, kept, options = truncation.structure, truncation.kept, truncation.options
    omega, beyond = truncation.omega, truncation.beyond
    basis = np.zeros((structure.rows, 0))
    outer = _without(structure, kept, loads)
    found = Flexibility(Modes(np.zeros(0), basis), np.inf, np.inf)
    rest = _residual_receptance(structure, kept, loads)
    static = _static(structure, kept, loads, rest, omega)
    highest = max(omega**2, float(kept.stiffness.max(initial=0.0)))
    far = options.massless_ratio**2 * (highest or 1.0)
    least = np.maximum(
        options.min_energy * _static(structure, kept, loads, rest, np.inf), options.min_energy**2 * static
    )
    newest = _of_energy_1(
        structure,
        _orthogonal(structure, kept, structure.static(outer, beyond, options.static_tolerance)),
        least,
    )
    for blocks in range(1, options.max_blocks + 1):
        basis = np.concatenate((basis, newest), axis=1)
        modes = _galerkin(structure, basis, far, options.min_energy)
        damping = omega * float(_damping_error(modes, outer, beyond, blocks > 1, static).max())
        bound = _receptance_error(truncation, modes, loads, static)
        if modes.stiffness.max(initial=0.0) > 0.9 * far:
            bound += omega**2 / far
        found = Flexibility(modes, bound, damping)
        if found.bound <= options.tolerance or modes.count < basis.shape[1]:
            break
        further = _orthogonal(
            structure, kept, structure.static(structure.M @ newest, beyond, options.static_tolerance)
        )
        newest = _of_energy_1(structure, further, (options.min_energy / highest) ** 2 if highest else 0.0)
    return found


def _with_shift_for_static(truncation: Truncation) -> Truncation:
    """The truncation, with another shift if static displacements would need too many corrections.

    For a small structure another shift costs nothing, while corrections lose the digits that cancel in K u.
    """
    structure, beyond, near = truncation.structure, truncation.beyond, truncation.options.static_tolerance
    number = structure.corrections(beyond, near)
    again = number > (0 if structure.rows <= OPTIONS.dense_size else OPTIONS.max_corrections)
    return replace(truncation, structure=shifted(structure, -near * beyond)) if again else truncation


def _receptance_error(truncation: Truncation, modes: Modes, loads: FloatArray, static: FloatArray) -> float:
    """Greatest error of a load's own receptance relative to `static`; inf beyond the first mode left out.

    `modes` are those that represent the modes left out.
    """
    structure, omega, beyond = truncation.structure, truncation.omega, truncation.beyond
    if omega**2 >= beyond:
        return np.inf
    outer = _without(structure, truncation.kept, loads)
    answer = modes.shapes * (1.0 / (modes.stiffness - omega**2)) @ (modes.shapes.conj().T @ outer)
    residual = outer - structure.K @ answer + omega**2 * (structure.M @ answer)
    error = _residual_receptance(structure, truncation.kept, residual)
    farther = (beyond - structure.shift) / (beyond - omega**2) if np.isfinite(beyond) else 1.0
    return float((np.abs(error) * farther / static).max())


def error_at_other_rows(
    truncation: Truncation, found: Flexibility, loads: FloatArray, others: Sequence[int]
) -> tuple[float, float]:
    """Error of the displacements at other rows under the loads, and the part of it due to damping.

    It is relative to the geometric mean of the two static receptances; the second is to be multiplied by the
    loss factor. The modes do not contain the flexibility of these rows. So Galerkin's solution errs more at
    them, and m_3 is only known to be at most m_2 over the first frequency left out. That holds both for the
    modes left out and for the modes that represent them.
    """
    omega, beyond = truncation.omega, truncation.beyond
    if omega**2 >= beyond:
        return np.inf, np.inf
    truncation = _with_shift_for_static(truncation)
    structure, kept = truncation.structure, truncation.kept
    own, share, together = 0.0, 0.0, truncation.options.batch_size
    for first in range(0, len(others), together):
        some = unit_columns(structure.rows, others[first : first + together])
        rest = _residual_receptance(structure, kept, some)
        static = _static(structure, kept, some, rest, omega)
        own = max(own, _receptance_error(truncation, found.modes, some, static))
        share = max(share, float((rest / static).max(initial=0.0)))
    rest = _residual_receptance(structure, kept, loads)
    share *= float((rest / _static(structure, kept, loads, rest, omega)).max(initial=0.0))
    slow = omega / np.sqrt(beyond)
    return float(np.sqrt(own * found.bound)), float(2.0 * slow * np.sqrt(share) / (1.0 - slow**2) ** 2)


def _residual_receptance(structure: FactoredStructure, kept: Modes, loads: FloatArray) -> FloatArray:
    """Part of each load's static receptance that the kept modes leave out."""
    outer = _without(structure, kept, loads)
    rest: FloatArray = np.einsum(
        "ij,ij->j", outer.conj(), _orthogonal(structure, kept, structure.solve(outer))
    ).real
    return rest


def _damping_error(
    modes: Modes, outer: FloatArray, beyond: float, sixth: bool, static: FloatArray
) -> FloatArray:
    """Bound of the error of m_3 of each load over its static receptance; `sixth`: whether m_6 is known.

    It is computed relative to the greatest part of each load and the lowest mode: powers of extremes
    overflow.
    """
    if not modes.count:
        return np.zeros(outer.shape[1])
    size = np.abs(modes.shapes.conj().T @ outer) ** 2
    most = size.max(axis=0)
    size /= np.where(most > 0.0, most, 1.0)
    lowest = modes.stiffness.min()
    slow = np.sqrt(lowest / modes.stiffness)[:, None]
    m_2, m_3, m_4, m_6 = ((size * slow**s).sum(axis=0) for s in (2, 3, 4, 6))
    if not sixth:
        m_6 = m_4 * (lowest / beyond)
    least = np.divide(m_4**1.5, np.sqrt(m_6), out=np.zeros_like(m_4), where=m_6 > 0.0)
    off = np.maximum(np.sqrt(m_2 * m_4) - m_3, m_3 - least)
    relative: FloatArray = off * (most / lowest / static) / np.sqrt(lowest)
    return relative


def _static(
    structure: FactoredStructure, kept: Modes, loads: FloatArray, rest: FloatArray, omega: float
) -> FloatArray:
    """Static displacement of each load along itself, from the kept modes' part and `rest`.

    Rigid-body modes have no static response. Their response at omega is taken, if omega is not 0: up to omega
    it is at least that.
    """
    rigid = kept.stiffness <= -structure.shift
    on_modes = np.abs(kept.shapes.conj().T @ loads) ** 2
    total: FloatArray = rest + (on_modes[~rigid] / kept.stiffness[~rigid, None]).sum(axis=0)
    if omega:
        total += on_modes[rigid].sum(axis=0) / omega**2
    return np.where(total > 0.0, total, 1.0)


def _without(structure: FactoredStructure, kept: Modes, loads: FloatArray) -> FloatArray:
    """Loads minus the part that pushes the kept modes."""
    outer: FloatArray = loads - structure.M @ (kept.shapes @ (kept.shapes.conj().T @ loads))
    return outer


def _orthogonal(structure: FactoredStructure, kept: Modes, displacements: FloatArray) -> FloatArray:
    """Displacements minus their part in the kept modes."""
    part: FloatArray = displacements - kept.shapes @ (kept.shapes.conj().T @ (structure.M @ displacements))
    return part


def _of_energy_1(structure: FactoredStructure, columns: FloatArray, least: FloatArray | float) -> FloatArray:
    """Columns scaled to elastic energy 1; columns of energy up to `least` are rounding and left out."""
    energy = energy_of(structure.K, columns)
    unit: FloatArray = columns[:, energy > least] / np.sqrt(energy[energy > least])
    return unit


def _galerkin(structure: FactoredStructure, basis: FloatArray, far: float, independent: float) -> Modes:
    """Modes within a space of displacements, without nearly dependent directions.

    far is the greatest squared angular frequency of a mode.
    """
    if not basis.shape[1]:
        return Modes(np.zeros(0), basis)
    stiffness = basis.conj().T @ (structure.K @ basis)
    unit = 1.0 / np.sqrt(np.diagonal(stiffness).real)
    value, vector = scipy.linalg.eigh(stiffness * unit * unit[:, None])
    good = value > independent * value.max()
    basis = basis @ ((unit[:, None] * vector[:, good]) / np.sqrt(value[good]))  # columns of stiffness 1
    mass, turn = scipy.linalg.eigh(basis.conj().T @ (structure.M @ basis))
    # descending order of mass is ascending order of frequency
    shapes = (basis @ turn / np.sqrt(np.maximum(mass, 1.0 / far)))[:, ::-1]
    return Modes(energy_of(structure.K, shapes), shapes)
