"""The response of a scene whose contacts are springs, or nothing, at all harmonics of its forces."""

import numpy as np

from fcm.reduction.linear import ModesWithSprings
from fcm.structure.linear import linear_of


def linear_response(scene, omega, springs):
    """Amplitudes (driven frequency, dof), of one driven harmonic after the other; springs (port,)."""
    linear = linear_of(scene)
    found = [ModesWithSprings(linear, k, omega, springs).response for k in range(len(linear.driven))]
    return np.concatenate([modes @ linear.dofs for modes in found])
