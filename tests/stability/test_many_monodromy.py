"""Multipliers of many contacts, each event a change of rank two, beside states that are put together anew."""

import numpy as np
import pytest

from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.stability.disturbance import Stiffness
from fcm.stability.monodromy import ManyMonodromy, Monodromy
from fcm.stability.state_sequence import BalancedSequence

from ..harmonic_balance.strips import strip


def multipliers(matrix):
    """Those that are not nearly zero: of sliders that forget, other numbers are followed."""
    values = np.linalg.eigvals(matrix)
    return np.sort_complex(values[np.abs(values) > 1e-6])


@pytest.mark.parametrize("follow", [0, 3])  # modes that follow without delay
@pytest.mark.parametrize("yielding", [True, False])
@pytest.mark.parametrize(("omega", "n_0"), [(1.15, 1.2), (1.4, 1.2), (1.15, 0.2), (1.15, -0.1)])
def test_multipliers_are_those_of_states_put_together_anew(omega, n_0, yielding, follow):
    system = System(strip(n_0=n_0), (1, 2, 3))
    linear, (z, *_) = system.linear, solutions(system, omega).solutions
    far = np.arange(linear.natural.size) >= linear.natural.size - follow
    contact = np.array([[c.mu, c.k_u, c.k_v, c.n_0] for c in system.scene.contacts])
    states = BalancedSequence(contact, [1, 2, 3])
    states.yielding = yielding
    assert states.find_events(z) and states.events > 12
    near = linear.ports[~far], linear.natural[~far], linear.damping[~far]
    soft = (linear.ports[far].T / linear.natural[far] ** 2) @ linear.ports[far]
    anew = Monodromy(Stiffness(*near, soft if follow else None, contact), states)
    anew.follow(omega)
    many = ManyMonodromy(linear.ports, linear.natural, linear.damping, far, contact, states)
    many.follow(omega)
    assert many.matrix().shape <= anew.matrix().shape
    found, expected = multipliers(many.matrix()), multipliers(anew.matrix())
    np.testing.assert_allclose(found, expected, atol=1e-9)
