"""The workspace of multipliers, taken on by one system after another."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene
from fcm.stability.multipliers import Multipliers
from fcm.stability.options import STABILITY

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


def test_modes_far_above_the_excitation_cost_a_contact_in_a_plane_no_steps():
    """Each of their vibrations was resolved: a blade of ten modes and two contacts took minutes."""
    scene = load_scene("platform-damper")
    modal, rng = scene.modal, np.random.default_rng(1)
    high = 1000.0 * modal.frequency.max() * np.array([1.0, 1.7, 2.9])
    added = replace(
        modal,
        mass=np.append(modal.mass, np.ones(3)),
        frequency=np.append(modal.frequency, high),
        damping=np.append(modal.damping, [0.001] * 3),
        shapes=np.vstack((modal.shapes, 30.0 * rng.normal(size=(3, modal.shapes.shape[1])))),
    )
    system = System(replace(scene, modal=added), (1,))
    low, top = system.scene.frequency_range
    z = solutions(system, 0.5 * (low + top)).solutions[0]
    resolved = replace(STABILITY, structure=replace(STABILITY.structure, above_of_few=np.inf))
    found, expected = (Multipliers(system, top, options=one) for one in (STABILITY, resolved))
    of_slow = [
        sorted((one for one in made.of(z) if abs(one) > 1e-3), key=lambda one: (abs(one), one.imag))
        for made in (found, expected)
    ]
    assert found.fine.monodromy.steps < 0.1 * expected.fine.monodromy.steps
    np.testing.assert_allclose(*map(np.array, of_slow), atol=1e-7)
