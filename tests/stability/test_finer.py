"""What further harmonics a balanced motion has, beside those that are balanced."""

import numpy as np
import pytest

from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict
from fcm.shooting import periodic
from fcm.stability.classification import flip_distance
from fcm.stability.multipliers import Multipliers


def halves(contacts):
    """Two masses that only their contacts hold together, of which the first slips."""
    share = 400.0 / contacts
    pair = {"tangential": {"a": 1.0, "b": -1.0}, "normal": "n", "mu": 0.5, "k_u": share, "k_v": share}
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["a", "b", "n"],
                "frequency": [1.0, 1.1, 1.05],
                "damping": [0.01, 0.01, 0.01],
                "shapes": np.eye(3).tolist(),
            },
            "contact": [
                {"name": f"c{i}", "n_0": 0.3 if i % 2 == 0 else 30.0} | pair for i in range(contacts)
            ],
            "force": [{"dof": "a", "amplitude": 2.0}],
            "response": {"frequency": [0.9, 1.2]},
        }
    )


def only(scene, omega, harmonics):
    (z,) = solutions(System(scene, harmonics), omega).solutions
    return z


@pytest.mark.parametrize("contacts", [2, 12])  # few ports, and many
def test_halves_held_together_by_contacts_have_the_further_harmonics_that_are_balanced(contacts):
    scene, omega = halves(contacts), 1.0
    few = Multipliers(System(scene), omega)
    finer = few.finer
    finer.at(only(scene, omega, (1,)))
    harmonics = tuple(int(h) for h in finer.receptance.harmonics)
    z = only(scene, omega, harmonics)
    width = 2 + 4 * len(harmonics)
    added, balanced = (np.reshape(x, (contacts, width))[:, 6:] for x in (finer.x, z[:-1]))
    assert np.abs(balanced).max() > 0.0
    assert np.abs(added - balanced).max() < 0.5 * np.abs(balanced).max()
    assert few.classify(only(scene, omega, (1,))).stable == 1.0


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3)])
def test_a_pair_near_minus_one_that_decays_where_it_meets_is_stable(harmonics):
    """As the exact motion; contacts change their state too little to part the pair as fast as it decays."""
    scene, omega = halves(2), 0.66
    classified = Multipliers(System(scene, harmonics), omega).classify(only(scene, omega, harmonics))
    assert classified.angle_to_flip < 0.4 and classified.stable == 1.0
    assert periodic(scene, omega).stable


def test_how_far_a_pair_is_from_meeting_and_how_far_it_has_parted():
    turned = 0.9 * np.exp(1j * (np.pi - 0.2))
    apart, size = flip_distance([turned, turned.conjugate(), 0.9 + 0.1j, 0.9 - 0.1j])
    assert (apart, size) == pytest.approx((2.0 - 2.0 * np.cos(0.2), np.log(0.9)))
    apart, size = flip_distance([complex(-0.9 * np.exp(0.1)), complex(-0.9 * np.exp(-0.1)), 0.5 + 0j])
    assert (apart, size) == pytest.approx((2.0 - 2.0 * np.cosh(0.1), np.log(0.9)))
    assert np.isnan(flip_distance([0.9 + 0.1j, 0.9 - 0.1j, -0.1 + 0j])).all()


@pytest.mark.parametrize(
    ("tangential", "small"),
    [({"a": 1.0, "b": -1.0}, slice(10, 12)), ([{"a": 1.0, "b": -1.0}, {"n": 1.0, "a": 0.05}], slice(5, 7))],
)
def test_what_is_added_to_a_motion_that_hardly_is_matters_no_more_than_it_changes_the_force(
    tangential, small
):
    """Of the normal motion of a contact under a deep indentation; and across the motion in its plane."""
    pair = {"tangential": tangential, "normal": {"n": 1.0, "a": 0.05}, "mu": 0.5, "k_u": 200.0, "k_v": 200.0}
    if isinstance(tangential, list):
        pair["normal"] = "m"
    scene = scene_from_dict(
        {
            "modal": {
                "dofs": ["a", "b", "n", "m"],
                "frequency": [1.0, 1.1, 1.05, 1.2],
                "damping": [0.01] * 4,
                "shapes": np.eye(4).tolist(),
            },
            "contact": [pair | {"name": f"c{i}", "n_0": n_0} for i, n_0 in enumerate((0.3, 30.0))],
            "force": [{"dof": "a", "amplitude": 2.0}],
            "response": {"frequency": [0.9, 1.2]},
        }
    )
    finer, z = Multipliers(System(scene), 1.0).finer, only(scene, 1.0, (1,))
    finer.at(z)
    before = finer.shift
    z[small] *= 1e-9
    finer.at(z)
    assert 0.0 < finer.shift < max(2.0 * before, 0.1)
