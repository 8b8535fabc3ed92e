"""A curve goes on where a short contact of its motion passes the instant at which the period begins."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.continuation import Checkpoint, FollowOptions, follow
from fcm.shooting import periodic
from fcm.shooting.problem import OrbitProblem

from ..response.random_scenes import random_scene

STIFF = 17  # a scene with a contact that is closed for 2e-3 of the period
# a motion of it that begins with 3e-6 of slip, as guess: (q, q', f, omega)
BEGIN = (
    -0.430025906,
    0.252818617,
    -0.659905831,
    0.327876189,
    0.0196352894,
    0.522276522,
    0.170894904,
    0.0707503126,
    -0.25006804,
    0.21013824,
    11.7164987,
    1.26890271,
    -1.68199869,
    5.89940793,
    0.313183886,
    2.7589239,
    4.20360587,
    -0.0612873411,
    -2.41095102,
    -0.559634746,
    -6.38961619,
    1.67997951,
)
STEPS = 60


class EnoughError(Exception):
    """It has been followed far enough."""


def test_a_curve_does_not_turn_back_where_slip_passes_the_start_of_the_period():
    """Friction falls to its limit and rises from there, nothing else of the motion turns."""
    scene, stages = random_scene(STIFF), list[Checkpoint]()
    problem = OrbitProblem(scene)

    def watch(stage: Checkpoint) -> None:
        stages.append(stage)
        if len(stages) == STEPS:
            raise EnoughError

    with pytest.raises(EnoughError):
        follow(
            problem,
            np.array(BEGIN),
            scene.frequency_range,
            options=FollowOptions(scene.max_step),
            forward=False,
            watch=watch,
        )
    frequency = np.array([stage.z[-1] for stage in stages])
    assert (np.diff(frequency) < 1e-12).all() and frequency[-1] < 0.97 * BEGIN[-1]
    last = problem.shot(stages[-1].z)
    assert last is not None
    again = periodic(scene, float(frequency[-1]), last.state)
    assert again.cycle.states == last.cycle.states
    assert np.abs(again.measure.amplitude - last.amplitude).max() < 1e-8 * last.amplitude.max()
