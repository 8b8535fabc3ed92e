"""Where no motion that was found is stable, and the stable ones that the level of the forces tells of there.

The structure does something at every frequency. Where it can stay at none of the motions found, it moves in a
way that the balance has no solution for, as in one that repeats after two periods or never, or a branch was
missed. So there the level of the forces is followed once more. What it passes that is stable is on no branch
that was found.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from fcm.continuation import Path
from fcm.harmonic.carried import passes
from fcm.harmonic.choice import Accurate, judged
from fcm.harmonic.error import reported
from fcm.harmonic.multipliers import multipliers_of
from fcm.harmonic.outline import Outline
from fcm.harmonic.start import NEAR, Found, solutions
from fcm.harmonic.system import System
from fcm.harmonic.trace import with_further
from fcm.harmonic.unstable import Stretch, unstable_stretches
from fcm.harmonic.work import TooLongError
from fcm.scene.model import FloatArray

LOOKS = 3  # stretches in whose middle the level is followed, the widest first,
SHARE = 0.2  # as long as that takes no more of the work before


def with_missed(found: Accurate, stable: Sequence[FloatArray], accuracy: float) -> Accurate:
    """A response with stable branches that were missed; itself if none is found, and each look came to its
    end.

    stable (path, point): 1 where a motion is stable, 0 where it is not, NaN where that is not known.
    """
    system, paths = found.system, found.traced.branches.paths
    parts = [(path.parameter, known) for path, known in zip(paths, stable, strict=True)]
    stretches = unstable_stretches(parts, system.scene.frequency_range)
    looked = _looked(system, stretches) if stretches else []
    missed = list(_missed(system, looked, paths)) if looked else []
    if not missed:
        return found if all(one.complete for one in looked) else _having(found, looked)
    traced = with_further(system, found.traced, looked, missed)
    further = traced.branches.paths[len(paths) :]
    shown = (*found.shown, *(reported(system, path) for path in further))
    every = judged(Outline(system, traced, shown, found.seconds), accuracy, found.errors)
    return replace(every, further=found.further, begun=found.begun)


def _having(found: Accurate, looked: Sequence[Found]) -> Accurate:
    """A response that says where else its branches were looked for."""
    return replace(found, traced=replace(found.traced, found=(*found.traced.found, *looked)))


def _looked(system: System, stretches: Sequence[Stretch]) -> list[Found]:
    """What the level passes in the middle of stretches, up to where few curves come back from: that takes
    half as long as to its end."""
    found = list[Found]()
    with system.work.up_to((1.0 + SHARE) * system.work.seconds):
        for low, high in stretches[:LOOKS]:
            try:
                found.append(solutions(system, 0.5 * (low + high), NEAR))
            except TooLongError:
                break
    return found


def _missed(system: System, looked: Sequence[Found], paths: Sequence[Path]) -> Iterator[FloatArray]:
    """The solutions that are stable, and that no path passes, as in a window of stability unseen."""
    of = multipliers_of(system, system.scene.frequency_range[1])
    for z in (z for one in looked for z in one.solutions):
        if of.verdict(z, enough=(1.0,)).stable == 1.0 and not any(passes(system, one, z) for one in paths):
            yield z
