"""Equal neighbours that the forces move alike: the contact between them hardly moves, under its preload."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.scene import scene_from_dict

BLADE = np.array(
    [[60.0, -1.0, -0.6, -0.4], [-1.0, 3.0, 0.2, 0.1], [-0.6, 0.2, 3.4, -0.15], [-0.4, 0.1, -0.15, 4.0]]
)
ROOTS = np.kron([[0.0, -1.0], [-1.0, 0.0]], np.diag([40.0, 0.0, 0.0, 0.0]))
MASS, BETA, K_U, K_V = np.tile([1.2, 0.35, 0.3, 0.25], 2), 0.004, 1.5, 1.0
FORCE = 0.05 * np.tile([0.0, 1.0, 0.4, 0.3], 2)
DOFS = [f"{name}{blade}" for blade in "ab" for name in ("root_", "x_", "y_", "z_")]


def stiffness(apart):
    """Of two blades, of which one is stiffer by a small share."""
    K = np.kron(np.eye(2), BLADE) + ROOTS
    K[1, 1] *= 1.0 + apart
    return K


def pair(apart, plane, harmonics, mu):
    relative = [{f"{name}_a": 1.0, f"{name}_b": -1.0} for name in "xyz"]
    return scene_from_dict(
        {
            "structure": {
                "dofs": DOFS,
                "mass": np.diag(MASS).tolist(),
                "stiffness": stiffness(apart).tolist(),
                "damping": {"stiffness": BETA},
            },
            "contact": [
                {
                    "name": "shroud",
                    "tangential": relative[:2] if plane else relative[0],
                    "normal": relative[2],
                    "mu": mu,
                    "k_u": K_U,
                    "k_v": K_V,
                    "n_0": 60.0,
                }
            ],
            "force": [{"dof": dict(zip(DOFS, FORCE.tolist(), strict=True)), "amplitude": 1.0}],
            "response": {"frequency": [2.2, 4.2], "harmonics": harmonics},
        }
    )


@pytest.mark.parametrize("plane, harmonics", [(True, 1), (False, [1, 3]), (True, [1, 3])])
@pytest.mark.parametrize("apart", [0.0, 1e-10, 1e-6])
@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_a_contact_that_hardly_moves_ends_no_curve(apart, plane, harmonics, mu):
    """It sticks, or slides freely, so that the response is linear. The rounding of the preload is no motion
    of its."""
    response = fcm.respond(pair(apart, plane, harmonics, mu))
    assert response.complete.item() == 1 and response.sizes["point"] < 500
    K = stiffness(apart)
    held = K.copy()
    k_u = K_U if mu else 0.0
    springs = (k_u, k_u, K_V) if plane else (k_u, 0.0, K_V)
    for i, spring in enumerate(springs, 1):
        direction = np.zeros(8)
        direction[[i, i + 4]] = 1.0, -1.0
        held += spring * np.outer(direction, direction)
    omega = response.frequency.values[0]
    dynamic = held - omega[:, None, None] ** 2 * np.diag(MASS) + 1j * omega[:, None, None] * BETA * K
    linear = np.abs(np.linalg.solve(dynamic, FORCE[:, None])[..., 0])
    found = response.amplitude.sel(dof=DOFS).values[0]
    assert found == pytest.approx(linear, rel=1e-6)
