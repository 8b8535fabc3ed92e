"""The curve does not depend on the step with which it is traced."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.continuation import Events, Mark, Status, follow
from fcm.harmonic_balance.system import System
from fcm.response import trace


def test_units_do_not_matter():
    """The same scene in metres and newtons, in 1e-9 m and 1e9 N, and in milliseconds."""
    scene = fcm.load_scene("yang1998-n5")
    reference = trace(scene, "closed-form").curves[0]
    length, stiffness, time = 2e-9, 3e11, 1e-3
    modal, (contact,) = scene.modal, scene.contacts
    other = replace(
        scene,
        modal=replace(modal, mass=modal.mass * stiffness * time**2, frequency=modal.frequency / time),
        contacts=(
            replace(
                contact,
                k_u=contact.k_u * stiffness,
                k_v=contact.k_v * stiffness,
                n_0=contact.n_0 * stiffness * length,
            ),
        ),
        forces=tuple(replace(f, amplitude=f.amplitude * stiffness * length) for f in scene.forces),
        frequency_range=(0.7 / time, 1.7 / time),
    )
    scaled = trace(other, "closed-form").curves[0]
    assert scaled.points == reference.points
    assert np.array(scaled.folds) * time == pytest.approx(reference.folds, rel=1e-7)
    assert scaled.amplitude / length == pytest.approx(reference.amplitude, rel=1e-4)
    assert scaled.peaks["u"][0] / length == pytest.approx(reference.peaks["u"][0], rel=1e-9)


def test_a_value_to_land_on_just_beyond_a_corner_takes_no_countless_steps():
    """Where the contact opens for an instant. The point beyond a corner lay beyond the value, too, so that
    the corner was met again a hair further on, 19 000 times."""
    curves = fcm.load_scene("yang1998").each_curve()
    scene = next(replace(one, curves=()) for one in curves if one.contacts[0].n_0 == -5.0).in_use()
    balance = System(scene, range(1, 10)).new_balance()
    start = np.append(np.zeros(balance.unknowns), 0.7)
    alone = follow(balance, start, (0.7, 1.7))
    corner = alone.parameter[alone.where(Mark.CORNER)][2]
    for beyond in np.linspace(0.0, 1.2e-7, 7):
        path = follow(balance, start, (0.7, 1.7), Events((corner + beyond,)))
        assert path.status is Status.COMPLETE
        assert (np.abs(path.parameter - corner - beyond) < 1e-15).any()
        assert len(path.parameter) <= len(alone.parameter) + 10
