"""Solutions of a few harmonics led to those with more, without the level of the forces."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.harmonic.carried import carried
from fcm.harmonic.start import solutions
from fcm.harmonic.system import System

from ..response.random_scenes import random_scene
from .scenes import displacements, isola_stuck, up_to

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


@pytest.mark.parametrize("seed, omega", [(5, 1.0001), (5, 1.337782986099887)])
def test_a_way_of_steps_comes_to_where_the_level_of_all_harmonics_leads(seed, omega):
    scene = random_scene(seed)
    found = led(scene, omega, 7, 11)
    (z,) = solutions(System(scene, up_to(11)), omega).solutions
    assert len(found.solutions) == 1
    assert np.abs(found.solutions[0] - z).max() < 1e-8 * np.abs(z).max()


def test_where_the_level_turns_near_one_or_of_a_few_harmonics_it_is_followed_again():
    scene, omega = isola_stuck(), 1.5
    before = solutions(System(scene, up_to(7)), omega)
    many = System(scene, up_to(13))
    assert carried(many, replace(before, turns=(1.2,))) is not None
    assert carried(many, replace(before, turns=(1.15,))) is None
    assert carried(many, replace(before, turns=(0.87,))) is None
    assert carried(many, replace(before, complete=False)) is None
    assert carried(many, solutions(System(scene, up_to(5)), omega)) is None
