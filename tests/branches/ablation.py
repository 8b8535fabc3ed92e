"""Which answers are lost without each mechanism that looks for branches, peaks, or harmonics.

usage: python -m tests.branches.ablation [HARMONICS] SCENE...   (files, or numbers of random scenes; HARMONICS
is a number, or 0 for as many as the accuracy takes)

Each mechanism is switched off in turn, and what changes is printed: peaks, whether their errors are told,
branches, folds, completeness.
"""

import sys
from contextlib import contextmanager
from importlib import import_module
from unittest.mock import patch

import numpy as np

from fcm.accuracy import refinement, unchecked_response
from fcm.branches import force_level, search
from fcm.branches import trace as branch_trace
from fcm.branches.symmetry_loss import SymmetryLoss
from fcm.response import refined
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import load_scene

from ..response.random_scenes import random_scene

ACCURACY, SAME = 1e-2, 1e-5
curve_trace = import_module("fcm.response.trace")  # not the function of that name

# what is put in the place of what, where it is called
OFF = {
    "folds followed": [(search, "with_isolas", lambda system, found: found)],
    "branch points": [
        (search, "with_branching", lambda system, found: found),
        (refined, "symmetry_loss", lambda system, found: SymmetryLoss()),
    ],
    "symmetry in the level": [(search, "with_unsymmetric", lambda system, found: found)],
    "friction raised from none": [(search, "with_friction_raised", lambda system, found: found)],
    "prolongation": [
        (unchecked_response, "prolongated_solutions", lambda before, harmonics: []),
        (refinement, "prolongated_solutions", lambda before, harmonics: []),
    ],
    "levels in gaps": [(force_level, "frequencies_in_gaps", lambda system, known, peaks=(): ())],
    "levels at lost peaks": [(branch_trace.Traced, "lost_peaks", lambda found, options: ())],
    "levels near peaks without preload": [(search, "with_large_motions", lambda system, found: found)],
    "levels below peaks": [(refined, "with_levels_below_peaks", lambda found, accuracy: found)],
    "levels where nothing is stable": [
        (refined, "with_levels_where_unstable", lambda found, stable, accuracy: (found, False))
    ],
    "narrow resonances": [(branch_trace, "narrow_resonances", lambda system: [])],
    "peaks between points": [(curve_trace, "with_tops", lambda peaks, found: peaks)],
    "stages that ask for more harmonics": [(refined, "retrace", lambda *args: None)],
    "low harmonics": [(refinement, "with_low_harmonics", lambda system, found: system.harmonics)],
}


@contextmanager
def without(patches):
    """Functions of modules replaced."""
    if not patches:
        yield
        return
    (module, name, other), *rest = patches
    with patch.object(module, name, other), without(rest):
        yield


def answer(scene, harmonics):
    """What is compared."""
    given = tuple(range(1, harmonics + 1)) if harmonics else None
    curve = traced_curve(scene, Request(given, ACCURACY))
    answers = {f"peak {dof}": peak.amplitude for dof, peak in curve.peaks.items()}
    answers["peaks of unknown error"] = sum(bool(np.isnan(peak.error)) for peak in curve.peaks.values())
    answers["branches"] = int(np.isnan(curve.frequency).sum()) + 1
    return answers | {"folds": len(curve.folds), "complete": curve.complete}


def changes(before, after):
    """Answers that differ, in words."""
    for name, value in before.items():
        if abs(float(after[name]) - float(value)) > SAME * abs(float(value)):
            yield f"{name} {value:.6g} -> {after[name]:.6g}"


def compared(scene, harmonics):
    """Of each mechanism without which something changes, what does."""
    whole = answer(scene, harmonics)
    for mechanism, patches in OFF.items():
        with without(patches):
            lost = list(changes(whole, answer(scene, harmonics)))
        if lost:
            yield mechanism, lost


def main(arguments):
    """Compare all scenes."""
    harmonics, *names = arguments
    for name in names:
        scene = random_scene(int(name)) if name.isdigit() else load_scene(name).each_curve()[0]
        for mechanism, lost in compared(scene, int(harmonics)):
            print(f"{name} without {mechanism}: {', '.join(lost)}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
