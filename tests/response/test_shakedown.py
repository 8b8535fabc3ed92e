"""Contacts that stick only by the friction force that slip has left, and motions that slip beside these."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.time_domain import simulate

from ..branches.hunt import passings as passings_at
from .random_scenes import random_scene


def wedged(seed):
    """A scene whose friction presses contacts together, with damping."""
    scene = random_scene(seed)
    return replace(scene, modal=replace(scene.modal, damping=np.maximum(scene.modal.damping, 3e-3)))


def test_a_motion_that_slips_is_found_beside_one_in_which_friction_holds_all_contacts():
    """Two contacts push each other closed as they slip. From rest the exact motion goes on to slip."""
    scene, omega = wedged(300), 1.334
    curve = traced_curve(scene, Request((1, 2, 3), 1e-2))
    marched = simulate(scene, omega, 400).measures(last=2)
    assert np.allclose(marched[0].amplitude, marched[1].amplitude, rtol=1e-6)
    assert np.isnan(curve.shakedown_at)
    passings, _ = passings_at(curve, omega)
    sizes = np.sort(passings.max(axis=1))
    assert sizes[-1] == pytest.approx(marched[0].amplitude.max(), rel=0.1)
    assert sizes[-1] > 3.0 * sizes[0]


@pytest.mark.slow
def test_the_exact_motion_that_slips_is_found_beside_one_in_which_friction_holds_all_contacts():
    scene, omega = wedged(300), 1.334
    curve = fcm.respond(scene, method="exact").isel(curve=0)
    passing = np.flatnonzero(np.diff(np.sign(curve.frequency.values - omega)) != 0.0)
    sizes = curve.amplitude.max("dof").values[passing]
    marched = simulate(scene, omega, 400).measures(last=1)[0]
    assert np.nanmax(sizes) == pytest.approx(marched.amplitude.max(), rel=0.05)


def test_where_friction_leads_to_no_motion_that_slips_it_is_said_that_contacts_shake_down():
    scene = wedged(355)
    curve = traced_curve(scene, Request((1,), 1e-2))
    low, high = scene.frequency_range
    assert low <= curve.shakedown_at <= high
    marched = simulate(scene, curve.shakedown_at, 300).measures(last=1)[0].amplitude
    here = [np.interp(curve.shakedown_at, curve.frequency, one) for one in curve.amplitude.T]
    assert np.allclose(marched, here, rtol=1e-3)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_contacts_shake_down_from_the_force_on_at_which_they_would_slip(share):
    """That is the least force with which a motion from rest slips at all, where its transient is small."""
    scene = wedged(316)
    curve = traced_curve(scene, Request((1,), 1e-2))
    scarcely = replace(scene, frequency_range=(curve.shakedown_at - 1e-3, curve.shakedown_at))
    onset = _onset(scene, curve.shakedown_at)
    forces = tuple(replace(one, amplitude=share * onset * one.amplitude) for one in scene.forces)
    found = traced_curve(replace(scarcely, forces=forces), Request((1,), 1e-2))
    assert np.isfinite(found.shakedown_at) == (share > 1.0)


def test_where_a_curve_is_unstable_it_is_said_that_its_contact_may_wedge():
    """From rest the exact motion slips once and then sticks, at an amplitude that no branch has."""
    scene, omega = fcm.load_scene(Path(__file__).parent / "scenes/wedge.toml").each_curve()[0], 1.2
    curve = traced_curve(scene, Request((1, 2, 3), 1e-2))
    first, last = (simulate(scene, omega, 300).measures(last=2)[k].amplitude for k in (0, 1))
    assert np.allclose(first, last, rtol=1e-9)
    passings, _ = passings_at(curve, omega)
    assert len(passings) and (passings.min(axis=0) > 3.0 * last).all()
    assert curve.may_wedge and curve.summary()["may_wedge"]
    smooth = tuple(replace(one, mu=0.1) for one in scene.contacts)
    assert not traced_curve(replace(scene, contacts=smooth), Request((1,), 1e-2)).may_wedge


def _onset(scene, omega):
    """The level at which a contact slips or opens: from the motion of the stuck structure alone."""
    modal, stuck = scene.modal, [one for one in scene.contacts if one.n_0 > 0.0]
    stiffness = np.diag(modal.mass * modal.frequency**2).astype(complex)
    stiffness += np.diag(-modal.mass * omega**2 + 2j * omega * modal.mass * modal.damping * modal.frequency)
    for one in stuck:
        for way, k in ((one.tangential, one.k_u), (one.normal, one.k_v)):
            stiffness += k * np.outer(modal.shapes @ way, modal.shapes @ way)
    force = sum(
        one.amplitude * np.exp(1j * one.phase) * (modal.shapes @ one.direction) for one in scene.forces
    )
    x = modal.shapes.T @ np.linalg.solve(stiffness, force)
    angle = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 20001))
    levels = [np.inf]
    for one in scene.contacts:
        u, v = (np.real(way @ x * angle) for way in (one.tangential, one.normal))
        reach = one.k_v * np.abs(v).max()
        levels.append(abs(one.n_0) / reach)
        if one.n_0 > 0.0 and one.mu > 0.0:
            levels.append(one.mu * one.n_0 / (np.abs(one.k_u * u) - one.mu * one.k_v * v).max())
    return min(levels)
