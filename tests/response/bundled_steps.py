"""Peaks and folds of the bundled scenes with three step limits: ``make study`` prints where they differ."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
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
    """Of the curves of a scene from those with the finest step, the greatest and where it is."""

    curves: int
    incomplete: int
    peaks: float = 0.0
    folds: float = 0.0  # infinite where there are not as many
    where: str = ""


def names() -> list[str]:
    """Of the scenes that come with the program."""
    scenes = files("fcm.scenes").iterdir()
    return sorted(one.name.removesuffix(".toml") for one in scenes if one.name.endswith(".toml"))


def difference(name: str) -> Difference:
    """Of a scene."""
    scenes = fcm.load_scene(name).each_curve()
    found = Difference(len(scenes), 0)
    for scene in scenes:
        *coarse, finest = (trace(replace(scene, max_step=step)).curves[0] for step in STEPS)
        if not all(curve.complete for curve in (*coarse, finest)):
            found.incomplete += 1
            continue
        for step, curve in zip(STEPS[:-1], coarse, strict=True):
            peaks, folds = differ(curve, finest)
            if max(peaks, folds) > max(found.peaks, found.folds):
                numbers = [f"{key} {value:g}" for key, value in scene.parameters.items()]
                found.where = ", ".join((*numbers, f"step {step:g}"))
            found.peaks, found.folds = max(found.peaks, peaks), max(found.folds, folds)
    return found


def differ(one: Curve, other: Curve) -> tuple[float, float]:
    """Greatest relative differences of peaks and of folds."""
    pairs = [(one.peaks[dof][0], other.peaks[dof][0]) for dof in one.peaks]
    peaks = max((abs(a / b - 1.0) for a, b in pairs if b > 0.0), default=0.0)
    if len(one.folds) != len(other.folds):
        return peaks, np.inf
    folds = zip(sorted(one.folds), sorted(other.folds), strict=True)
    return peaks, max((abs(a / b - 1.0) for a, b in folds), default=0.0)


def main(at_once: int = 2) -> None:
    print(f"Peaks and folds of the bundled scenes with the step limits {STEPS}, relative to the last:")
    print(f"{'scene':<24} curves incomplete    peaks    folds")
    for name, found in in_time(difference, names(), SECONDS, at_once):
        if found is None:
            print(f"{name:<24} not done within {SECONDS} s")
            continue
        differs = f"{found.peaks:8.1e} {found.folds:8.1e}"
        where = f"  at {found.where}" if max(found.peaks, found.folds) > AGREE else ""
        print(f"{name:<24} {found.curves:6d} {found.incomplete:10d} {differs}{where}")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
