"""Peaks of exact curves: the greatest of many loops are found, and one that a guess is very near to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.continuation import FollowOptions, Mark, Segment, follow
from fcm.shooting import periodic
from fcm.shooting.peaks_and_folds import OrbitGuess, located
from fcm.shooting.problem import OrbitProblem

from ..response.random_scenes import random_scene
from .curves import light

LOW, HIGH = 0.42, 0.44


def amplitudes(problem, z, direction):
    problem.evaluate_outputs(z, direction)
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


@pytest.mark.slow
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_peak_is_found_however_near_the_guess_is(side):
    """Within rounding of its start a curve has the peak twice, or not at all."""
    problem, dof, omega = OrbitProblem(replace(random_scene(9), frequency_range=(1.849, 1.852))), 3, 1.85063
    near, other = periodic(problem.scene, omega), periodic(problem.scene, omega - 1e-5)
    neighbour = other.frequency, other.state
    peak = located(problem, OrbitGuess(omega, near.state, neighbour, dof), [])
    assert peak is not None
    sides = [periodic(problem.scene, peak.frequency * (1.0 + step)) for step in (-1e-5, 1e-5)]
    assert all(peak.measure.amplitude[dof] > one.measure.amplitude[dof] for one in sides)
    for distance in 10.0 ** np.arange(-12.0, -6.0, 0.25):
        guess = OrbitGuess(peak.frequency * (1.0 + side * distance), peak.state, neighbour, dof)
        found = located(problem, guess, [])
        assert found is not None
        assert found.measure.amplitude[dof] == pytest.approx(peak.measure.amplitude[dof], rel=1e-9)
