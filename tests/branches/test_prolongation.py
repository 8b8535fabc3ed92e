"""Branches that only those of fewer harmonics lead to."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.accuracy.refinement import refined_response, with_given_harmonics
from fcm.branches.options import LevelCurveOptions
from fcm.branches.prolongation import at_its_frequency
from fcm.branches.trace import traced
from fcm.harmonic_balance.system import System
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import load_scene
from fcm.time_domain import State, simulate

from ..harmonic_balance.scenes import displacements, isola_stuck, up_to
from ..harmonic_balance.truth import exact
from ..response.random_scenes import random_scene

KNOWN = Path(__file__).parents[1] / "harmonic_balance/scenes"


def amplitudes_at(found, omega):
    """Amplitudes of a response where its branches pass a frequency, between two points."""
    there = []
    for path, one in zip(found.traced.branches.paths, found.quantities, strict=True):
        off = path.parameter - omega
        for i in np.flatnonzero(off[:-1] * off[1:] < 0.0):
            part = off[i] / (off[i] - off[i + 1])
            there.append((1.0 - part) * one.amplitude[i] + part * one.amplitude[i + 1])
    return there


@pytest.mark.slow
def test_a_closed_branch_is_not_lost_with_more_harmonics():
    """Whose highest peak is stable, and which no level of the forces leads to that is followed at resonances:
    that of few harmonics hangs together with the others, and leads to that of ten only where it is about to
    leave it."""
    at_resonances = (LevelCurveOptions(max_gap=np.inf),)
    system = System(random_scene(1), up_to(10), other_options=at_resonances)
    alone = [path.z[:, -1] for path in traced(system).branches.paths]
    found = with_given_harmonics(system)
    closed = [i for i, path in enumerate(found.traced.branches.paths) if path.status.name == "CLOSED"]
    (path,) = (found.traced.branches.paths[i] for i in closed)
    (amplitude,) = (found.quantities[i].amplitude for i in closed)
    others = [one.amplitude[:, 0].max() for i, one in enumerate(found.quantities) if i not in closed]
    top = int(amplitude[:, 0].argmax())
    assert len(others) == len(alone) and amplitude[top, 0] > 1.2 * max(others)
    assert exact(system, path.z[top]) == pytest.approx(amplitude[top], rel=2e-2)
    assert np.ptp(path.parameter) < 0.2


@pytest.mark.slow
@pytest.mark.parametrize("highest", [6, 7, 12])
def test_an_isolated_branch_is_not_lost_with_more_harmonics_where_its_peak_is_unstable(highest):
    """At 1.05324 rad/s a march of the contact law, by the method of Runge and Kutta, settles at
    (0.4170, 0.1473) from 6 of 14 random states. Five harmonics have this branch at the end
    of the range; it is closed.
    """
    scene = load_scene(KNOWN / "loose_isola.toml").each_curve()[0]
    found = with_given_harmonics(System(replace(scene, frequency_range=(0.977, 1.5)), up_to(highest)))
    there = amplitudes_at(found, 1.05324)
    assert min(np.abs(one[[0, 3]] / (0.4170, 0.1473) - 1.0).max() for one in there) < 2e-2


@pytest.mark.parametrize("highest", [3, 10])
def test_a_branch_that_hangs_together_with_the_others_with_one_harmonic_alone_is_found(highest):
    """At 1.7 rad/s a march of the contact law, by the method of Runge and Kutta, settles at
    (6.022, 29.47, 1.393, 4.921) from 2 of 5 random states. Three harmonics or more have it on a closed
    branch.
    """
    scene = load_scene(KNOWN / "high_isola.toml").each_curve()[0]
    found = with_given_harmonics(System(scene, up_to(highest)))
    there = amplitudes_at(found, 1.7)
    assert min(np.abs(one[:4] / (6.022, 29.47, 1.393, 4.921) - 1.0).max() for one in there) < 2e-2


@pytest.mark.slow
def test_a_high_branch_is_found_beside_what_some_of_the_harmonics_make_of_few():
    """Beside its peak with one harmonic there is no solution with eight, but there is one with three, and
    beside that one with eight. A march settles there; by what the contact that never slips remembers its
    amplitude differs by 4 %."""
    scene = load_scene(KNOWN / "stepwise_isola.toml")
    begin = State(np.array([-1.0, 5.0]), np.zeros(2), np.zeros(3))
    settled = simulate(scene, 1.73, 800, begin).measures(last=1)[0].amplitude
    assert settled.min() > 6.0
    found = refined_response(System(replace(scene, frequency_range=(1.4, 2.0)), (1,)), 1e-2)
    there = amplitudes_at(found, 1.73)
    assert min(np.abs(one / settled - 1.0).max() for one in there) < 0.04


def test_what_lies_beside_a_peak_out_of_the_range_starts_no_branch():
    """The highest point is at an end of the range, and the balance of more harmonics beside it is beyond."""
    system = System(load_scene("extreme/no-normal-motion"), (1, 2, 3))
    low, high = system.scene.frequency_range
    alone = traced(system).branches.paths
    beyond = np.append(alone[0].z[0, :-1], 0.99 * low)
    for path in traced(system, near=[beyond]).branches.paths:
        assert path.parameter.min() >= low and path.parameter.max() <= high
    assert [path.status.name for path in with_given_harmonics(system).traced.branches.paths] == ["COMPLETE"]


def displacements_at(curve, omega):
    """Amplitudes where the branches of a curve pass a frequency, between two points."""
    off = curve.frequency - omega
    for i in np.flatnonzero(off[:-1] * off[1:] < 0.0):
        part = off[i] / (off[i] - off[i + 1])
        yield (1.0 - part) * curve.amplitude[i] + part * curve.amplitude[i + 1]


def test_all_solutions_of_a_window_are_those_that_a_march_comes_to():
    """At 1.5 rad/s a march of the contact law settles at these fundamentals of v, of rest and of the closed
    branch."""
    found = with_given_harmonics(System(isola_stuck(), up_to(13)))
    heights = sorted(
        float(abs(displacements(found.system, z)[0][1]))
        for path in found.traced.branches.paths
        for z in path.z[path.parameter == 1.5]
    )
    assert len(heights) == 3
    assert heights[0] == pytest.approx(0.6025, rel=2e-4)
    assert heights[-1] == pytest.approx(12.680, rel=2e-4)


def passed_at(system, path, omega):
    """Solutions of a path at a frequency."""
    off = path.parameter - omega
    for i in np.flatnonzero((off[:-1] * off[1:] <= 0.0) & (off[:-1] != off[1:])):
        guess = path.z[i] + off[i] / (off[i] - off[i + 1]) * (path.z[i + 1] - path.z[i])
        guess[-1] = omega
        yield at_its_frequency(system, guess)


@pytest.mark.slow
def test_two_motions_of_which_the_level_of_many_harmonics_leads_to_one():
    """What seven lead to, and the level of eleven does not: both are motions of the exact contact law."""
    scene, omega = random_scene(5), 1.4389632784841668
    near = replace(scene, frequency_range=(0.95 * omega, 1.02 * omega))
    found = with_given_harmonics(System(near, up_to(11)))
    passed = [z for path in found.traced.branches.paths for z in passed_at(found.system, path, omega)]
    fronts = {round(float(displacements(found.system, z)[1][0]), 6): z for z in passed}
    z, other = fronts[max(fronts)], fronts[min(fronts)]
    for one in (z, other):
        front = displacements(found.system, one)[1][[0, 3]]
        assert exact(found.system, one)[[0, 3]] == pytest.approx(front, rel=4e-2)
    assert exact(found.system, other)[0] < 0.95 * exact(found.system, z)[0]


@pytest.mark.slow
@pytest.mark.parametrize("highest", [17, 19])
def test_a_solution_that_only_the_level_of_some_harmonics_leads_to_is_found_with_others(highest):
    """At 0.8018 rad/s a march of the contact law, by the method of Runge and Kutta, settles at this from all
    of ten random states. The level of 7, 8, 9 or 14 harmonics passes it, that of 11, 19 or 20 does not.
    """
    scene = load_scene(KNOWN / "pinched_level.toml").each_curve()[0]
    curve = traced_curve(replace(scene, frequency_range=(0.78, 0.82)), Request(up_to(highest)))
    marched = (2.3889, 1.7381, 2.8195, 1.2588)
    assert min(np.abs(one / marched - 1.0).max() for one in displacements_at(curve, 0.8018)) < 1e-2
