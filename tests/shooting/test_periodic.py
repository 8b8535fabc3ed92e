"""Periodic solutions: against long simulations, with their derivatives, along curves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.shooting import harmonic_state, periodic, trace_orbits
from fcm.shooting.residual import Shot
from fcm.time_domain import SimulationError, energy, simulate

from ..time_domain.cases import SCENES, one_mode, two_contacts, yang

CASES = [("n_0 = 5", 1.3), ("n_0 = 0", 1.1), ("one mode", 1.1), ("two contacts", 1.3), ("two contacts", 2.3)]


def unknowns(orbit):
    return np.concatenate((orbit.state.q, orbit.state.velocity, orbit.state.friction))


@pytest.mark.parametrize(("name", "omega"), CASES)
def test_what_a_long_simulation_comes_to(name, omega):
    orbit = periodic(SCENES[name], omega)
    motion = simulate(SCENES[name], omega, 300)
    assert orbit.stable
    assert orbit.states == motion.cycles[-1].states
    measure = motion.measures(last=1)[0]
    assert orbit.measure.amplitude == pytest.approx(measure.amplitude, rel=1e-9)
    assert orbit.measure.mean == pytest.approx(measure.mean, abs=1e-8)


@pytest.mark.parametrize(("name", "omega"), CASES)
def test_newton_s_method_needs_few_steps(name, omega):
    orbit = periodic(SCENES[name], omega, simulate(SCENES[name], omega, 20).end)
    assert orbit.iterations <= 6
    assert orbit.residual < 1e-11


@pytest.mark.parametrize(("name", "omega"), CASES)
def test_the_derivative_is_that_of_differences(name, omega):
    orbit = periodic(SCENES[name], omega)
    shot = Shot(orbit.cycle.system, unknowns(orbit))
    for i in range(shot.x.size):
        move = np.zeros(shot.x.size)
        move[i] = 1e-6 * shot.scale[i]
        ahead, behind = Shot(shot.system, shot.x + move), Shot(shot.system, shot.x - move)
        quotient = (ahead.closure + ahead.x - behind.closure - behind.x) / (2e-6 * shot.scale[i])
        column = shot.derivative[:, i]
        assert column * shot.scale[i] / shot.scale == pytest.approx(
            quotient * shot.scale[i] / shot.scale, abs=1e-7
        )


def test_multipliers_are_the_decay_of_a_disturbance():
    orbit = periodic(yang(10.0), 1.3449)
    end = simulate(orbit.scene, 1.3449, 12, replace(orbit.state, q=orbit.state.q * (1.0 + 1e-5))).end
    left = np.abs(end.q - orbit.state.q).max() / np.abs(1e-5 * orbit.state.q).max()
    assert left < 3.0 * np.abs(orbit.multipliers[0]) ** 12


def test_multipliers_without_contact_are_known():
    orbit = periodic(yang(-60.0), 1.3)
    decay = np.exp(-0.01 * 2.0 * np.pi / 1.3)
    assert np.abs(orbit.multipliers[:2]) == pytest.approx(decay, rel=1e-10)


def test_orbits_from_points_of_the_response_curve():
    """Stable and unstable ones, near the balanced points; the power of the force is dissipated."""
    scene = yang()
    curve = fcm.respond(scene, "closed-form").isel(curve=0)
    seen = set()
    for k in np.flatnonzero((curve.frequency > 1.2) & (curve.frequency < 1.235))[::8]:
        point = curve.isel(point=k)
        omega = float(point.frequency)
        guess = harmonic_state(scene, omega, point.amplitude, point.phase, point["mean"])
        orbit = periodic(scene, omega, guess)
        seen.add(orbit.stable)
        assert orbit.measure.fundamental[0] == pytest.approx(float(point.amplitude[0]), rel=0.2)
        assert energy(orbit.motion).error < 1e-12
    assert seen == {True, False}


def test_a_guess_too_far_away():
    with pytest.raises(SimulationError, match="Simulate some cycles"):
        state = periodic(yang(-60.0), 1.0).state
        scene = one_mode(damping=0.0, n_0=-1e9)
        periodic(scene, 1.0, replace(state, q=np.ones(1), velocity=np.ones(1)))


def test_the_exact_folds_at_n_0_5():
    """Beside 1.1875 and 1.2388 of the single harmonic; a multiplier of a fold is 1."""
    branch = trace_orbits(replace(yang(), frequency_range=(1.1, 1.3)))
    assert branch.complete
    assert [fold.frequency for fold in branch.folds] == pytest.approx([1.2398288, 1.1935588], abs=1e-6)
    for fold in branch.folds:
        assert np.abs(fold.multipliers - 1.0).min() < 1e-4
    largest = max(orbit.measure.amplitude[0] for orbit in branch.orbits)
    assert largest == pytest.approx(14.83, abs=0.03)
    assert branch.orbits[-1].frequency == 1.3
    stable = [orbit.stable for orbit in branch.orbits]
    assert stable[0] and stable[-1] and not all(stable)


def test_a_curve_of_two_contacts():
    scene = replace(two_contacts(), frequency_range=(1.2, 1.6))
    branch = trace_orbits(scene, 0.1)
    assert branch.complete
    middle = min(branch.orbits, key=lambda orbit: abs(orbit.frequency - 1.4))
    again = periodic(scene, middle.frequency)
    assert again.measure.amplitude == pytest.approx(middle.measure.amplitude, rel=1e-8)


@pytest.mark.parametrize(("n_0", "folds"), [(10.0, 0), (2.0, 0), (0.0, 0), (-5.0, 2), (-20.0, 2), (-60.0, 0)])
def test_the_preloads_of_figure_13_over_the_whole_range(n_0, folds):
    """Through the corners where contacts begin to slip or to separate, and never back."""
    branch = trace_orbits(yang(n_0))
    assert branch.complete, branch.reason
    assert len(branch.folds) == folds
    assert branch.orbits[-1].frequency == yang().frequency_range[1]
