"""Scenes for the time simulation, and the paper's oscillator."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fcm
from fcm.scene import Contact, Force, Modal, Scene


def yang(n_0: float = 5.0, **contact: float) -> Scene:
    """The oscillator of section 4.3 at a preload, other contact parameters changed at will."""
    scene = fcm.load_scene("yang1998-n5")
    return replace(scene, contacts=(replace(scene.contacts[0], n_0=n_0, **contact),))


def one_mode(**changes: object) -> Scene:
    """A mass on a spring with a contact of its own tangential and normal directions."""
    values: dict[str, object] = {
        "frequency": 1.0, "damping": 0.02, "shape": (1.0, 0.5),
        "mu": 0.3, "k_u": 2.0, "k_v": 1.0, "n_0": 2.0, "force": 1.0,
    } | changes  # fmt: skip
    modal = Modal(
        ("u", "v"),
        np.ones(1),
        np.array([values["frequency"]], dtype=float),
        np.array([values["damping"]], dtype=float),
        np.array([values["shape"]], dtype=float),
    )
    contact = Contact(
        "c", np.array([1.0, 0.0]), np.array([0.0, 1.0]),
        *(float(values[k]) for k in ("mu", "k_u", "k_v", "n_0")),  # type: ignore[arg-type]
    )  # fmt: skip
    force = Force(np.array([1.0, 0.0]), float(values["force"]), 0.3)  # type: ignore[arg-type]
    return Scene("one mode", modal, (contact,), (force,), (0.5, 2.0), 0.05)


def three_harmonics() -> Scene:
    """The oscillator with forces at the second and, growing with the frequency, the third harmonic."""
    scene = yang(2.0)
    second = Force(np.array([0.2, 1.0]), 0.8, 0.3, harmonic=2)
    third = Force(np.array([1.0, 0.0]), 0.5, -1.1, power=2, harmonic=3)
    return replace(scene, forces=(*scene.forces, second, third))


def two_contacts() -> Scene:
    """Three modes, two contacts of which one has a gap, forces out of phase; all terms of one size."""
    modal = Modal(
        ("a", "b", "c", "d"),
        np.array([1.0, 2.0, 0.5]),
        np.array([1.0, 1.9, 4.0]),
        np.array([0.02, 0.03, 0.02]),
        np.array([[1.0, 0.4, -0.3, 0.5], [0.6, -0.8, 0.9, 0.2], [0.3, 0.5, 0.4, -0.7]]),
    )
    x = np.eye(4)
    contacts = (
        Contact("one", x[0] - x[2], x[1], 0.4, 1.5, 1.0, 1.0),
        Contact("two", x[3], x[2] - 0.5 * x[1], 0.3, 0.8, 2.0, -0.4),
    )
    forces = (Force(x[0], 1.0, 0.2), Force(x[3] - x[1], 0.7, 1.1))
    return Scene("two contacts", modal, contacts, forces, (0.5, 4.0), 0.05)


SCENES = {
    "n_0 = 5": yang(),
    "n_0 = 0": yang(0.0),
    "n_0 = -2": yang(-2.0),
    "one mode": one_mode(),
    "two contacts": two_contacts(),
    "three harmonics": three_harmonics(),
}
