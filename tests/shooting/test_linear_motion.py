"""Motions in which contacts stick all through, far from those that a curve has."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.model.scene import Start
from fcm.response.exact import trace_exact
from fcm.response.options import RESPONSE
from fcm.response.undetermined_traction import undetermined
from fcm.shooting.linear_orbits import linear_motions
from fcm.shooting.options import SHOOTING
from fcm.time_domain import State, simulate

from ..program import called
from ..response.random_scenes import random_scene

WEDGE = Path(__file__).parent / "scenes/wedge.toml"


def _with_residual(scene, one, share):
    """The state of a motion with a share of its residual friction; without a mean but by that."""
    contact, modal = scene.contacts[0], scene.modal
    along, across = contact.tangential @ modal.shapes.T, contact.normal @ modal.shapes.T
    stiffness = np.diag(modal.mass * modal.frequency**2)
    stiffness += contact.k_u * np.outer(along, along) + contact.k_v * np.outer(across, across)
    q = share * np.linalg.solve(stiffness, along * one.residual[0]) + one.wave.imag
    return State(q, one.state.velocity, contact.k_u * (along @ q) - share * one.residual)


def test_a_wedged_contact_stays_stuck_with_the_least_residual_friction_that_is_told():
    """Marched from there it never slips; with a part of that friction it comes loose."""
    scene = fcm.load_scene(WEDGE)
    (one,) = linear_motions(scene, 1.3)
    assert one.states == ("E",)
    for share, kept in ((1.0, True), (2.0, True), (0.9, False)):
        cycles = simulate(scene, 1.3, 20, _with_residual(scene, one, share)).cycles
        assert all(cycle.states == ("E",) for cycle in cycles) is kept
    last = simulate(scene, 1.3, 20, one.state).measures(last=1)[0]
    assert last.amplitude == pytest.approx(np.abs(scene.modal.shapes.T @ one.wave[0]), rel=1e-6)


def test_marched_these_motions_keep_every_contact_as_it_is():
    scenes = [random_scene(np.random.default_rng(seed)) for seed in range(16)]
    places = [(scene, omega) for scene in scenes for omega in np.linspace(*scene.frequency_range, 3).tolist()]
    found = [(*place, one) for place in places for one in linear_motions(*place)]
    assert len(found) > 5 and {"".join(sorted(set(one.states))) for *_, one in found} == {"E", "ES"}
    for scene, omega, one in found:
        motion = simulate(scene, omega, 5, one.state)
        assert all(cycle.states == one.states for cycle in motion.cycles)
        amplitude = np.abs(scene.modal.shapes.T @ one.wave[0])
        assert motion.measures(last=1)[0].amplitude == pytest.approx(amplitude, rel=1e-6)


@pytest.mark.parametrize("options", [(), ("--at", "1.3")])
def test_motions_that_no_point_belongs_to_are_told_with_what_leads_to_them(options, tmp_path):
    run = called("respond", WEDGE, "--method", "exact", "--json", *options)
    (curve,) = json.loads(run.out)["curves"]
    (beside,) = curve["stuck_beside"]
    assert run.code == 0 and beside["regime"] == ["E"]
    assert "beside the curves there are motions in which a contact never slips, 1 of them" in run.err
    assert f"friction = [{beside['start_friction'][0]:.5g}] in [start]" in run.err
    scene = fcm.load_scene(WEDGE)
    start = Start(np.zeros(1), np.zeros(1), np.array(beside["start_friction"]), 0.0)
    at = None if not options else [1.3]
    (chosen,) = trace_exact(replace(scene, start=start), at).curves
    assert chosen.complete and not chosen.orbits.stuck
    there = (chosen.regime[:, 0] == "E") & (chosen.stable == 1.0)
    nearest = np.abs(np.where(there, chosen.frequency, np.inf) - beside["frequency"]).argmin()
    expected = np.abs(scene.modal.shapes.T @ linear_motions(scene, chosen.frequency[nearest])[0].wave[0])
    assert there.any() and chosen.amplitude[nearest] == pytest.approx(expected, rel=1e-6)


def _wedged(scene, residual):
    """At rest with the contacts closed, the first strained by that much of its own friction."""
    modal, (wedge, other) = scene.modal, scene.contacts
    along, across = wedge.tangential @ modal.shapes.T, wedge.normal @ modal.shapes.T
    stiffness = np.diag(modal.mass * modal.frequency**2) + wedge.k_u * np.outer(along, along)
    stiffness += (wedge.k_v + other.k_v) * np.outer(across, across)
    q = np.linalg.solve(stiffness, along * residual)
    return State(q, np.zeros(2), np.array([wedge.k_u * (along @ q) - residual, 0.0]))


@pytest.mark.slow
def test_a_motion_with_one_contact_wedged_and_another_that_slips_is_told_with_its_extent():
    """Marched from much of that friction the first sticks and the other slips; from little it comes loose."""
    scene = fcm.load_scene(WEDGE.parent / "wedge_beside_slip.toml")
    (curve,) = trace_exact(scene, [1.3]).curves
    (beside,) = curve.orbits.stuck
    assert "E" not in curve.regime and beside.states == ("E", "EPEN") and beside.friction[1] == 0.0
    found = []
    for share, sticks in ((0.3, False), (1.2, True), (8.0, True), (400.0, True)):
        motion = simulate(scene, 1.3, 200, _wedged(scene, -share * beside.friction[0]))
        assert (motion.cycles[-1].states[0] == "E") is sticks
        (last,) = motion.measures(last=1)
        inside = (last.amplitude > 0.999 * beside.least) & (last.amplitude < 1.001 * beside.greatest)
        assert inside.all() if sticks else last.amplitude == pytest.approx(curve.amplitude[0], rel=1e-6)
        found.append(last.amplitude)
    assert found[1] == pytest.approx(beside.greatest, rel=0.01)
    assert found[3] == pytest.approx(beside.least, rel=1e-4)
    start = Start(np.zeros(2), np.zeros(2), beside.friction, 0.0)
    chosen = [trace_exact(replace(scene, start=start), at).curves[0] for at in ([1.3], None)]
    wedged, both = list(beside.states), curve.regime[0].tolist()  # in sweeps, and beside them
    assert chosen[0].regime.tolist() == [wedged, wedged, both] and not chosen[0].orbits.stuck
    assert ["E", "EPEN"] in chosen[1].regime.tolist()


def test_an_extent_that_was_not_sought_to_its_end_is_told(scenes=WEDGE.parent):
    """Even where all motions that were found are alike, as one is."""
    none = replace(SHOOTING.partly_sticking, max_tries=0)
    alone = replace(SHOOTING, family=replace(SHOOTING.family, max_motions=0), partly_sticking=none)
    options = replace(RESPONSE, shooting=alone)
    (curve,) = trace_exact(fcm.load_scene(scenes / "not_unique.toml"), [1.5], options=options).curves
    assert curve.orbits.family_complete.tolist() == [0.0, 0.0]
    assert np.isnan(curve.orbits.family_greatest).all()


@pytest.mark.parametrize(("turned", "felt"), [(False, False), (True, True)])
def test_a_contact_that_sticks_is_felt_where_its_friction_changes_the_load_of_another(turned, felt):
    """By what a static force along the one does to the other; the modes are apart."""
    scene = fcm.load_scene("two-contacts")
    first, second = scene.contacts
    dofs = np.eye(len(first.tangential))
    shapes = np.eye(2, len(first.tangential))
    modal = replace(
        scene.modal, mass=np.ones(2), frequency=np.ones(2), damping=np.full(2, 0.01), shapes=shapes
    )
    first = replace(first, tangential=dofs[0], normal=0.0 * dofs[0])
    second = replace(second, tangential=dofs[1], normal=dofs[0] if turned else 0.0 * dofs[0])
    two = replace(scene, modal=modal, contacts=(first, second))
    assert undetermined(two, np.array([["E", "E"]])).tolist() == [felt]
    assert undetermined(two, np.array([["E", "EPEN"]])).tolist() == [True]
