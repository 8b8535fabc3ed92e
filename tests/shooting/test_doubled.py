"""Curves of motions that repeat only after several periods, from where the period doubles."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response.exact import trace_exact
from fcm.response.resumable_branches import ResumablePaths
from fcm.run import Report
from fcm.shooting import OrbitProblem
from fcm.shooting.orbit_record import samples
from fcm.shooting.period_doubling import DoubledPeriodProblem, doubled_paths, to_flips
from fcm.shooting.residual import Shot
from fcm.shooting.trace import explore
from fcm.time_domain import simulate

from ..program import called

SCENES = Path(__file__).parent / "scenes"


@pytest.fixture(scope="module")
def cascade():
    """The branches of one, two and four periods of a scene, and the problems that they solve."""
    scene = replace(fcm.load_scene(SCENES / "irregular.toml"), frequency_range=(1.2, 1.25))
    resumable, problem = ResumablePaths(scene.frequency_range, Report(lambda *_: None)), OrbitProblem(scene)
    paths, *_ = explore(problem, resumable)
    found = [(problem, [samples(problem, path) for path in paths])]
    for _ in range(2):
        once, branches = found[-1]
        problem = DoubledPeriodProblem(once)
        paths, lost = doubled_paths(problem, branches, resumable)
        assert len(paths) == 1 and not lost
        found.append((problem, [to_flips(problem, samples(problem, path), branches) for path in paths]))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("level", [1, 2])
def test_marched_they_repeat_after_so_many_periods_and_not_before(cascade, level):
    problem, (points,) = cascade[level]
    periods = 2**level
    stable = [point for point in points if point.stable and point.repeats == periods]
    assert len(stable) > 5
    for point in stable[2::5]:
        last = simulate(problem.scene, point.frequency, 8 * periods, point.state).measures(last=2 * periods)
        amplitude = np.array([one.amplitude for one in last])
        assert amplitude[:periods] == pytest.approx(amplitude[periods:], rel=1e-6)
        half = periods // 2
        assert np.abs(amplitude[:half] / amplitude[half:periods] - 1.0).max() > 1e-5
        assert point.steady.least == pytest.approx(amplitude.min(axis=0), rel=1e-6)
        assert point.steady.greatest == pytest.approx(amplitude.max(axis=0), rel=1e-6)
    assert all(Shot(problem.shooting.system(point.frequency), _x(point), periods=periods // 2).residual > 1e-6
               for point in stable)  # fmt: skip


def _x(point):
    return np.concatenate((point.state.q, point.state.velocity, point.state.friction))


@pytest.mark.parametrize("level", [1, 2])
def test_they_begin_at_a_flip_of_the_motions_of_half_the_periods(cascade, level):
    """There a multiplier of those is -1, and the curve of more periods has come to them."""
    points = cascade[level][1][0]
    first = points[0]
    assert first.repeats == 2 ** (level - 1) and points[1].repeats == 2**level
    assert first.multipliers[0].real == pytest.approx(-1.0, abs=0.05)  # beside a corner
    reached = points[1].measure.amplitude, first.measure.amplitude
    assert np.abs(reached[0] - reached[1]).max() < 0.01 * reached[1].max()


def test_the_derivative_by_the_frequency_is_that_of_all_periods(cascade):
    problem, (points,) = cascade[1]
    z, step = points[5].z, 1e-6
    problem.evaluate(z)
    rate, ends = np.array(problem.jacobian)[:, -1], []
    for sign in (1.0, -1.0):
        problem.evaluate(z + np.append(np.zeros(z.size - 1), sign * step))
        ends.append(np.array(problem.residual))
    assert rate == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-4, abs=1e-5)


@pytest.mark.slow
def test_the_program_follows_them_where_it_is_asked_to(tmp_path):
    scene = tmp_path / "scene.toml"
    text = (SCENES / "two_periods.toml").read_text()
    scene.write_text(text.replace("frequency=[0.75, 2.4593]", "frequency=[2.0, 2.05]"))
    assert "2.05" in scene.read_text()
    once, twice = (
        called("respond", scene, "--method", "exact", "--periods", periods, "--json") for periods in (1, 2)
    )
    one, two = (json.loads(run.out)["curves"][0] for run in (once, twice))
    assert once.code == twice.code == 0 and one["repeats"] == [1] and two["repeats"] == [1, 2]
    assert len(one["jumps"]) == 2 and not two["jumps"]  # the sweep goes on with two periods
    assert one["period_doubles"] == pytest.approx([jump["frequency"] for jump in one["jumps"]])
    told = [{"kind": "period doubling", "frequency": at} for at in one["period_doubles"]]
    assert one["bifurcations"] == told
    assert "places at which the period doubles: 2" in once.err and "--periods 2 follows" in once.err
    assert "(repeats): " in twice.err and ", after 2" in twice.err and "period doubles" not in twice.err
    (curve,) = trace_exact(fcm.load_scene(scene), periods=2).curves
    (visited,) = trace_exact(fcm.load_scene(scene), [2.0315]).curves
    there = np.flatnonzero(curve.orbits.repeats == 2)
    rows = there[np.argsort(curve.frequency[there])]
    for dof in range(curve.amplitude.shape[1]):
        between = np.interp(2.0315, curve.frequency[rows], curve.amplitude[rows, dof])
        assert visited.amplitude[0, dof] == pytest.approx(between, rel=0.01)


@pytest.mark.parametrize("others", [("--at", "1.3"), ("--only", "peaks")])
def test_it_is_refused_where_it_means_nothing(others):
    run = called("respond", "yang1998-n5", "--method", "exact", "--periods", 2, *others)
    assert run.code == 2 and "--periods needs --method exact, and whole curves" in run.err
    assert called("respond", "yang1998-n5", "--periods", 2).code == 2


def marched(n_0, omega, cycles, steps=600):
    """The paper's oscillator from rest, its law in small steps.

    Of each cycle half the peak-to-peak u, greatest normal and friction force, slip, dissipated energy.
    """
    shapes, natural = np.array([[0.707, 0.707], [1.0, -0.5]]), np.array([1.0, 10.0])
    q, rate, friction, (u, v) = np.zeros(2), np.zeros(2), 0.0, (0.0, 0.0)
    dt, found = 2.0 * np.pi / omega / steps, []
    for cycle in range(cycles):
        us, most, slip, energy = [], [0.0, 0.0], 0.0, 0.0
        for step in range(steps):
            force = np.sin(omega * dt * (cycle * steps + step))
            load = max(n_0 + v, 0.0)
            pushed = shapes @ (force - friction, force - (load - max(n_0, 0.0)))
            rate = rate + dt * (pushed - 0.02 * natural * rate - natural**2 * q)
            q = q + dt * rate
            before, (u, v) = u, shapes.T @ q
            trial, now = friction + u - before, max(n_0 + v, 0.0)
            held, friction = friction, min(max(trial, -0.4 * now), 0.4 * now)
            slip += abs(trial - friction) if now > 0.0 else 0.0  # k_u is 1
            energy += (held + friction) / 2.0 * (u - before)
            most = np.maximum(most, [now, abs(friction)])
            us.append(u)
        found.append([np.ptp(us) / 2.0, *most, slip, energy])
    return np.array(found)


@pytest.mark.slow
def test_they_are_found_where_they_are_far_from_the_motions_that_they_leave():
    """A contact without preload: beside the flip at which they begin they are twice as great already."""
    scene = fcm.load_scene("yang1998-n5")
    contact = replace(scene.contacts[0], n_0=0.0)
    scene = replace(scene, contacts=(contact,), frequency_range=(0.7, 0.8))
    (curve,) = trace_exact(scene, periods=2).curves
    assert curve.complete and not curve.orbits.doubles
    twice = np.flatnonzero(curve.orbits.repeats == 2)
    twice = twice[np.argsort(curve.frequency[twice])]
    assert curve.frequency[twice[0]] < 0.73 and curve.frequency[twice[-1]] > 0.762
    last = marched(0.0, 0.745, 150)[-2:]
    expected = [
        (curve.orbits.cycle_least[:, 0], last[:, 0].min()),
        (curve.orbits.cycle_greatest[:, 0], last[:, 0].max()),
        (curve.cycle[:, 0, 0], last[:, 1].max()),
        (curve.cycle[:, 0, 1], last[:, 2].max()),
        (curve.cycle[:, 0, 2], last[:, 3].mean()),
        (curve.cycle[:, 0, 3], last[:, 4].mean()),
    ]
    for values, value in expected:
        between = np.interp(0.745, curve.frequency[twice], values[twice])
        assert between == pytest.approx(value, rel=0.01)
