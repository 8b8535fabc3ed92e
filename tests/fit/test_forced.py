"""Residuals of measured responses: distances to the nearest branch, and their exact rates."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.fit.forced import errors_of, forced_rows
from fcm.fit.options import FIT
from fcm.fit.parameters import parameters_of
from fcm.fit.solve import FitProblem, solved
from fcm.model.scene import Measured
from fcm.response import trace
from fcm.scene.load import scene_from_dict

K_U, DAMPING = 0.7, 0.02


def stuck(k_u=K_U, damping=DAMPING, unit="rad/s"):
    """A mass whose contact never slips: a linear oscillator with the spring k_u beside its own."""
    return scene_from_dict(
        {
            "frequency_unit": unit,
            "modal": {"dofs": ["u", "v"], "frequency": [1.0, 9.0], "damping": [damping, 0.1],
                      "shapes": [[1.0, 0.0], [0.0, 1.0]]},
            "contact": [{"name": "c", "tangential": "u", "normal": "v", "mu": 1e6, "k_u": k_u, "k_v": 1.0,
                         "n_0": 1.0}],
            "force": [{"dof": "u", "amplitude": 2.0, "phase": 0.3}],
            "response": {"frequency": [0.8, 1.8], "harmonics": 1},
        }
    )  # fmt: skip


def linear(omega, level=1.0):
    """Its complex displacement, over sin(omega t): worked out by hand."""
    return level * 2.0 * np.exp(0.3j) / (1.0 + K_U - omega**2 + 2j * DAMPING * omega)


def measured(quantity="displacement", phased=False, level=1.0):
    omega = np.linspace(0.9, 1.6, 15)
    value = (
        linear(omega, level) * (1j * omega) ** {"displacement": 0, "velocity": 1, "acceleration": 2}[quantity]
    )
    phase = np.angle(value) if phased else None
    ones = np.ones(omega.size)
    return Measured("made", "u", omega, np.abs(value), ones, level * ones, phase, quantity=quantity)


@pytest.mark.slow
@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
@pytest.mark.parametrize("phased", [False, True])
def test_a_linear_response_gives_back_its_stiffness_and_damping(quantity, phased):
    parameters = parameters_of(stuck(0.5, 0.03), ["contact.c.k_u", "modal.damping.0"], [None, None])
    data = [measured(quantity, phased), measured(quantity, phased, level=3.0)]
    found = solved(parameters, data, (1,), begin=[parameters.start])
    assert found.values == pytest.approx([K_U, DAMPING], rel=1e-7)


KEYS = ["contact.shroud.mu", "contact.shroud.n_0"]


def jump():
    """The paper's oscillator at a preload at which its response folds back."""
    return fcm.load_scene("yang1998-n5")


def of_curve(scene, every=9, **more):
    """Points of a response with folds, on all its parts."""
    curve = trace(scene, method="closed-form").curves[0]
    assert len(curve.folds) == 2
    known = np.flatnonzero(np.isfinite(curve.frequency))[::every]
    ones = np.ones(known.size)
    return Measured("made", "u", curve.frequency[known], curve.amplitude[known, 0], ones, ones, **more)


@pytest.mark.parametrize("blurred", [False, True])
def test_rates_are_those_of_the_distances_beside_folds_too(blurred):
    scene = jump()
    data = of_curve(scene)
    data = replace(data, amplitude=data.amplitude * (1.0 + 0.01 * np.cos(np.arange(data.points))))
    parameters = parameters_of(scene, [*KEYS, "modal.damping.0"], [None] * 3)
    problem = FitProblem(parameters, [data], (1,), blurred)
    x = parameters.unknowns(parameters.start * 1.01)
    gradient = problem.jacobian(x).T @ problem.residual(x)
    costs = [0.5 * (problem.residual(x + sign * h) ** 2).sum() for h in 1e-6 * np.eye(3) for sign in (1, -1)]
    assert gradient == pytest.approx(np.diff(np.reshape(costs, (3, 2))).ravel() / -2e-6, rel=1e-4)


