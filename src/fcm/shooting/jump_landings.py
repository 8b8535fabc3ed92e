"""Points of exact curves at the frequencies at which other stable stretches end, where a sweep may land."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fcm.continuation import Mark
from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray
from fcm.shooting.orbit_record import OrbitRecord, recorded_point
from fcm.shooting.problem import OrbitProblem, correct_at_frequency


def with_landings(problem: OrbitProblem, branches: list[list[OrbitRecord]]) -> list[list[OrbitRecord]]:
    """Add a point to branches wherever a stable stretch passes the frequency at which another ends.

    A stable stretch ends at a fold or where stability changes. Interpolation between two points has an error
    of the order of their distance squared. With these points a sweep's landing is as accurate as its jump.

    Parameters
    ----------
    branches : list of list of OrbitRecord
        Each in the order along its curve.
    """
    ends = {p.frequency for points in branches for p in points if p.stable and p.mark & _ENDS}
    newton = Newton(problem)
    return [_landed(problem, newton, points, np.array(sorted(ends))) for points in branches]


_ENDS = Mark.FOLD | Mark.CROSSING


def _landed(
    problem: OrbitProblem, newton: Newton, points: list[OrbitRecord], ends: FloatArray
) -> list[OrbitRecord]:
    out = points[:1]
    for one, other in pairwise(points):
        if one.stable and other.stable:
            low, high = sorted((one.frequency, other.frequency))
            inside = ends[(ends > low) & (ends < high)].tolist()
            found = [_at(problem, newton, one, other, omega) for omega in inside]
            found = found if one.frequency < other.frequency else found[::-1]
            out += [sample for sample in found if sample is not None]
        out.append(other)
    return out


def _at(
    problem: OrbitProblem, newton: Newton, one: OrbitRecord, other: OrbitRecord, omega: float
) -> OrbitRecord | None:
    """The point of the curve at a frequency between two neighbours; None if it is not found."""
    share = (omega - one.frequency) / (other.frequency - one.frequency)
    guess = one.z + share * (other.z - one.z)
    guess[-1] = omega
    if not correct_at_frequency(newton, guess) or newton.moved > np.linalg.norm(
        (other.z - one.z) / np.asarray(newton.scale)
    ):
        return None
    direction = np.asarray(newton.tangent) * np.asarray(newton.scale)
    if direction @ (other.z - one.z) < 0.0:
        direction = -direction
    return recorded_point(problem, np.array(newton.z), direction, Mark.USER_POINT)
