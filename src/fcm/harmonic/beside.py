"""Solutions of a balance with more harmonics beside the highest stable ones of a balance with fewer.

An isolated branch may be out of reach of the level of the forces: what leads to it with few harmonics may
lead elsewhere with more. A peak at which the structure can stay is then looked for again where it was.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.multipliers import multipliers_of
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

ENOUGH = 1e-6  # of a displacement, from which Newton's method ends at the precision of numbers
TOGETHER = 8  # points, within which one top speaks for those of other degrees of freedom
AROUND = (1, 2, 3, 4, 6, 8, 11, 16, 23, 32)  # points from a top, where one may be led to the same branch


def beside(
    system: System, paths: Sequence[Path], amplitudes: Sequence[FloatArray], more: tuple[int, ...]
) -> list[FloatArray]:
    """Stable solutions (unknown + 1,) with more harmonics beside the tops of paths of a system.

    A top is the highest point of a path, for each degree of freedom, of those that the determinant allows to
    be stable; amplitudes are (point, dof) of each path. Where none is found beside a top, one is looked for
    beside points around it.
    """
    finer = system.with_harmonics(more)
    lifted = Lifted(finer.balance(), list(system.harmonics), list(more), ENOUGH)
    of = multipliers_of(finer, system.scene.frequency_range[1])
    found = []
    for path, amplitude in zip(paths, amplitudes, strict=True):
        even = path.orientation * np.sign(path.direction[:, -1]) > 0.0
        for top in _tops(path, even, amplitude):
            z = _around(lifted, path, even, top)
            if z is not None and of.verdict(z).stable == 1.0:
                found.append(z)
    return found


def _tops(path: Path, even: npt.NDArray[np.bool_], amplitude: FloatArray) -> list[int]:
    """Where degrees of freedom are highest, of points inside the range with an even number of real
    multipliers above 1.
    """
    inside = (path.parameter > path.parameter.min()) & (path.parameter < path.parameter.max())
    places = np.flatnonzero(even & inside)
    if not places.size:
        return []
    tops = np.unique(places[amplitude[places].argmax(axis=0)])
    apart = np.append(True, np.diff(tops) > TOGETHER)
    return [int(top) for top in tops[apart]]


def _around(lifted: Lifted, path: Path, even: npt.NDArray[np.bool_], top: int) -> FloatArray | None:
    """The solution beside a top, or else beside the first point around it that has one."""
    newton = lifted.newton
    for i in (top, *(top + way * step for step in AROUND for way in (-1, 1))):
        same = 0 <= i < len(even) and even[min(i, top) : max(i, top) + 1].all()
        if same and lifted.beside(path.z[i], path.direction[i]) and newton.correct(1.0):
            return np.array(newton.z)
    return None
