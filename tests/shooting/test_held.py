"""Exact curves without the contacts that keep their state: the same motion, and checked to be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.continuation import Events, FollowOptions
from fcm.model.scene import HeldContact, Load
from fcm.reduction import constant_state_contacts
from fcm.response.exact import trace_exact
from fcm.response.exact_curve import ExactCurveTask
from fcm.response.options import leaving_out
from fcm.response.resumable_branches import ResumablePaths, SavedPath, TimeOver
from fcm.run import Report
from fcm.scene import Contact, Force, Modal, Scene, scene_from_dict
from fcm.shooting.harmonic_balance_state import balanced_states
from fcm.shooting.initial_orbits import first_point, near_balance
from fcm.shooting.problem import OrbitProblem
from fcm.time_domain import simulate

from .curves import within

SAME = 1e-8  # of amplitudes, of curves that are known to a few 1e-10
OMEGA = 1.2  # of the one point that is looked at


def contact(along, across, n_0, name):
    return Contact(name, np.array(along), np.array(across), 0.3, 2.0, 3.0, n_0)


@pytest.fixture(scope="module")
def scene():
    """A contact that slips, one that always sticks, pressed by a load, and one that is always open."""
    modal = Modal(
        ("x", "y", "z"), np.array([1.0, 1.2, 0.8]), np.array([1.0, 1.6, 2.9]), np.array([0.02, 0.03, 0.02]),
        np.array([[0.7, 0.3, 0.4], [0.5, -0.8, 0.2], [0.3, 0.4, -0.9]]),
    )  # fmt: skip
    contacts = (
        contact([1.0, 0.0, 0.0], [0.0, 0.5, 0.2], 2.0, "slips"),
        contact([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], 30.0, "sticks"),
        contact([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], -300.0, "open"),
    )
    return Scene(
        "three", modal, contacts, (Force(np.array([1.0, 0.0, 0.0]), 1.0, 0.0),), (0.9, 1.5), 0.1,
        name="three", reported=("x", "y", "z"), loads=(Load(np.array([0.0, 0.4, 0.0]), 1.0),),
    )  # fmt: skip


@pytest.fixture(scope="module")
def lightened(scene):
    """The scene without the two that keep their state, and a point of its exact curve."""
    w = constant_state_contacts.resting(scene)
    light = scene.holding(
        (
            HeldContact(1, scene.contacts[1], False, w[1]),
            HeldContact(2, scene.contacts[2], True),
        )
    )
    problem, orbit = OrbitProblem(light), next(near_balance(light, OMEGA))
    return light, problem.shot(first_point(problem, orbit))


@pytest.fixture(scope="module")
def responses(scene):
    return trace_exact(scene), trace_exact(scene, options=leaving_out(None))


@pytest.mark.slow
def test_contacts_that_keep_their_state_are_left_out_and_told(responses):
    light, whole = responses
    assert len(light.left_out) == 2
    assert light.left_out[0].startswith(
        "the transitions of contact sticks, which sticks all over the range: "
    )
    assert light.left_out[1].startswith("the transitions of contact open, which is open all over the range: ")
    assert whole.left_out == [] and whole.curves[0].orbits.held.size == 0
    kept = light.curves[0].orbits.held
    assert np.isfinite(kept).tolist() == [[False, False], [True, False], [False, True]]
    assert (kept[np.isfinite(kept)] > 0.2).all()


def test_the_curve_is_that_with_all_contacts(responses):
    light, whole = (response.curves[0] for response in responses)
    assert light.complete and whole.complete
    for dof, peak in whole.peaks.items():
        assert light.peaks[dof].amplitude == pytest.approx(peak.amplitude, rel=SAME)
    assert set(light.regime[:, 1]) == {"E"} and set(light.regime[:, 2]) == {"S"}
    assert set(light.regime[:, 0]) == set(whole.regime[:, 0]) != {"E"}
    for end in (0, -1):
        assert light.amplitude[end] == pytest.approx(whole.amplitude[end], rel=SAME)
        assert light.cycle[end] == pytest.approx(whole.cycle[end], rel=1e-6, abs=1e-9)


@pytest.mark.slow
def test_of_a_sweep_it_is_told_in_how_many_curves(scene):
    """The load of the second contact: it sticks in one of the two, and slips in the other."""
    weak = replace(
        scene, contacts=(scene.contacts[0], replace(scene.contacts[1], n_0=0.1), scene.contacts[2])
    )
    response = trace_exact(replace(scene, curves=(scene, weak)))
    assert "which sticks all over the range of 1 of 2 curves: " in response.left_out[0]
    assert "which is open all over the range: " in response.left_out[1]
    assert {len(row) for row in response.curves[1].regime} == {3}


def test_a_point_is_a_motion_of_all_contacts(scene, lightened):
    """Marched for some periods with all contacts, the state comes back."""
    light, first = lightened
    state = constant_state_contacts.whole_state(light, first.state)
    motion = simulate(scene, OMEGA, 3, state)
    assert motion.cycles[0].states == constant_state_contacts.whole_states(light, first.cycle.states)
    assert motion.end.q == pytest.approx(state.q, abs=1e-9)
    assert motion.end.friction == pytest.approx(state.friction, abs=1e-9)


def test_what_a_contact_keeps_is_that_of_its_motion(scene, lightened):
    """Of its slip limit and of its gap, sampled from a motion with all contacts."""
    light, first = lightened
    motion = simulate(scene, OMEGA, 1, constant_state_contacts.whole_state(light, first.state))
    cycle = motion.cycles[0]
    rows = np.zeros((3, cycle.system.size))
    rows[0, cycle.system.f.start + 1] = rows[1, cycle.system.n.start + 1] = 1.0
    rows[2, cycle.system.n.start + 2] = 1.0
    force, load, gap = cycle.values(rows, np.linspace(0.0, cycle.duration, 4001)).T
    limit = 0.3 * (30.0 + load)
    expected = [(limit - np.abs(force)).min() / limit.max(), (300.0 - gap).min() / (300.0 - gap).max()]
    assert first.held_distances == pytest.approx(expected, rel=1e-5)


def with_expected(scene, held):
    """The curve of a scene, some of whose contacts are expected to keep their state."""
    (curve,) = ExactCurveTask(None, expected=lambda *_: held)((scene,), Report(lambda *_: None))
    return curve


@pytest.mark.slow
def test_a_curve_goes_on_where_a_contact_has_lost_its_state(scene):
    """To the curve of all contacts that are computed then; the other is held as before."""
    weak = (scene.contacts[0], replace(scene.contacts[1], n_0=2.0), scene.contacts[2])
    scene = replace(scene, contacts=weak)
    wrong = (
        HeldContact(1, weak[1], False, constant_state_contacts.resting(scene)[1]),
        HeldContact(2, weak[2], True),
    )
    curve = with_expected(scene, wrong)
    assert curve.complete and np.isfinite(curve.orbits.held).tolist()[1:] == [[False, False], [False, True]]
    (whole,) = trace_exact(scene, options=leaving_out(None)).curves
    for dof, peak in whole.peaks.items():
        assert curve.peaks[dof].amplitude == pytest.approx(peak.amplitude, rel=SAME)


@pytest.mark.slow
def test_a_contact_that_does_not_keep_its_state_is_computed_after_all(scene, responses):
    """Foreseen wrongly: the first contact, which slips, and the last, which is open, as sticking."""
    w = constant_state_contacts.resting(scene)
    curve = with_expected(
        scene, tuple(HeldContact(i, one, False, w[i]) for i, one in enumerate(scene.contacts))
    )
    assert np.isfinite(curve.orbits.held).any(axis=1).tolist() == [False, True, False]
    whole = responses[1].curves[0]
    assert curve.peaks["x"].amplitude == pytest.approx(whole.peaks["x"].amplitude, rel=SAME)
    assert set(curve.regime[:, 2]) == {"S"}


def over(*_):
    raise TimeOver


@pytest.mark.parametrize("tolerance", [1e-5, None])
def test_a_limit_of_time_before_the_first_point(scene, tolerance):
    """In the balance that tells which contacts keep their state; and where the first motion is sought."""
    (curve,) = trace_exact(scene, options=within(1e-9, leaving_out(tolerance))).curves
    assert curve.points == 0 and curve.reason == "not finished in 1e-09 s of processor time, at the start"


def test_the_balance_that_guesses_come_from_is_ended_by_a_look(scene):
    assert balanced_states(scene, 1.2)
    with pytest.raises(TimeOver):
        balanced_states(scene, 1.2, over)


def test_contacts_are_foreseen_only_with_room(scene):
    found = constant_state_contacts.expected_constant(scene)
    assert [(one.place, one.open) for one in found] == [(1, False), (2, True)]
    weaker = replace(
        scene, contacts=(scene.contacts[0], replace(scene.contacts[1], n_0=3.0), scene.contacts[2])
    )
    assert [one.place for one in constant_state_contacts.expected_constant(weaker)] == [2]


def test_a_stiff_contact_is_not_replaced_by_a_spring(scene):
    """Its force, computed from displacements, would have fewer digits."""
    stiff = replace(scene.contacts[1], k_u=1e6, mu=1e6)
    other = replace(scene, contacts=(scene.contacts[0], stiff, scene.contacts[2]))
    assert [one.place for one in constant_state_contacts.expected_constant(other)] == [2]


def test_what_is_saved_of_other_unknowns_is_not_gone_on_with(scene):
    """A run that is resumed may hold other contacts at first than the one that was interrupted."""
    light = scene.holding((HeldContact(2, scene.contacts[2], True),))
    saved: list[object] = []
    first = OrbitProblem(scene)
    z = first_point(first, next(near_balance(scene, 0.9)))
    ResumablePaths(scene.frequency_range, Report(lambda *_: None, save=saved.append))(
        first, z, scene.frequency_range, Events(), FollowOptions(0.1), forward=True
    )
    assert isinstance(saved[-1], SavedPath)
    problem = OrbitProblem(light)
    z = first_point(problem, next(near_balance(light, 0.9)))
    resumable = ResumablePaths(scene.frequency_range, Report(lambda *_: None, saved))
    path = resumable(problem, z, scene.frequency_range, Events(), FollowOptions(0.1), forward=True)
    assert path.z.shape[1] == z.size


@pytest.mark.slow
def test_residual_friction_is_limited_under_forces_of_several_harmonics():
    """Beside the balance of enough harmonics."""
    scene = scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v", "w"],
                "frequency": [1.0, 2.3, 10.0],
                "damping": [0.01, 0.015, 0.01],
                "shapes": [[0.707, 0.707, 0.3], [1.0, -0.5, 0.2], [0.2, 0.4, -1.1]],
            },
            "contact": [
                {"name": "c", "tangential": "u", "normal": {"v": 1.0, "w": 0.2}}
                | {"mu": 0.4, "k_u": 1.0, "k_v": 0.8, "n_0": 2.0},
                {
                    "name": "d",
                    "tangential": "w",
                    "normal": "v",
                    "mu": 0.3,
                    "k_u": 0.6,
                    "k_v": 0.5,
                    "n_0": 1.0,
                },
            ],
            "force": [
                {"dof": "u", "amplitude": 1.0},
                {"dof": "v", "amplitude": 0.3, "harmonic": 2, "phase": 0.7},
            ],
            "response": {"frequency": [1.2, 1.24]},
        }
    )
    exact, balanced = fcm.respond(scene, "exact"), fcm.respond(scene, harmonics=9)
    assert exact.complete.item() == 1
    assert exact.peak_amplitude.values == pytest.approx(balanced.peak_amplitude.values, rel=2e-3)
