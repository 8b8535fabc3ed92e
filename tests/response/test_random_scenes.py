"""A sample of the study of random scenes."""

import pytest

from .random_scenes import AGREE, outcome


@pytest.mark.parametrize("seed", range(6))
def test_complete_and_the_same_for_every_step(seed):
    result = outcome(seed)
    assert result.complete, result.reasons
    assert result.disagreement < AGREE
