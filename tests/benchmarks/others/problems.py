"""What is set before other packages, and what fcm makes of it: ``make bench-others``, its first part.

Eight preloads of the paper's oscillator with one harmonic and with three, and fifty random scenes with one.
All in modal coordinates, in a file that needs no fcm to be read. The reference of a peak is exact in its
forces: the same harmonics in closed form or with located events, with steps sixteen times shorter.
"""

from __future__ import annotations

import json
import platform
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import fcm
from fcm.model.scene import Scene
from fcm.response import Curve, trace
from fcm.run import Execution

sys.path.append(str(Path(__file__).parents[2] / "response"))
from random_scenes import random_scene

PRELOADS = (50.0, 20.0, 10.0, 5.0, 2.0, 0.0, -5.0, -20.0)  # without 100 and -60, which are linear
HARMONICS = (1, 3)  # all up to these
FINEST = 1.0 / 16.0  # of the longest steps
REPEATS = 2  # of every curve; the least time counts
RANDOM = 50


def preloads() -> list[Scene]:
    """The curves of the paper's figure 13 that are not linear."""
    swept = fcm.load_scene("yang1998").curves
    return [replace(c, curves=()) for n in PRELOADS for c in swept if c.contacts[0].n_0 == n]


def problem(scene: Scene, dof: int) -> dict[str, Any]:
    """A scene in coordinates of its modes, normalised to the mass; the output is its amplitude at a dof."""
    modal = scene.modal
    shapes = modal.shapes / np.sqrt(modal.mass)[:, None]
    forces = [(shapes @ f.direction * f.amplitude, f.phase) for f in scene.forces]
    return {
        "natural": modal.frequency.tolist(),
        "damping": modal.damping.tolist(),
        "cosine": sum(f * np.sin(phase) for f, phase in forces).tolist(),  # of F sin(wt + phase)
        "sine": sum(f * np.cos(phase) for f, phase in forces).tolist(),
        "range": list(scene.frequency_range),
        "contacts": [
            {
                "mu": c.mu, "k_u": c.k_u, "k_v": c.k_v, "n_0": c.n_0,
                "tangential": (shapes @ c.tangential).tolist(), "normal": (shapes @ c.normal).tolist(),
            }
            for c in scene.contacts
        ],
        "output": shapes[:, dof].tolist(),
    }  # fmt: skip


TABLE = fcm.open_table()


def traced(scene: Scene, harmonics: int) -> tuple[float, Curve]:
    """A curve as a user gets it, errors and stability included, and its processor time [s]."""
    best = np.inf
    for _ in range(REPEATS):
        begin = time.process_time()
        (curve,) = trace(scene, method=TABLE, harmonics=harmonics, execution=Execution(jobs=1)).curves
        best = min(best, time.process_time() - begin)
    return float(best), curve


def compared(name: str, group: str, scene: Scene, harmonics: int, fine: bool) -> dict[str, Any]:
    """A problem with its reference, and fcm's own result."""
    seconds, curve = traced(scene, harmonics)
    peaks = {d: curve.peaks[dof].amplitude for d, dof in enumerate(scene.modal.dofs) if dof in curve.peaks}
    dof = 0 if group == "preloads" else max(peaks, key=lambda d: peaks[d]) if peaks else 0
    peak = folds = None
    if fine:
        (reference,) = trace(
            replace(scene, max_step=FINEST * scene.max_step),
            "closed-form",
            harmonics=harmonics,
            execution=Execution(jobs=1),
        ).curves
        peak, folds = reference.peaks[scene.modal.dofs[dof]].amplitude, len(reference.folds)
    own = {
        "points": curve.points, "seconds": seconds, "complete": curve.complete, "state": curve.reason,
        "peak": peaks.get(dof), "folds": len(curve.folds),
    }  # fmt: skip
    return {
        "name": name, "group": group, "harmonics": harmonics, **problem(scene, dof),
        "peak": peak if fine else own["peak"], "folds": folds, "fcm": own,
    }  # fmt: skip


def main(output: Path) -> None:
    found = [
        compared(f"n_0 = {scene.contacts[0].n_0:g}", "preloads", scene, harmonics, fine=True)
        for harmonics in HARMONICS
        for scene in preloads()
    ]
    found += [
        compared(f"random {seed}", "random", random_scene(seed), 1, fine=False) for seed in range(RANDOM)
    ]
    versions = f"fcm {fcm.__version__}, Python {platform.python_version()}, numpy {np.__version__}"
    output.write_text(json.dumps({"versions": versions, "problems": found}), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
