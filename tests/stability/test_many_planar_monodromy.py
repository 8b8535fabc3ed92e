"""Disturbances of many contacts in a plane over a period: condensed to what slips, and not condensed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.stability.classification import Bifurcation
from fcm.stability.following_modes import PortModes
from fcm.stability.many_planar_monodromy import ManyPlanarMonodromy
from fcm.stability.multipliers import Multipliers
from fcm.stability.options import STABILITY
from fcm.stability.planar_monodromy import PlanarMonodromy
from fcm.stability.planar_sequence import PlanarSequence

from ..harmonic_balance.strips import planar_strip

OMEGA = 1.1
# u_x, u_y, v of harmonics 0 to 2, and mu, k_u, k_v, n_0 of each contact
SLIPS = ((0.0, 2.0, 0.1), (0.0, -1.8j, 0.0), (0.0, 0.1, 0.0)), (0.5, 1.3, 0.8, 1.0)
CATCHES = ((0.0, 1.0, 0.2j), (0.0, 0.5j, 0.1), (0.0, 0.3j, 0.0)), (0.5, 1.3, 0.8, 2.0)
OPENS = ((0.0, 4.0, 0.2), (0.0, 0.1j, 0.3), (0.0, -3.0j, 0.0)), (0.4, 1.1, 0.9, 0.4)
OPENS_TWICE = ((0.0, 1.0, 0.2), (0.0, 0.7j, 0.3), (0.0, 1.0j, 0.3)), (0.5, 1.3, 0.8, 0.2)
SLIDES_FREELY = ((0.0, 1.0, 0.1), (0.0, 0.5j, 0.0), (0.0, 2.0, 0.1)), (0.0, 1.3, 0.8, 0.5)
STICKS = ((0.0, 0.1, 0.0), (0.0, 0.1j, 0.0), (0.0, 0.1, 0.0)), (0.5, 1.3, 0.8, 3.0)
STAYS_OPEN = ((0.0, 1.0, 0.0), (0.0, 1.0j, 0.0), (-9.0, 0.1, 0.0)), (0.5, 1.3, 0.8, 3.0)
ALL = SLIPS, STICKS, CATCHES, OPENS, STAYS_OPEN, OPENS_TWICE, SLIDES_FREELY, STICKS


def structure(contacts, modes, seed=3):
    generator = np.random.default_rng(seed)
    shapes = generator.uniform(-0.5, 0.5, (modes, 3 * contacts))
    return shapes, np.linspace(0.8, 4.0, modes), np.linspace(0.02, 0.1, modes)


def motion(some):
    """The unknowns, and the numbers of the contacts."""
    blocks = []
    for waves, _ in some:
        X = np.array(waves, dtype=complex)
        blocks.append(np.concatenate((X[:, 0].real, X[:, 1:].T.ravel().view(float))))
    return np.concatenate(blocks), np.array([numbers for _, numbers in some])


@pytest.mark.parametrize("far", [0, 3])
@pytest.mark.parametrize("some", [ALL, (STICKS, SLIPS), (OPENS, STAYS_OPEN), (STICKS, STICKS)])
def test_condensed_as_by_all_displacements(some, far):
    """All states at once, with modes that follow without delay and without."""
    x, contact = motion(some)
    shapes, natural, damping = structure(len(some), 6)
    above = np.arange(6) >= 6 - far
    found = []
    for make, tolerance in (
        (PlanarMonodromy, 1e-10),
        (ManyPlanarMonodromy, 1e-10),
        (ManyPlanarMonodromy, 1e-4),
        (ManyPlanarMonodromy, STABILITY.planar.tolerance_of_many),
    ):
        sequence = PlanarSequence(
            contact, (1, 2), replace(STABILITY.planar, tolerance=tolerance, tolerance_of_many=tolerance)
        )
        assert sequence.find_events(x)
        monodromy = make(PortModes(shapes, natural, damping, above), sequence)
        monodromy.follow(OMEGA)
        found.append(np.array(monodromy.matrix()))
    assert found[0].shape[0] >= 2 * (6 - far)
    assert found[1] == pytest.approx(found[0], abs=1e-9)
    assert found[2] == pytest.approx(found[0], abs=2e-6)
    assert found[3] == pytest.approx(found[0], abs=0.05 * STABILITY.planar.tolerance_of_many)


def test_more_disturbances_than_are_followed_are_none():
    x, contact = motion((SLIPS,))
    sequence = PlanarSequence(contact, (1, 2), replace(STABILITY.planar, most_of_many=5))
    assert sequence.find_events(x)
    monodromy = ManyPlanarMonodromy(PortModes(*structure(1, 6), np.zeros(6, dtype=bool)), sequence)
    monodromy.follow(OMEGA)
    assert np.isnan(monodromy.matrix()).all()


@pytest.mark.parametrize("make", [PlanarMonodromy, ManyPlanarMonodromy])
def test_contacts_that_mirror_one_another_take_no_more_steps_for_rounding_errors(make):
    """Their events are apart by these; apart, each would end a step."""
    found, steps = [], []
    for away in (0.0, 1e-11):
        x, contact = motion((CATCHES, CATCHES, SLIPS, OPENS, OPENS))
        x[: x.size // 5] *= 1.0 + away
        x[-x.size // 5 :] *= 1.0 + away
        sequence = PlanarSequence(contact, (1, 2), STABILITY.planar)
        assert sequence.find_events(x)
        monodromy = make(PortModes(*structure(5, 6), np.zeros(6, dtype=bool)), sequence)
        monodromy.follow(OMEGA)
        found.append(np.array(monodromy.matrix()))
        steps.append(monodromy.steps)
    assert steps[1] <= steps[0] + 1
    assert found[1] == pytest.approx(found[0], abs=1e-6)


def test_each_event_of_many_contacts_may_interrupt():
    x, contact = motion(ALL)
    sequence = PlanarSequence(contact, (1, 2), STABILITY.planar)
    assert sequence.find_events(x)
    events = sum(count for count in np.asarray(sequence.count).tolist() if count > 1)
    polled = []
    structural = PortModes(*structure(len(ALL), 6), np.zeros(6, dtype=bool)), sequence
    ManyPlanarMonodromy(*structural, lambda: polled.append(1)).follow(OMEGA)
    assert len(polled) > 0.5 * events

    def interrupt():
        polled.pop()
        if len(polled) < 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ManyPlanarMonodromy(*structural, interrupt).follow(OMEGA)


def marched(scene, omega, steps=500, cycles=30):
    """Of the motion from rest (q, q' / omega) after each cycle; the slider is drawn back to its disc."""
    modal, law = scene.modal, scene.contacts[0]
    x, y, v = (
        modal.shapes @ np.array([getattr(one, way) for one in scene.contacts]).T
        for way in ("tangential", "second", "normal")
    )
    dt, natural = 2.0 * np.pi / omega / steps, modal.frequency
    phase = np.linspace(0.0, 2.0 * np.pi, steps, endpoint=False)[:, None]
    push = sum(
        one.amplitude * np.sin(phase + one.phase) * (modal.shapes @ one.direction) for one in scene.forces
    )
    q, p, w, after = np.zeros(len(x)), np.zeros(len(x)), np.zeros((2, x.shape[1])), []
    for _ in range(cycles):
        for force in push:
            n = np.maximum(law.n_0 + law.k_v * (q @ v), 0.0)
            d = np.array((q @ x, q @ y)) - w
            back = np.minimum(law.mu * n / (law.k_u * np.maximum(np.hypot(*d), 1e-12)), 1.0)
            w += (1.0 - back) * d
            f = law.k_u * back * d
            p += dt * (force - 2.0 * modal.damping * natural * p - natural**2 * q)
            p -= dt * (x @ f[0] + y @ f[1] + v @ (n - law.n_0))
            q += dt * p
        after.append(np.concatenate((q, p / omega)))
    return np.array(after)


@pytest.mark.parametrize(("omega", "stable"), [(0.92, False), (0.96, True)])
def test_a_march_comes_to_rest_in_what_is_stable_and_doubles_its_period_in_what_is_not(omega, stable):
    """Of twelve contacts that slip, open and close again, all of them, with three harmonics."""
    scene = planar_strip()
    (z,) = solutions(System(scene, (1, 2, 3)), omega).solutions
    classified = Multipliers(System(scene, (1, 2, 3)), omega).classify(z)
    after = marched(scene, omega)
    once, twice = (np.linalg.norm(after[-1] - after[-1 - k]) / np.linalg.norm(after[-1]) for k in (1, 2))
    assert classified.stable == stable
    assert (once < 1e-4) == stable and twice < 1e-2
    assert stable or classified.kind is Bifurcation.PERIOD_DOUBLING


@pytest.mark.slow
def test_one_harmonic_too_few_does_not_call_stable_what_doubles_its_period():
    """The same structure: the march above doubles its period at 0.92, where one harmonic errs by a tenth."""
    found = fcm.respond(planar_strip(frequency=(0.9, 0.96)), harmonics=1)
    frequency, stable, error = (np.ravel(found[name]) for name in ("frequency", "stable", "truncation_error"))
    near = (frequency > 0.907) & (frequency < 0.935)
    assert near.any() and np.all(error[near] > 0.05)
    assert not np.any(stable[near] == 1.0)
    assert stable[frequency > 0.95].all()
