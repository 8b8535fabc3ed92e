"""Decides which degrees of freedom are at rest: their amplitudes are only rounding of sums over modes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen


class RestOptions(Frozen):
    """Thresholds below which a displacement counts as rest.

    displacement : amplitude, relative to the greatest of a curve, up to which it is rounding. A sum over
        modes has errors of some hundred units in the last of its sixteen digits.
    uncertain : relative rounding error above which nothing is known of an amplitude. It matters for very
        stiff contacts, with which smaller displacements can be accurate, and larger ones may not be.
    """

    displacement: float = 1e-13
    uncertain: float = 1.0


def at_rest(size: npt.NDArray[np.float64], options: RestOptions | None = None) -> npt.NDArray[np.bool_]:
    """Mask (dof,) of the degrees of freedom that are at rest, from their greatest amplitudes size (dof,).

    >>> at_rest(np.array([3.0, 1e-6, 2e-15, 0.0])).tolist()
    [False, False, True, True]
    """
    part = (options or RestOptions()).displacement
    rest: npt.NDArray[np.bool_] = size <= part * np.fmax.reduce(size, initial=0.0)
    return rest
