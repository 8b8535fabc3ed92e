"""The steady motion that a simulation comes to: periods until it repeats, irregular motions."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response.exact import trace_exact
from fcm.shooting import Shooting, periodic
from fcm.shooting.options import SHOOTING
from fcm.shooting.periodic_orbit import converged
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import resting_at
from fcm.shooting.steady_state import SteadyMotion, grows_or_decays, steady
from fcm.time_domain import State, simulate
from fcm.time_domain.equations_of_motion import EquationsOfMotion

from ..time_domain.cases import one_mode, yang

SCENES = Path(__file__).parent / "scenes"
TWO, IRREGULAR = (fcm.load_scene(SCENES / f"{name}.toml") for name in ("two_periods", "irregular"))


def found_at(scene, omega):
    found = steady(EquationsOfMotion(scene, omega), State.rest(scene))
    assert isinstance(found, SteadyMotion)
    return found


@pytest.mark.parametrize(("scene", "omega"), [(TWO, 2.031), (yang(0.0), 0.74)], ids=["scene", "yang"])
def test_a_motion_of_two_periods(scene, omega):
    """Its cycles are by turns those of a long simulation, and the motion of one period is not stable."""
    found = found_at(scene, omega)
    assert found.periods == 2 and found.error < 1e-10
    two = simulate(scene, omega, 3000).measures(last=2)
    amplitude = np.sort([one.amplitude for one in two], axis=0)
    assert found.least == pytest.approx(amplitude[0], rel=1e-5)
    assert found.greatest == pytest.approx(amplitude[1], rel=1e-5)
    assert (found.greatest > found.least * (1.0 + 1e-3)).any()
    span = np.max([one.greatest for one in two], axis=0) - np.min([one.least for one in two], axis=0)
    assert found.measure.amplitude == pytest.approx(0.5 * span, rel=1e-5)
    x = np.concatenate((found.state.q, found.state.velocity, found.state.friction))
    system = EquationsOfMotion(scene, omega)
    once, _ = converged(Shot(system, x, resting_at(system, x)))
    assert once.multipliers[0].real < -1.0 and once.multipliers[0].imag == 0.0


@pytest.mark.parametrize(("n_0", "damping", "omega"), [(1e9, 0.01, 209.0), (-1e15, 1e-5, 1.0)])
def test_what_decays_over_thousands_of_periods_is_not_irregular(n_0, damping, omega):
    """With a contact that sticks, or is open, all through the structure is linear: matrices tell it."""
    scene = yang(n_0)
    scene = replace(scene, modal=replace(scene.modal, damping=np.full(2, damping)))
    found = found_at(scene, omega)
    assert found.periods == 1 and found.states == ("E" if n_0 > 0.0 else "S",)
    shapes, own = np.asarray(scene.modal.shapes), np.asarray(scene.modal.frequency)
    springs = shapes @ shapes.T if n_0 > 0.0 else 0.0  # both of the contact are 1
    loss = np.diag(2.0 * damping * own)
    dynamic = np.diag(own**2) + springs - omega**2 * np.eye(2) + 1j * omega * loss
    force = sum(one.amplitude * np.exp(1j * one.phase) * shapes @ one.direction for one in scene.forces)
    expected = np.abs(shapes.T @ np.linalg.solve(dynamic, force))
    assert found.measure.amplitude == pytest.approx(expected, rel=1e-6)


def test_shares_of_the_time():
    found = found_at(yang(), 1.3)
    assert found.periods == 1 and found.states == ("SPEN",)
    times = np.linspace(0.0, 2.0 * np.pi / 1.3, 20_001)
    motion = simulate(yang(), 1.3, 1, found.state)
    load = 5.0 + motion.displacement(times)[:, 1]
    assert found.shares[0, 2] == pytest.approx((load < 0.0).mean(), abs=1e-3)
    slips = np.abs(np.abs(motion.friction(times)[:, 0]) - 0.4 * load) < 1e-9
    assert found.shares[0, 1] == pytest.approx((slips & (load > 0.0)).mean(), abs=1e-3)
    assert found.shares.sum(axis=1) == pytest.approx(1.0)


def test_an_irregular_motion_has_an_extent():
    """Neighbouring motions part, so that it repeats after no number of periods; a longer one stays inside."""
    found = found_at(IRREGULAR, 1.4)
    assert found.periods == 0 and np.isnan(found.error)
    near = replace(found.state, q=found.state.q * (1.0 + 1e-9))
    one, other = (simulate(IRREGULAR, 1.4, 300, state) for state in (found.state, near))
    apart = [
        np.abs(a.amplitude - b.amplitude).max() for a, b in zip(one.measures(), other.measures(), strict=True)
    ]
    assert max(apart[:5]) < 1e-6 and max(apart[-100:]) > 0.1
    amplitude = np.array([measure.amplitude for measure in other.measures()])
    assert (amplitude.max(axis=0) < 1.2 * found.greatest).all()
    assert (amplitude.min(axis=0) > 0.5 * found.least).all()


@pytest.mark.slow
def test_an_irregular_motion_that_lingers_has_an_extent():
    """Each start leads elsewhere; some of them to where hardly anything changes for hundreds of periods.

    Rounding decides which. A march may linger to its end: then nothing is said to be steady.
    """
    rest, equations = State.rest(IRREGULAR), EquationsOfMotion(IRREGULAR, 1.3)
    found = [steady(equations, replace(rest, q=rest.q + 1e-12 * k)) for k in range(6)]
    extents = [one for one in found if isinstance(one, SteadyMotion)]
    assert len(extents) >= 4 and all(one.periods == 0 for one in extents)


@pytest.mark.slow
def test_the_extent_holds_bursts_that_are_seldom():
    """For two thousand periods there may be none, and the amplitude is half as great until then. So it is a
    matter of the start, and of rounding: of eight starts at least five meet a burst, as seven did here."""
    long = simulate(IRREGULAR, 1.7, 12_000).measures(last=11_000)
    greatest = np.max([one.amplitude for one in long], axis=0)
    rest, hold = State.rest(IRREGULAR), 0
    for k in range(8):
        found = steady(EquationsOfMotion(IRREGULAR, 1.7), replace(rest, q=rest.q + 1e-12 * k))
        assert isinstance(found, SteadyMotion) and found.periods == 0
        assert (found.greatest < 1.1 * greatest).all()
        hold += bool((found.greatest > 0.9 * greatest).all())
    assert hold >= 5


def test_amplitudes_that_grow_or_decay_have_no_extent_and_bursts_have_one():
    """Windows of made-up cycle amplitudes: geometric ones at several rates, and bursts in one of three."""
    rng, cycle = np.random.default_rng(1), np.arange(100)
    for rate in (1.5, 3.0, 30.0):
        rising = [rate ** (k + cycle / 100) * (1.0 + 0.01 * rng.standard_normal(100)) for k in range(3)]
        for windows in (rising, rising[::-1]):
            assert grows_or_decays([one[:, None] for one in windows], SHOOTING)
    quiet = [1.0 + 0.1 * rng.standard_normal((100, 1)) for _ in range(3)]
    assert not grows_or_decays(quiet, SHOOTING)
    for place in range(3):
        bursts = [one.copy() for one in quiet]
        bursts[place][40:60] += 5.0
        assert not grows_or_decays(bursts, SHOOTING)


def test_a_transient_is_no_steady_motion():
    """It grows without limit."""
    scene = yang(-1e15)
    scene = replace(scene, modal=replace(scene.modal, damping=np.zeros(2)))
    assert isinstance(steady(EquationsOfMotion(scene, 1.0), State.rest(scene)), State)


@pytest.mark.slow
def test_curves_say_after_how_many_periods_a_point_repeats():
    (curve,) = trace_exact(TWO, [2.0, 2.031]).curves
    at = dict(zip(curve.frequency.round(6), curve.orbits.repeats, strict=True))
    assert at == {2.0: 1, 2.031: 2}
    assert curve.summary()["repeats"] == [1, 2]
    k = int(np.flatnonzero(curve.orbits.repeats == 2)[0])
    assert (curve.orbits.cycle_least[k] < curve.orbits.cycle_greatest[k]).all()
    (curve,) = trace_exact(IRREGULAR, [1.3]).curves
    assert curve.complete and curve.orbits.repeats.tolist() == [0, 0]
    data = fcm.respond(IRREGULAR, "exact", at=[1.3])
    assert (data.repeats == 0).all() and (data.cycle_least < data.cycle_greatest).all()
    # neighbouring motions part, and a longer look may find higher cycles: neither is claimed
    assert data.stable.isnull().all() and data.peak_stable.isnull().all()
    assert data.error.isnull().all() and data.peak_error.isnull().all()


def test_the_residual_of_several_periods():
    """That of one period closes after two; its derivatives are those of differences."""
    scene, omega = one_mode(), 1.1
    two, orbit = Shooting(scene, periods=2), periodic(scene, omega)
    x = two.unknowns(orbit.state)
    shot = two.residual(x, omega)
    assert shot.residual < 1e-11 and len(shot.segments) > len(orbit.cycle.segments)
    assert np.sort(np.abs(shot.multipliers)) == pytest.approx(
        np.sort(np.abs(orbit.multipliers**2)), abs=1e-12
    )
    quotient = (two.residual(x, omega + 1e-6).closure - two.residual(x, omega - 1e-6).closure) / 2e-6
    assert shot.by_parameter == pytest.approx(quotient, abs=1e-7 * np.abs(quotient).max())
