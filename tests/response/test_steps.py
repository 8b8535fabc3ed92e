"""The curve does not depend on the step with which it is traced."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.continuation import Events, Mark, Status, follow
from fcm.harmonic_balance.system import System
from fcm.response import trace

STEPS = np.geomspace(0.2, 0.005, 20)
PRELOADS = (10.0, 5.0, 2.0, 0.0, -5.0, -20.0)


@pytest.fixture(scope="module")
def by_step():
    """Every preload with every step limit, all curves in one group."""
    scene = fcm.load_scene("yang1998-n5")

    def curve(n_0: float, step: float):
        contact = replace(scene.contacts[0], n_0=n_0)
        return replace(scene, contacts=(contact,), max_step=step, parameters={"n_0": n_0, "step": step})

    curves = tuple(curve(n_0, step) for n_0 in PRELOADS for step in STEPS)
    response = trace(replace(scene, curves=curves), "table")
    return {(c.parameters["n_0"], c.parameters["step"]): c for c in response.curves}


@pytest.mark.slow
@pytest.mark.parametrize("n_0", PRELOADS)
def test_folds_and_peaks_for_every_step(by_step, n_0):
    finest = by_step[n_0, STEPS[-1]]
    for step in STEPS:
        curve = by_step[n_0, step]
        assert curve.complete
        assert curve.folds == pytest.approx(finest.folds, abs=1e-7)
        for dof in ("u", "v"):
            assert curve.peaks[dof][:2] == pytest.approx(finest.peaks[dof][:2], rel=1e-7)


def test_a_smaller_step_gives_more_points(by_step):
    points = [by_step[5.0, step].points for step in (STEPS[0], STEPS[10], STEPS[-1])]
    assert points[0] < points[1] < points[2]


def test_points_are_ordered_and_close(by_step):
    curve = by_step[5.0, STEPS[-1]]
    assert np.all(np.abs(np.diff(curve.frequency)) <= 0.005 * 1.5)
    assert curve.frequency[0] == 0.7
    assert curve.frequency[-1] == 1.7


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
