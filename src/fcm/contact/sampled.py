"""A hysteresis loop as points: each state of the cycle, and the transitions between them, for a picture."""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.contact.loop import Loop
from fcm.contact.periodic.loop import PeriodicLoop
from fcm.frozen import Frozen


class Part(Frozen):
    """One state of the cycle from its beginning to its end.

    For a `Loop`, displacements are relative to a and forces to k_u a; for a `PeriodicLoop` they have units.

    Angles increase from where the state begins, in [0, 2 pi), and may exceed 2 pi.
    """

    state: str  # E stick, P positive slip, N negative slip, S separation
    theta: FloatArray  # (i,) [rad]
    displacement: FloatArray  # (i,) u
    force: FloatArray  # (i,) f
    limit: FloatArray  # (i,) mu n


class LoopTransition(Frozen):
    """A point where one state of the cycle ends and the next begins."""

    states: str  # both letters, the ending state first
    theta: float  # in [0, 2 pi] [rad]
    displacement: float
    force: float


def parts(loop: Loop | PeriodicLoop, steps: int = 720) -> list[Part]:
    """The states of a cycle in order, sampled; `steps` is the number of steps in a whole cycle.

    >>> from fcm.contact.loop import hysteresis_loop
    >>> [(part.state, round(float(part.theta[0]), 3)) for part in parts(hysteresis_loop(0.5, 0.0, 0.0))]
    [('E', 4.712), ('P', 0.0), ('E', 1.571), ('N', 3.142)]
    """
    if loop.angles.size == 0:
        return [_part(loop, loop.sequence, 0.0, 2.0 * np.pi, steps)]
    length = np.mod(np.diff(loop.angles, append=loop.angles[0]), 2.0 * np.pi)
    return [
        _part(loop, state, float(begin), float(turn), steps)
        for state, begin, turn in zip(loop.sequence, loop.angles, length, strict=True)
    ]


def _part(loop: Loop | PeriodicLoop, state: str, begin: float, length: float, steps: int) -> Part:
    count = max(int(np.ceil(steps * length / (2.0 * np.pi))), 1)
    theta = begin + np.linspace(0.0, length, count + 1)
    return Part(state, theta, loop.displacement(theta), loop.force(theta), loop.slip_limit(theta))


def shown_degrees(theta: float, from_greatest: bool = False) -> float:
    """An angle [rad] in degrees in [0, 360); from_greatest: counted from the greatest displacement.

    >>> shown_degrees(0.5 * np.pi), shown_degrees(0.5 * np.pi, from_greatest=True)
    (90.0, 0.0)
    """
    degrees = float(np.degrees(theta)) - (90.0 if from_greatest else 0.0)
    return degrees % 360.0


def transitions(loop: Loop | PeriodicLoop) -> list[LoopTransition]:
    """Every transition of a cycle, in the order of the sequence; empty if there is one state only."""
    displacement, force = loop.displacement(loop.angles), loop.force(loop.angles)
    return [
        LoopTransition(
            loop.sequence[i - 1] + loop.sequence[i], float(theta), float(displacement[i]), float(force[i])
        )
        for i, theta in enumerate(loop.angles)
    ]
