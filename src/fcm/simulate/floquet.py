"""The derivative of the motion over one period with respect to its start.

Across a segment it is the exponential of the segment's matrix; across a transition whose instant moves
with the start, y+ = y- + (A+ y - R A- y) (g y') ..., the saltation matrix

    S = R + (F+ - R F-) g / (g F-),    F = A y at the transition,

with g the row that vanishes there and R the derivative of what the transition does to the state.
"""

from __future__ import annotations

import numpy as np

from fcm.scene.model import FloatArray
from fcm.simulate.march import Segment
from fcm.simulate.system import NEGATIVE, OPEN, POSITIVE, System

GRAZING = 1e-12  # an exit passed this slowly, relative to its terms, is taken as touched


def entry_derivative(system: System, states: str) -> FloatArray:
    """Derivative of the state vector at the start by x = (q, q', f): (d, 2 modes + contacts)."""
    size = system.n.start
    out = np.zeros((system.size, size))
    out[:size, :size] = np.eye(size)
    stiffness = np.array([contact.k_v for contact in system.contacts])
    out[system.n, system.q] = stiffness[:, None] * system.normal
    return _with_friction(system, out, range(len(states)), states)


def period_derivative(system: System, segments: list[Segment]) -> FloatArray:
    """Derivative of x = (q, q', f) at the end of the segments by x at their start."""
    last = len(segments) - 1
    return derivative_at(system, segments, last, segments[last].length)[: system.n.start]


def derivative_at(system: System, segments: list[Segment], last: int, position: float) -> FloatArray:
    """Derivative of the state vector at a position in a segment by x at the start of the first."""
    columns = entry_derivative(system, segments[0].states)
    for i, segment in enumerate(segments[: last + 1]):
        length = position if i == last else segment.length
        columns = segment.flow.at(columns, length)
        if i < last:
            columns = _across(system, segment, segments[i + 1], columns)
    return columns


def _across(system: System, old: Segment, new: Segment, columns: FloatArray) -> FloatArray:
    """The columns after the transition from one segment to the next."""
    changed = [j for j, (a, b) in enumerate(zip(old.states, new.states, strict=True)) if a != b]
    row = old.flow.rows[old.exit]
    before = old.flow.matrix @ new.y  # the state is continuous: only its rate jumps
    speed = row @ before
    reset = _with_friction(system, columns.copy(), changed, new.states)
    if abs(speed) <= GRAZING * (np.abs(row) @ np.abs(before)):
        return reset
    jump = new.flow.matrix @ new.y - _with_friction(system, before[:, None].copy(), changed, new.states)[:, 0]
    return reset + np.outer(jump, (row @ columns) / speed)


def _with_friction(
    system: System, columns: FloatArray, contacts: range | list[int], states: str
) -> FloatArray:
    """The friction rows of the contacts put where their states want them."""
    for j in contacts:
        f, load = system.f.start + j, system.contacts[j].mu * columns[system.n.start + j]
        if states[j] == POSITIVE:
            columns[f] = load
        elif states[j] == NEGATIVE:
            columns[f] = -load
        elif states[j] == OPEN:
            columns[f] = 0.0
    return columns
