"""Random scenes, on the boundaries as often as not: the energy balances, the law of friction holds."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.scene import Contact, Force, Modal, Scene
from fcm.time_domain import energy, simulate


def random_scene(rng) -> Scene:
    modes, contacts = rng.integers(1, 6), rng.integers(1, 4)
    dofs = 2 * contacts + 1
    modal = Modal(
        tuple(f"d{i}" for i in range(dofs)),
        rng.uniform(0.5, 2.0, modes),
        np.sort(rng.uniform(0.5, 6.0, modes)),
        rng.choice([0.0, 0.005, 0.02, 0.1]) * np.ones(modes),
        rng.normal(size=(modes, dofs)),
    )
    made = tuple(
        Contact(
            f"c{j}", rng.normal(size=dofs), rng.normal(size=dofs), rng.choice([0.0, 0.1, 0.4, 1.0, 2.0]),
            10 ** rng.uniform(-3, 3), 10 ** rng.uniform(-3, 3),
            rng.choice([0.0, 1.0, -0.1, 0.1, 3.0, rng.normal()]),
        )
        for j in range(contacts)
    )  # fmt: skip
    force = Force(rng.normal(size=dofs), 1.0, rng.uniform(0.0, 6.0))
    return Scene("random", modal, made, (force,), (0.5, 2.0), 0.05)


# 213 is one in which two states tie at a transition
@pytest.mark.parametrize("seed", [*range(24), 213])
def test_energy_and_the_law_of_friction(seed):
    rng = np.random.default_rng(seed)
    scene = random_scene(rng)
    motion = simulate(scene, rng.uniform(0.5, 4.0), 6)
    assert energy(motion).error < 1e-12
    times = np.linspace(0.0, motion.duration, 1000)
    x, f = motion.displacement(times), motion.friction(times)
    for j, contact in enumerate(scene.contacts):
        load = np.maximum(contact.n_0 + contact.k_v * (x @ contact.normal), 0.0)
        slack = 1e-9 * (1.0 + contact.mu * contact.k_v)
        assert (np.abs(f[:, j]) <= contact.mu * load + slack).all()
