"""What is computed of a scene is not taken for that of another, of other contacts, frequencies or options."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.branches.force_level import solutions
from fcm.branches.linear_limits import linear_responses
from fcm.harmonic_balance.modal_condensation import CONDENSATION
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict
from fcm.scene.draft import number_of
from fcm.stability.floquet import multipliers
from fcm.stability.multipliers import Multipliers
from fcm.tracking.parameter_line import VariedBalance, line_along


def stiffer(scene, factor):
    contacts = (replace(one, k_u=factor * one.k_u, k_v=2.0 * factor * one.k_v) for one in scene.contacts)
    return replace(scene, contacts=tuple(contacts))


@pytest.mark.parametrize("factor", [0.05, 3.0, 40.0])
@pytest.mark.parametrize("name", ["yang1998-n5", "two-contacts"])
def test_the_linear_responses_are_of_the_present_springs(name, factor):
    """Stuck, open and as at rest; they are solutions where nothing slips."""
    (scene,) = fcm.load_scene(name).each_curve()
    first = System(scene)
    list(linear_responses(first, 1.1, 1.0))
    other = stiffer(scene, factor)
    then, fresh = first.with_scene(other), System(other)
    pairs = zip(linear_responses(then, 1.1, 1.0), linear_responses(fresh, 1.1, 1.0), strict=True)
    assert all(one == pytest.approx(right, rel=1e-12) for one, right in pairs)
    ours, right = (np.array(solutions(one, 1.1).solutions) for one in (then, fresh))
    assert ours == pytest.approx(right, rel=1e-9)


def test_the_equilibrium_is_that_of_the_present_springs():
    """A mode of frequency 2 and mass 1 under a static load of 3, on a contact without preload:
    u = 3 / (4 + k_v)."""
    scene = scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"],
                "frequency": [1.0, 2.0],
                "damping": [0.01, 0.01],
                "shapes": [[1.0, 0.0], [0.0, 1.0]],
            },
            "contact": [
                {"name": "c", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 1.0, "k_v": 2.0, "n_0": 0.0}
            ],
            "force": [{"dof": "u", "amplitude": 0.1}],
            "load": [{"dof": "v", "force": 3.0}],
            "response": {"frequency": [0.5, 1.5]},
        }
    )
    (scene,) = scene.each_curve()
    system = System(scene)
    assert system.rest[1] == pytest.approx(3.0 / 6.0)
    other = system.with_scene(stiffer(scene, 4.0))
    assert other.rest[1] == pytest.approx(3.0 / 20.0)
    assert other.loads_at_rest == pytest.approx([3.0 * 16.0 / 20.0])


def with_seven_modes():
    """A contact on modes enough for their decay between changes of state to be kept from period to period."""
    shapes = np.random.default_rng(2).uniform(-1.0, 1.0, (7, 2)).tolist()
    (scene,) = scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"],
                "frequency": [1.0, 2.1, 3.3, 4.2, 5.7, 6.1, 7.4],
                "damping": [0.01] * 7,
                "shapes": shapes,
            },
            "contact": [
                {"name": "c", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 2.0, "k_v": 1.5, "n_0": 1.0}
            ],
            "force": [{"dof": "u", "amplitude": 2.0}, {"dof": "v", "amplitude": 1.0}],
            "response": {"frequency": [0.5, 2.6]},
        }
    ).each_curve()
    return scene


def test_multipliers_along_a_varied_stiffness_are_those_of_each_scene():
    scene = with_seven_modes()
    varied = VariedBalance(System(scene, (1, 3)), line_along(number_of(scene, "contact.c.k_u")))
    for k_u in (0.5, 2.0, 3.5, 6.5):
        varied.set_parameter(k_u)
        alone = System(replace(scene, contacts=(replace(scene.contacts[0], k_u=k_u),)), (1, 3))
        for z in solutions(alone, 1.3).solutions:
            for _ in range(3):  # what is kept is used from the second time on
                found = multipliers(varied.system, z)
            assert np.abs(found) == pytest.approx(np.abs(multipliers(alone, z)), abs=1e-9)


def test_multipliers_do_not_depend_on_those_asked_for_before():
    """Of the same structure at another frequency other modes follow the contact without delay."""
    (scene,) = scene_from_dict(
        {
            "modal": {
                "dofs": ["x", "y", "v"],
                "frequency": [1.0, 20.0],
                "damping": [0.01, 0.01],
                "shapes": [[1.0, 0.5, 0.2], [0.6, -1.0, 0.8]],
            },
            "contact": [
                {
                    "name": "c",
                    "tangential": ["x", "y"],
                    "normal": "v",
                    "mu": 0.3,
                    "k_u": 20.0,
                    "k_v": 15.0,
                    "n_0": 1.0,
                }
            ],
            "force": [{"dof": "x", "amplitude": 2.0}, {"dof": "v", "amplitude": 1.0}],
            "response": {"frequency": [0.5, 4.6]},
        }
    ).each_curve()
    system = System(scene)
    for omega in (3.0, 0.8, 3.0):
        (z,) = solutions(system, omega).solutions
        alone = Multipliers(system, omega).of(z)
        assert len(multipliers(system, z)) == len(alone)
        assert np.abs(multipliers(system, z)).max() == pytest.approx(np.abs(alone).max(), abs=1e-12)


def test_shared_balances_are_of_the_options_of_their_system():
    (scene,) = fcm.load_scene("two-contacts").each_curve()
    assert not System(scene, (1, 2, 3)).shared_balance.rank
    small = replace(CONDENSATION, min_unknowns=10, max_fraction=2.0)
    condensed = System(scene, (1, 2, 3), condensation=small)
    assert condensed.shared_balance.rank == condensed.new_balance().rank > 0


def test_shared_balances_look_for_peaks_of_the_reported_degrees_of_freedom():
    (scene,) = fcm.load_scene("yang1998-n5").each_curve()
    counts = (
        np.count_nonzero(System(replace(scene, reported=some)).shared_balance.reported)
        for some in ((), ("u",))
    )
    assert tuple(counts) == (2, 1)