@pytest.mark.slow
def test_rates_of_a_contact_in_a_plane():
    """It slips along both directions, in an orbit."""
    scene = scene_from_dict(
        {
            "modal": {"dofs": ["x", "y", "z"], "frequency": [1.0, 1.2, 9.0], "damping": [0.02, 0.02, 0.02],
                      "shapes": [[1.0, 0.4, 0.2], [-0.3, 1.0, 0.1], [0.0, 0.0, 1.0]]},
            "contact": [{"name": "c", "tangential": ["x", "y"], "normal": "z", "mu": 0.4, "k_u": 0.6,
                         "k_v": 0.5, "n_0": 2.0}],
            "force": [{"dof": "x", "amplitude": 1.0}, {"dof": "y", "amplitude": 0.8, "phase": 1.3}],
            "response": {"frequency": [0.9, 1.5], "harmonics": 1},
        }
    )  # fmt: skip
    curve = trace(scene, method="closed-form").curves[0]
    chosen = np.unique(np.linspace(0, curve.points - 1, 9).astype(int))[1:-1]
    assert any("P" in regime for regime in curve.regime[chosen, 0])
    ones = np.ones(chosen.size)
    amplitude = curve.amplitude[chosen, 0] * (1.0 + 0.02 * np.cos(np.arange(chosen.size)))
    data = Measured("made", "x", curve.frequency[chosen], amplitude, ones, ones)
    parameters = parameters_of(scene, ["contact.c.mu", "contact.c.k_u"], [None] * 2)
    problem = FitProblem(parameters, [data], (1,), False)
    x = parameters.unknowns(parameters.start * 1.01)
    gradient = problem.jacobian(x).T @ problem.residual(x)
    costs = [0.5 * (problem.residual(x + sign * h) ** 2).sum() for h in 1e-6 * np.eye(2) for sign in (1, -1)]
    assert gradient == pytest.approx(np.diff(np.reshape(costs, (2, 2))).ravel() / -2e-6, rel=1e-4)


@pytest.mark.parametrize("count", [1, 2, 8])
def test_so_many_starts_are_tried_the_numbers_of_the_scene_first(count):
    """One start was two."""
    parameters = parameters_of(stuck(), ["contact.c.k_u", "modal.damping.0"], [None, None])
    found = np.array(list(parameters.starts(count)))
    assert len(found) == count
    assert np.exp(found[0]) == pytest.approx([K_U, DAMPING])


def test_a_point_is_compared_with_the_nearest_point_of_all_branches():
    """Found here among many points of a fine curve, which the fold makes no function of the frequency."""
    scene = jump()
    curve = trace(replace(scene, max_step=1e-3), method="closed-form").curves[0]
    data = of_curve(scene)
    data = replace(data, amplitude=data.amplitude * 1.05)
    errors = errors_of(data, True, FIT)
    rows = forced_rows(scene, KEYS, (1,), data, errors, FIT)
    for i in range(data.points):
        off_frequency = (curve.frequency - data.frequency[i]) / errors.frequency[i]
        off_amplitude = (curve.amplitude[:, 0] - data.amplitude[i]) / errors.amplitude[i]
        nearest = np.sqrt(np.nanmin(off_frequency**2 + off_amplitude**2))
        distance = np.linalg.norm(rows.residual[i])
        assert nearest - 0.01 < distance <= nearest * (1.0 + 1e-9)


@pytest.mark.slow
def test_a_response_with_folds_gives_back_its_numbers():
    scene, truth = jump(), np.array([0.4, 5.0])
    away = parameters_of(scene, KEYS, [None, None]).at(np.array([0.3, 6.5]))
    parameters = parameters_of(away, KEYS, [None, None])
    found = solved(parameters, [of_curve(scene, every=5)], (1,))
    assert found.values == pytest.approx(truth, rel=1e-6)
    assert found.rows.cost < 1e-6


@pytest.mark.slow
def test_each_point_may_have_a_level_of_its_own():
    """As where a shaker's force falls in the resonance."""
    omega = np.linspace(0.9, 1.6, 15)
    level = 1.0 - 0.8 / (1.0 + ((omega - 1.3) / 0.1) ** 2)
    data = Measured("made", "u", omega, np.abs(linear(omega, level)), np.ones(omega.size), level)
    parameters = parameters_of(stuck(0.5, 0.03), ["contact.c.k_u", "modal.damping.0"], [None, None])
    assert solved(parameters, [data], (1,), begin=[parameters.start]).values == pytest.approx(
        [K_U, DAMPING], rel=1e-6
    )
