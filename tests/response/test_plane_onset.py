"""Onsets of slip of a contact in a plane under a varying load, where the forces begin as a root."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.response import trace
from fcm.results.result import Curve
from fcm.scene import scene_from_dict

from .random_planes import random_plane


def curve_of(seed: int, harmonics: int) -> Curve:
    scene = replace(random_plane(seed, contacts=1), harmonics=tuple(range(1, harmonics + 1)))
    return trace(scene, method="closed-form").curves[0]


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "harmonics"), [(16, 1), (19, 1), (3, 3), (8, 3), (19, 3)])
def test_a_curve_goes_on_where_slip_begins(seed: int, harmonics: int) -> None:
    """It may leave in the direction that it came from: a cusp."""
    curve = curve_of(seed, harmonics)
    assert curve.complete, curve.reason
    assert {"E", "EPEP"} <= set(curve.regime[:, 0].tolist())


def test_slip_begins_at_a_cusp() -> None:
    """On both sides of the onset at 1.4578 the curve is at lower frequencies."""
    curve = curve_of(16, 1)
    state = curve.regime[:, 0]
    onsets = np.flatnonzero((state[:-1] == "EPEP") & (state[1:] == "E"))
    (onset,) = onsets[np.abs(curve.frequency[onsets] - 1.4578) < 1e-4]
    before, here, after = curve.frequency[onset - 1 : onset + 2]
    assert before < here
    assert after < here
    assert curve.frequency[onset : onset + 20].min() < here - 1e-4


@pytest.mark.slow
def test_slip_begins_where_the_root_is_steep() -> None:
    """Seen from where it slips the load's root is eighty times as steep as from where it sticks."""
    data = {
        "structure": {
            "dofs": ["x", "y", "z"], "mass": np.eye(3).tolist(), "damping": 0.02,
            "stiffness": [[2.17, 0.1, 0.2], [0.1, 2.02, 0.15], [0.2, 0.15, 1.32]],
        },
        "contact": [
            {
                "name": "c", "tangential": ["x", "y"], "normal": "z",
                "mu": 0.57, "k_u": 4.97, "k_v": 3.89, "n_0": 2.85,
            }
        ],
        "force": [
            {"dof": "x", "amplitude": 1.24, "phase": 5.01},
            {"dof": "y", "amplitude": 0.45, "phase": 2.39},
            {"dof": "z", "amplitude": 0.71, "phase": 4.48},
        ],
        "response": {"frequency": [0.5, 3.5], "harmonics": 1},
    }  # fmt: skip
    curve = trace(scene_from_dict(data), method="closed-form").curves[0]
    assert curve.complete, curve.reason
    state = curve.regime[:, 0]
    assert np.count_nonzero((state[:-1] == "EPEP") & (state[1:] == "E")) == 1


@pytest.mark.slow
def test_more_harmonics_begin_beside_a_corner_that_they_share() -> None:
    """Where the contact rests the harmonics are uncoupled, and the fold in a corner is one of all of them."""
    data = {
        "modal": {
            "dofs": ["x", "y", "z"], "mass": 1.0, "frequency": [1.0, 1.15, 1.6], "damping": 0.02,
            "shapes": [[1.0, 0.1, 0.3], [-0.1, 1.0, 0.2], [0.2, 0.3, 1.0]],
        },
        "contact": [
            {
                "name": "c", "tangential": ["x", "y"], "normal": "z",
                "mu": 0.4, "k_u": 20.0, "k_v": 15.0, "n_0": 3.0,
            }
        ],
        "force": [
            {"dof": "x", "amplitude": 1.0},
            {"dof": "y", "amplitude": 0.7, "phase": float(np.deg2rad(70.0))},
        ],
        "response": {"frequency": [1.65, 1.9]},
    }  # fmt: skip
    curve = trace(scene_from_dict(data), method="closed-form", accuracy=0.05).curves[0]
    assert len(curve.harmonics) > 1
    assert curve.complete, curve.reason


@pytest.mark.slow
def test_more_harmonics_begin_beside_a_fold_that_they_share() -> None:
    """All three degrees of freedom have a peak at the fold."""
    scene = replace(random_plane(321, contacts=1), harmonics=None)
    curve = trace(scene, method="closed-form", accuracy=3e-3).curves[0]
    assert curve.complete, curve.reason


@pytest.mark.slow
def test_the_corner_behind_is_not_gone_back_to() -> None:
    """A second disc ceases to hold the slider just beyond an onset of slip, from where the curve comes."""
    curve = trace(replace(random_plane(220), harmonics=None), method="closed-form", accuracy=1e-2).curves[0]
    assert curve.complete, curve.reason
    assert {"E", "EPEP"} <= set(curve.regime.ravel().tolist())
