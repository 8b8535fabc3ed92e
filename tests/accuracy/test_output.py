"""The accuracy is that of the degrees of freedom in `output`: a stiff axis does not ask for harmonics."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.scene.load import scene_from_dict

STIFF = 20.0  # of the second axis, which moves a thousandth of the first


def inclined(**response):
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["x", "z"],
                "frequency": [1.0, STIFF],
                "damping": 0.002,
                "shapes": [[1.0, 0.0], [0.0, 1.0]],
            },
            "contact": [
                {
                    "name": "damper",
                    "tangential": {"x": 0.954, "z": -0.3},
                    "normal": {"x": 0.3, "z": 0.954},
                    "mu": 0.3,
                    "k_u": 1.0,
                    "k_v": 1.0,
                    "n_0": 1.0,
                }
            ],
            "force": [{"dof": "x", "amplitude": 0.2}],
            "response": {"frequency": [0.9, 1.6]} | response,
        }
    )


@pytest.fixture(scope="module")
def every():
    return fcm.respond(inclined())


@pytest.fixture(scope="module")
def asked():
    return fcm.respond(inclined(output=["x"]))


def test_a_motion_that_is_not_asked_for_takes_no_harmonics(every, asked):
    assert every.harmonic.size > 9 and asked.harmonic.values.tolist() == [1]
    one = asked.sel(harmonic=1)
    np.testing.assert_allclose(one.harmonic_amplitude, asked.fundamental, rtol=1e-12)
    np.testing.assert_allclose(np.exp(1j * (one.harmonic_phase - asked.phase)), 1.0, atol=1e-12)
    assert every.peak_error.max() < 1e-2


def test_the_errors_of_all_motions_are_told(every, asked):
    """Those with many harmonics are the reference."""
    true = abs(every.peak_amplitude / asked.peak_amplitude - 1.0).squeeze()
    told = asked.peak_error.squeeze()
    assert told.sel(dof="x") < 1e-2 and true.sel(dof="x") < 1.5 * told.sel(dof="x")
    assert true.sel(dof="z") > 0.1 and 0.5 < float(told.sel(dof="z") / true.sel(dof="z")) < 2.0
