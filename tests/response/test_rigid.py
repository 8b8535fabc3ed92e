"""Rigid-body modes: held by closed contacts, adrift along friction alone, or not at rest at all."""

import re

import numpy as np
import pytest

from fcm.response import trace
from fcm.response.level import LevelRequest, trace_levels
from fcm.scene import scene_from_dict
from fcm.shooting import periodic
from fcm.time_domain import simulate

CONTACT = {"name": "c", "tangential": "x", "normal": "y", "mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 5.0}
BODY = {  # free along x and along y, but for its contact
    "dofs": ["x", "y"],
    "mass": [1.0, 1.0],
    "frequency": [0.0, 0.0],
    "damping": 0.0,
    "shapes": [[1.0, 0.0], [0.0, 1.0]],
}
JENKINS = BODY | {"frequency": [0.0, 3.0], "damping": [0.0, 0.02]}  # held along y, for a constant load


def curve(modal, contact=CONTACT, forces=(("x", 1.0),), **more):
    data = {
        "modal": modal,
        "contact": [CONTACT | contact] if contact else [],
        "force": [{"dof": dof, "amplitude": amplitude} for dof, amplitude in forces],
        "response": {"frequency": [0.3, 1.7], "max_step": 0.2, "harmonics": 1},
    }
    scene = scene_from_dict(data | more)
    return scene, trace(scene, "closed-form").curves[0]


@pytest.mark.parametrize("n_0", [20.0, 2.0])
def test_a_mode_held_by_the_contact_is_the_limit_of_one_with_a_small_frequency(n_0):
    modal = BODY | {"damping": [0.02, 0.02], "shapes": [[0.8, 0.3], [-0.3, 0.9]]}
    forces = (("x", 1.0), ("y", 0.5))
    _, rigid = curve(modal | {"frequency": [0.0, 2.0]}, {"n_0": n_0}, forces)
    _, nearly = curve(modal | {"frequency": [1e-5, 2.0]}, {"n_0": n_0}, forces)
    assert rigid.complete and len(rigid.folds) == len(nearly.folds) > 0
    assert rigid.folds == pytest.approx(nearly.folds, rel=1e-5)
    assert np.nanmax(np.abs(rigid.mean)) > 1.0  # the static balance has something to do
    for dof in "xy":
        assert rigid.peaks[dof][:2] == pytest.approx(nearly.peaks[dof][:2], rel=1e-5)


def test_the_static_balance_is_that_of_the_exact_motion():
    """In the mean the normal force is the preload, and the friction vanishes: the mode takes up no force."""
    modal = BODY | {"frequency": [0.0, 2.0], "damping": [0.02, 0.02], "shapes": [[0.8, 0.3], [-0.3, 0.9]]}
    scene, found = curve(modal, {"n_0": 20.0}, (("x", 1.0), ("y", 0.5)))
    at = int(np.nanargmax(found.fundamental[:, 0]))
    orbit = periodic(scene, found.frequency[at])
    exact = orbit.measure
    error = 3.0 * found.truncation_error[at]
    assert set(found.regime[at]) == {"EPEN"} and 0.0 < error < 0.05
    assert found.stable[at] and orbit.stable  # slip resists a drift
    assert found.fundamental[at] == pytest.approx(exact.fundamental, rel=error)
    assert found.mean[at] == pytest.approx(exact.mean, rel=0.05)


def test_a_mass_on_a_friction_contact():
    """Stuck it is an oscillator of natural frequency 1; its mean place, that nothing decides, is 0."""
    scene, found = curve(JENKINS)
    stuck = found.regime[:, 0] == "E"
    assert (
        found.complete and found.stable.all() and (found.mean == 0.0).all() and 10 < stuck.sum() < stuck.size
    )
    assert found.amplitude[stuck, 0] == pytest.approx(
        1.0 / np.abs(1.0 - found.frequency[stuck] ** 2), rel=1e-9
    )
    at = int(np.nanargmax(found.fundamental[:, 0]))
    exact = periodic(scene, found.frequency[at]).measure
    assert found.fundamental[at, 0] == pytest.approx(
        exact.fundamental[0], rel=3.0 * found.truncation_error[at]
    )


def test_the_basis_of_rigid_modes_does_not_matter():
    """Free along x and y: the contact holds y, and x is adrift, whatever combinations the modes are."""
    c, s = np.cos(0.7), np.sin(0.7)
    turned = BODY | {"shapes": [[c, s], [-s, c]], "mass": [4.0, 0.25]}
    turned["shapes"] = (np.sqrt([[4.0], [0.25]]) * turned["shapes"]).tolist()
    below = {"response": {"frequency": [0.3, 0.8], "max_step": 0.2, "harmonics": 1}}
    for modal in (BODY, turned):
        _, found = curve(modal, {"n_0": 50.0}, (("x", 1.0), ("y", 0.5)), **below)
        assert found.complete and set(found.regime.ravel()) == {"E"}
        one = 1.0 / (1.0 - found.frequency**2)  # both springs of the contact are 1
        assert found.amplitude == pytest.approx(np.column_stack((one, 0.5 * one)), rel=1e-9)


def test_friction_that_pushes_one_way_has_no_steady_state():
    _, found = curve(JENKINS, forces=(("x", 1.0), ("y", 3.0)))
    assert not found.complete
    assert "one way on average, along a rigid-body mode" in found.reason
    _, stuck = curve(
        JENKINS, {"n_0": 500.0}, (("x", 0.01), ("y", 3.0)), response={"frequency": [0.3, 0.9], "harmonics": 1}
    )
    assert stuck.complete and set(stuck.regime.ravel()) == {"E"}


THREE = {  # free along x, held along y and z
    "dofs": ["x", "y", "z"],
    "mass": [1.0, 1.0, 1.0],
    "frequency": [0.0, 3.0, 9.0],
    "damping": [0.0, 0.02, 0.02],
    "shapes": np.eye(3).tolist(),
}


def gripped(n_0, grip):
    """A contact of varying load, which pushes along x on average, and one of constant load that holds."""
    contacts = [CONTACT | {"n_0": n_0}, CONTACT | {"name": "grip", "normal": "z", "n_0": grip}]
    forces = [{"dof": dof, "amplitude": amplitude} for dof, amplitude in (("x", 1.0), ("y", 3.0))]
    response = {"frequency": [0.3, 0.8], "max_step": 0.2, "harmonics": 1}
    data = {"modal": THREE, "contact": contacts, "force": forces, "response": response}
    scene = scene_from_dict(data)
    return scene, trace(scene, "closed-form").curves[0]


def test_contacts_that_stick_hold_a_mode_against_friction_that_pushes_one_way():
    scene, found = gripped(1.0, 100.0)
    assert found.complete, found.reason
    assert "EPEN" in found.regime[:, 0] and set(found.regime[:, 1]) == {"E"}
    assert (found.stable == 1.0).all()
    motion = simulate(scene, 0.75, 300)
    before, last = (motion.measures(last=100)[i].mean[0] for i in (0, -1))
    assert motion.cycles[-1].states == ("EPEN", "E")
    assert last == pytest.approx(before, abs=1e-6) != 0.0  # in time it does not creep


def test_stability_is_unknown_where_contacts_that_stick_may_not_hold_alone():
    """Where all slip nothing holds; before that, it is not known."""
    _, found = gripped(2.0, 1.2)
    slip = (found.regime != "E").all(axis=1)
    assert not found.complete and 0 < slip.sum() < slip.size
    assert (found.stable[slip] == 0.0).all() and not (found.stable[~slip] == 0.0).any()
    unknown = np.isnan(found.stable)
    assert unknown.any() and found.frequency[unknown].min() > found.frequency[found.stable == 1.0].max()


def test_stability_by_levels_is_unknown_where_contacts_may_not_hold():
    scene, _ = gripped(2.0, 1.2)
    found = trace_levels(scene, LevelRequest([0.65], (0.2, 1.5))).curves[0]
    slip = (found.regime != "E").all(axis=1)
    assert np.isnan(found.stable[~slip]).any() and not (found.stable[~slip] == 0.0).any()
    assert slip.any() and (found.stable[slip] == 0.0).all()


def test_what_would_hold_a_body_is_said_by_the_keys_that_the_scene_has():
    """Two masses on a spring, free along x: a scene of matrices has no modal.frequency."""
    K = [[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 9.0]]
    structure = {"dofs": ["x", "far", "y"], "stiffness": K, "mass": [0.5, 0.5, 1.0], "damping": 0.02}
    forces = [{"dof": "x", "amplitude": 1.0}, {"dof": "y", "amplitude": 3.0}]
    data = {"structure": structure, "contact": [CONTACT], "force": forces, "frequency_unit": "Hz"}
    response = {"frequency": [0.05, 0.2], "max_step": 0.2, "harmonics": 1}
    found = trace(scene_from_dict(data | {"response": response}), "closed-form").curves[0]
    assert found.reason.endswith(
        "Hold it by a contact along its normal, or by soft springs in structure.stiffness"
    )
    assert " Hz friction pushes" in found.reason
    _, of_modes = curve(JENKINS, forces=(("x", 1.0), ("y", 3.0)))
    assert of_modes.reason.endswith("or by a small modal.frequency")


@pytest.mark.parametrize("n_0", [0.0, -5.0, -50.0])
def test_a_body_that_no_contact_can_press_is_said_before_any_point(n_0):
    """Its one contact can only push it away: in the mean it bears nothing."""
    gap = {"tangential": "y", "normal": "x", "n_0": n_0}
    scene, found = curve(JENKINS, gap)
    assert not found.complete and found.frequency.size == 0
    assert "Rigid-body modes are at rest only while closed contacts hold them" in found.reason
    (by_level,) = trace_levels(scene, LevelRequest([0.5], (0.0, 1.0))).curves
    assert by_level.reason == found.reason


def test_a_body_between_two_gaps_is_not_refused():
    """Two contacts that face each other bear the same mean force; one may lean on the friction of another."""
    wall = {"normal": "x", "tangential": "y", "n_0": -0.5}
    two = [CONTACT | wall, CONTACT | wall | {"name": "back", "normal": {"x": -1.0}}]
    floor = CONTACT | {"name": "floor", "n_0": -0.5}
    for contacts in (two, [two[0], floor]):
        response = {"frequency": [0.3, 1.0], "max_step": 0.2, "harmonics": 1}
        force = [{"dof": dof, "amplitude": 1.0} for dof in "xy"]
        data = {"modal": JENKINS, "contact": contacts, "force": force, "response": response}
        found = trace(scene_from_dict(data), "closed-form").curves[0]
        assert "for good" not in found.reason


@pytest.mark.slow
def test_a_body_that_stops_at_a_resonance_that_nothing_damps_is_told_what_does():
    """The fifth harmonic meets that of the body on its seat, the root of 10; damped as said it does not."""
    body = {"dofs": ["x"], "mass": [1.0], "frequency": [0.0], "damping": [0.01], "shapes": [[1.0]]}
    seat = {"tangential": "x", "normal": "x", "mu": 0.0, "k_u": 0.0, "k_v": 10.0, "n_0": 0.5}
    response = {"frequency": [0.55, 0.75], "harmonics": 5}
    _, found = curve(body, seat, (("x", 0.3),), response=response)
    said = re.fullmatch(
        r"stopped at (\S+) rad/s: no further point could be found: harmonic (\d+) meets a resonance .*, "
        r"at (\S+) rad/s, that nothing damps\. .*: try a modal.frequency of (\S+) for them, .* of (\S+)",
        found.reason,
    )
    assert said and int(said[2]) == 5
    assert (5.0 * float(said[1]), float(said[3])) == pytest.approx((np.sqrt(10.0),) * 2, rel=1e-5)
    advised = body | {"frequency": [float(said[4])], "damping": [float(said[5])]}
    _, whole = curve(advised, seat, (("x", 0.3),), response=response)
    assert whole.complete


@pytest.mark.slow
def test_a_curve_that_stops_is_told_what_helps_by_its_cause():
    """A floating body beside a mode that nothing damps: it was told to take more preload or a smaller step.

    With the damping that is advised the curve is whole.
    """
    body = BODY | {"frequency": [0.0, 0.5], "shapes": [[0.75, 0.66], [-0.66, 0.75]]}
    contact, forces = {"n_0": 2.0, "mu": 0.3, "k_v": 10.0, "k_u": 5.0}, (("x", 1.0), ("y", 1.0))
    response = {"frequency": [0.3, 1.7], "max_step": 0.2, "harmonics": 2}
    _, found = curve(body, contact, forces, response=response)
    said = re.fullmatch(
        r"stopped at \S+ rad/s: no further point could be found\. Nothing damps the structure, so that the "
        r"curve may turn back on the spot: try a damping ratio of (\S+)",
        found.reason,
    )
    assert said and not found.complete
    _, whole = curve(body | {"damping": float(said[1])}, contact, forces, response=response)
    assert whole.complete


def test_a_free_structure_without_contacts():
    _, found = curve(JENKINS, None)
    assert found.complete
    assert found.amplitude[:, 0] == pytest.approx(1.0 / found.frequency**2, rel=1e-12)


def test_a_range_that_begins_at_a_resonance_that_only_the_contact_damps():
    """An undamped mode at its own frequency has no receptance; the curve begins there all the same."""
    undamped = BODY | {"frequency": [1.0, 3.0]}
    starts = []
    for low in (1.0, 1.0 - 1e-7):
        _, found = curve(undamped, response={"frequency": [low, 1.7], "max_step": 0.2, "harmonics": 1})
        assert found.complete
        starts.append(found.amplitude[0, 0])
    assert starts[0] == pytest.approx(starts[1], rel=1e-5)
