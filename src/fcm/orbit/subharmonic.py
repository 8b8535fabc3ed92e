"""Motions that repeat after several periods of the force."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fcm.motion.measure import Measure, measure
from fcm.motion.run import cycles_from
from fcm.motion.state import State
from fcm.motion.system import System

MOST_PERIODS = 8
REPEATS = 1e-6  # difference of two states, relative to the motion, below which it does


class Repeating(NamedTuple):
    """A motion that repeats."""

    periods: int
    states: tuple[str, ...]  # of each contact in its last period
    measure: Measure  # over all periods
    error: float  # by which it fails to repeat, relative to the motion


def repeating(system: System, state: State) -> Repeating | None:
    """A simulated motion that repeats after two to MOST_PERIODS periods, else None."""
    start = np.concatenate((state.q, state.velocity / system.omega))
    cycles = []
    for cycle, end in cycles_from(system, MOST_PERIODS, state):
        cycles.append(cycle)
        size = max(max(c.segments.largest()[system.q].max() for c in cycles), 1e-300)
        error = float(np.abs(np.concatenate((end.q, end.velocity / system.omega)) - start).max()) / size
        if error < REPEATS and len(cycles) == 1:
            return None
        if error < REPEATS:
            return Repeating(len(cycles), cycles[-1].states, together([measure(c) for c in cycles]), error)
    return None


def together(measures: Sequence[Measure]) -> Measure:
    """Measures of successive cycles as of one motion: its extremes, its mean, its fundamental.

    >>> import numpy as np
    >>> one, other = (Measure(*np.full((6, 1), x)) for x in (1.0, 3.0))
    >>> together([one, other]).mean, together([one, other]).amplitude
    (array([2.]), array([1.]))
    """
    greatest = np.max([m.greatest for m in measures], axis=0)
    least = np.min([m.least for m in measures], axis=0)
    wave = np.mean([m.fundamental * np.exp(1j * m.phase) for m in measures], axis=0)
    mean = np.mean([m.mean for m in measures], axis=0)
    return Measure(0.5 * (greatest - least), np.abs(wave), np.angle(wave), mean, greatest, least)
