"""Peaks and folds of the bundled scenes with three step limits: ``make study`` prints where they differ."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from importlib.resources import files

import numpy as np

import fcm
from fcm.response import Curve, trace

if __package__:
    from .in_time import in_time
else:  # run as a program
    from in_time import in_time

STEPS = (0.2, 0.05, 0.005)
AGREE = 1e-5  # relative, of peaks and folds between the steps
SECONDS = 120  # of a processor, for a scene


@dataclass
class Difference:
    """What differs from the finest step: the greatest relative difference, and folds that are missing."""

    curves: int
    incomplete: int
    peaks: float
    folds: float  # inf where there are not as many
    where: str = ""


def names() -> list[str]:
    """Of the scenes that come with the program."""
    return sorted(
        one.name.removesuffix(".toml") for one in files("fcm.scenes").iterdir() if one.name.endswith(".toml")
    )


def difference(name: str) -> Difference:
    """Of the curves of a scene."""
    scene = fcm.load_scene(name)
    every = [trace(scene, max_step=step).curves for step in STEPS]
    found = Difference(len(every[0]), 0, 0.0, 0.0)
    for number, curves in enumerate(zip(*every, strict=True)):
        if not all(curve.complete for curve in curves):
            found.incomplete += 1
            continue
        finest = curves[-1]
        for step, curve in zip(STEPS, curves[:-1], strict=False):
            peaks, folds = differ(curve, finest)
            if max(peaks, folds) > max(found.peaks, found.folds):
                found.where = f"{', '.join(f'{k} {v:g}' for k, v in scene.each_curve()[number].parameters.items())}, step {step:g}"
            found.peaks, found.folds = max(found.peaks, peaks), max(found.folds, folds)
    return found


def differ(one: Curve, other: Curve) -> tuple[float, float]:
    """Greatest relative differences of peaks and of folds."""
    peaks = max(
        (abs(one.peaks[dof][0] / other.peaks[dof][0] - 1.0) for dof in one.peaks if other.peaks[dof][0]),
        default=0.0,
    )
    if len(one.folds) != len(other.folds):
        return peaks, np.inf
    folds = max(
        (abs(a / b - 1.0) for a, b in zip(sorted(one.folds), sorted(other.folds), strict=True)), default=0.0
    )
    return peaks, folds


def main(at_once: int = 2) -> None:
    print(f"Peaks and folds of the bundled scenes, step limits {STEPS}: relative differences from the last")
    print(f"{'scene':<24} curves incomplete    peaks    folds")
    for name, found in in_time(difference, names(), SECONDS, at_once):
        if found is None:
            print(f"{name:<24} not done within {SECONDS} s")
            continue
        where = f"  at {found.where}" if max(found.peaks, found.folds) > AGREE else ""
        print(
            f"{name:<24} {found.curves:6d} {found.incomplete:10d} {found.peaks:8.1e} {found.folds:8.1e}{where}"
        )


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
