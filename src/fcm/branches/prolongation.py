"""Solutions with few harmonics prolongated to more: zero for the new ones, then Newton's method.

Each branch is prolongated at several of its points, as the branch of more harmonics may leave that of few
anywhere. The solution with more is looked for in the plane normal to the curve of few; where Newton's method
does not lead there at once, by a homotopy from the equations that the point of few solves (`Lifted`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from fcm.branches.options import PROLONGATION, ProlongationOptions
from fcm.continuation import Mark, Path
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray


def prolongated(
    system: System,
    fewer: Sequence[int],
    paths: Sequence[Path],
    options: ProlongationOptions = PROLONGATION,
) -> Iterator[FloatArray]:
    """Solutions (unknown + 1,) of a system within its range, near points of paths of fewer harmonics.

    First one of each path, then the next of each, so that most branches are known before their other points.
    """
    low, high = system.scene.frequency_range
    lifted = Lifted(system.balance(), list(fewer), list(system.harmonics), options.enough)
    chosen = [places(path, options) for path in paths]
    for k in range(max(map(len, chosen), default=0)):
        for path, at in zip(paths, chosen, strict=True):
            if k >= len(at) or not lifted.beside(path.z[at[k]], path.direction[at[k]]):
                continue
            if lifted.newton.correct(1.0) and low <= lifted.newton.z[-1] <= high:
                yield np.array(lifted.newton.z)


def places(path: Path, options: ProlongationOptions = PROLONGATION) -> list[int]:
    """The points of a path that are prolongated: its peaks, ends and folds, and some between them."""
    count = len(path.z)
    marked = [path.where(Mark.PEAK), np.array([0, count - 1]), path.where(Mark.FOLD)]
    marked.append(np.linspace(0, count - 1, min(options.even, count)).astype(np.intp))
    every = np.concatenate([_some(one, options.of_a_kind) for one in marked])
    return list(dict.fromkeys(every.tolist()))


def _some(places: npt.NDArray[np.intp], most: int) -> npt.NDArray[np.intp]:
    """No more than so many of some places, evenly."""
    if len(places) <= most:
        return places
    return places[np.linspace(0, len(places) - 1, most).astype(np.intp)]
