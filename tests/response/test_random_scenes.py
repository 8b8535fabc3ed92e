"""A sample of the study of random scenes."""

import re
from dataclasses import replace

import numpy as np
import pytest

from fcm.branches.trace import traced
from fcm.continuation import Status
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.shooting.initial_orbits import solution_at

from .random_scenes import AGREE, outcome, random_scene


# 166: a contact so stiff that digits are counted, and a fold in a corner
@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(6), 166])
def test_complete_and_the_same_for_every_step(seed):
    result = outcome(seed)
    assert result.complete, result.reasons
    assert result.disagreement < AGREE


@pytest.mark.slow
def test_where_nothing_damps_it_is_said_what_would_do():
    """In phase with the forces a contact slides without work, and the curve turns on the spot, to a resonance
    that has no limit; with a little damping it leads there, and past it to where the exact motion is.
    """
    scene = random_scene(151)
    (curve,) = trace(scene).curves
    said = re.search(r"Nothing damps the structure.*: try a damping ratio of (\S+)$", curve.reason)
    assert not curve.complete and said
    damping = np.full(scene.modal.frequency.size, float(said[1]))
    damped = replace(scene, modal=replace(scene.modal, damping=damping))
    (whole,) = trace(damped).curves
    assert whole.complete
    resonance = curve.frequency[np.nanargmax(curve.amplitude[:, 0])]
    assert whole.peaks["d0"].frequency == pytest.approx(resonance, rel=1e-3)
    at = np.abs(whole.frequency - 1.3).argmin()
    exact = solution_at(damped, float(whole.frequency[at]))
    off = abs(exact.measure.amplitude[0] / whole.amplitude[at, 0] - 1.0)
    assert exact.stable and 0.5 * whole.error[at, 0] < off < 2.0 * whole.error[at, 0] < 0.2


@pytest.mark.slow
def test_a_curve_goes_on_where_another_extreme_of_a_limit_holds_a_slider():
    system = System(replace(random_scene(82), max_step=0.1), (1, 2, 3))
    assert traced(system).branches.status is Status.COMPLETE
