"""A response with the isolated branches that the folds of the level of the forces lead to."""

from __future__ import annotations

import numpy as np

from fcm.branches.prolongation import prolongated
from fcm.branches.search import with_isolas
from fcm.harmonic.choice import Accurate, enlarged, finer
from fcm.harmonic.restless import with_traced
from fcm.harmonic.trace import with_further

ROUNDS = 2  # of more harmonics, for branches that were not known when the harmonics were chosen


def with_all_branches(found: Accurate, accuracy: float | None) -> Accurate:
    """The response with these branches; with an accuracy also with the harmonics that they take."""
    most = np.inf if accuracy is None else accuracy
    traced = with_isolas(found.system, found.traced)
    if traced is found.traced:
        return found
    found = with_traced(found, traced, most)
    for _ in range(ROUNDS if accuracy is not None else 0):
        more = found.system.harmonics if found.reached else enlarged(found, most)
        if more == found.system.harmonics:
            break
        again = finer(found, more, most)
        if again is None:
            break
        found = _with_prolongated(again, found, most)
    return found


def _with_prolongated(found: Accurate, fewer: Accurate, accuracy: float) -> Accurate:
    """A response with the branches that those of fewer harmonics lead to."""
    starts = list(prolongated(found.system, fewer.system.harmonics, fewer.traced.branches.paths))
    return with_traced(found, with_further(found.system, found.traced, (), starts), accuracy)
