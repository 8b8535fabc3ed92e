"""Branches where every motion that was found is unstable."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.continuation import FollowOptions, follow
from fcm.shooting.orbit_record import samples
from fcm.shooting.periodic_orbit import shoot
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.trace import orbits_in_unstable_ranges
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.state import State

UNSTABLE = [0.2578, -0.1272, -0.0544], [0.7575, 0.6428, -0.0122], [0.0, 0.0667, 0.0]
MARCHED = [0.79029, 0.31136, 1.13541]  # from rest at 1.55 rad/s, 4000 steps of Runge and Kutta a cycle


def test_the_motion_that_rest_comes_to_is_on_a_branch():
    """All else leads to unstable ones alone; marches from random states come to the same."""
    scene = fcm.load_scene(Path(__file__).parent / "scenes/restless.toml")
    problem, low = OrbitProblem(scene), scene.frequency_range[0]
    orbit = shoot(EquationsOfMotion(scene, low), State(*map(np.array, UNSTABLE)))
    assert orbit is not None and not orbit.stable
    span, options = scene.frequency_range, FollowOptions(scene.max_step)
    path = follow(problem, problem.z(orbit.state, low), span, options=options)
    (z,) = orbits_in_unstable_ranges(problem, [path], lambda: None)
    ways = [follow(problem, z, span, options=options, forward=forward) for forward in (False, True)]
    unstable, found = samples(problem, path), samples(problem, ways[0].backwards().then(ways[1]))
    assert not any(point.stable for point in unstable) and all(point.stable for point in found)
    omega = np.array([point.frequency for point in found])
    amplitude = np.array([point.measure.amplitude for point in found])
    order = np.argsort(omega)
    there = [np.interp(1.55, omega[order], one[order]) for one in amplitude.T]
    assert there == pytest.approx(MARCHED, rel=1e-3)
