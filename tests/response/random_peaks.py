"""Peaks of random scenes against the exact motion: ``make study`` prints how true they and their errors are.

Each scene is traced with the harmonics that an accuracy takes. At the greatest amplitude of each degree of
freedom the exact periodic motion is found at the same frequency, from the balance's own state; where there is
none beside it, the peak is counted as alone.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fcm.harmonic.choice import accurate
from fcm.harmonic.system import System

if __package__:
    from ..harmonic.truth import exact
    from .random_scenes import random_scene
else:  # run as a program
    sys.path += [str(Path(__file__).parents[1] / "harmonic")]
    from random_scenes import random_scene
    from truth import exact

ACCURACY = 1e-2
MOVING = 1e-3  # of the greatest amplitude, from which on a degree of freedom is compared
SAME = 0.3  # relative difference, beyond which the exact motion is another solution
SMALLEST = 1e-4  # error, below which an estimate is not compared with it


class Peak(NamedTuple):
    seed: int
    contacts: int
    estimate: float  # nan where the method cannot tell
    error: float  # nan where no exact motion is beside it


def peaks(seed: int) -> list[Peak]:
    """Those of a scene; none of one whose curve has no branches."""
    scene = replace(random_scene(seed), harmonics=None)
    found = accurate(System(scene), ACCURACY)
    paths = found.traced.branches.paths
    if not paths:
        return []
    heights = np.array([one.amplitude.max(axis=0) for one in found.shown])
    out, known = [], {}
    for d, k in enumerate(heights.argmax(axis=0)):
        if heights[k, d] < MOVING * heights.max():
            continue
        top = int(found.shown[k].amplitude[:, d].argmax())
        if (k, top) not in known:
            known[k, top] = exact(found.system, paths[k].z[top])
        motion = known[k, top]
        error = np.nan if motion is None else abs(heights[k, d] / motion[d] - 1.0)
        error = error if error < SAME else np.nan
        out.append(Peak(seed, len(scene.contacts), float(found.peak[d]), float(error)))
    return out


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


def main(count: int = 200) -> None:
    found: list[Peak] = []
    with ProcessPoolExecutor() as processes:
        for done, some in enumerate(processes.map(peaks, range(count)), start=1):
            print(f"\r{done} of {count}", end="", file=sys.stderr, flush=True)
            found += some
    print(file=sys.stderr)
    print(f"Peaks of {count} random scenes with the accuracy {ACCURACY:g}, beside the exact motion there;")
    print(f"estimates are compared where the error or the estimate is above {SMALLEST:g}")
    print("contacts  peaks  alone  within    median    9 in 10 untold  compared in 2x  low3 high3")
    for contacts in sorted({peak.contacts for peak in found}):
        print(f"{contacts:8d} {shares([peak for peak in found if peak.contacts == contacts])}")
    print(f"     all {shares(found)}")
    worst = sorted(
        (p for p in found if p.error > 3.0 * p.estimate and p.error > SMALLEST), key=lambda p: -p.error
    )
    print(
        "low by more than three (seed, estimated, true):", [(p.seed, p.estimate, p.error) for p in worst[:10]]
    )


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
