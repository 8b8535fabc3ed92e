"""Where stability changes between two points of an exact curve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.continuation import FollowOptions, Mark, Segment, follow
from fcm.shooting import periodic
from fcm.shooting.options import SHOOTING
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.residual import Shooting
from fcm.shooting.stability_changes import crossing

from .curves import light


def greatest(problem, z):
    """Of all multipliers, from the whole matrix of the period; the stuck contact's are exactly 1."""
    return np.abs(np.linalg.eigvals(problem.shot(z).derivative)).max()


def test_the_multipliers_beside_a_stuck_contact_are_those_of_the_whole_matrix():
    orbit, problem = periodic(light(), 0.6), Shooting(light())
    shot = problem.residual(problem.unknowns(orbit.state), 0.6)
    assert [states for states in orbit.states if states == "E"] == ["E"]
    assert (shot.multipliers == 1.0).sum() == 1 and not (shot.other_multipliers == 1.0).any()
    for one in np.linalg.eigvals(shot.derivative):
        assert np.abs(shot.multipliers - one).min() < 1e-9


def test_a_closed_contact_without_friction_adds_no_multiplier():
    """Its force along the surface, 0, is an unknown of the motion that never changes."""
    scene = light()
    smooth = replace(scene.contacts[0], name="smooth", mu=0.0, k_v=0.1, n_0=100.0)
    scene = replace(scene, contacts=(*scene.contacts, smooth))
    orbit, problem = periodic(scene, 0.6), Shooting(scene)
    shot = problem.residual(problem.unknowns(orbit.state), 0.6)
    assert orbit.states[-1] == "E"
    still = sum(states == "E" for states in orbit.states)
    whole = np.linalg.eigvals(shot.derivative)
    moving = np.delete(whole, np.argsort(np.abs(whole - 1.0))[:still])
    assert (shot.multipliers == 1.0).sum() == still and shot.multipliers.size == whole.size
    for one in moving:
        assert np.abs(shot.multipliers - one).min() < 1e-9


@pytest.fixture(scope="module")
def crossed():
    """A problem, its path, and the steps on which stability changes between folds."""
    scene = replace(light(), frequency_range=(0.54, 0.55))
    problem, begin = OrbitProblem(scene), periodic(scene, 0.54)
    path = follow(problem, problem.z(begin.state, 0.54), scene.frequency_range, options=FollowOptions(0.05))
    stable = [greatest(problem, z) <= 1.0 + SHOOTING.floquet.classification.growth_tolerance for z in path.z]
    steps = [
        k
        for k in range(len(stable) - 1)
        if stable[k] != stable[k + 1] and not (path.mark[k] | path.mark[k + 1]) & Mark.FOLD
    ]
    return problem, path, stable, steps


def test_stability_changes_at_the_place(crossed):
    """It is stable; a little further on the unstable side, or as far as a jump may be off, it is not."""
    problem, path, stable, steps = crossed
    jumps = 0
    assert len(steps) > 10
    for k in steps:
        place, between = crossing(problem, path, k), Segment(problem, path, k)
        assert (
            place is not None
            and greatest(problem, place.z) <= 1.0 + SHOOTING.floquet.classification.growth_tolerance
        )
        aside = max(1e-5, 2.0 * FollowOptions().switching.reached_distance / between.length)
        part = place.part + (aside if stable[k] else -aside)
        assert (
            between.find(part)
            and greatest(problem, between.z) > 1.0 + SHOOTING.floquet.classification.growth_tolerance
        )
        jumps += greatest(problem, between.z) > 1.0 + 1e-3 and greatest(problem, place.z) < 1.0 + 1e-8
    assert 0 < jumps < len(steps)


def test_a_change_of_stability_takes_few_periods(crossed):
    """A bisection to a rounding takes some forty places, each with a period or more."""
    problem, path, _, steps = crossed
    again = OrbitProblem(problem.scene)
    for k in steps:
        crossing(again, path, k)
    assert again.periods < 30 * len(steps)


def test_a_place_beside_known_ones_is_the_same_and_takes_fewer_periods(crossed):
    """The curve at a part of the way is one, whatever it was looked for from."""
    problem, path, _, steps = crossed
    again, parts, alone, beside = OrbitProblem(problem.scene), (0.7, 0.3, 0.5, 0.4, 0.45, 0.425), 0, 0
    for k in steps:
        among = Segment(again, path, k)
        for part in parts:
            assert among.find(part)
        found, fresh = among.z, OrbitProblem(problem.scene)
        by_itself = Segment(fresh, path, k)
        before = fresh.periods
        assert by_itself.find(parts[-1])
        problem.evaluate_scale(found)
        assert (np.abs(found - by_itself.z) < 1e-10 * np.asarray(problem.scale)).all()
        alone += fresh.periods - before
        before = again.periods
        assert among.find(0.5 * (parts[-1] + parts[-2]))
        beside += again.periods - before
    assert beside < 0.8 * alone
