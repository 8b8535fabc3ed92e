"""Stable motions that were missed, where the level of the forces tells of them.

The structure does something at every frequency. Where it can stay at none of the motions found, it moves in a
way that the balance has no solution for, as in one that repeats after two periods or never, or a branch was
missed. So there the level of the forces is followed once more. What it passes that is stable is on no branch
that was found, or in a window of stability that was not seen on one.

And where a low harmonic comes to the frequency at which the response is highest, or to that of smaller
motions: a contact that opens and closes twice or thrice a period may keep that going on a closed branch,
beside one on which it stays closed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from fcm.accuracy.outline import Outline
from fcm.accuracy.refinement import Accurate, judged
from fcm.continuation import Mark, Path
from fcm.harmonic.carried import place_on
from fcm.harmonic.reported import reported
from fcm.harmonic.start import NEAR, Found, resonances, solutions
from fcm.harmonic.system import System
from fcm.harmonic.trace import Traced, with_further
from fcm.harmonic.work import TooLongError
from fcm.scene.model import FloatArray
from fcm.stability.floquet import multipliers_of
from fcm.stability.multipliers import Multipliers
from fcm.stability.unstable_ranges import Stretch, stretches_of

SHARE = 0.2  # of the work before, that following the level in the middle of stretches may take,
UNNOTICED = 0.1  # and seconds of work that it may in any case: of small scenes all stretches are looked at
LOW = 3  # harmonics whose resonances are strong enough to keep themselves up
NEAR_ENOUGH = 0.02  # to a frequency that was looked at: a closed branch is about as wide
WIDE = 0.1  # of the range: of a stretch that is wider more than the middle is looked at


def with_missed(
    found: Accurate, stable: Sequence[FloatArray], accuracy: float
) -> tuple[Accurate, list[FloatArray]]:
    """A response with stable branches that were missed, and stable with windows that were; it says where it
    was looked for them, and is the same where nothing had to be.

    stable (path, point): 1 where a motion is stable, 0 where it is not, NaN where that is not known.
    """
    system, paths, known = found.system, found.traced.branches.paths, list(stable)
    stretches = stretches_of(paths, known, system.scene.frequency_range)
    seconds = max(SHARE * system.work.seconds, UNNOTICED)
    looked = [*looks(system, stretches, seconds), *looks(system, met(found), seconds)]
    if not looked:
        return found, known
    of = multipliers_of(system, system.scene.frequency_range[1])
    missed = []
    for z in _stable(of, looked):
        passed = [(k, i) for k, path in enumerate(paths) if (i := place_on(system, path, z)) is not None]
        for k, i in passed:
            known[k] = _with_window(of, paths[k], known[k], i)
        if not passed:
            missed.append(z)
    if not missed:
        return replace(found, traced=replace(found.traced, found=(*found.traced.found, *looked))), known
    return with_branches(found, looked, missed, accuracy), known


def with_branches(
    found: Accurate, looked: Sequence[Found], starts: Sequence[FloatArray], accuracy: float
) -> Accurate:
    """A response with the branches through further solutions, and where else it was looked for them."""
    return with_traced(found, with_further(found.system, found.traced, looked, starts), accuracy)


def with_traced(found: Accurate, traced: Traced, accuracy: float) -> Accurate:
    """A response with further branches, which come after its own."""
    system, known = found.system, len(found.shown)
    shown = (*found.shown, *(reported(system, path) for path in traced.branches.paths[known:]))
    every = judged(Outline(system, traced, shown, found.seconds), accuracy, found.errors)
    return replace(every, further=found.further, begun=found.begun)


def looks(system: System, stretches: Iterable[Stretch], seconds: float) -> Iterator[Found]:
    """What the level passes in the middle of stretches, the widest first, for so many more seconds of work.

    Of a wide stretch both halves are looked at as well: a closed branch may lie beside its middle. The level
    is followed up to where few curves come back from: that takes half as long as to its end.
    """
    first, last = system.scene.frequency_range
    left = sorted(stretches, key=_width)
    with system.work.up_to(system.work.seconds + seconds):
        while left:
            low, high = left.pop()
            middle = 0.5 * (low + high)
            try:
                yield solutions(system, middle, NEAR)
            except TooLongError:
                return
            if high - low > WIDE * (last - first):
                left = sorted([*left, (low, middle), (middle, high)], key=_width)


def met(found: Accurate) -> Iterator[Stretch]:
    """Where low harmonics come to a highest peak, and between that and the nearest resonance, as those of
    smaller motions are: single frequencies, as stretches of no width."""
    low, high = found.system.scene.frequency_range
    known, inside = [one.omega for one in found.traced.found], resonances(found.system)
    for top in peaks_at(found):
        nearest = min(inside, key=lambda omega: abs(omega - top), default=top)
        harmonics = (h for h in found.system.harmonics if 1 < h <= LOW)
        for omega in (omega / h for h in harmonics for omega in (top, 0.5 * (top + nearest))):
            if low < omega < high and all(abs(omega - other) > NEAR_ENOUGH * omega for other in known):
                known.append(omega)
                yield omega, omega


def peaks_at(found: Accurate) -> Iterator[float]:
    """The frequencies of the highest peaks of the degrees of freedom."""
    paths, shown = found.traced.branches.paths, found.shown
    heights = np.array([one.amplitude.max(axis=0) for one in shown])
    for d, k in enumerate(heights.argmax(axis=0).tolist()):
        yield float(paths[k].parameter[shown[k].amplitude[:, d].argmax()])


def _width(stretch: Stretch) -> float:
    return stretch[1] - stretch[0]


def _stable(of: Multipliers, looked: Sequence[Found]) -> Iterator[FloatArray]:
    """The solutions that are stable."""
    for z in (z for one in looked for z in one.solutions):
        if of.verdict(z, enough=(1.0,)).stable == 1.0:
            yield z


def _with_window(of: Multipliers, path: Path, stable: FloatArray, i: int) -> FloatArray:
    """Of the points of a path (point,) whether they are stable, with a window that was not seen: from a place
    behind point i to either side, up to a fold or the first point that is not stable."""
    found = stable.copy()
    sign = path.orientation * np.sign(path.direction[:, -1])  # what a verdict is of, see `stability`
    inside = (sign > 0.0) & ((path.mark & Mark.FOLD) == 0) & (stable == 0.0)
    for way, j in ((-1, i), (1, i + 1)):
        while 0 <= j < len(found) and inside[j]:
            found[j] = of.verdict(path.z[j]).stable
            if found[j] != 1.0:
                break
            j += way
    return found
