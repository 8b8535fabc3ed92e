"""The workspace of multipliers, taken on by one system after another."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.stability.multipliers import Multipliers

from ..harmonic_balance.strips import strip


@pytest.mark.parametrize("contacts", [5, 12])
def test_states_that_were_met_are_those_of_the_contacts_as_they_are(contacts):
    """What is remembered of a state of the contacts is no longer true of stiffer ones."""
    scene = strip(contacts, n_0=0.3)
    stiffer = replace(scene, contacts=tuple(replace(one, k_u=2.0 * one.k_u) for one in scene.contacts))
    soft, stiff = System(scene, (1, 2, 3)), System(stiffer, (1, 2, 3))
    kept, (z, *_) = Multipliers(soft, 1.5), solutions(soft, 1.15).solutions
    for _ in range(3):  # a state is remembered once it was met twice
        kept.of(z)
    kept.take(stiff)
    (z, *_) = solutions(stiff, 1.15).solutions
    expected, found = Multipliers(stiff, 1.5).of(z), kept.of(z)
    assert max(abs(one) for one in expected) > 0.5
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(expected), atol=1e-9)
