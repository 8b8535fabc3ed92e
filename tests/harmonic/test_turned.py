"""Branches that the level of the forces tells of by a turn short of 1 alone."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.continuation import Mark, Status
from fcm.harmonic.choice import accurate, given
from fcm.harmonic.system import System
from fcm.scene import load_scene

from .scenes import up_to
from .test_beside import amplitudes_at


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3])
def test_a_closed_branch_between_the_frequencies_of_the_levels_is_found(accuracy):
    """At 1.05324 rad/s a march of the contact law, by the method of Runge and Kutta, settles at
    (0.4170, 0.1473) from 6 of 14 random states. Nothing of one harmonic tells of this branch, and where the
    level of more is followed it turns at 0.9 to 0.996.
    """
    scene = load_scene(Path(__file__).parent / "scenes/loose_isola.toml").each_curve()[0]
    found = accurate(System(replace(scene, frequency_range=(0.977, 1.15)), (1,)), accuracy)
    there = amplitudes_at(found, 1.05324)
    assert min(np.abs(one[[0, 3]] / (0.4170, 0.1473) - 1.0).max() for one in there) < 2e-2


@pytest.mark.parametrize("highest", [4, 6])
def test_a_closed_branch_above_which_the_level_turns_is_found(highest):
    """At 1.266 rad/s a march of the contact law, by the method of Runge and Kutta, settles at (9.174, 27.28)
    from 4 of 60 random states, and at (0.52, 1.55) from the others.

    The branch is closed, from 1.2610 to 1.2719 rad/s: at both ends of the range the level turns above 1.
    """
    scene = load_scene(Path(__file__).parent / "scenes/between_levels.toml").each_curve()[0]
    there = amplitudes_at(given(System(scene, up_to(highest))), 1.266)
    assert min(np.abs(one / (9.174, 27.28) - 1.0).max() for one in there) < 5e-3


@pytest.mark.parametrize("highest", [5, 7])
def test_a_closed_branch_far_from_where_the_level_turns_is_found_and_traced_once(highest):
    """At 1.3 rad/s a march of the contact law with steps of a fixed length settles at (1.107, 3.222, 4.367,
    1.662) from 12 of 40 random states, and at less than a third of it from the others.

    The branch is closed, from 1.2585 to 1.3581 rad/s; the level turns at 2.5 at 1 rad/s.
    """
    scene = load_scene(Path(__file__).parent / "scenes/far_isola.toml").each_curve()[0]
    found = given(System(scene, up_to(highest)))
    there = amplitudes_at(found, 1.3)
    assert min(np.abs(one / (1.107, 3.222, 4.367, 1.662) - 1.0).max() for one in there) < 5e-3
    (closed,) = (path for path in found.traced.branches.paths if path.status is Status.CLOSED)
    assert len(closed.where(Mark.FOLD)) == 2


def test_a_closed_branch_is_found_across_a_corner_on_the_way_from_where_the_level_turns():
    """At 1.0384 rad/s a march of the exact motion settles at (2.51734, 1.44807) from 3 of 30 random states,
    and at (3.361, 1.215) from the others.

    The branch is closed, from 1.0163 to 1.0753 rad/s. The level turns at 0.78 at 1.0001 rad/s.
    """
    scene = load_scene(Path(__file__).parent / "scenes/cornered_isola.toml").each_curve()[0]
    there = amplitudes_at(given(System(scene, up_to(5))), 1.0384)
    assert min(np.abs(one / (2.51734, 1.44807) - 1.0).max() for one in there) < 2e-2
