"""Solutions of a balance with more harmonics beside the highest stable ones of a balance with fewer.

An isolated branch may be out of reach of the level of the forces: what leads to it with few harmonics may
lead elsewhere with more. A peak at which the structure can stay is then looked for again where it was.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path
from fcm.harmonic.floquet import multipliers_of
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.multipliers import Multipliers
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
    be stable; amplitudes are (point, dof) of each path. Where none is found beside a top, or none that is
    stable, one is looked for beside points around it.
    """
    finer = system.with_harmonics(more)
    lifted = Lifted(finer.balance(), list(system.harmonics), list(more), ENOUGH)
    of = multipliers_of(finer, system.scene.frequency_range[1])
    found = []
    for path, amplitude in zip(paths, amplitudes, strict=True):
        for top, even in tops(path, amplitude):
            z = _stable(of, _around(lifted, path, even, top))
            found += [] if z is None else [z]
    return found


def tops(path: Path, amplitude: FloatArray) -> Iterator[tuple[int, npt.NDArray[np.bool_]]]:
    """Where degrees of freedom are highest, of points inside the range with an even number of real
    multipliers above 1; and which points (point,) have that.
    """
    even = path.orientation * np.sign(path.direction[:, -1]) > 0.0
    inside = (path.parameter > path.parameter.min()) & (path.parameter < path.parameter.max())
    places = np.flatnonzero(even & inside)
    if not places.size:
        return
    highest = np.unique(places[amplitude[places].argmax(axis=0)])
    apart = np.append(True, np.diff(highest) > TOGETHER)
    for top in highest[apart].tolist():
        yield top, even


def around(even: npt.NDArray[np.bool_], top: int) -> Iterator[int]:
    """A top and the points around it that no fold is between, the nearest first."""
    for i in (top, *(top + way * step for step in AROUND for way in (-1, 1))):
        if 0 <= i < len(even) and even[min(i, top) : max(i, top) + 1].all():
            yield i


def _stable(of: Multipliers, around: Iterator[tuple[int, FloatArray]]) -> FloatArray | None:
    """The first that is stable of solutions with their distances from a top; each time twice as far away.

    Near a fold, where a branch is highest, it may not be.
    """
    judged = 0
    for away, z in around:
        if judged and judged < away < 2 * judged:
            continue
        if of.verdict(z, enough=(1.0,)).stable == 1.0:
            return z
        judged = max(away, 1)
    return None


def _around(
    lifted: Lifted, path: Path, even: npt.NDArray[np.bool_], top: int
) -> Iterator[tuple[int, FloatArray]]:
    """The solutions beside a top and beside the points around it, the nearest first, each with how many
    points away that is."""
    newton = lifted.newton
    for i in around(even, top):
        if lifted.beside(path.z[i], path.direction[i]) and newton.correct(1.0):
            yield abs(i - top), np.array(newton.z)
