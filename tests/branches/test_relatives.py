"""No stable motion is off the branches of random scenes of the kinds of which some were missed."""

import pytest

from .hunt import hunt
from .relatives import KINDS


@pytest.mark.slow
@pytest.mark.parametrize("exact", [False, True], ids=["balance", "exact"])
@pytest.mark.parametrize(
    ("kind", "seed"),
    [("meets", 0), ("meets", 1), ("stops", 0), ("stops", 16), ("stops", 54), ("stops", 2033), ("meets", 81)],
)
def test_marches_from_random_states_settle_on_branches(kind, seed, exact):
    assert list(hunt(KINDS[kind](seed), looks=5, tries=3, exact=exact)) == []
