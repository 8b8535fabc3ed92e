"""Rigid-body modes as an eigensolver gives them: with a small frequency, which is its rounding."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fcm.structure.digits import energy_uncertain

if TYPE_CHECKING:
    from fcm.structure.eigen import FloatArray, Matrix, Modes

FAR_BELOW = 1e-3  # of the next frequency: so low are rigid-body modes that come out of an eigensolver
MOST = 6  # rigid-body modes of one body
CANCELLED = 4e-16  # share of the elastic energy's terms that is left of their sum: rounding of its entries
NEARLY = {1e-13: 0.03, 1e-6: 1e-4}  # the same, of a matrix written with fewer digits: of the next frequency
DEVIATIONS, BELOW = 4.0, 0.3  # of the energy by the digits of the entries; of the next frequency
WORTH_SAYING = 0.03  # of the first elastic frequency: so near to it a soft mode may be taken for a rigid one
AT_REST = 1e-3  # the share of the elastic forces of a row: a soft mode of stiff parts has some of its own


def rigid_by_gap(frequency: FloatArray, below: float = FAR_BELOW, most: int = MOST) -> int:
    """How many of the lowest modes are rigid-body modes, of those with a frequency above 0: at most `most`.

    Their own frequencies are rounding, and may be as far from each other.

    >>> rigid_by_gap(np.array([2e-8, 1e-3, 2e-3, 52.0, 80.0])), rigid_by_gap(np.array([0.5, 52.0, 80.0]))
    (3, 0)
    """
    ordered = np.sort(frequency[frequency > 0.0])
    gaps = np.flatnonzero(ordered[:-1] <= below * ordered[1:])
    gaps = gaps[gaps < most]
    return int(gaps[-1]) + 1 if gaps.size else 0


def most_rigid(K: Matrix) -> int:
    """How many rigid-body modes there may be: six of each body, fewer of one with fewer rows.

    >>> import scipy.sparse
    >>> most_rigid(scipy.sparse.block_diag([np.ones((2, 2)), np.ones((9, 9))]))
    8
    """
    from scipy.sparse.csgraph import connected_components  # modes from a file do without scipy

    _, body = connected_components(abs(K), directed=False)
    return int(np.minimum(np.bincount(body), MOST).sum())


def rigid_by_energy(K: Matrix, modes: Modes) -> int:
    """How many of the lowest modes have no elastic energy, beyond the rounding of its sum."""
    forces = abs(K) @ np.abs(modes.shapes)
    terms = np.einsum("ij,ij->j", np.abs(modes.shapes), forces)
    left = modes.stiffness / np.where(terms > 0.0, terms, 1.0)
    of_rows = np.divide(np.abs(K @ modes.shapes), forces, out=np.zeros_like(forces), where=forces > 0.0)
    none = left <= CANCELLED
    frequency = np.sqrt(np.maximum(modes.stiffness, 0.0))
    negative, number = int((modes.stiffness <= 0.0).sum()), np.arange(left.size)
    many = most_rigid(K)
    for share, below in NEARLY.items():
        none |= (left <= share) & (number < negative + rigid_by_gap(frequency, below, many))
    none |= number < _uncertain(K, modes, frequency, many)
    return int((none & (of_rows.max(axis=0, initial=0.0) <= AT_REST)).sum())


def _uncertain(K: Matrix, modes: Modes, frequency: FloatArray, most: int) -> int:
    """How many of the lowest modes may have no stiffness, by the digits of K, far below the next that has."""
    may = modes.stiffness <= DEVIATIONS * energy_uncertain(K, modes.shapes)
    count = may.size if may.all() else int(may.argmin())
    apart = 0 < count < may.size and count <= most and frequency[count - 1] <= BELOW * frequency[count]
    return count if apart else 0


def unclear_below(K: Matrix, modes: Modes, rigid: int) -> float:
    """Up to which part of the first elastic frequency the digits of K do not tell modes from rigid-body ones.

    0 where that is too little to be said, or nothing is rigid.
    """
    if not 0 < rigid < modes.count:
        return 0.0
    uncertain = DEVIATIONS * energy_uncertain(K, modes.shapes[:, :rigid]).max()
    part = float(np.sqrt(uncertain / modes.stiffness[rigid]))
    return part if part > WORTH_SAYING else 0.0
