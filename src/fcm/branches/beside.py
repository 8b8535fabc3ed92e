"""Solutions of a balance with more harmonics beside the highest stable ones of a balance with fewer.

An isolated branch may be out of reach of the level of the forces: what leads to it with few harmonics may
lead elsewhere with more. A peak at which the structure can stay is then looked for again where it was.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path
from fcm.harmonic.cost import seconds_of
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray
from fcm.scene.rules import MOST_HARMONICS
from fcm.stability.floquet import multipliers_of
from fcm.stability.multipliers import Multipliers

ENOUGH = 1e-6  # of a displacement, from which Newton's method ends at the precision of numbers
TIMES = 3  # as many harmonics, on the way to more that are not found beside at once, and where these tell
DEAR = 0.02  # seconds of an evaluation with many harmonics, of which some hundred may be needed
TOGETHER = 8  # points, within which one top speaks for those of other degrees of freedom
AROUND = (1, 2, 3, 4, 6, 8, 11, 16, 23, 32)  # points from a top, where one may be led to the same branch


def beside(
    system: System, paths: Sequence[Path], amplitudes: Sequence[FloatArray], more: tuple[int, ...]
) -> list[FloatArray]:
    """Stable solutions (unknown + 1,) with more harmonics beside the tops of paths of a system.

    A top is the highest point of a path, for each degree of freedom, of those that the determinant allows to
    be stable; amplitudes are (point, dof) of each path. Where none is found beside a top, or none that is
    stable, one is looked for beside points around it; and where there is none either, beside what some of the
    harmonics make of these.
    """
    judge = _Judge(system.with_harmonics(more))
    ways = [_lifts(system, sets) for sets in dict.fromkeys(((more,), gradually(system.harmonics, more)))]
    found = []
    for path, amplitude in zip(paths, amplitudes, strict=True):
        for top, even in tops(path, amplitude):
            stable = (_stable(judge, _around(lifts, path, even, top)) for lifts in ways)
            z = next((z for z in stable if z is not None), None)
            found += [] if z is None else [z]
    return found


def gradually(harmonics: tuple[int, ...], more: tuple[int, ...]) -> tuple[tuple[int, ...], ...]:
    """Sets of harmonics from some to more, the lowest of these first, each at most `TIMES` as many."""
    sets, count = [], len(harmonics) * TIMES
    while count < len(more):
        sets.append(tuple(sorted({*harmonics, *more[:count]})))
        count *= TIMES
    return tuple(dict.fromkeys((*sets, more)))


def _lifts(system: System, sets: Sequence[tuple[int, ...]]) -> list[Lifted]:
    """From the harmonics of a system to the first of sets, and from each to the next."""
    fewer = [system.harmonics, *sets[:-1]]
    return [
        Lifted(system.with_harmonics(more).balance(), list(few), list(more), ENOUGH)
        for few, more in zip(fewer, sets, strict=True)
    ]


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


class _Judge:
    """Whether the structure can stay at solutions of a system; what that cannot tell many harmonics do, where
    they are not too dear."""

    def __init__(self, system: System) -> None:
        self.system, self.of = system, multipliers_of(system, system.scene.frequency_range[1])
        self.further: tuple[Lifted, Multipliers] | None = None

    def stable(self, z: FloatArray, direction: FloatArray) -> bool:
        """Of a solution and the direction of the curve there."""
        alone = self.of.verdict(z, enough=(1.0,)).stable
        return alone == 1.0 or (math.isnan(alone) and self._with_many(z, direction))

    def _with_many(self, z: FloatArray, direction: FloatArray) -> bool:
        if self.further is None:
            harmonics = self.system.harmonics
            highest = min(TIMES * len(harmonics), MOST_HARMONICS)
            many = tuple(sorted({*harmonics, *range(1, highest + 1)}))
            if many == harmonics or seconds_of(self.system, 1, len(many)) > DEAR:
                return False
            (lifted,), finer = _lifts(self.system, (many,)), self.system.with_harmonics(many)
            self.further = lifted, multipliers_of(finer, self.system.scene.frequency_range[1])
        lifted, of = self.further
        if not (lifted.beside(z, direction) and lifted.newton.correct(1.0)):
            return False
        return of.verdict(np.array(lifted.newton.z), enough=(1.0,)).stable == 1.0


def _stable(judge: _Judge, around: Iterator[tuple[int, FloatArray, FloatArray]]) -> FloatArray | None:
    """The first that is stable of solutions around a top; each time twice as far away.

    Near a fold, where a branch is highest, it may not be.
    """
    judged = 0
    for away, z, direction in around:
        if judged and judged < away < 2 * judged:
            continue
        if judge.stable(z, direction):
            return z
        judged = max(away, 1)
    return None


def _around(
    lifts: Sequence[Lifted], path: Path, even: npt.NDArray[np.bool_], top: int
) -> Iterator[tuple[int, FloatArray, FloatArray]]:
    """The solutions beside a top and beside the points around it, the nearest first: how many points away
    each is, itself, and the direction of its curve."""
    for i in around(even, top):
        z, direction = path.z[i], path.direction[i]
        for lifted in lifts:
            newton = lifted.newton
            if not (lifted.beside(z, direction) and newton.correct(1.0)):
                break
            z, direction = np.array(newton.z), np.asarray(newton.tangent) * newton.scale
        else:
            yield abs(i - top), z, direction
