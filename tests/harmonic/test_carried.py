"""Solutions of a few harmonics led to those with more."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.harmonic.carried import carried, found_at
from fcm.harmonic.start import solutions
from fcm.harmonic.system import System
from fcm.scene import load_scene

from ..response.random_scenes import random_scene
from .scenes import displacements, isola_stuck, up_to
from .truth import exact

# fundamentals of v at 1.5 rad/s where a march of the contact law settles, of rest and of the closed branch
MARCHED = (0.6025, 12.680)


def led(scene, omega, few, many):
    return carried(System(scene, up_to(many)), solutions(System(scene, up_to(few)), omega))


def test_all_solutions_of_a_window_are_those_that_a_march_comes_to():
    found = led(isola_stuck(), 1.5, 7, 13)
    system = System(isola_stuck(), up_to(13))
    heights = sorted(float(displacements(system, z)[0][1]) for z in found.solutions)
    assert len(heights) == 3 and found.complete
    assert heights[0] == pytest.approx(MARCHED[0], rel=2e-4)
    assert heights[-1] == pytest.approx(MARCHED[1], rel=2e-4)


def test_where_one_leads_far_the_level_of_all_harmonics_is_followed_too():
    """What seven lead to, and the level of eleven does not: both are motions of the exact contact law."""
    scene, omega = random_scene(5), 1.4389632784841668
    assert led(scene, omega, 7, 11) is None
    system = System(scene, up_to(11))
    (found,) = found_at(system, (omega,), (solutions(System(scene, up_to(7)), omega),))
    (alone,) = solutions(system, omega).solutions
    first, other = found.solutions
    assert np.array_equal(first, alone)
    for z in (first, other):
        front = displacements(system, z)[1][[0, 3]]
        assert exact(system, z)[[0, 3]] == pytest.approx(front, rel=4e-2)
    assert exact(system, other)[0] < 0.95 * exact(system, first)[0]


@pytest.mark.parametrize("highest", [17, 19])
def test_a_solution_that_only_the_level_of_some_harmonics_leads_to_is_found_with_others(highest):
    """At 0.8018 rad/s a march of the contact law, by the method of Runge and Kutta, settles at this from all
    of ten random states. The level of 7, 8, 9 or 14 harmonics passes it, that of 11, 19 or 20 does not.
    """
    scene = load_scene(Path(__file__).parent / "scenes/pinched_level.toml").each_curve()[0]
    system = System(scene, up_to(highest))
    (found,) = found_at(system, (0.8018,))
    off = [
        np.abs(displacements(system, z)[1] / (2.3889, 1.7381, 2.8195, 1.2588) - 1.0).max()
        for z in found.solutions
    ]
    assert min(off) < 1e-2


def test_where_the_level_turns_near_one_or_of_a_few_harmonics_it_is_followed_again():
    scene, omega = isola_stuck(), 1.5
    before = solutions(System(scene, up_to(7)), omega)
    many, turn = System(scene, up_to(13)), before.turns[0]
    assert carried(many, replace(before, turns=(turn._replace(level=1.2),))) is not None
    assert carried(many, replace(before, turns=(turn._replace(level=1.15),))) is None
    assert carried(many, replace(before, turns=(turn._replace(level=0.87),))) is None
    assert carried(many, replace(before, complete=False)) is None
    assert carried(many, solutions(System(scene, up_to(5)), omega)) is None
