"""A response with every branch: isolated ones, and those that leave others at branch points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.accuracy.refinement import Accurate, enlarged, finer
from fcm.branches.branch_points import all_up_to
from fcm.branches.prolongation import prolongated
from fcm.branches.search import symmetry_lost, with_branching, with_isolas
from fcm.branches.trace import with_further
from fcm.response.further_levels import with_levels_below_peaks, with_traced

ROUNDS = 3  # of more harmonics, for branches that were not known when the harmonics were chosen


def with_all_branches(found: Accurate, accuracy: float | None) -> Accurate:
    """The response with these branches; with an accuracy also with the harmonics that they take."""
    most = np.inf if accuracy is None else accuracy
    known = found.traced
    found = _searched(found, most)
    lost = symmetry_lost(found.system, found.traced)
    for _ in range(0 if accuracy is None else ROUNDS):
        more = found.system.harmonics
        if lost:
            more = all_up_to(found.system).harmonics
        elif found.traced is not known and not _enough(found, most):
            more = enlarged(found, most)
        again = None if more == found.system.harmonics else finer(found, more, most)
        if again is None:
            break
        known = again.traced
        found = _searched(_with_prolongated(again, found, most), most)
        lost = symmetry_lost(found.system, found.traced)
    return replace(found, traced=replace(found.traced, symmetry_lost=lost)) if lost else found


def _enough(found: Accurate, accuracy: float) -> bool:
    """Whether all errors that can be told are within the accuracy, those of the peaks among them."""
    return found.told <= accuracy and not np.isnan(found.peak).any()


def _searched(found: Accurate, accuracy: float) -> Accurate:
    """With what levels below its peaks, its folds and its branch points lead to."""
    found = with_levels_below_peaks(found, accuracy)
    traced = with_branching(found.system, with_isolas(found.system, found.traced))
    return found if traced is found.traced else with_traced(found, traced, accuracy)


def _with_prolongated(found: Accurate, fewer: Accurate, accuracy: float) -> Accurate:
    """A response with the branches that those of fewer harmonics lead to."""
    starts = list(prolongated(found.system, fewer.system.harmonics, fewer.traced.branches.paths))
    return with_traced(found, with_further(found.system, found.traced, (), starts), accuracy)
