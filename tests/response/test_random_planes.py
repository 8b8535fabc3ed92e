"""A sample of the study of random scenes of contacts in a plane."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.accuracy.refinement import refined_response
from fcm.branches.force_level import linear_responses
from fcm.branches.trace import traced as branches
from fcm.continuation import Events, FollowOptions, Mark, Status, follow
from fcm.harmonic_balance.system import System

from .random_planes import marched, random_plane, traced

MARCHED = 1e-4  # of an amplitude, by which marches of few steps may be off


def test_a_slider_between_two_discs_that_part_goes_on_to_slip_from_there():
    """It rests where their edges cross, which moves as a root until they touch in a point.

    A step of 1e-5 from there once came to another part of the curve, thousands of times as far away, and
    from that to the same corner, again and again.
    """
    system = System(replace(random_plane(87), harmonics=(1,)))
    level, stepper = system.level_problem
    level.begin(2.2, True)
    first = 0.005321899722338341
    start = np.append(next(linear_responses(system, 2.2, first)), first)
    options = FollowOptions(1.0, True)
    options = replace(options, step=replace(options.step, max_steps=400))
    path = follow(level, start, (1e-9, 3.0), Events((1.0,)), options, stepper=stepper)
    assert path.status is Status.COMPLETE
    lowest = np.flatnonzero((path.parameter < 0.0277) & (path.mark & Mark.CORNER != 0))[-1]
    assert np.all(np.diff(path.parameter[lowest:]) > 0.0)  # it is passed once, and no level beyond it twice
    assert np.abs(path.z[lowest + 1] - path.z[lowest]).max() < 1e-5


@pytest.mark.slow
def test_a_contact_that_sticks_once_in_a_cycle_has_few_corners():
    """Its slip takes the slider back to where it was, but for rounding, which once made 1567 corners."""
    (path,) = branches(System(random_plane(220), (1, 2, 3))).branches.paths
    assert path.status is Status.COMPLETE
    assert path.where(Mark.CORNER).size < 30


@pytest.mark.slow
def test_a_curve_that_bounces_between_two_corners_is_ended_there():
    """They are 7e-7 of the motion apart; it went to and fro until the work was at its limit, two minutes."""
    system = System(replace(random_plane(149), harmonics=None))
    found = refined_response(system, 1e-2)
    assert system.work.seconds < 0.02 * system.options.work.max_seconds  # of the cost model, no clock's
    assert found.max_error < 1e-2 and found.traced.branches.paths[-1].status is Status.COMPLETE


@pytest.mark.slow
def test_a_peak_where_a_contact_never_slips_is_compared_with_that_contact_where_it_rests():
    """What a march pushes its slider at first moves the amplitude by ten times the error."""
    found = traced(50)
    error, uncertain_at, stable = marched([50], [found])
    assert found.rests.tolist() == [0.0, 0.0, 1.0]
    assert error[0] < MARCHED + found.estimate and stable[0]
    assert uncertain_at[0] < MARCHED
