"""Peaks on an exact curve with many loops: the greatest are found, those below them not sought."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.continuation import FollowOptions, Mark, Segment, follow
from fcm.shooting import periodic
from fcm.shooting.problem import OrbitProblem

from .curves import light

LOW, HIGH = 0.42, 0.44


def amplitudes(problem, z, direction):
    problem.report(z, direction)
    return np.array(problem.output)


@pytest.mark.slow
def test_the_greatest_amplitudes_are_found_and_few_others():
    """No place midway between two points exceeds them; most peaks exceed all points before them."""
    scene = replace(light(), frequency_range=(LOW, HIGH))
    problem = OrbitProblem(scene)
    path = follow(
        problem, problem.z(periodic(scene, LOW).state, LOW), (LOW, HIGH), options=FollowOptions(0.05)
    )
    outputs = np.array([amplitudes(problem, *one) for one in zip(path.z, path.direction, strict=True)])
    greatest = outputs.max(axis=0)
    for k in range(len(outputs) - 1):
        between = Segment(problem, path, k)
        if between.find(0.5):
            assert (amplitudes(problem, between.z, between.direction) <= greatest * (1.0 + 1e-9)).all()
    peaks = [k for k in range(1, len(outputs)) if path.mark[k] & Mark.PEAK]
    lower = [k for k in peaks if (outputs[k] < outputs[:k].max(axis=0)).all()]
    assert len(peaks) > 10 and 3 * len(lower) < len(peaks)
