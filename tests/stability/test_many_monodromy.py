"""Multipliers of many contacts, each event a change of rank two, beside states that are put together anew."""

import numpy as np
import pytest

from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.stability.disturbance import Stiffness
from fcm.stability.monodromy import ManyMonodromy, Monodromy
from fcm.stability.quasi_static_modes import PortModes, combined
from fcm.stability.state_sequence import BalancedSequence

from ..harmonic_balance.strips import strip


def multipliers(matrix):
    """Those that are not nearly zero: of sliders that forget, other numbers are followed."""
    values = np.linalg.eigvals(matrix)
    return np.sort_complex(values[np.abs(values) > 1e-6])


# modes that follow without delay, fewer than the contacts or more
@pytest.mark.parametrize(("follow", "copies"), [(0, 1), (3, 1), (3, 12)])
@pytest.mark.parametrize("yielding", [True, False])
@pytest.mark.parametrize(("omega", "n_0"), [(1.15, 1.2), (1.4, 1.2), (1.15, 0.2), (1.15, -0.1)])
def test_multipliers_are_those_of_states_put_together_anew(omega, n_0, yielding, follow, copies):
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
    part = np.where(far, copies, 1)  # of each mode, all of which together are it
    ports, natural, damping, share = (
        np.repeat(one, part, axis=0) for one in (linear.ports, linear.natural, linear.damping, part)
    )
    ports /= np.sqrt(share)[:, None]
    many = ManyMonodromy(PortModes(ports, natural, damping, np.repeat(far, part)), contact, states)
    many.follow(omega)
    assert many.matrix().shape <= anew.matrix().shape
    found, expected = multipliers(many.matrix()), multipliers(anew.matrix())
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_combined_modes_have_the_flexibility_but_for_what_hardly_yields_beside_the_springs():
    rng = np.random.default_rng(0)
    shapes, natural = rng.normal(size=(9, 6)), rng.uniform(2.0, 40.0, 9)
    springs = np.array([3.0, 0.5, 0.0, 20.0, 1.0, 7.0])
    flexibility = (shapes.T / natural**2) @ shapes
    held = springs > 0.0
    root = np.sqrt(springs[held])
    for tolerance in (1e-12, 0.02, 0.5):
        found = combined(shapes, natural, springs, tolerance)
        assert not found[:, ~held].any()
        left = (flexibility - found.T @ found)[np.ix_(held, held)]
        most = np.linalg.eigvalsh(root[:, None] * left * root).max()
        assert most <= tolerance + 1e-12
        yields = np.linalg.eigvalsh(root[:, None] * flexibility[np.ix_(held, held)] * root)
        assert len(found) == (yields > tolerance).sum()
