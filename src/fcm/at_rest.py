"""Amplitude up to which a degree of freedom is at rest: what rounding leaves of sums over modes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen


class RestOptions(Frozen):
    """Thresholds below which a displacement counts as rest.

    displacement : part of the greatest amplitude of a curve, up to which an amplitude is rounding. A sum over
        modes is off by some hundred units of the last of its sixteen digits.
    uncertain : relative rounding of an amplitude from which nothing of it is known. It decides where contacts
        are so stiff that smaller displacements have digits, and larger ones may have none.
    """

    displacement: float = 1e-13
    uncertain: float = 1.0


def at_rest(size: npt.NDArray[np.float64], options: RestOptions | None = None) -> npt.NDArray[np.bool_]:
    """Mask of the degrees of freedom, of greatest amplitudes (dof,), that move by rounding alone or not at
    all.

    >>> at_rest(np.array([3.0, 1e-6, 2e-15, 0.0])).tolist()
    [False, False, True, True]
    """
    part = (options or RestOptions()).displacement
    rest: npt.NDArray[np.bool_] = size <= part * np.fmax.reduce(size, initial=0.0)
    return rest
