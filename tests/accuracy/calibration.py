"""How true the estimated errors are: python tests/accuracy/calibration.py [points of a path]

For curves of 1, 2, 3 and 5 harmonics, each with its errors at points and at the greatest amplitude of each
degree of freedom: the estimate over the truth, which is the exact motion where shooting finds it, else the
balance of 21 harmonics. Printed are the shares of estimates within a factor of two, low by more than three
and high by more than three, the worst low one, and the points where the method cannot tell.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

try:
    from ..harmonic_balance.truth import MANY, SAME, Truth, exact, scene
except ImportError:  # run as a program
    sys.path.append(str(Path(__file__).parents[1] / "harmonic_balance"))
    from truth import MANY, SAME, Truth, exact, scene

from fcm.accuracy.options import PAIR
from fcm.accuracy.refinement import with_errors
from fcm.accuracy.unchecked_response import unchecked_response
from fcm.continuation import FollowOptions, Mark, follow
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.harmonic_balance.system import System

CASES = (
    *(("yang1998", preload) for preload in (100, 50, 20, 10, 5, 2, 0, -5, -20)),
    *((name, None) for name in ("gap5", "stuck_mean", "isola", "isola-stuck", "sub", "chaos")),
    *(("shroud", preload) for preload in (300, 100, 20, 10, 7.5)),
)
HARMONICS = ((1,), (1, 2), (1, 2, 3), (1, 2, 3, 4, 5))
SMALLEST = 1e-4  # errors below are not compared
STEP = 0.1  # longest, along a branch that is followed
MOVING = 1e-3  # of the greatest amplitude at a point, from which on a degree of freedom is compared


def with_estimated_errors(system, accuracy):
    """The response of a system, with its errors."""
    return with_errors(unchecked_response(system), accuracy)


def points(system, number):
    """(estimate, truth) of amplitudes at points of the system's curves, and how many could not be told."""
    found, truth = with_estimated_errors(system, 0.0), Truth(system)
    pairs, silent, alone, checked = [], 0, 0, 0
    for path, quantities, errors in zip(
        found.traced.branches.paths, found.quantities, found.errors, strict=True
    ):
        at = np.linspace(1, len(path.z) - 2, number).astype(int)
        for i in np.setdiff1d(at, path.where(Mark.FOLD | Mark.PEAK)):
            known, now = errors.amplitude[i], quantities.amplitude[i]
            if np.isnan(known).any():
                silent += 1
                continue
            z = truth.at(path.z[i], path.direction[i])
            if z is None:
                alone += 1
                continue
            many = truth.amplitude(z)
            motion = exact(truth.many, z)
            if motion is not None and np.abs(motion / many - 1.0).max() < SAME:
                many, checked = motion, checked + 1
            moving = now > MOVING * now.max()
            pairs += zip(known[moving], np.abs(many / now - 1.0)[moving], strict=True)
    return np.array(pairs).reshape(-1, 2), silent, alone, checked


def peaks(case, harmonics):
    """(estimate, truth) of the greatest amplitude of each degree of freedom, by a balance of many.

    What that balance does not come to from the starts of its own, as a closed branch within the range, counts
    where a branch of fewer harmonics leads to it and the exact motion is there, too; for all of these.
    """
    system = System(case)
    true = with_estimated_errors(system.with_harmonics(MANY), 0.0)
    height = np.max([one.amplitude.max(axis=0) for one in true.quantities], axis=0)
    few = [with_estimated_errors(system.with_harmonics(one), 0.0) for one in harmonics]
    for found in few:
        for path, quantities in zip(found.traced.branches.paths, found.quantities, strict=True):
            if (quantities.amplitude.max(axis=0) > PAIR.rival_fraction * height).any():
                height = np.maximum(height, beyond(found.system, path, quantities.amplitude))
    for found in few:
        now = np.max([quantities.amplitude.max(axis=0) for quantities in found.quantities], axis=0)
        yield np.column_stack((found.peak, np.abs(height / now - 1.0)))


def beyond(system, path, amplitude):
    """Greatest amplitudes of the curve of many harmonics next to the highest point of a path."""
    truth, at = Truth(system), int((amplitude / amplitude.max(axis=0)).mean(axis=1).argmax())
    z = truth.beside(path.z[at], path.direction[at])
    motion = None if z is None else exact(truth.many, z)
    if motion is None or np.abs(motion / truth.amplitude(z) - 1.0).max() > SAME:
        return np.zeros(amplitude.shape[1])
    span = system.scene.frequency_range
    sides = [
        follow(truth.many.new_balance(), z, span, options=FollowOptions(STEP), forward=forward)
        for forward in (True, False)
    ]
    return np.max([reported_quantities(truth.many, side).amplitude.max(axis=0) for side in sides], axis=0)


def summary(pairs):
    """Shares of estimates over truths, of those that matter."""
    pairs = pairs[np.isfinite(pairs).all(axis=1)]
    pairs = pairs[pairs.max(axis=1, initial=0.0) > SMALLEST]
    if not len(pairs):
        return "nothing to compare"
    ratio = pairs[:, 0] / np.maximum(pairs[:, 1], 1e-12)
    within, low, high = (0.5 <= ratio) & (ratio <= 2.0), ratio < 1.0 / 3.0, ratio > 3.0
    worst = pairs[ratio.argmin()]
    return (
        f"{len(pairs):5d}: within two {within.mean():.3f}, low by three {low.mean():.4f}, "
        f"high {high.mean():.4f}; "
        f"worst low {ratio.min():.2g} ({worst[0]:.1e} for {worst[1]:.1e})"
    )


def main():
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    all_points, all_peaks = [], []
    for name, preload in CASES:
        one = scene(name, preload)
        tops = list(peaks(one, HARMONICS))
        all_peaks += tops
        for harmonics, top in zip(HARMONICS, tops, strict=True):
            pairs, silent, alone, checked = points(System(one, harmonics), number)
            all_points.append(pairs)
            print(f"{name} {preload or ''} {len(harmonics)}: points {summary(pairs)}", flush=True)
            print(f"      {silent} not told, {alone} without truth, {checked} exact; peaks {summary(top)}")
    for what, pairs in (("points", all_points), ("peaks", all_peaks)):
        joined = np.concatenate(pairs)
        print(f"all {what}: {summary(joined)}; not told {np.isnan(joined[:, 0]).mean():.3f}")
        for low, high in ((1e-4, 1e-3), (1e-3, 1e-2), (1e-2, 1e-1), (1e-1, 1e3)):
            some = joined[(joined[:, 0] >= low) & (joined[:, 0] < high)]
            print(f"    estimated {low:g} to {high:g}: {summary(some)}")


if __name__ == "__main__":
    main()
