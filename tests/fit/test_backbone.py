"""Residuals of measured backbones, and their rates."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.fit.backbone import measured_span
from fcm.fit.parameters import parameters_of
from fcm.fit.solve import FitProblem, solved
from fcm.harmonic_balance.system import System
from fcm.model.scene import Measured
from fcm.nonlinear_modes.backbone import nonlinear_mode
from fcm.scene.load import scene_from_dict

HARMONICS = (1, 2, 3)
KEYS = ["contact.c.mu", "contact.c.k_u", "modal.damping.0"]
TRUTH = np.array([0.4, 1.0, 0.01])


def scene(mu=TRUTH[0], k_u=TRUTH[1], damping=TRUTH[2]):
    return scene_from_dict(
        {
            "modal": {"dofs": ["u", "v"], "frequency": [1.0, 10.0], "damping": [damping, 0.01],
                      "shapes": [[1.0, 0.0], [0.2, 1.0]]},
            "contact": [{"name": "c", "tangential": "u", "normal": "v", "mu": mu, "k_u": k_u, "k_v": 1.0,
                         "n_0": 5.0}],
            "force": [{"dof": "u", "amplitude": 1.0}],
            "response": {"frequency": [0.8, 1.8], "harmonics": 3},
        }
    )  # fmt: skip


def backbone(dof):
    """Of the model itself; amplitudes modal, or those of a displacement. No point at a corner of it."""
    system = System(scene(), HARMONICS)
    mode = nonlinear_mode(system, 1, (1.0, 30.0), 0.05)
    size = mode.amplitude
    if dof:
        d = system.scene.modal.dofs.index(dof)
        size = np.abs(mode.displacements()[0][:, system.harmonics.index(1), d])
    chosen = np.arange(3, mode.omega.size, 9)
    ones = np.ones(chosen.size)
    return Measured("made", dof, mode.omega[chosen], size[chosen], ones, ones, damping=mode.damping[chosen])


@pytest.mark.slow
@pytest.mark.parametrize("dof", ["", "u"])
def test_rates_are_those_of_frequency_and_damping(dof):
    parameters = parameters_of(scene(), KEYS, [None] * 3)
    problem = FitProblem(parameters, [backbone(dof)], HARMONICS, False)
    x = parameters.unknowns(TRUTH * [0.97, 1.02, 1.1])
    rates, step = problem.jacobian(x), 1e-5
    found = [(problem.residual(x + h) - problem.residual(x - h)) / (2.0 * step) for h in step * np.eye(3)]
    assert np.abs(np.column_stack(found) - rates).max() < 1e-3 * np.abs(rates).max()


@pytest.mark.slow
def test_a_backbone_gives_back_the_numbers_of_its_contact():
    parameters = parameters_of(scene(0.3, 0.8, 0.02), KEYS, [None] * 3)
    found = solved(parameters, [backbone("")], HARMONICS, begin=[parameters.start])
    assert found.values == pytest.approx(TRUTH, rel=1e-5)


def test_points_that_the_mode_does_not_come_to_are_counted():
    data = backbone("")
    lost = replace(data, mode=2, amplitude=data.amplitude)
    parameters = parameters_of(scene(), KEYS, [None] * 3)
    parts = FitProblem(parameters, [lost], HARMONICS, False).parts(parameters.unknowns(TRUTH))
    assert parts is not None and np.isfinite(parts[0].residual).all()


def test_the_fitted_mode_is_shown_over_what_was_measured_and_a_tenth_beyond():
    """It went three times beyond, as the fit does, into where there may be no steady state."""
    data = backbone("u")
    low, high = measured_span(System(scene(), HARMONICS), data)
    mode = nonlinear_mode(System(scene(), HARMONICS), 1, (low, high), 0.05)
    first = System(scene(), HARMONICS).harmonics.index(1)
    size = np.abs(mode.displacements()[0][:, first, 0])
    assert 0.8 * data.amplitude.min() < size.min() < data.amplitude.min()
    assert data.amplitude.max() < size.max() < 1.25 * data.amplitude.max()
