"""Exact curves of structures with many modes that hardly anything damps: what they take.

The first 24 random scenes with seven modes or more, with the damping ratios of 1e-4 to 0.1 that are drawn for
their modes, and with 1e-4 for each. A curve has so many seconds, of a processor on which np.sin takes 10 ns;
where that is not enough, it has at least the points found until then. Beside it stands what as many points
take at one period of the motion and its derivative each. As a program: seconds, ``drawn`` or 0.0001 for one
of the two alone, and ``peaks`` if the peaks, folds and jumps are wanted alone.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import count, islice
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

from fcm.response import exact_curve
from fcm.response.exact import trace_exact
from fcm.response.options import RESPONSE
from fcm.response.orbit_branches import OrbitBranches
from fcm.response.orbit_curve import orbit_curve
from fcm.results.result import Curve

sys.path += [str(Path(__file__).parent), str(Path(__file__).parents[1] / "benchmarks")]
from in_time import in_time
from random_scenes import random_scene
from unit import SINE, sine

MODES, DAMPING, SCENES = 7, 1e-4, 24
AFTERWARDS = 4  # times as long as it has, after which a curve that has not ended is not waited for
CUT_OFF = "not finished in"  # how the reason of a curve begins that has taken as long as it may
MEASURED = 100  # points of a curve at which a period and its derivative are timed


class Taken(NamedTuple):
    complete: bool
    reason: str
    seconds: float
    points: int
    folds: int
    bare: float  # [s] a period and its derivative at one of the points


def taken(seed: int, limit: float, damping: float | None, only: str | None) -> Taken:
    """What the exact curve of a scene has come to in so many seconds here; damping as drawn if it is None."""
    scene, groups = random_scene(seed), list[OrbitBranches]()
    if damping is not None:
        alike = np.full(scene.modal.mass.size, damping)
        scene = replace(scene, modal=replace(scene.modal, damping=alike))

    def noted(found: Sequence[OrbitBranches], *rest: Any) -> Curve:
        groups[:] = found
        return orbit_curve(found, *rest)

    options = replace(RESPONSE, exact=replace(RESPONSE.exact, max_seconds=limit))
    begin = time.process_time()
    with patch.object(exact_curve, "orbit_curve", noted):
        (curve,) = trace_exact(scene, only=only, options=options).curves
    seconds, points = time.process_time() - begin, np.count_nonzero(np.isfinite(curve.frequency))
    return Taken(curve.complete, curve.reason, seconds, int(points), len(curve.folds), _bare(groups))


def _bare(groups: Sequence[OrbitBranches]) -> float:
    """Seconds of a period and its derivative, the mean of points all along the curve."""
    z = [row for group in groups for path in group.paths for row in path.z]
    if not z:
        return np.nan
    some = [z[k] for k in np.unique(np.linspace(0, len(z) - 1, MEASURED).astype(int))]
    begin = time.process_time()
    for row in some:
        assert groups[0].problem.shooting.residual(row[:-1], float(row[-1])).derivative.size
    return (time.process_time() - begin) / len(some)


def main(seconds: float, damping: float | None, only: str | None) -> None:
    scale = 1e6 * sine() / SINE
    seeds = list(islice((k for k in count() if random_scene(k).modal.mass.size >= MODES), SCENES))
    work = partial(taken, limit=seconds * scale, damping=damping, only=only)
    ratio = "those drawn" if damping is None else f"{damping:g}"
    print(f"{only or 'all points'} of the exact curves of {SCENES} random scenes with at least {MODES} modes")
    print(f"damping ratios: {ratio}; each in {seconds:g} s (of which one takes {scale:.2f} s here)")
    print("seed       s  points   folds   a period and its derivative [us], of all these points [s]")
    done = ended = more = 0
    for seed, found in in_time(work, seeds, int(AFTERWARDS * seconds * scale) + 1):
        if found is None:
            print(f"{seed:4d}  not waited for any longer, or failed", flush=True)
            continue
        took, bare = found.seconds / scale, found.bare / scale
        by_itself = took <= seconds and not found.reason.startswith(CUT_OFF)
        done, ended = done + (found.complete and by_itself), ended + (by_itself and not found.complete)
        more += found.points * bare > seconds
        print(
            f"{seed:4d} {took:7.1f} {found.points:7d} {found.folds:7d} {1e6 * bare:10.0f} "
            f"{found.points * bare:10.1f}  {found.reason}",
            flush=True,
        )
    print(f"{done} complete in {seconds:g} s, {ended} at an end by then and not complete; of {more} these")
    print("points alone take more than that", flush=True)


if __name__ == "__main__":
    words = [word for word in sys.argv[2:] if word != "peaks"]
    for each in words or ("drawn", DAMPING):
        main(
            float(sys.argv[1]) if sys.argv[1:] else 10.0,
            None if each == "drawn" else float(each),
            "peaks" if "peaks" in sys.argv else None,
        )
