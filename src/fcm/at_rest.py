"""How little of a motion is none: what is left of sums over modes by rounding."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen


class RestOptions(Frozen):
    """How little is nothing.

    displacement : part of the greatest amplitude of a curve, up to which an amplitude is rounding. A sum over
        modes is off by some hundred units of the last of its sixteen digits.
    uncertain : relative rounding of an amplitude from which nothing of it is known. It decides where contacts
        are so stiff that smaller displacements have digits, and larger ones may have none.
    """

    displacement: float = 1e-13
    uncertain: float = 1.0


def at_rest(size: npt.NDArray[np.float64], options: RestOptions | None = None) -> npt.NDArray[np.bool_]:
    """Which of the degrees of freedom with greatest amplitudes (dof,) move by rounding alone, or not at all.

    >>> at_rest(np.array([3.0, 1e-6, 2e-15, 0.0])).tolist()
    [False, False, True, True]
    """
    part = (options or RestOptions()).displacement
    rest: npt.NDArray[np.bool_] = size <= part * np.fmax.reduce(size, initial=0.0)
    return rest
