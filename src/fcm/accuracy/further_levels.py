"""Follow the force level at further frequencies that the known branches suggest.

At the first of these, a low harmonic meets the highest peak, or comes between that and the nearest resonance.
There a contact may open and close two or three times a period on a closed branch, beside one on which it
stays closed. The others are in ranges in which no known motion is stable. The steady motion there is another
one: on an unknown branch, of several periods, or aperiodic.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from fcm.accuracy.refinement import RefinedResponse, with_errors
from fcm.branches.force_level import LevelSolutions, linear_resonances, solutions
from fcm.branches.options import LEVEL_CURVE, LEVELS, LevelOptions
from fcm.branches.prolongation import at_its_frequency
from fcm.branches.trace import Traced, with_further
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.model.scene import FloatArray
from fcm.stability.unstable_ranges import Stretch, stretches_of


def with_traced(found: RefinedResponse, traced: Traced, accuracy: float) -> RefinedResponse:
    """A response with further branches appended after its own."""
    every = with_errors(found.with_traced(traced), accuracy, found.errors)
    return replace(every, further=found.further, begun=found.begun)


def with_levels_below_peaks(found: RefinedResponse, accuracy: float) -> RefinedResponse:
    """A response with branches from force levels where a low harmonic excites the highest peaks."""
    system, options = found.system, found.system.option(LEVELS)
    looked = list(_level_solutions(system, _excited_frequencies(found, options), options))
    return _with_branches(found, looked, [z for one in looked for z in one.solutions], accuracy)


def with_levels_where_unstable(
    found: RefinedResponse, stable: Sequence[FloatArray], accuracy: float
) -> tuple[RefinedResponse, bool]:
    """A response with the branches that the level leads to in frequency ranges without a stable motion.

    Also returns whether more harmonics have a motion there that is higher than the response's peaks with
    their errors.

    stable (path, point): 1 where a motion is stable, 0 where it is not, NaN where that is unknown. If the
    response has few harmonics, the level is followed with more. Its solutions then start branches of the
    response's harmonics.
    """
    system, paths = found.system, found.traced.branches.paths
    stretches = stretches_of(paths, stable, system.scene.frequency_range)
    harmonics, options = system.harmonics, system.option(LEVELS)
    if len(harmonics) < options.max_harmonics:
        harmonics = tuple(sorted({*harmonics, *range(1, options.max_harmonics + 1)}))
    more = system.with_harmonics(harmonics)
    looked = list(_level_solutions(more, stretches, options))
    passed = [z for one in looked for z in one.solutions]
    if more.harmonics == system.harmonics:
        return _with_branches(found, looked, passed, accuracy), False
    looked = [replace(one, harmonics=system.harmonics, solutions=(), folds=()) for one in looked]
    guesses = (system.extended(z, more.harmonics) for z in passed)
    starts = [z for z in (at_its_frequency(system, guess) for guess in guesses) if z is not None]
    found = _with_branches(found, looked, starts, accuracy)
    greatest = np.max([one.amplitude.max(axis=0) for one in found.quantities], axis=0) * (1.0 + found.peak)
    heights = (reported_at(more, z[None], np.eye(1, z.size, z.size - 1)).amplitude[0] for z in passed)
    return found, any((height > greatest).any() for height in heights)


def _with_branches(
    found: RefinedResponse, looked: Sequence[LevelSolutions], starts: Sequence[FloatArray], accuracy: float
) -> RefinedResponse:
    """A response with the branches through given solutions, and a record of the frequencies searched."""
    if not looked:
        return found
    traced = with_further(found.system, found.traced, looked, starts)
    if len(traced.branches.paths) == len(found.quantities):
        return replace(found, traced=traced)
    return with_traced(found, traced, accuracy)


def _level_solutions(
    system: System, stretches: Iterable[Stretch], options: LevelOptions
) -> Iterator[LevelSolutions]:
    """Yield the solutions that the force level passes in the middle of stretches, the widest first.

    Both halves of a wide stretch are searched as well: a closed branch may lie beside its middle. The level
    is followed only up to `clear_level`, above which few curves come back. That takes half as long as to its
    end.
    """
    first, last = system.scene.frequency_range
    left = sorted(stretches, key=_width)
    seconds = max(options.work_fraction * system.work.seconds, options.min_seconds)
    with system.work.limited_to(system.work.seconds + seconds):
        while left:
            low, high = left.pop()
            middle = 0.5 * (low + high)
            try:
                yield solutions(system, middle, system.option(LEVEL_CURVE).clear_level)
            except WorkLimitError:
                return
            if high - low > options.wide_range * (last - first):
                left = sorted([*left, (low, middle), (middle, high)], key=_width)


def _width(stretch: Stretch) -> float:
    return stretch[1] - stretch[0]


def _excited_frequencies(found: RefinedResponse, options: LevelOptions) -> Iterator[Stretch]:
    """Yield frequencies at which a low harmonic meets a highest peak, as stretches of width zero.

    Frequencies halfway between that peak and the nearest resonance are included, since peaks of smaller
    motions lie there.
    """
    low, high = found.system.scene.frequency_range
    harmonics = [h for h in found.system.harmonics if 1 < h <= options.strong_harmonics]
    if not harmonics:
        return
    known, inside = [one.omega for one in found.traced.found], linear_resonances(found.system)
    for top in _highest_peaks(found):
        nearest = min(inside, key=lambda omega: abs(omega - top), default=top)
        for omega in (omega / h for h in harmonics for omega in (top, 0.5 * (top + nearest))):
            if low < omega < high and all(
                abs(omega - other) > options.distinct_frequency * omega for other in known
            ):
                known.append(omega)
                yield omega, omega


def _highest_peaks(found: RefinedResponse) -> Iterator[float]:
    """Yield the frequency of the highest peak of each degree of freedom."""
    paths, quantities = found.traced.branches.paths, found.quantities
    heights = np.array([one.amplitude.max(axis=0) for one in quantities])
    for d, k in enumerate(heights.argmax(axis=0).tolist()):
        yield float(paths[k].parameter[quantities[k].amplitude[:, d].argmax()])
