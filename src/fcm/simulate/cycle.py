"""One cycle of an exact motion: its values at any instants, extremes, mean and fundamental."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fcm.scene.model import FloatArray
from fcm.simulate.flow import ORDER
from fcm.simulate.march import Segment
from fcm.simulate.system import System

# eight points integrate a polynomial of degree 15 exactly; over a step what is beyond it is rounding
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
NODES, WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
_CHUNK = 4_000_000  # numbers held at once


@dataclass(frozen=True)
class Cycle:
    """The motion over one period of the force, or over the part of one that ends a phase."""

    system: System
    start: float  # [s] from the start of the motion
    duration: float  # [s]
    angle: float  # of the forces at its start [rad]
    segments: list[Segment]

    @property
    def states(self) -> tuple[str, ...]:
        """For each contact the sequence of its states, such as 'EPEN', as if the cycle repeated."""
        letters = [segment.states for segment in self.segments if segment.length > 0.0]
        return tuple(_sequence([states[j] for states in letters]) for j in range(len(self.system.contacts)))

    def values(self, rows: FloatArray, times: FloatArray) -> FloatArray:
        """rows @ y at increasing times [s] from the start of the cycle: (time, row)."""
        out = np.empty((times.size, rows.shape[0]))
        ends = np.array([segment.start for segment in self.segments[1:]])
        owner = np.searchsorted(ends, times, side="right")
        for i in np.unique(owner):
            segment, chosen = self.segments[i], np.flatnonzero(owner == i)
            position = (times[chosen] - segment.start) / segment.flow.step
            whole = np.floor(np.clip(position, 0.0, None)).astype(np.intp)
            states = segment.flow.grid(segment.y, int(whole.max()) + 1)[whole]
            out[chosen] = _evaluate(taylor(segment, rows, states), position - whole)
        return out


def _sequence(letters: list[str]) -> str:
    """The letters around the cycle without repetition, from separation or else the stick before P."""
    kept = "".join(x for i, x in enumerate(letters) if i == 0 or letters[i - 1] != x)
    if len(kept) > 1 and kept[0] == kept[-1]:
        kept = kept[:-1]
    for first in ("S", "EP", "E"):
        at = (kept + kept[:1]).find(first)
        if at >= 0:
            return kept[at:] + kept[:at]
    return kept


class Piece(NamedTuple):
    """Successive steps of one segment, as polynomials in the position in a step."""

    segment: Segment
    first: int  # step of the segment
    powers: FloatArray  # (step, ORDER + 1, row)
    lengths: FloatArray  # (step,) in (0, 1]


def pieces(cycle: Cycle, rows: FloatArray) -> Iterator[Piece]:
    """All steps of a cycle, rows @ y as polynomials."""
    most = max(1, _CHUNK // ((ORDER + 1) * max(rows.size, 1)))
    for segment in cycle.segments:
        y, left, first = segment.y, segment.length, 0
        while left > 0.0:
            steps = min(int(np.ceil(left)), most)
            lengths = np.minimum(left - np.arange(steps), 1.0)
            yield Piece(segment, first, taylor(segment, rows, segment.flow.grid(y, steps)), lengths)
            y, left, first = segment.flow.advance(y, steps), left - steps, first + steps


def taylor(segment: Segment, rows: FloatArray, states: FloatArray) -> FloatArray:
    """Taylor coefficients of rows @ y from each of the states: (state, ORDER + 1, row)."""
    flat = (rows @ segment.flow.series).reshape(-1, states.shape[1])
    return (states @ flat.T).reshape(states.shape[0], ORDER + 1, rows.shape[0])


def _evaluate(powers: FloatArray, position: FloatArray) -> FloatArray:
    value = np.zeros((powers.shape[0], powers.shape[2]))
    for j in range(ORDER, -1, -1):
        value = value * position[:, None] + powers[:, j]
    return value
