"""Units of displacements along a curve: of many contacts, and of the directions of sliding in a plane."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.branches.force_level import LevelRange, level_curve
from fcm.harmonic_balance.options import HarmonicBalanceOptions, UnitOptions
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict

OWN = HarmonicBalanceOptions(
    units=UnitOptions(min_contacts=1000)
)  # each displacement, or contact, has its own unit


def plane(contacts):
    """A row of contacts, pressed by loads that differ by a hundred times, on a structure of ten modes."""
    x = (np.arange(contacts) + 0.5) / contacts
    directions = np.cos, (lambda a: 0.3 * np.sin(a)), (lambda a: 0.2 * np.cos(0.7 * a))
    shapes = [np.concatenate([d(np.pi * i * x) for d in directions]).tolist() for i in range(10)]
    law = {"mu": 0.4, "k_u": 15.0 / contacts, "k_v": 30.0 / contacts}
    return scene_from_dict(
        {
            "modal": {
                "dofs": [f"{d}{i}" for d in "xyz" for i in range(contacts)],
                "frequency": [1.0, 1.6, 2.7, *(8.0 * (i + 1) for i in range(7))],
                "damping": [0.02] * 10,
                "shapes": shapes,
            },
            "contact": [
                {
                    "name": f"c{i}",
                    "tangential": [f"x{i}", f"y{i}"],
                    "normal": f"z{i}",
                    "n_0": 10.0 ** (-(i % 7) / 3.0) / contacts,
                    **law,
                }
                for i in range(contacts)
            ],
            "force": [{"dof": "x0", "amplitude": 3.0}, {"dof": "z0", "amplitude": 1.5}],
            "response": {"frequency": [0.9, 1.6]},
        }
    )


def raised(system, omega=1.3):
    return level_curve(system, omega, LevelRange((0.0, 3.0), 1.0, (1.0,), 0.0, True, True))


def test_level_curves_step_over_corners_of_single_contacts():
    """To the same motion at the level 1 with a fraction of the work."""
    scene = plane(14)
    one, own = (raised(System(scene, options=options)) for options in (HarmonicBalanceOptions(), OWN))
    motions = [path.z[path.parameter == 1.0] for path in (one, own)]
    assert motions[0].shape[0] == motions[1].shape[0] == 1
    assert motions[0] == pytest.approx(motions[1], rel=1e-6, abs=1e-6 * np.abs(motions[1][0, :-1]).max())
    assert 2 * one.evaluations < own.evaluations


def test_both_directions_of_sliding_have_one_unit():
    """As they have in any other two directions of the same plane."""
    balance = System(plane(3)).new_balance()
    z = np.random.default_rng(1).normal(size=balance.unknowns + 1)
    balance.evaluate_scale(z)
    units = np.asarray(balance.scale)[:-1].reshape(3, 9)
    along, across, normal = units[:, [0, 3, 4]], units[:, [1, 5, 6]], units[:, [2, 7, 8]]
    moved = z[:-1].reshape(3, 9)
    assert along == pytest.approx(across)
    assert along == pytest.approx(
        3.0 * np.repeat(np.hypot.reduce(moved[:, [0, 1, 3, 4, 5, 6]], 1)[:, None], 3, 1)
    )
    assert normal == pytest.approx(3.0 * np.repeat(np.hypot.reduce(moved[:, [2, 7, 8]], 1)[:, None], 3, 1))
