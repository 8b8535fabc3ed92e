"""The energy balance, at every stiffness."""

from __future__ import annotations

import pytest

from fcm.time_domain import energy, simulate
from fcm.time_domain.contact_loads import contact_loads

from .cases import one_mode, two_contacts, yang

STIFFNESS = [1e-6, 1e-3, 1e3, 1e6, 1e8]


@pytest.mark.parametrize("omega", [0.7, 1.1, 1.3])
@pytest.mark.parametrize("scene", [yang(), yang(-2.0), one_mode(), two_contacts()], ids=lambda s: s.title)
def test_energy_balances(scene, omega):
    balance = energy(simulate(scene, omega, 20.5))
    assert balance.work > 0.0
    assert balance.error < 1e-12


@pytest.mark.parametrize("changes", ["k_u", "k_v", "k_u k_v"])
@pytest.mark.parametrize("stiffness", STIFFNESS)
def test_energy_balances_at_any_stiffness(stiffness, changes):
    scene = one_mode(n_0=1.0, **dict.fromkeys(changes.split(), stiffness))
    balance = energy(simulate(scene, 1.1, 1.0 if stiffness > 1e7 else 3.0))
    assert balance.error < 1e-10


def test_what_slip_takes_of_contacts_is_that_of_the_balance_and_is_not_added_up():
    motion = simulate(two_contacts(), 1.1, 3)
    once, again = contact_loads(motion.cycles), contact_loads(motion.cycles)
    assert once[:, 3].sum() * 3.0 == pytest.approx(energy(motion).slip, rel=1e-12)
    assert (once == again).all() and once[:, 3].sum() > 0.0
