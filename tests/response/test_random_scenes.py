"""A sample of the study of random scenes."""

from dataclasses import replace

import pytest

from fcm.continuation import Status
from fcm.harmonic.system import System
from fcm.harmonic.trace import traced

from .random_scenes import AGREE, outcome, random_scene


# 166: a contact so stiff that digits are counted, and a fold in a corner
@pytest.mark.parametrize("seed", [*range(6), 166])
def test_complete_and_the_same_for_every_step(seed):
    result = outcome(seed)
    assert result.complete, result.reasons
    assert result.disagreement < AGREE


def test_a_curve_goes_on_where_another_extreme_of_a_limit_holds_a_slider():
    system = System(replace(random_scene(82), max_step=0.1), (1, 2, 3))
    assert traced(system).branches.status is Status.COMPLETE
