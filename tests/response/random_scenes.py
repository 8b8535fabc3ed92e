"""Random scenes traced with three step limits: ``make study`` prints what became of them.

One to four contacts between random degrees of freedom, two to twelve modes, preloads from open to stuck,
friction from 0 to 2, stiffness ratios from 1e-3 to 1e6, damping from 0 to 0.1. With one harmonic two hundred,
with three the first forty of them.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fcm.model.scene import Contact, Force, Modal, Scene
from fcm.response import Curve, trace

if __package__:
    from .in_time import in_time
else:  # run as a program
    from in_time import in_time

STEPS = (0.1, 0.05, 0.02)
AGREE = 1e-5  # relative, of peaks and folds between the steps
SECONDS = 30  # of a processor, for a scene


def random_scene(seed: int) -> Scene:
    rng = np.random.default_rng(seed)
    modes, dofs = int(rng.integers(2, 13)), int(rng.integers(2, 9))
    frequency = np.concatenate(([1.0], np.sort(rng.uniform(1.0, 10.0, modes - 1))))
    damping = np.zeros(modes) if rng.random() < 0.1 else 10.0 ** rng.uniform(-4.0, -1.0, modes)
    names = tuple(f"d{i}" for i in range(dofs))
    modal = Modal(names, np.ones(modes), frequency, damping, rng.normal(size=(modes, dofs)))
    contacts = tuple(_contact(rng, f"c{k}", dofs) for k in range(rng.integers(1, 5)))
    forces = tuple(
        Force(np.eye(dofs)[rng.integers(dofs)], 1.0, float(rng.uniform(0.0, 2.0 * np.pi)))
        for _ in range(rng.integers(1, 3))
    )
    span = (float(rng.uniform(0.3, 0.8)), float(rng.uniform(1.3, 3.0)))
    return Scene(f"random {seed}", modal, contacts, forces, span, 0.05, harmonics=(1,))


def _contact(rng: np.random.Generator, name: str, dofs: int) -> Contact:
    first, second = rng.choice(dofs, 2, replace=False)
    tangential, normal = np.eye(dofs)[first], np.eye(dofs)[second]
    if rng.random() < 0.4:  # between two points of the structure
        tangential = tangential - 0.8 * np.eye(dofs)[rng.integers(dofs)]
        normal = normal - 0.7 * np.eye(dofs)[rng.integers(dofs)]
    stiff = rng.random() < 0.3
    k_u = float(10.0 ** (rng.uniform(-3.0, 6.0) if stiff else rng.uniform(-1.0, 2.0)))
    k_v = float(k_u * 10.0 ** rng.uniform(-1.0, 1.0))
    mu = 0.0 if rng.random() < 0.05 else float(rng.uniform(0.0, 2.0))
    n_0 = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-2.0, 2.0))
    return Contact(name, tangential, normal, mu, k_u, k_v, n_0)


@dataclass
class Outcome:
    seed: int
    curves: list[Curve]

    @property
    def complete(self) -> bool:
        return all(curve.complete for curve in self.curves)

    @property
    def reasons(self) -> set[str]:
        return {curve.reason.split(": ")[-1] for curve in self.curves if not curve.complete}

    @property
    def disagreement(self) -> float:
        """Greatest relative difference of a peak or a fold from those of the finest step."""
        finest = self.curves[-1]
        return max(self._difference(curve, finest) for curve in self.curves[:-1])

    @staticmethod
    def _difference(one: Curve, other: Curve) -> float:
        if len(one.folds) != len(other.folds):
            return np.inf
        pairs = [(one.peaks[dof][0], other.peaks[dof][0]) for dof in one.peaks]
        pairs += list(zip(one.folds, other.folds, strict=True))
        return max(abs(a / b - 1.0) for a, b in pairs)


def outcome(seed: int, highest: int = 1) -> Outcome:
    scene = replace(random_scene(seed), harmonics=tuple(range(1, highest + 1)))
    return Outcome(seed, [trace(replace(scene, max_step=step)).curves[0] for step in STEPS])


def main(count: int = 200, of_three: int = 40, at_once: int = 2) -> None:
    study(count, 1, at_once)
    study(of_three, 3, at_once)


def study(count: int, highest: int, at_once: int) -> None:
    """Print what became of so many scenes."""
    reasons: Counter[str] = Counter()
    agree, differ, late = 0, [], []
    for seed, result in in_time(partial(outcome, highest=highest), range(count), SECONDS, at_once):
        if result is None:
            late.append(seed)
            continue
        reasons.update(result.reasons)
        if result.complete:
            good = result.disagreement < AGREE
            agree += good
            differ += [] if good else [(seed, result.disagreement)]
    print(f"{count} random scenes with harmonics up to {highest}, each with the step limits {STEPS}")
    print(f"{agree:5d}  complete; peaks and folds agree between the steps to {AGREE:g}")
    print(f"{len(differ):5d}  complete; they differ by more (seed, by): {differ}")
    for reason, number in reasons.most_common():
        print(f"{number:5d}  stopped: {reason}")
    print(f"{len(late):5d}  not done within {SECONDS} s of a processor, or failed: {sorted(late)}")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
