"""Whether more harmonics than those given have higher peaks, on branches that were not found.

The error of a peak is that of the branch that it is on. A branch that comes to be with the seventh harmonic
is none of five, and may be the highest. Where nothing that was found is stable something else must happen,
maybe on such a branch: there the level of the forces is followed with more harmonics. What is higher than the
peaks may be by their errors is led to those given; if it is on no branch of these, of the peaks is not told
how far they are from the motion's.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.accuracy.refinement import Accurate
from fcm.harmonic.carried import led_to
from fcm.harmonic.reported import reported_at
from fcm.harmonic.system import System
from fcm.response.restless import looks, with_branches
from fcm.scene.model import FloatArray
from fcm.stability.unstable_ranges import Stretch, stretches_of

MANY = 9  # harmonics, with which a peak is within a thousandth or so: the branches of more are theirs, too
SHARE = 0.5  # of the work before, that looking for higher peaks may take


def with_higher(found: Accurate, stable: Sequence[FloatArray]) -> tuple[Accurate, bool]:
    """A response with branches higher than those that it has, and whether one that it lacks is higher still.

    stable (path, point): 1 where a motion is stable, 0 where it is not, NaN where that is not known.
    """
    system = found.system
    stretches = stretches_of(found.traced.branches.paths, stable, system.scene.frequency_range)
    if not stretches or len(system.harmonics) >= MANY:
        return found, False
    more = tuple(sorted({*system.harmonics, *range(1, MANY + 1)}))
    higher = _higher(system.with_harmonics(more), stretches, _most(found))
    if not higher:
        return found, False
    guesses = (system.extended(z, more) for z, _ in higher)
    starts = [z for z in (led_to(system, guess) for guess in guesses) if z is not None]
    found = with_branches(found, (), starts, np.inf) if starts else found
    most = _most(found)
    return found, any((amplitude > most).any() for _, amplitude in higher)


def _most(found: Accurate) -> FloatArray:
    """(dof,) the greatest amplitudes, by their errors; NaN where these are not told."""
    greatest: FloatArray = np.max([one.amplitude.max(axis=0) for one in found.shown], axis=0)
    return greatest * (1.0 + found.peak)


def _higher(
    system: System, stretches: Sequence[Stretch], most: FloatArray
) -> list[tuple[FloatArray, FloatArray]]:
    """The first solutions with a higher amplitude (dof,) than the most, with that; none if none is found."""
    for found in looks(system, stretches, SHARE * system.work.seconds):
        passed = found.solutions
        amplitudes = (reported_at(system, z[None], np.eye(z.size)[-1:]).amplitude[0] for z in passed)
        higher = [(z, one) for z, one in zip(passed, amplitudes, strict=True) if (one > most).any()]
        if higher:
            return higher
    return []
