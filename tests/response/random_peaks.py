"""Peaks of random scenes against the exact motion: ``make study`` prints how true they and their errors are.

Each scene is traced with the harmonics that an accuracy takes. For the greatest amplitude of each degree of
freedom the peak of the exact motion is sought beside it, on the curve of periodic motions next to the
balance's own; where there is none, the peak is counted as alone.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fcm.accuracy.refinement import RefinedResponse, refined_response
from fcm.harmonic_balance.system import System
from fcm.shooting.harmonic_balance_state import state_of
from fcm.shooting.orbit_record import OrbitRecord
from fcm.shooting.peaks_and_folds import OrbitGuess, located
from fcm.shooting.problem import OrbitProblem
from fcm.time_domain import SimulationError

if __package__:
    from .in_time import in_time
    from .random_scenes import random_scene
else:  # run as a program
    from in_time import in_time
    from random_scenes import random_scene

ACCURACY = 1e-2
MOVING = 1e-3  # of the greatest amplitude, from which on a degree of freedom is compared
SAME = 0.5  # relative difference, beyond which the exact motion is another solution
SMALLEST = 1e-4  # error, below which an estimate is not compared with it
SECONDS = 10  # of a processor, for a scene: what takes longer is counted


class Peak(NamedTuple):
    seed: int
    contacts: int
    estimate: float  # nan where the method cannot tell
    error: float  # nan where no exact motion is beside it


def peaks(seed: int) -> list[Peak]:
    """Those of a scene; none of one whose curve has no branches."""
    scene = replace(random_scene(seed), harmonics=None)
    found = refined_response(System(scene), ACCURACY)
    if not found.traced.branches.paths:
        return []
    heights = np.array([one.amplitude.max(axis=0) for one in found.quantities])
    problem, known, out = OrbitProblem(scene), list[OrbitRecord](), []
    for d, k in enumerate(heights.argmax(axis=0)):
        if heights[k, d] < MOVING * heights.max():
            continue
        exact = height(found, problem, known, int(k), d)
        error = np.nan if exact is None else abs(heights[k, d] / exact - 1.0)
        error = error if error < SAME else np.nan
        out.append(Peak(seed, len(scene.contacts), float(found.peak[d]), float(error)))
    return out


def height(
    found: RefinedResponse, problem: OrbitProblem, known: list[OrbitRecord], number: int, d: int
) -> float | None:
    """Of the exact peak beside the greatest amplitude of a degree of freedom on a path."""
    path, amplitude = found.traced.branches.paths[number], found.quantities[number].amplitude[:, d]
    top = int(amplitude.argmax())
    beside = top - 1 if top else 1
    scene, harmonics = found.system.scene, found.system.harmonics
    here, there = (state_of(scene, harmonics, path.z[i]) for i in (top, beside))
    guess = OrbitGuess(float(path.parameter[top]), here, (float(path.parameter[beside]), there), d)
    try:
        peak = located(problem, guess, known)
    except SimulationError:
        return None
    return None if peak is None else float(peak.measure.amplitude[d])


def shares(found: Sequence[Peak]) -> str:
    """A line of a table: of the true errors, and of estimated over true."""
    error = np.array([peak.error for peak in found])
    estimate = np.array([peak.estimate for peak in found])
    there, told = np.isfinite(error), np.isfinite(estimate)
    both = there & told & (np.maximum(error, estimate) > SMALLEST)
    ratio = estimate[both] / np.maximum(error[both], 1e-300)
    within = _percent(error[there] <= ACCURACY)
    twice = _percent((ratio >= 0.5) & (ratio <= 2.0))
    low, high = np.count_nonzero(ratio < 1.0 / 3.0), np.count_nonzero(ratio > 3.0)
    median, tenth = np.quantile(error[there], (0.5, 0.9)) if there.any() else (np.nan, np.nan)
    return (
        f"{len(found):6d} {np.count_nonzero(~there):6d} {within:>7} {median:9.1e} {tenth:9.1e} "
        f"{np.count_nonzero(~told):6d} {both.sum():6d} {twice:>7} {low:5d} {high:5d}"
    )


def _percent(which: np.ndarray) -> str:
    return f"{100.0 * np.mean(which):.0f} %" if which.size else "-"


def main(count: int = 200, at_once: int = 2) -> None:
    found: list[Peak] = []
    late = []
    for seed, some in in_time(peaks, range(count), SECONDS, at_once):
        late += [seed] if some is None else []
        found += some or []
    print(f"Peaks of {count} random scenes with the accuracy {ACCURACY:g}, beside those of the exact motion;")
    report(found)
    print(f"not done within {SECONDS} s of a processor, or failed: {len(late)}:", sorted(late))


def report(found: Sequence[Peak]) -> None:
    """Print how true peaks and their errors are."""
    print(f"estimates are compared where the error or the estimate is above {SMALLEST:g}")
    print("contacts  peaks  alone  within    median    9 in 10 unknown  compared in 2x  low3 high3")
    for contacts in sorted({peak.contacts for peak in found}):
        print(f"{contacts:8d} {shares([peak for peak in found if peak.contacts == contacts])}")
    print(f"     all {shares(found)}")
    error = np.array([peak.error for peak in found if np.isfinite(peak.estimate + peak.error)])
    print(f"within the accuracy of those whose error is told: {_percent(error <= ACCURACY)}")
    worst = sorted(
        (p for p in found if p.error > 3.0 * p.estimate and p.error > SMALLEST), key=lambda p: -p.error
    )
    print(
        "low by more than three (seed, estimated, true):", [(p.seed, p.estimate, p.error) for p in worst[:10]]
    )


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
