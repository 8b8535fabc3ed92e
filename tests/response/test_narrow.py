"""Peaks of a mode that hardly anything damps, much narrower than a step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fcm.response import trace
from fcm.scene import Contact, Modal, scene_from_dict
from fcm.shooting import periodic

from ..time_domain.cases import yang

STEPS = (0.2, 0.1, 0.05, 0.02)


def with_mode(n_0: float, frequency: float, damping: float, share: float):
    """The paper's oscillator with a mode more, of which u has a share, and which is all that w has."""
    scene = yang(n_0)
    shapes = np.block([[scene.modal.shapes, np.zeros((2, 1))], [np.array([share, 0.0, 1.0])]])
    contact = scene.contacts[0]
    modal = Modal(
        ("u", "v", "w"), np.ones(3), np.append(scene.modal.frequency, frequency),
        np.append(scene.modal.damping, damping), shapes,
    )  # fmt: skip
    contact = Contact(
        contact.name, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]),
        contact.mu, contact.k_u, contact.k_v, contact.n_0,
    )  # fmt: skip
    forces = tuple(replace(one, direction=np.append(one.direction, 0.0)) for one in scene.forces)
    scene = replace(scene, modal=modal, reported=modal.dofs, contacts=(contact,), forces=forces)
    return replace(scene, frequency_range=(1.25, 1.4))


def linear(scene, omega: float) -> float:
    """Amplitude of u with the contact open."""
    modal = scene.modal
    q = modal.shapes @ sum(one.amplitude * np.exp(1j * one.phase) * one.direction for one in scene.forces)
    natural, damping = modal.frequency, modal.damping
    return float(abs(modal.shapes[:, 0] @ (q / (natural**2 - omega**2 + 2j * damping * natural * omega))))


def narrow_peak(scene) -> tuple[float, float]:
    """The same at the mode of 1.31 rad/s and damping 1e-5: its peak, and where that is."""
    top = minimize_scalar(
        lambda d: -linear(scene, 1.31 + 1e-5 * d),
        bounds=(-3.0, 3.0),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return -top.fun, 1.31 + 1e-5 * top.x


@pytest.mark.parametrize("step", STEPS)
def test_a_narrow_peak_of_an_open_contact(step):
    scene = with_mode(-60.0, 1.31, 1e-5, 0.005)
    (curve,) = trace(replace(scene, max_step=step), harmonics=1).curves
    top = narrow_peak(scene)
    assert top[0] > 1.25 * linear(scene, 1.3)
    assert curve.peaks["u"][:2] == pytest.approx(top, rel=1e-8)


def test_a_narrow_peak_of_the_third_harmonic():
    scene = with_mode(5.0, 3.93, 1e-4, 0.1)
    peaks = [trace(replace(scene, max_step=step), harmonics=3).curves[0].peaks["w"] for step in STEPS]
    for peak in peaks:
        assert peak[:2] == pytest.approx(peaks[-1][:2], rel=1e-6)
    around = peaks[0].frequency + np.linspace(-2e-4, 2e-4, 9)
    exact = [periodic(scene, omega).measure.amplitude[2] for omega in around]
    assert peaks[0].amplitude == pytest.approx(max(exact), rel=0.03)


def around(scene):
    """A ring of such sectors, held by nothing but themselves, of which u and v are seen.

    Only the waves that travel with the forces meet the last mode.
    """
    modal, (contact,), diameters = scene.modal, scene.contacts, 4
    other = np.append(modal.frequency[:-1], 7.0)
    law = {key: getattr(contact, key) for key in ("mu", "k_u", "k_v", "n_0")}
    data = {
        "cyclic": {"sectors": 6, "engine_order": 1},
        "modal": {
            "dofs": ["u", "v"],
            "nodal_diameter": np.repeat(np.arange(diameters), other.size).tolist(),
            "frequency": np.concatenate((other, modal.frequency, other, other)).tolist(),
            "damping": modal.damping.tolist() * diameters,
            "shapes": modal.shapes[:, :2].tolist() * diameters,
        },
        "contact": [{"name": contact.name, "tangential": "u", "normal": "v", **law}],
        "force": [{"dof": dof, "amplitude": 1.0} for dof in ("u", "v")],
        "response": {"frequency": list(scene.frequency_range)},
    }
    return scene_from_dict(data)


@pytest.mark.parametrize("step", [0.2, 0.1])
def test_a_narrow_peak_of_a_ring(step):
    alone = with_mode(-60.0, 1.31, 1e-5, 0.005)
    (curve,) = trace(replace(around(alone), max_step=step), harmonics=3).curves
    top = narrow_peak(alone)
    assert curve.peaks["u"][:2] == pytest.approx(top, rel=1e-8)
