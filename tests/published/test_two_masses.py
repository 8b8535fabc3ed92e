"""Two masses in a chain, the first with rigid Coulomb friction, beside a march with rigid friction.

The march is that of Moreau (Nonsmooth mechanics and applications, CISM 302, Springer, 1988): over each step
the impulse of friction is the one within its limits that ends the sliding, or opposes it. Nothing in it is a
spring; the scene's contact sticks on one that is stiff.
"""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.scene import scene_from_dict

FRICTION, STIFF = 0.4, 1e5
STIFFNESS = np.array([[2.0, -1.0], [-1.0, 1.0]])
DAMPING = 0.2  # times the stiffness
STEPS, CYCLES = 800, 30


def scene(omega):
    structure = {
        "dofs": ["first", "last"], "mass": [1.0, 1.0], "stiffness": STIFFNESS.tolist(),
        "damping": {"stiffness": DAMPING},
    }  # fmt: skip
    wall = {"name": "wall", "tangential": "first", "normal": "first", "mu": FRICTION, "n_0": 1.0}
    return scene_from_dict(
        {
            "structure": structure,
            "contact": [wall | {"k_u": STIFF, "k_v": 0.0}],
            "force": [{"dof": "last", "amplitude": 1.0}],
            "response": {"frequency": [0.5 * omega, 1.5 * omega]},
        }
    )


def marched(omega, steps):
    """Half the peak-to-peak displacements of the last cycle (dof,), and its part in which the first rests."""
    step = 2.0 * np.pi / omega / steps
    implicit = np.eye(2) + 0.5 * step * DAMPING * STIFFNESS + 0.25 * step * step * STIFFNESS
    inverse = np.linalg.inv(implicit)
    x, v, track, rests = np.zeros(2), np.zeros(2), [], 0
    for n in range(steps * CYCLES):
        force = np.array([0.0, np.sin(omega * (n + 0.5) * step)])
        push = v + step * (force - STIFFNESS @ (x + 0.25 * step * v) - 0.5 * DAMPING * (STIFFNESS @ v))
        free = inverse @ push
        impulse = np.clip(-free[0] / inverse[0, 0], -FRICTION * step, FRICTION * step)
        new = free + inverse[:, 0] * impulse
        x, v = x + 0.5 * step * (v + new), new
        if n >= steps * (CYCLES - 1):
            track.append(x)
            rests += abs(impulse) < FRICTION * step
    return np.ptp(track, axis=0) / 2.0, rests / steps


@pytest.mark.parametrize(("omega", "stops"), [(0.4, True), (0.68, False), (1.2, False)])
def test_stiff_contacts_are_rigid_friction_in_the_limit(omega, stops):
    expected, rests = marched(omega, STEPS)
    assert (rests > 0.05) if stops else (rests < 0.01)
    coarse, _ = marched(omega, STEPS // 2)
    assert coarse == pytest.approx(expected, rel=2e-3)  # the march's own error
    found = fcm.respond(scene(omega), "exact", at=[omega])
    amplitude = found.amplitude.values.reshape(-1, 2)
    amplitude = amplitude[np.isfinite(amplitude).all(axis=1)]
    assert len(amplitude) == 2  # swept up, and down
    for one in amplitude:
        assert one == pytest.approx(expected, rel=2e-3)
