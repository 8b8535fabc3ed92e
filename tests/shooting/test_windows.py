"""Windows of stability, or of its loss, between two points of an exact curve."""

from __future__ import annotations

import numpy as np

from fcm.continuation import FollowOptions, Segment, follow
from fcm.shooting import periodic
from fcm.shooting.orbit_record import samples
from fcm.shooting.problem import OrbitProblem

from ..response.random_scenes import random_scene
from .curves import between as within

EDGE = 1e-3  # of a step: a change of stability is known to less


def grows(problem, z):
    """Whether a disturbance does, from the whole matrix of the period."""
    return np.abs(np.linalg.eigvals(problem.shot(z).derivative)).max() > 1.0 + 1e-7


def test_a_window_between_two_points_that_agree_is_on_the_curve():
    """Nine places on each such step are what the points of the curve on either side of them say."""
    low, high = 1.0748, 1.1413
    scene, windows = within(random_scene(37), low, high), 0
    problem = OrbitProblem(scene)
    path = follow(
        problem, problem.z(periodic(scene, low).state, low), (low, high), options=FollowOptions(0.2)
    )
    points = samples(problem, path)
    known = np.array([point.frequency for point in points])
    assert (np.diff(known) > 0.0).all()
    for k in range(len(path.z) - 1):
        if grows(problem, path.z[k]) != grows(problem, path.z[k + 1]):
            continue
        way, told = Segment(problem, path, k), set()
        for part in np.linspace(0.1, 0.9, 9):
            assert way.find(part)
            i = int(np.searchsorted(known, way.z[-1]))
            if min(way.z[-1] - known[i - 1], known[i] - way.z[-1]) > EDGE * (known[i] - known[i - 1]):
                told.add(points[i - 1].stable and points[i].stable)
                assert grows(problem, way.z) != (points[i - 1].stable and points[i].stable)
        windows += len(told) == 2
    assert windows == 1
