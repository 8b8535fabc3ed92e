"""The contact law in small steps: trial force f + du, clipped to +-n. Knows of no event and no sequence.

The error, with a step of h: a slip ends up to h / 2 from a node, where its limit has turned by h^2 / 8 of its
amplitude, at most 1 + b, and the trapezoidal rule meets kinks of slope at most 1 + b. That makes no more than
(1 + b) h^2 in any coefficient. A contact that closes between two nodes sticks with the displacement of the
first, up to h too little or too much: 4 / pi of that in a coefficient. `test_reference` measures both orders.
"""

import numpy as np

TOUCH = 1e-12  # a limit that is touched to within rounding does not push


def error(n0_bar, b_bar, steps):
    """Bound of the error of `coefficients`."""
    h = 2.0 * np.pi / steps
    return (1.0 + b_bar) * h * h + np.where(n0_bar < b_bar, 4.0 / np.pi * h, 0.0)


def march(n0_bar, b_bar, phi, steps, cycles=2):
    """theta, force and state ('E', 'P', 'N', 'S') at each of the steps of the last cycle, from rest."""
    theta = 2.0 * np.pi * np.arange(steps) / steps
    u = np.sin(theta)
    load = np.maximum(np.add.outer(0.0 * theta, n0_bar) + b_bar * np.sin(np.add.outer(theta, phi)), 0.0)
    forces, states = np.empty(load.shape), np.empty(load.shape, dtype="<U1")
    force = np.clip(0.0, -load[0], load[0])
    for step in range(1, cycles * steps + 1):
        i = step % steps
        trial = force + u[i] - u[i - 1]
        force = np.clip(trial, -load[i], load[i])
        forces[i] = force
        states[i] = np.select(
            [load[i] == 0.0, trial - load[i] > TOUCH, -trial - load[i] > TOUCH], ["S", "P", "N"], "E"
        )
    return theta, forces, states


def coefficients(n0_bar, b_bar, phi, steps):
    """F_b, F_s, F_c by the trapezoidal rule, of the shape of the arguments (one-dimensional)."""
    theta, forces, _ = march(n0_bar, b_bar, phi, steps)
    return forces.mean(0), 2.0 * np.sin(theta) @ forces / steps, 2.0 * np.cos(theta) @ forces / steps
