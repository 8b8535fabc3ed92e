"""Forces at harmonics of the frequency: linear and similar responses, a march, what follows a curve."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.response import ResponseError, trace
from fcm.response.exact import trace_exact
from fcm.response.mode import ModeRequest, trace_modes
from fcm.scene import scene_from_dict
from fcm.scene.errors import SceneError

SHAPES = np.array([[0.9, 0.2], [0.3, -0.8]])  # (mode, dof)
NATURAL, DAMPING = np.array([1.0, 2.3]), np.array([0.05, 0.04])
MU, K_U, K_V = 0.4, 0.7, 0.9


def scene(forces, n_0=1.0, span=(0.4, 1.2), **others):
    """Two modes with a contact at the degrees of freedom u and v."""
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"],
                "frequency": NATURAL.tolist(),
                "damping": DAMPING.tolist(),
                "shapes": SHAPES.tolist(),
            },
            "contact": [
                {"name": "c", "tangential": "u", "normal": "v", "mu": MU, "k_u": K_U, "k_v": K_V, "n_0": n_0}
            ],
            "force": forces,
            "response": {"frequency": list(span)},
            **others,
        }
    )


def force(amplitude, harmonic=1, phase=0.0, dof="u"):
    return {"dof": dof, "amplitude": amplitude, "harmonic": harmonic, "phase": phase}


BOTH = [force(1.0), force(1.2, 2, 0.3, "v")]


def linear(omega):
    """Response (dof,) of the structure with its contact stuck to a unit force on u."""
    stiffness = np.diag(NATURAL**2) + SHAPES @ np.diag([K_U, K_V]) @ SHAPES.T
    dynamic = stiffness - omega**2 * np.eye(2) + 2j * omega * np.diag(DAMPING * NATURAL)
    return SHAPES.T @ np.linalg.solve(dynamic, SHAPES[:, 0])


def test_a_force_at_the_second_harmonic_is_answered_as_at_twice_the_frequency():
    (curve,) = trace(scene([force(1.0, 2, 0.3)], n_0=1e4), harmonics=1).curves
    assert curve.harmonics == (1, 2) and curve.complete and curve.points > 50
    expected = np.array([linear(2.0 * omega) for omega in curve.frequency])
    assert np.abs(curve.amplitude - np.abs(expected)).max() < 1e-10
    assert np.abs(curve.harmonic[:, 1] - expected * np.exp(0.3j)).max() < 1e-10
    assert np.abs(curve.fundamental).max() < 1e-10


def test_a_force_in_proportion_to_the_square_of_the_frequency_has_it_of_harmonic_one():
    grows = force(1.0, 3) | {"proportional_to": "omega^2"}
    (curve,) = trace(scene([grows], n_0=1e4), harmonics=1).curves
    expected = [omega**2 * np.abs(linear(3.0 * omega)) for omega in curve.frequency]
    assert curve.harmonics == (1, 3)
    np.testing.assert_allclose(curve.amplitude, expected, rtol=1e-10)


@pytest.mark.parametrize("harmonic", [2, 3])
def test_a_contact_slips_as_under_the_first_harmonic_of_a_multiple_of_the_frequency(harmonic):
    """The frequency is still that of harmonic 1, and the motion repeats within its period."""
    (first,) = trace(scene([force(1.0)]), harmonics=[1, 2, 3]).curves
    span = 0.4 / harmonic, 1.2 / harmonic
    many = [1, *(harmonic * h for h in (1, 2, 3))]
    (curve,) = trace(scene([force(1.0, harmonic)], span=span), harmonics=many).curves
    assert "N" in "".join(curve.regime.ravel()) and curve.complete
    for dof, peak in first.peaks.items():
        assert curve.peaks[dof].amplitude == pytest.approx(peak.amplitude, rel=1e-5)
        assert curve.peaks[dof].frequency == pytest.approx(peak.frequency / harmonic, rel=1e-3)
        assert curve.peaks[dof].stable == peak.stable


def marched(forces, n_0, omega, cycles=30, steps=1000):
    """Half the peak-to-peak (omega, dof) after some cycles from rest, by central differences in time."""
    omega = np.asarray(omega)
    q, p, w = np.zeros((2, omega.size)), np.zeros((2, omega.size)), np.zeros(omega.size)
    dt = 2.0 * np.pi / omega / steps
    rate = (DAMPING * NATURAL)[:, None]
    least, greatest = np.full((2, omega.size), np.inf), np.full((2, omega.size), -np.inf)
    for k in range(cycles * steps):
        u, v = SHAPES.T @ q
        n = np.maximum(n_0 + K_V * v, 0.0)
        friction = np.clip(K_U * (u - w), -MU * n, MU * n)
        w = np.where(n > 0.0, u - friction / K_U, u)
        onto = np.array([-friction, -(n - max(n_0, 0.0))])
        for one in forces:
            turned = np.sin(2.0 * np.pi * one["harmonic"] * k / steps + one["phase"])
            onto["uv".index(one["dof"])] += one["amplitude"] * turned
        rest = SHAPES @ onto - NATURAL[:, None] ** 2 * q
        p = ((1.0 - rate * dt) * p + dt * rest) / (1.0 + rate * dt)
        q = q + dt * p
        if k >= (cycles - 1) * steps:
            x = SHAPES.T @ q
            least, greatest = np.minimum(least, x), np.maximum(greatest, x)
    return 0.5 * (greatest - least).T


@pytest.mark.slow
@pytest.mark.parametrize("n_0", [0.5, -0.3])
def test_a_superharmonic_response_is_that_of_a_march(n_0):
    """The contact slips and opens; the second harmonic of the force is near the second mode."""
    at = (0.6, 0.95, 1.25)
    (curve,) = trace(scene(BOTH, n_0, (0.5, 1.4)), harmonics=11).curves
    assert curve.complete and "S" in "".join(curve.regime.ravel())
    order = np.argsort(curve.frequency)
    assert (np.diff(curve.frequency) > 0.0).all()  # one motion at each frequency
    expected = marched(BOTH, n_0, at)
    for dof in range(2):
        found = np.interp(at, curve.frequency[order], curve.amplitude[order, dof])
        np.testing.assert_allclose(found, expected[:, dof], rtol=5e-3)
    (alone,) = trace(scene(BOTH[:1], n_0, (0.5, 1.4)), harmonics=11).curves
    without = np.interp(at, np.sort(alone.frequency), alone.amplitude[np.argsort(alone.frequency), 1])
    assert np.abs(without / expected[:, 1] - 1.0).max() > 0.3


def test_the_harmonics_of_the_forces_are_balanced_whatever_is_asked_for():
    (few,) = trace(scene(BOTH), harmonics=1).curves
    (needed,) = trace(scene(BOTH), accuracy=1e-4).curves
    assert few.harmonics == (1, 2) and {1, 2} < set(needed.harmonics)
    top, sure = few.peaks["u"], needed.peaks["u"]
    assert abs(top.amplitude / sure.amplitude - 1.0) < 3.0 * (top.error + sure.error)


def test_the_level_multiplies_the_forces_of_all_harmonics():
    from fcm.response.level import LevelRequest, trace_levels

    (curve,) = trace_levels(scene(BOTH), LevelRequest([0.9], (0.01, 1.0)), harmonics=5).curves
    (whole,) = trace(scene(BOTH, span=(0.8, 1.0)), harmonics=5).curves
    half = [one | {"amplitude": 0.5 * one["amplitude"]} for one in BOTH]
    (less,) = trace(scene(half, span=(0.8, 1.0)), harmonics=5).curves
    for other, level in ((whole, 1.0), (less, 0.5)):
        for dof in range(2):
            found = np.interp(level, curve.level, curve.amplitude[:, dof])
            expected = np.interp(0.9, other.frequency, other.amplitude[:, dof])
            assert found == pytest.approx(expected, rel=5e-3)


@pytest.mark.slow
def test_derivatives_of_the_peak_by_the_forces_are_those_of_differences():
    from fcm.response.sensitivity import add_sensitivities

    response = trace(scene(BOTH), harmonics=3)
    add_sensitivities(response, scene(BOTH))
    found = response.curves[0].sensitivity
    for key, step in (("force.v.amplitude", 1e-4), ("force.u.amplitude", 1e-4), ("force.v.phase", 1e-3)):
        ends = []
        for sign in (1.0, -1.0):
            moved = [dict(one) for one in BOTH]
            moved["uv".index(key[6])][key[8:]] += sign * step
            (curve,) = trace(scene(moved), harmonics=3).curves
            ends.append(curve.peaks["u"].amplitude)
        expected = (ends[0] - ends[1]) / (2.0 * step)
        assert found.height[0, found.numbers.index(key)] == pytest.approx(expected, rel=2e-3, abs=1e-3)


@pytest.mark.slow
def test_a_tracked_peak_is_that_of_curves():
    from fcm.response.track import TrackRequest, track

    response = track(scene(BOTH), TrackRequest("peaks", "force.v.amplitude", (0.9, 1.3)), harmonics=3)
    tracked = response.tracking
    (curve,) = trace(scene([BOTH[0], BOTH[1] | {"amplitude": 1.1}]), harmonics=3).curves
    assert tracked is not None
    peaks = [found for found in tracked.curves if found.what == "peak of u"]
    heights = [float(np.interp(1.1, one.number, one.amplitude[:, 0])) for one in peaks]
    assert max(heights) == pytest.approx(curve.peaks["u"].amplitude, rel=1e-3)


@pytest.mark.parametrize("wrong", [0, -1, 1.5, "two", True, 1000])
def test_what_is_no_harmonic_is_told(wrong):
    with pytest.raises(SceneError, match=r"force\[0\].harmonic: must be a whole number from 1 to"):
        scene([force(1.0, wrong)])


def test_a_mode_predicts_of_forces_of_harmonic_one_alone():
    with pytest.raises(
        ResponseError, match="what a nonlinear mode predicts knows forces of harmonic 1 alone"
    ):
        trace_modes(scene(BOTH), ModeRequest(1, (0.1, 1.0)))


def test_the_exact_motion_under_a_second_harmonic_is_that_at_twice_the_frequency():
    (curve,) = trace_exact(scene([force(1.0, 2, 0.3)], n_0=1e4)).curves
    assert curve.complete and curve.points > 50 and (curve.stable == 1.0).all()
    expected = np.abs([linear(2.0 * omega) for omega in curve.frequency])
    assert np.abs(curve.amplitude / expected - 1.0).max() < 1e-10


def test_the_exact_motion_under_a_third_harmonic_slips_as_at_three_times_the_frequency():
    (first,) = trace_exact(scene([force(1.0)])).curves
    (curve,) = trace_exact(scene([force(1.0, 3)], span=(0.4 / 3.0, 0.4))).curves
    assert curve.complete and "P" in "".join(curve.regime.ravel())
    for dof, peak in first.peaks.items():
        assert curve.peaks[dof].amplitude == pytest.approx(peak.amplitude, rel=1e-8)
        assert curve.peaks[dof].frequency == pytest.approx(peak.frequency / 3.0, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("n_0", [0.5, -0.3])
def test_the_exact_superharmonic_motion_is_that_of_a_march(n_0):
    at = (0.6, 0.95, 1.25)
    (curve,) = trace_exact(scene(BOTH, n_0, (0.5, 1.4)), at).curves
    assert "S" in "".join(curve.regime.ravel())
    expected = dict(zip(at, marched(BOTH, n_0, at), strict=True))
    for omega, found in zip(curve.frequency, curve.amplitude, strict=True):
        np.testing.assert_allclose(found, expected[float(omega)], rtol=2e-3)


def test_the_exact_motion_meets_the_balance_of_many_harmonics():
    (exact,) = trace_exact(scene(BOTH, 0.5)).curves
    (curve,) = trace(scene(BOTH, 0.5), harmonics=15).curves
    assert exact.complete and curve.complete
    for dof, peak in exact.peaks.items():
        assert curve.peaks[dof].amplitude == pytest.approx(peak.amplitude, rel=1e-3)
        assert curve.peaks[dof].frequency == pytest.approx(peak.frequency, rel=1e-3)


def test_a_schedule_with_a_second_harmonic_comes_to_that_of_twice_the_frequency():
    from fcm.time_domain.simulation import simulate_schedule

    phases = [{"frequency": 0.45, "cycles": 40.5}, {"frequency": 0.5, "cycles": 60}]
    motion = simulate_schedule(scene([force(1.0, 2, 0.3)], n_0=1e4, schedule=phases))
    last = motion.measures(last=1)[0]
    np.testing.assert_allclose(last.amplitude, np.abs(linear(1.0)), rtol=1e-4)


def test_the_command_says_which_harmonics_it_took():
    data = fcm.respond(scene(BOTH), "closed-form", harmonics=1)
    assert data.harmonic.values.tolist() == [1, 2]


@pytest.mark.parametrize(
    "damping", [{"frequency": [0.5, 2.0], "ratio": [0.01, 0.02]}, [[0.01, 0.02], [0.03]]]
)
def test_damping_that_varies_with_the_frequency_is_refused(damping):
    modal = {"dofs": ["u"], "frequency": [1.0, 2.0], "damping": damping, "shapes": [[1.0], [1.0]]}
    with pytest.raises(SceneError, match=r"modal\.damping: varies with the frequency, which is not computed"):
        scene([force(1.0)], modal=modal)


def test_the_linear_response_is_told_at_the_resonances_of_each_driven_harmonic():
    from fcm.reduction.linear import comparison_frequencies

    from ..response.linear_response import linear_response

    of = scene([force(1.0, 2, 0.3)], span=(0.4, 0.6))
    at, free = comparison_frequencies(of, np.zeros(2)), np.zeros(2)
    assert np.abs(at - 0.5).min() < 1e-3
    found = linear_response(of, at, free)
    dynamic = NATURAL**2 - (2.0 * at[:, None]) ** 2 + 4j * at[:, None] * DAMPING * NATURAL
    expected = (SHAPES[:, 0] / dynamic) @ SHAPES
    assert not found[: at.size].any()  # nothing of harmonic 1
    np.testing.assert_allclose(np.abs(found[at.size :]), np.abs(expected), rtol=1e-10)


def test_what_is_driven_is_said_and_an_exact_motion_is_offered():
    from fcm.cli.caveats import maybe_not_unique
    from fcm.results.result import Response
    from fcm.results.summary import summary

    (note,) = scene(BOTH).notes
    assert note.startswith("force: at harmonics 1, 2 of the frequency") and not scene(BOTH[:1]).notes
    for forces in (BOTH, BOTH[:1]):
        said = summary(Response.of(scene(forces), [], "closed-form"))
        assert "--method exact" in maybe_not_unique(said | {"curves": [{"may_not_be_unique": 3}]})


@pytest.mark.slow
def test_the_least_peak_under_both_forces_is_that_of_a_scan():
    """Curves at preloads beside it are no lower, and that at the optimum has the peak that is told."""
    from fcm.response.optimum import optimise

    aim, span = {"vary": ["contact.c.n_0"], "bounds": [[1.0, 9.0]], "minimise": "peak.u"}, (0.7, 1.4)
    response = optimise(scene(BOTH, span=span, optimum=aim), harmonics=3)
    (found,) = response.tracking.optima
    (best,) = found.values.values()
    (there,) = trace(scene(BOTH, best, span), harmonics=3).curves
    assert there.harmonics == (1, 2, 3) and 1.1 < best < 8.5
    assert there.peaks["u"].amplitude == pytest.approx(found.value, rel=1e-6)
    for preload in (0.95 * best, 1.05 * best, 1.0, 9.0):
        (other,) = trace(scene(BOTH, preload, span), harmonics=3).curves
        assert other.peaks["u"].amplitude > (1.0 + 1e-5) * found.value
