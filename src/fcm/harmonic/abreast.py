"""What more harmonics make of points beside which the corrected curve is missed: that at their own frequency.

Where a corner has moved, no point of the corrected curve lies normal to the curve. At the frequency of the
point there is one nonetheless, but next to a fold, which may have moved across it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from fcm.continuation import Mark, Path
from fcm.harmonic.believed import AT_FOLD, runs
from fcm.harmonic.corrected import Corrected
from fcm.harmonic.further import padded
from fcm.harmonic.lifted import Lifted
from fcm.scene.model import FloatArray

FAR = 0.5  # of a solution's size: what lies further away is another one
LARGE = 0.05  # a change of an amplitude, from which on it is corrected once more


def with_those_abreast(corrected: Corrected, shift: FloatArray) -> FloatArray:
    """Shifts (point, dof) of amplitudes at the same frequency, in units of the corrected curve, also where
    they are NaN as that is missed.

    From both ends of such a stretch the solutions are followed inwards, each from that before it, as long as
    they are as stable by the number of real multipliers above 1.
    """
    found, path = shift.copy(), corrected.path
    for first, end in runs(np.isnan(shift.max(axis=1))):
        if not _at_fold(path, first, end):
            more = corrected.sets(np.arange(first, end))
            for inwards in (range(first, end), range(end - 1, first - 1, -1)):
                _follow(corrected, more, inwards, found)
    return found


def _at_fold(path: Path, first: int, end: int) -> bool:
    """Whether a stretch is no more than what a fold has: there the corrected curve may have no solution."""
    around = slice(max(first - 1, 0), end + 1)
    width = np.ptp(path.parameter[around])
    return bool((path.mark[around] & Mark.FOLD).any() and width < AT_FOLD * path.parameter[first])


def _follow(corrected: Corrected, more: tuple[int, ...], points: Iterable[int], shift: FloatArray) -> None:
    """Fill shift (point, dof) of points in a row, up to one that is known or that has no such solution."""
    corrector, path = corrected.corrector, corrected.path
    even, off = path.orientation * np.sign(path.direction[:, -1]), None
    for i in points:
        if not np.isnan(shift[i]).any():
            return
        lifted = corrector.lifted(more)
        guess = padded(path.z[i], corrector.system.harmonics, more)
        if not _solved(lifted, guess if off is None else guess + off, even[i], off is None):
            return
        z, found, now = np.array(lifted.newton.z), np.array(lifted.found[1:]), corrected.amplitude[i]
        off = z - guess
        if np.linalg.norm(off / lifted.newton.scale) > FAR:
            return
        if np.abs(found - now).max() > LARGE * now.max():
            second = corrector.of(more)
            second.further.at(z, found)
            most = second.ranking.most()
            lifted = second.lifted(most)
            if not _solved(lifted, padded(z, more, most), even[i], False):
                return
            found = np.array(lifted.found[1:])
        shift[i] = (found - now) / corrected.unit[i]


def _solved(lifted: Lifted, guess: FloatArray, even: float, by_parts: bool) -> bool:
    """Whether newton.z of a balance is a solution at the frequency of a guess, and as even as that."""
    newton = lifted.newton
    return bool(lifted.abreast(guess, by_parts)) and newton.orientation * np.sign(newton.tangent[-1]) == even
