"""Steady motions at given frequencies: both branches, jumps, and motions of several periods."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm import load_scene
from fcm.response.exact import trace_exact
from fcm.response.options import STEPPED, ExactOptions, ResponseOptions
from fcm.run import Execution
from fcm.time_domain import State, simulate
from fcm.time_domain.cycle_measures import measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.simulation import cycles_from

from ..time_domain.cases import one_mode, two_contacts, yang
from .curves import within

SCENES = Path(__file__).parent / "scenes"


def visited(scene, at):
    """The curve, and its amplitudes of the first degree of freedom by sweep and frequency."""
    (curve,) = trace_exact(scene, at).curves
    keys = zip(curve.orbits.sweep.tolist(), curve.frequency.round(9).tolist(), strict=True)
    return curve, dict(zip(keys, curve.amplitude[:, 0], strict=True))


def test_both_states_of_the_paper():
    """Upper at 1.195 and not at 1.190, lower at 1.235 and not at 1.240: amplitudes of test_published."""
    at = [1.17, 1.19, 1.195, 1.235, 1.24, 1.26]
    curve, u = visited(yang(), at)
    assert curve.complete and curve.stable.all()
    assert curve.frequency == pytest.approx(at + at[::-1])
    assert curve.orbits.sweep.tolist() == ["up"] * 6 + ["down"] * 6
    assert u["up", 1.235] == pytest.approx(2.5641, abs=1e-3)
    assert u["up", 1.24] > 10.0
    assert u["down", 1.195] == pytest.approx(14.7229, abs=1e-3)
    assert u["down", 1.19] == pytest.approx(1.7088, abs=1e-3)
    up, down = curve.jumps()
    assert (up.sweep, down.sweep) == ("up", "down")
    assert 1.235 < up.frequency < 1.24 and 1.19 < down.frequency < 1.195
    assert up.after[0] > 10.0 > up.before[0] and down.before[0] > 10.0 > down.after[0]


@pytest.mark.parametrize("scene", [one_mode(), two_contacts(), yang(10.0)], ids=["one", "two", "yang"])
def test_the_same_as_long_simulations(scene):
    at = [0.9, 1.15, 1.4]
    curve, _ = visited(scene, at)
    for k, omega in enumerate(at):
        last = simulate(scene, omega, 400).measures(last=1)[0]
        for point in (k, -1 - k):
            assert curve.amplitude[point] == pytest.approx(last.amplitude, rel=1e-7)
            assert curve.fundamental[point] == pytest.approx(last.fundamental, rel=1e-7)


@pytest.mark.slow
def test_a_sweep_stays_on_a_motion_of_two_periods_beside_a_stable_one_of_one():
    """As the march does that goes on from frequency to frequency, each for 300 cycles.

    Where the period has just doubled it settles slowly; the other motion is 2 % lower, and more.
    """
    scene, at, state = (
        load_scene(SCENES / "two_beside_one.toml"),
        [287.5, 288.0, 288.5, 289.0, 294.0, 302.0],
        None,
    )
    _, first = visited(scene, at)
    for omega in at:
        system = EquationsOfMotion(scene, omega)
        ends = list(cycles_from(system, 300, State.rest(scene) if state is None else state))
        state = ends[-1][1]
        two = [measure(cycle) for cycle, _ in ends[-2:]]
        span = max(one.greatest[0] for one in two) - min(one.least[0] for one in two)
        assert first["up", omega] == pytest.approx(0.5 * span, rel=1e-3)
    assert first["up", 289.0] > 1.02 * first["down", 289.0]


def test_a_contact_a_hundred_thousand_times_as_stiff_as_the_structure_that_sticks():
    """Its motion is that of the structure with its springs; what closes it has 5 digits less than all."""
    scene, omega = yang(k_u=1e5), 1.3
    (curve,) = trace_exact(scene, [omega]).curves
    shapes, modal = scene.modal.shapes, scene.modal  # on u and v, of modes of unit mass
    own = modal.frequency**2 - omega**2 + 2j * omega * modal.damping * modal.frequency
    dynamic = np.diag(own) + shapes @ np.diag([1e5, 1.0]) @ shapes.T
    amplitude = np.abs(shapes.T @ np.linalg.solve(dynamic, shapes.sum(axis=1)))
    assert curve.complete and set(curve.regime[:, 0]) == {"E"}
    assert curve.amplitude == pytest.approx(np.tile(amplitude, (2, 1)), rel=1e-6)


def test_of_a_contact_too_stiff_to_visit_it_is_said_what_would_do():
    (curve,) = trace_exact(
        yang(k_u=1e12), [1.0, 1.3], options=ResponseOptions(exact=ExactOptions(stiff_seconds=1e-9))
    ).curves
    assert re.fullmatch(
        r"not finished in 1e-09 s of processor time, at the start; the k_u of contact \S+ is \S+ times as "
        r"stiff as the structure there, so that .*\. Try \S+, nearly rigid, "
        r"and half of that to see how much it matters",
        curve.reason,
    )
    (slow,) = trace_exact(yang(), [1.0], options=within(1e-9)).curves
    assert not slow.complete and slow.reason == "not finished in 1e-09 s of processor time, at the start"


def test_a_motion_of_two_periods():
    """n_0 = 0 at 0.74: every second cycle is larger, and the extremes are those of both."""
    curve, u = visited(yang(0.0), [0.71, 0.74, 0.78])
    assert curve.complete
    two = simulate(yang(0.0), 0.74, 300).measures(last=2)
    assert abs(two[0].amplitude[0] - two[1].amplitude[0]) > 0.1
    span = max(m.greatest[0] for m in two) - min(m.least[0] for m in two)
    assert u["up", 0.74] == pytest.approx(0.5 * span, rel=1e-4)
    assert u["down", 0.74] == pytest.approx(0.5 * span, rel=1e-4)


@pytest.mark.slow
def test_where_the_period_doubles_nothing_jumps():
    """Just beyond 0.7282 a simulation repeats after two periods, and hardly differs from the motion below."""
    curve, _ = visited(yang(0.0), [0.71, 0.74, 0.78])
    assert curve.jumps() == []
    (below,) = simulate(yang(0.0), 0.728, 1000).measures(last=1)
    two = [one.amplitude[0] for one in simulate(yang(0.0), 0.728215, 3000).measures(last=2)]
    assert min(two) < 0.99 * max(two)
    assert two == pytest.approx([below.amplitude[0]] * 2, rel=0.02)


def test_jumps_do_not_hang_on_the_frequencies_that_are_visited():
    """Two are far from the ends of both branches; there is one motion beyond each, which is simulated."""
    curve, _ = visited(yang(), [1.0, 1.6])
    for jump, beyond, end in zip(curve.jumps(), (1.23984, 1.19355), (1.239829, 1.193559), strict=True):
        assert jump.frequency == pytest.approx(end, abs=2e-6)
        (there,) = simulate(yang(), beyond, 800).measures(last=1)
        assert jump.after == pytest.approx(there.amplitude, rel=2e-3)


def test_a_corner_is_no_jump():
    """The motion changes quickly below the resonance: it is followed by a simulation in small steps."""
    scene = load_scene(SCENES / "sharp_corner.toml")
    curve, _ = visited(scene, [1.0, 1.5])
    assert curve.complete and curve.jumps() == []
    state, before = simulate(scene, 1.236, 400).end, None
    for omega in np.linspace(1.236, 1.238, 11):
        motion = simulate(scene, float(omega), 150, state)
        now, state = motion.measures(last=1)[0].amplitude, motion.end
        assert before is None or now == pytest.approx(before, rel=0.03)
        before = now


def test_frequencies_without_steady_motion_are_named():
    """At the natural frequency without damping; the others are there."""
    scene = yang(-1e15)
    scene = replace(scene, modal=replace(scene.modal, damping=np.zeros(2)))
    curve, u = visited(scene, [0.9, 1.0])
    assert not curve.complete and curve.reason.startswith("at 1 rad/s the motion does not become steady")
    assert list(u) == [("up", 0.9), ("down", 0.9)]


def test_order_and_repetition_do_not_matter():
    one, _ = visited(one_mode(), [1.2, 0.9, 1.2])
    other, _ = visited(one_mode(), [0.9, 1.2])
    np.testing.assert_array_equal(one.amplitude, other.amplitude)


def test_a_frequency_too_low_to_follow_says_so():
    curve, _ = visited(yang(5.0), [1e-9])
    assert not curve.complete and curve.points == 0
    assert curve.reason.startswith("a cycle at 1e-09 rad/s lasts")


@pytest.mark.slow
def test_a_frequency_at_which_the_motion_is_not_determined_does_not_take_the_others():
    """In a ten-thousandth of a mode's period next to nothing is lost that would say which motion is steady:
    rounding decides whether one is found, which is that of the masses alone."""
    masses, reasons = 0.707**2 + 1.0, set[str]()
    for omega in (5e4, 1e5, 1.5e5, 3e5):
        (curve,) = trace_exact(yang(), [1.26, omega]).curves
        fast = curve.frequency == omega
        rounding = 1e-13  # of displacements of the order of 1 about which it vibrates
        np.testing.assert_allclose(curve.amplitude[fast, 0], masses / omega**2, rtol=0.0, atol=rounding)
        assert 1.26 in curve.frequency and curve.complete == fast.any()
        reasons.add(curve.reason)
    assert any("times the frequency of the highest mode" in reason for reason in reasons)
    resonant = one_mode(damping=0.0, mu=0.0, k_v=0.0)
    (curve,) = trace_exact(resonant, [1.0, 1.3]).curves
    assert not curve.complete and 1.3 in curve.frequency and 1.0 not in curve.frequency


def test_a_long_motion_at_one_frequency_shows_that_it_goes_on():
    """At 1.235 the motion is simulated for many cycles: the text says at which step of them it is."""
    said = []
    trace_exact(yang(), [1.235], execution=Execution(progress=lambda share, text: said.append((share, text))))
    steps = [text for share, text in said if "up, 1.235 rad/s, step" in text]
    assert len(steps) > 10 and len(set(steps)) == len(steps)
    shares = [share for share, _ in said]
    assert shares == sorted(shares)


@pytest.mark.slow
def test_jumps_of_motions_of_several_periods_are_those_of_their_branches():
    """They were in no table; and steps of 2 rad/s left the branch before its end."""
    scene = load_scene(SCENES / "two_beside_one.toml")
    curve, _ = visited(scene, list(range(286, 306, 2)))
    (whole,) = trace_exact(replace(scene, frequency_range=(286.0, 304.0)), periods=2).curves
    found, exact = curve.jumps(), whole.jumps()
    assert [(one.sweep, one.periods) for one in found] == [(one.sweep, one.periods) for one in exact]
    assert [one.periods for one in found] == [(2, 2), (2, 2), (2, 1), (1, 2)]
    for one, other in zip(found, exact, strict=True):
        assert one.frequency == pytest.approx(other.frequency, rel=2.0 * STEPPED.min_step_of_periods)
        assert one.after == pytest.approx(other.after, rel=1e-3)
        assert one.before == pytest.approx(other.before, rel=0.1)  # steep beside a fold


def test_where_the_period_is_halved_nothing_jumps():
    """Beside it the two halves of the period differ as the root of the distance, by more than 1 %."""
    curve, _ = visited(yang(0.0), [0.72, 0.74, 0.76, 0.77])
    assert curve.orbits.repeats.tolist() == [1, 2, 2, 1, 1, 2, 2, 1]
    assert curve.jumps() == []
