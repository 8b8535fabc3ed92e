"""Recognise rigid-body modes in the results of an eigensolver, whose low frequencies are rounding."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.structure.digits import energy_uncertain
from fcm.structure.options import RIGID_BODY

if TYPE_CHECKING:
    from fcm.structure.eigen import FloatArray, Matrix, Modes

MOST = 6  # number of rigid-body modes of one body


def rigid_by_gap(frequency: FloatArray, most: int = MOST) -> int:
    """Number of rigid-body modes among modes of nonzero frequency, by a gap after them; at most `most`.

    The frequencies of rigid-body modes are rounding, and may also have gaps between them.

    >>> rigid_by_gap(np.array([2e-8, 1e-3, 2e-3, 52.0, 80.0])), rigid_by_gap(np.array([0.5, 52.0, 80.0]))
    (3, 0)
    """
    ordered = np.sort(frequency[frequency > 0.0])
    gaps = np.flatnonzero(ordered[:-1] <= RIGID_BODY.rigid_ratio * ordered[1:])
    gaps = gaps[gaps < most]
    return int(gaps[-1]) + 1 if gaps.size else 0


def most_rigid(K: Matrix) -> int:
    """Greatest possible number of rigid-body modes: six for each body, fewer if it has fewer rows.

    >>> import scipy.sparse
    >>> most_rigid(scipy.sparse.block_diag([np.ones((2, 2)), np.ones((9, 9))]))
    8
    """
    return int(np.minimum(np.bincount(bodies(K)), MOST).sum())


def bodies(K: Matrix) -> npt.NDArray[np.intp]:
    """The body of each row (row,): the number of the part of the structure that its stiffness couples it to.

    >>> import scipy.sparse
    >>> bodies(scipy.sparse.block_diag([np.ones((2, 2)), -np.ones((3, 3))])).tolist()
    [0, 0, 1, 1, 1]
    """
    from scipy.sparse.csgraph import connected_components  # modes from a file do without scipy

    return np.asarray(connected_components(abs(K), directed=False)[1], dtype=np.intp)


def rigid_by_energy(K: Matrix, M: Matrix, modes: Modes) -> int:
    """Number of lowest modes that have no stiffness beyond the rounding of the matrices.

    The criteria do not depend on the units of the rows. Each needs a gap to the next frequency, which is the
    wider the less is known of the rounding:

    - the elastic energy relative to the sizes of its terms, phi^T K phi / |phi|^T |K| |phi|;
    - the most negative stiffness. No structure has one, so it is an error left by a reduction;
    - phi^T K phi / phi^T M phi relative to the largest ratio of the diagonals. After a reduction to few rows,
      a free body has only rounding, which is then all of its stiffness;
    - the last digits with which the entries were written.
    """
    share = _share(K, modes)
    size, many = np.abs(modes.stiffness), most_rigid(K)
    frequency, unknown, low = np.sqrt(size), _unknown(modes), _low(K, M, share)
    uncertain = _uncertain(K, modes, frequency, many)
    for count in range(size.size, 0, -1):
        left, highest = share[:count].max(), size[:count].max()
        if count == size.size:
            if left <= RIGID_BODY.cancellation_tolerance:
                return count
            continue  # there is no next frequency to compare with
        gap = float(np.sqrt(highest)) / max(float(frequency[count]), 1e-300)
        if (
            (left <= RIGID_BODY.cancellation_tolerance and gap <= RIGID_BODY.max_cancelled_ratio)
            or (highest <= unknown and gap <= RIGID_BODY.max_cancelled_ratio)
            or ((size <= low)[:count].all() and gap <= RIGID_BODY.max_soft_ratio)
            or (count <= many and left <= RIGID_BODY.nearly_rigid[0] and gap <= _nearest(left))
        ):
            return max(count, uncertain)
    return uncertain


def may_be_rigid(K: Matrix, M: Matrix, modes: Modes) -> int:
    """Number of lowest modes that may be rigid-body modes: with little elastic energy, followed by a gap."""
    size = np.abs(modes.stiffness)
    share = _share(K, modes)
    little = (share <= RIGID_BODY.nearly_rigid[0]) | (size <= np.maximum(_unknown(modes), _low(K, M, share)))
    frequency = np.sqrt(size)
    gap = (
        np.append(frequency[:-1] <= RIGID_BODY.max_frequency_ratio * frequency[1:], True)
        if frequency.size
        else little
    )
    count = little.size if little.all() else int(little.argmin())
    found = np.flatnonzero(gap[:count])
    return int(found[-1]) + 1 if found.size else 0


def _nearest(left: float) -> float:
    """Greatest ratio of neighbouring frequencies that is a gap, for a share `left` of the energy's terms."""
    return min(
        RIGID_BODY.min_ratio,
        RIGID_BODY.nearly_rigid[1]
        * float((RIGID_BODY.nearly_rigid[0] / max(left, 1e-300)) ** RIGID_BODY.ratio_exponent),
    )


def _share(K: Matrix, modes: Modes) -> FloatArray:
    """Elastic energy of each mode relative to the sum of the magnitudes of its terms."""
    size = np.abs(modes.shapes)
    terms = np.einsum("ij,ij->j", size, abs(K) @ size)
    share: FloatArray = np.abs(modes.stiffness) / np.where(terms > 0.0, terms, 1.0)
    return share


def _unknown(modes: Modes) -> float:
    """Stiffness up to which modes are uncertain, by the most negative stiffness; 0 if none is negative."""
    return RIGID_BODY.negative_factor * max(0.0, -float(modes.stiffness.min(initial=0.0)))


def _low(K: Matrix, M: Matrix, share: FloatArray) -> FloatArray:
    """Stiffness of each mode that is rounding relative to the stiffest row of the matrices."""
    stiff, heavy = K.diagonal().real, M.diagonal().real
    largest = float((np.abs(stiff[heavy > 0.0]) / heavy[heavy > 0.0]).max())
    low: FloatArray = (
        np.where(
            share < RIGID_BODY.uncoupled_share, RIGID_BODY.soft_stiffness, RIGID_BODY.uncoupled_stiffness
        )
        * largest
    )
    return low


def _uncertain(K: Matrix, modes: Modes, frequency: FloatArray, most: int) -> int:
    """Number of lowest modes with no stiffness within the digits of K and a gap after them; 0 if none."""
    may = modes.stiffness <= RIGID_BODY.standard_deviations * energy_uncertain(K, modes.shapes)
    count = may.size if may.all() else int(may.argmin())
    apart = (
        0 < count < may.size
        and count <= most
        and frequency[count - 1] <= RIGID_BODY.max_frequency_ratio * frequency[count]
    )
    return count if apart else 0


def unclear_below(K: Matrix, modes: Modes, rigid: int) -> float:
    """Fraction of the first elastic frequency below which the digits of K cannot exclude rigid-body modes.

    0 if it is too small to matter, or if there are no rigid-body modes.
    """
    if not 0 < rigid < modes.count:
        return 0.0
    uncertain = RIGID_BODY.standard_deviations * energy_uncertain(K, modes.shapes[:, :rigid]).max()
    part = float(np.sqrt(uncertain / modes.stiffness[rigid]))
    return part if part > RIGID_BODY.doubtful_ratio else 0.0
