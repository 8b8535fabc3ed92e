"""Amplitudes under forces on the ports, beside those of the equations of motion written out."""

from __future__ import annotations

import numpy as np

from fcm.structure.receptance import ForcedModes

RNG = np.random.default_rng(7)
MODES, PORTS, DOFS, POINTS, HARMONICS = 3, 4, 5, 6, 7


def test_shares_are_those_of_the_equations_of_motion():
    """M x'' + C x' + K x = P F exp(i h omega t), in coordinates that are no modes; other harmonics stay."""
    turned = np.linalg.qr(RNG.standard_normal((MODES, MODES)))[0]
    natural, damping = np.array([1.0, 3.0, 7.0]), np.array([0.01, 0.3, 0.0])
    stiffness = turned @ np.diag(natural**2) @ turned.T
    damper = turned @ np.diag(2.0 * damping * natural) @ turned.T
    on_ports, shown = RNG.standard_normal((MODES, PORTS)), RNG.standard_normal((MODES, DOFS))
    force = RNG.standard_normal((POINTS, HARMONICS, PORTS, 2))
    omega, size = RNG.uniform(0.5, 2.0, POINTS), RNG.uniform(0.1, 1.0, (POINTS, DOFS))
    out = np.full((POINTS, HARMONICS), -1.0)
    modes = ForcedModes(natural, damping, turned.T @ on_ports, turned.T @ shown)
    for i in range(POINTS):
        modes.shares(np.array([2, 3, 6]), omega[i], force[i], size[i], out[i])
        for h in (2, 3, 6):
            w = h * omega[i]
            pushed = on_ports @ (force[i, h - 1, :, 0] + 1j * force[i, h - 1, :, 1])
            x = np.linalg.solve(stiffness + 1j * w * damper - w * w * np.eye(MODES), pushed)
            expected = (np.abs(shown.T @ x) / size[i]).max()
            assert abs(out[i, h - 1] / expected - 1.0) < 1e-12
    assert (out[:, [0, 3, 4, 6]] == -1.0).all()


def test_what_does_not_move_has_no_share_and_resonance_no_infinite_one():
    modes = ForcedModes(np.array([2.0]), np.zeros(1), np.ones((1, 1)), np.ones((1, 2)))
    out, force = np.zeros(2), np.ones((2, 1, 2))
    modes.shares(np.array([2]), 1.0, force, np.array([0.0, 1.0]), out)
    assert out[0] == 0.0 and np.isfinite(out[1]) and out[1] > 1e6
    modes.shares(np.array([2]), 1.0, force, np.zeros(2), out)
    assert (out == 0.0).all()
