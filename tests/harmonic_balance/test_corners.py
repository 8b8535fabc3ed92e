"""Changes of a contact's regime with several harmonics: corners of the curve, landed on and left.

Curves of a finite-element blade with a shroud contact that could not be followed past one of them, and a
random scene whose curve takes a long way round behind a margin that only dips below zero.
"""

import numpy as np
import pytest

from fcm import load_scene
from fcm.branches.force_level import linear_resonances, solutions
from fcm.continuation import Mark, Status
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict

from ..response.random_scenes import random_scene
from .scenes import Curves, up_to
from .truth import scene

HERTZ = 2.0 * np.pi
WHOLE = (Status.COMPLETE, Status.RETURNED, Status.CLOSED)
LAST = 1e-6  # relative, to which peaks and folds of different steps agree


# a second slip begins at 586.45 Hz; the contact begins to slip at all at 686.15 Hz
@pytest.mark.parametrize(
    ("preload", "span", "corner"), [(100, (570, 600), 586.453), (7.5, (680, 692), 686.154)]
)
def test_a_slip_that_begins_is_a_corner(preload, span, corner):
    low, high = (HERTZ * end for end in span)
    curves = Curves(scene("shroud", preload), up_to(5), frequency_range=(low, high))
    assert curves.branches.status is Status.COMPLETE
    (path,) = (path for path in curves.paths if path.status is Status.COMPLETE)
    assert np.abs(path.parameter[path.where(Mark.CORNER)] / HERTZ - corner).min() < 1e-3


@pytest.mark.parametrize("preload", [300, 20, 7.5])
def test_all_solutions_of_a_blade_are_found(preload):
    """The level of the forces is followed to its end, through every change of the regime."""
    one = scene("shroud", preload)
    system = System(one, up_to(5))
    assert all(solutions(system, omega).complete for omega in one.frequency_range)


# of each seed a step used to pass what another found
@pytest.mark.slow
@pytest.mark.parametrize("seed", [4, 14, 37])
def test_the_same_for_every_step(seed):
    coarse, fine = (Curves(random_scene(seed), up_to(3), max_step=step) for step in (0.2, 0.02))
    for curves in (coarse, fine):
        assert all(path.status in WHOLE for path in curves.paths)
    assert np.sort(coarse.folds) == pytest.approx(np.sort(fine.folds), rel=LAST)
    assert coarse.amplitude.max(axis=0) == pytest.approx(fine.amplitude.max(axis=0), rel=LAST)


def test_a_contact_closes_that_is_a_million_times_as_stiff():
    """From level 3e-5 on at the least of these frequencies: beyond that depths are 1e-8 of the motion."""
    system = System(random_scene(19), up_to(3))
    for omega in (*system.scene.frequency_range, *linear_resonances(system)):
        assert solutions(system, omega).complete


def test_two_limits_that_are_met_at_one_frequency():
    """A contact begins to slip and opens within 1e-11 of its load, where the curve turns back.

    Both limits are equal to rounding at that fold: n_0 - |V| = 0 and |k_u U -+ mu k_v V| = mu n.
    """
    one = load_scene("extreme/friction-100")
    folds = []
    for step in (0.2, 0.1, 0.05, 0.02):
        curves = Curves(one, (1,), max_step=step)
        (path,) = curves.paths
        assert path.status is Status.COMPLETE
        folds.append(np.sort(curves.folds))
        v_0, *parts = path.z[path.parameter == folds[-1][-1]][0, 1:6]
        U, V = complex(*parts[:2]), complex(*parts[2:])
        load = one.contacts[0].n_0 + v_0
        assert load == pytest.approx(abs(V), rel=1e-8)
        assert abs(U - 100.0 * V) + abs(U + 100.0 * V) == pytest.approx(200.0 * load, rel=1e-8)
    for other in folds[1:]:
        assert other == pytest.approx(folds[0], rel=LAST)


@pytest.mark.slow
def test_a_curve_does_not_come_back_on_itself():
    """A stiff contact that closes once more: within 1e-7 of that the curve turns by 40 degrees."""
    (path,) = Curves(random_scene(19), up_to(3), max_step=0.2).paths
    assert path.status is Status.COMPLETE
    folds = path.parameter[path.where(Mark.FOLD)]
    assert folds.size == 18 and np.diff(np.sort(folds)).min() > 1e-9


def test_a_slider_comes_to_rest_between_two_discs():
    """Both the slider and the slip go as the root of the distance from there, at 2.795 rad/s.

    The curve came ever nearer by shorter steps, until they were as short as those of rounding.
    """
    forces = {"x": (0.7448, 1.5294), "y": (1.086, 4.4698), "z": (0.9508, 4.4541)}
    data = {
        "structure": {
            "dofs": ["x", "y", "z"],
            "mass": np.eye(3).tolist(),
            "stiffness": [[1.39, 0.1, 0.2], [0.1, 1.394, 0.15], [0.2, 0.15, 0.9494]],
            "damping": 0.02,
        },
        "contact": [
            {"name": "c", "tangential": ["x", "y"], "normal": "z"}
            | {"mu": 0.4531, "k_u": 1.693, "k_v": 4.339, "n_0": 1.649}
        ],
        "force": [{"dof": dof, "amplitude": a, "phase": phase} for dof, (a, phase) in forces.items()],
        "response": {"frequency": [0.5, 3.5]},
    }
    curves = Curves(scene_from_dict(data), up_to(1))
    (path,) = curves.paths
    assert path.status is Status.COMPLETE and np.unique(path.orientation).size == 1
    corners = path.parameter[path.where(Mark.CORNER)]
    assert np.abs(corners - 2.7946).min() < 1e-4
