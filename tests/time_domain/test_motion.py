"""Motions: continuation, schedules, histories, measures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.scene import Phase
from fcm.time_domain import SimulationError, simulate, simulate_schedule

from .cases import two_contacts, yang


def test_a_motion_in_parts_is_the_motion_whole():
    scene = two_contacts()
    whole = simulate(scene, 1.3, 7.25)
    first = simulate(scene, 1.3, 2.4)
    rest = simulate(scene, 1.3, 7.25 - 2.4, first.end)
    assert rest.end.q == pytest.approx(whole.end.q, abs=1e-12)
    assert rest.end.friction == pytest.approx(whole.end.friction, abs=1e-12)
    assert rest.end.angle == pytest.approx(whole.end.angle, abs=1e-12)


def test_the_angle_of_the_force_does_not_jump():
    """A schedule's displacement and velocity are continuous, and so is the force: the acceleration."""
    scene = replace(yang(), schedule=(Phase(1.2, 1.3), Phase(1.7, 2.6)))
    fractions: list[float] = []
    motion = simulate_schedule(scene, progress=lambda done, text: fractions.append(done))
    seam = 1.3 * 2.0 * np.pi / 1.2
    before, after = motion.velocity([seam - 1e-6, seam, seam + 1e-6])[[0, 2]] - motion.velocity([seam])
    assert -before == pytest.approx(after, abs=1e-9)
    assert motion.duration == pytest.approx(seam + 2.6 * 2.0 * np.pi / 1.7)
    assert len(motion.cycles) == 5
    assert fractions == sorted(fractions)


def test_history_is_the_motion_at_even_angles():
    motion = simulate(yang(), 1.3, 3.5)
    history = motion.history(32)
    assert history.time.size == 3.5 * 32 + 1
    assert history.time[-1] == motion.duration
    assert history.displacement == pytest.approx(motion.displacement(history.time), abs=1e-13)
    assert set(history.states.ravel()) <= set("EPNS")


def test_velocity_is_the_derivative_and_friction_keeps_its_limit():
    motion = simulate(yang(), 1.3, 5)
    t, h = np.linspace(0.1, motion.duration - 0.1, 200), 1e-4
    slope = (motion.displacement(t + h) - motion.displacement(t - h)) / (2.0 * h)
    assert motion.velocity(t) == pytest.approx(slope, abs=1e-6)
    load = np.maximum(5.0 + motion.displacement(t)[:, 1], 0.0)
    assert (np.abs(motion.friction(t)[:, 0]) <= 0.4 * load + 1e-12).all()


def test_times_outside_of_the_motion():
    with pytest.raises(SimulationError, match="lasts from 0"):
        simulate(yang(), 1.3, 1).displacement([100.0])


def test_measures_against_dense_samples():
    motion = simulate(yang(), 1.3, 60)
    cycle, measure = motion.cycles[-1], motion.measures(last=1)[0]
    t = cycle.start + cycle.duration * np.arange(20_000) / 20_000
    x = motion.displacement(t)
    assert measure.greatest == pytest.approx(x.max(axis=0), abs=1e-6)
    assert measure.least == pytest.approx(x.min(axis=0), abs=1e-6)
    wave = 2j * (x * np.exp(-1j * 1.3 * t)[:, None]).mean(axis=0)
    assert measure.mean == pytest.approx(x[:, :].mean(axis=0), abs=1e-5)
    assert measure.fundamental == pytest.approx(np.abs(wave), abs=1e-5)
    assert measure.fundamental * np.exp(1j * measure.phase) == pytest.approx(wave, abs=1e-4)
