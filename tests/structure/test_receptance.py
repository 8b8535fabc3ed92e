"""Receptances are the sums over the modes, however many ports there are."""

import numpy as np
import pytest

from fcm.scene import scene_from_dict
from fcm.structure.linear import linear_of
from fcm.structure.options import DAMPING
from fcm.structure.receptance import DrivenModes, ForcedModes, Receptance, dynamic_stiffness


@pytest.mark.parametrize(("ports", "modes"), [(2, 5), (4, 7), (8, 38), (20, 30)])
def test_receptances_and_their_derivatives_are_sums_over_the_modes(ports: int, modes: int) -> None:
    random = np.random.default_rng(ports)
    shapes, natural = random.normal(size=(modes, ports)), random.uniform(1.0, 30.0, modes)
    damping, force = (
        random.uniform(0.01, 0.1, modes),
        random.normal(size=modes) + 1j * random.normal(size=modes),
    )
    harmonics, omega = np.array([1.0, 2.0, 5.0]), 3.1
    loaded = DrivenModes(shapes, natural, damping, force[None], 0.0 * force[None], (1,))
    seen = Receptance(loaded, np.zeros((ports, ports)), harmonics)
    seen.at(omega)
    w = harmonics[:, None] * omega
    compliance = 1.0 / (natural**2 - w**2 + 2j * damping * natural * w)
    slope = -(compliance**2) * harmonics[:, None] * (2j * damping * natural - 2.0 * w)
    for weight, re, im in ((compliance, seen.G_re, seen.G_im), (slope, seen.dG_re, seen.dG_im)):
        expected = np.einsum("ik,im,hi->hkm", shapes, shapes, weight)
        assert np.asarray(re) + 1j * np.asarray(im) == pytest.approx(expected, rel=1e-12, abs=1e-13)


def test_answers_with_springs_of_few_modes_are_those_of_the_receptance() -> None:
    """The modes' dynamic stiffness with springs in it, against springs closed on the ports' receptance."""
    rng = np.random.default_rng(11)
    contact = {"mu": 0.3, "k_u": 2.0, "k_v": 3.0, "n_0": 1.0}
    scene = scene_from_dict(
        {
            "modal": {
                "dofs": list("abcdef"),
                "frequency": [1.0, 2.5],
                "damping": [0.01, 0.2],
                "shapes": rng.standard_normal((2, 6)).tolist(),
            },
            "contact": [contact | {"name": t, "tangential": t, "normal": n} for t, n in ("ab", "cd", "ef")],
            "force": [
                {"dof": "a", "amplitude": 1.0, "phase": 0.4},
                {"dof": "d", "amplitude": 0.5, "harmonic": 3},
            ],
            "response": {"frequency": [0.5, 1.5]},
        }
    )
    linear, held = linear_of(scene), np.array([[2.0, 3.0] * 3, [0.0, 1.0] * 3])
    omega = np.array([0.7, 1.0])
    found = linear.answers_with(held, omega)
    for j, w in enumerate(omega):
        for k, (G, X) in enumerate(zip(*linear.at(w), strict=True)):
            for answer, springs in zip(found[:, j, k], held, strict=True):
                assert answer + G @ (springs * answer) == pytest.approx(X, rel=1e-11)


def test_an_undamped_mode_at_its_own_frequency_answers_alike_to_all_that_ask() -> None:
    """A quarter of a period behind the force, as a damped one does: its stiffness is a little damping."""
    natural, damping, one = np.array([3.0]), np.zeros(1), np.ones((1, 1))
    stiffness = dynamic_stiffness(natural, damping, natural)[0, 0]
    assert stiffness == 9j * DAMPING.min_loss_factor
    loaded = DrivenModes(one, natural, damping, one, 0.0 * one, (1,))
    seen = Receptance(loaded, np.zeros((1, 1)), np.ones(1))
    seen.at(3.0)
    assert seen.of_harmonic(0)[0, 0] == pytest.approx(1.0 / stiffness, rel=1e-14)
    share = np.zeros(1)
    damped = np.array([0.5 * DAMPING.min_loss_factor])
    together = np.hstack((natural, natural)), np.hstack((damping, damped))
    shapes = np.array([[1.0], [1.0]])
    # beside a mode with that damping: what both do together is twice as much, and not the root of two
    modes = ForcedModes(*together, shapes, shapes)
    modes.shares(np.ones(1, dtype=np.intp), 3.0, np.array([[[1.0, 0.0]]]), np.ones(1), share)
    assert share[0] == pytest.approx(2.0 / abs(stiffness), rel=1e-14)
