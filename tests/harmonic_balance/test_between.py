"""A closed branch between the ends of the range and the resonances that no level there leads to."""

import numpy as np
import pytest

from fcm.accuracy.refinement import refined_response, with_given_harmonics
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict
from fcm.time_domain import State, simulate

from ..branches.test_prolongation import amplitudes_at
from .scenes import up_to

CLOSED_AT_REST = {
    "modal": {"dofs": ["u", "v"], "frequency": [1.0], "damping": [0.0143], "shapes": [[-0.631, 0.674]]},
    "contact": [
        {"name": "c", "tangential": "u", "normal": "v", "mu": 0.81, "k_u": 0.125, "k_v": 3.94, "n_0": 0.886}
    ],
    "force": [{"dof": "u", "amplitude": 1.0}],
    "response": {"frequency": [0.573, 1.337]},
}


def within_a_hundredth(scene):
    return refined_response(System(scene, (1,)), 1e-2)


def of_three_harmonics(scene):
    return with_given_harmonics(System(scene, up_to(3)))


@pytest.mark.parametrize("response", [within_a_hundredth, of_three_harmonics])
def test_what_opens_twice_a_cycle_is_found_beside_what_stays_closed(response):
    """From most states the motion comes to this one, which is twice as large as the stuck one."""
    scene, omega = scene_from_dict(CLOSED_AT_REST), 0.8057
    start = State(np.array([2.0]), np.zeros(1), np.zeros(1))
    motion = simulate(scene, omega, 300, start)
    assert motion.cycles[-1].states == ("SESE",)
    amplitude = motion.measures()[-1].amplitude
    there = amplitudes_at(response(scene), omega)
    assert min(np.abs(one / amplitude - 1.0).max() for one in there) < 2e-2
