"""Stability of twelve contacts in a plane that slip and open, against a march in time."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.stability.classification import Bifurcation
from fcm.stability.multipliers import Multipliers

from ..harmonic_balance.strips import planar_strip


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
