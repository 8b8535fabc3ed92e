"""Receptances are the sums over the modes, however many ports there are."""

import numpy as np
import pytest

from fcm.structure.receptance import Receptance


@pytest.mark.parametrize(("ports", "modes"), [(2, 5), (4, 7), (8, 38), (20, 30)])
def test_receptances_and_their_derivatives_are_sums_over_the_modes(ports: int, modes: int) -> None:
    random = np.random.default_rng(ports)
    shapes, natural = random.normal(size=(modes, ports)), random.uniform(1.0, 30.0, modes)
    damping, force = (
        random.uniform(0.01, 0.1, modes),
        random.normal(size=modes) + 1j * random.normal(size=modes),
    )
    harmonics, omega = np.array([1.0, 2.0, 5.0]), 3.1
    seen = Receptance(shapes, natural, damping, force, np.zeros((ports, ports)), harmonics)
    seen.at(omega)
    w = harmonics[:, None] * omega
    compliance = 1.0 / (natural**2 - w**2 + 2j * damping * natural * w)
    slope = -(compliance**2) * harmonics[:, None] * (2j * damping * natural - 2.0 * w)
    for weight, re, im in ((compliance, seen.G_re, seen.G_im), (slope, seen.dG_re, seen.dG_im)):
        expected = np.einsum("ik,im,hi->hkm", shapes, shapes, weight)
        assert np.asarray(re) + 1j * np.asarray(im) == pytest.approx(expected, rel=1e-12, abs=1e-13)
