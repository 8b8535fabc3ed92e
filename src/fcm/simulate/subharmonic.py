"""Motions that repeat after several periods of the force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.simulate.measure import Measure, measure
from fcm.simulate.motion import dof_rows
from fcm.simulate.run import cycles_from
from fcm.simulate.sample import Sample
from fcm.simulate.state import State
from fcm.simulate.system import System

MOST_PERIODS = 8
REPEATS = 1e-6  # difference of two states, relative to the motion, below which it does


def repeating(system: System, state: State) -> Sample | None:
    """A simulated motion that repeats after at most MOST_PERIODS periods, measured over all of them.

    It is stable, as it was come to. None if it does not repeat, or does after every period.
    """
    start = np.concatenate((state.q, state.velocity / system.omega))
    cycles = []
    for cycle, end in cycles_from(system, MOST_PERIODS, state):
        cycles.append(cycle)
        size = max(float(np.abs([y.y[system.q] for c in cycles for y in c.segments]).max()), 1e-300)
        error = float(np.abs(np.concatenate((end.q, end.velocity / system.omega)) - start).max()) / size
        if error < REPEATS and len(cycles) == 1:
            return None
        if error < REPEATS:
            whole = together([measure(c, dof_rows(system)) for c in cycles])
            none = np.zeros(0)
            return Sample(
                system.omega, state, cycles[-1].states, whole, none.astype(np.complex128), error,
                none, none, none, 0.0,
            )  # fmt: skip
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
