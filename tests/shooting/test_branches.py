"""The orbit as a problem of the continuation, the branches found by it, and what can be asked of them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import fcm
from fcm.continuation import FollowOptions, Mark, Status, follow
from fcm.continuation.corrector import Newton
from fcm.continuation.path import Path as Followed
from fcm.response.exact import trace_exact
from fcm.response.options import ExactOptions, ResponseOptions, leaving_out
from fcm.scene import Force, Modal, scene_from_dict
from fcm.shooting import (
    OrbitProblem,
    harmonic_state,
    periodic,
    trace,
)
from fcm.shooting.damping_homotopy import less_damped, more_damped
from fcm.shooting.harmonic_balance_branches import passes
from fcm.shooting.initial_orbits import (
    find_initial_orbits,
    first_point,
    inner_resonances,
    near_balance,
)
from fcm.shooting.options import SHOOTING
from fcm.shooting.problem import correct_at_frequency
from fcm.shooting.trace import distinct_motions, explore, incomplete, is_known
from fcm.time_domain import State, simulate
from fcm.time_domain.errors import SimulationError

from ..branches.relatives import KINDS
from ..interrupted import interrupted_after
from ..response.random_scenes import random_scene
from ..time_domain.cases import one_mode, two_contacts, yang
from .curves import between, curve_of, within

SCENES = Path(__file__).parent / "scenes"


@pytest.mark.parametrize(("scene", "omega"), [(yang(), 1.3), (two_contacts(), 1.7)], ids=["yang", "two"])
def test_the_derivatives_are_those_of_differences(scene, omega):
    """Of the closure away from a solution, and of the amplitudes along any direction."""
    problem, rng = OrbitProblem(scene), np.random.default_rng(1)
    z = problem.z(periodic(scene, omega).state, omega)
    z[: scene.modal.mass.size] *= 1.01
    way, h = rng.normal(size=z.size) * np.abs(z), 1e-6

    def at(z):
        problem.evaluate(z)
        problem.evaluate_outputs(z, way)
        return np.array(problem.residual), np.array(problem.output)

    at(z)
    jacobian, growth = np.array(problem.jacobian), np.array(problem.growth)
    (residual, output), (before, less) = at(z + h * way), at(z - h * way)
    difference = (residual - before) / (2.0 * h)
    assert jacobian @ way == pytest.approx(difference, rel=1e-5, abs=1e-6 * np.abs(difference).max())
    assert growth == pytest.approx((output - less) / (2.0 * h), rel=1e-5)


def test_a_branch_that_no_end_of_the_range_leads_to_is_found():
    """Simulated from its own points, the motion stays on it: far above the one from rest."""
    scene = fcm.load_scene(Path(__file__).parent / "scenes/isolated.toml")
    curve = curve_of(scene)
    assert curve.complete and curve.branch.max() == 1
    high = np.flatnonzero((curve.branch == 1) & (curve.stable == 1.0) & (curve.amplitude[:, 1] > 12.0))
    k = int(high[len(high) // 2])
    omega = curve.frequency[k]
    guess = harmonic_state(scene, omega, curve.fundamental[k], curve.phase[k], curve.mean[k])
    last = simulate(scene, omega, 400, guess).measures(last=1)[0]
    assert last.amplitude == pytest.approx(curve.amplitude[k], rel=1e-6)
    rest = simulate(scene, omega, 400).measures(last=1)[0]
    assert rest.amplitude[1] < 0.5 * last.amplitude[1]


def test_a_search_for_further_branches_that_is_given_up_for_its_time_is_told():
    scene = fcm.load_scene(Path(__file__).parent / "scenes/isolated.toml")
    paths, missed, _ = explore(OrbitProblem(scene), most=0.0)
    assert paths and all(path.status is not Status.STALLED for path in paths)
    assert missed.startswith("the search for further branches was given up: it takes more than 0 s")


@pytest.mark.slow
def test_no_branches_are_looked_for_without_end_where_those_that_are_followed_break_off():
    """Contacts that rattle have countless unstable motions; here every branch ends where it begins."""

    def broken(problem, z, *_, **__):
        begun.append(z[-1])
        one, nothing = np.array(z)[None], np.zeros(1)
        return Followed(one, 0.0 * one, nothing.astype(int), nothing, Status.STALLED, 0)

    scene, begun = fcm.load_scene(SCENES / "closed_inside.toml"), []
    problem = OrbitProblem(scene)
    paths, missed, _ = explore(problem, broken)
    assert len(paths) == len(begun) == len(find_initial_orbits(problem, lambda: None)[0])
    assert (
        missed == "the search for further branches was given up: 3 of them broke off while they were followed"
    )
    said = incomplete(scene, paths, missed)
    assert said.startswith("stopped at ") and said.endswith(missed)


def test_a_motion_between_points_of_a_path_is_on_it_and_on_no_other():
    problem = OrbitProblem(fcm.load_scene(Path(__file__).parent / "scenes/isolated.toml"))
    paths, missed, _ = explore(problem)
    assert len(paths) == 2 and not missed
    for path, other in (paths, paths[::-1]):
        k, newton = len(path.z) // 2, Newton(problem)
        assert correct_at_frequency(newton, 0.3 * path.z[k] + 0.7 * path.z[k + 1])
        z = np.array(newton.z)
        assert passes(path, z, problem) and not passes(other, z, problem)
        assert not passes(path, np.append(1.01 * z[:-1], z[-1]), problem)


@pytest.mark.slow
def test_a_closed_branch_is_found_that_the_balance_has_at_the_end_of_the_range():
    """From 1.0035 to 1.0845 rad/s. At 1.05324 a march of the contact law, by the method of Runge and Kutta,
    comes to (0.4170, 0.1473) from 6 of 14 random states; the balance has the branch at 0.977, too.
    """
    scene = fcm.load_scene(Path(__file__).parents[1] / "harmonic_balance/scenes/loose_isola.toml")
    curve = curve_of(replace(scene, frequency_range=(0.977, 1.15)))
    assert curve.complete and sorted(round(fold, 3) for fold in curve.folds) == [1.003, 1.084]
    off = curve.frequency - 1.05324
    there = [
        curve.amplitude[i] - off[i] / (off[i + 1] - off[i]) * (curve.amplitude[i + 1] - curve.amplitude[i])
        for i in np.flatnonzero((off[:-1] * off[1:] < 0.0) & (curve.stable[:-1] == 1.0))
    ]
    assert max(one[0] for one in there) == pytest.approx(0.4170, rel=1e-2)


@pytest.mark.slow
def test_closed_branches_that_neither_the_ends_nor_the_resonances_of_the_range_lead_to_are_found():
    """The motions of simulations from states near two of them stay on them."""
    scene = fcm.load_scene(SCENES / "closed_inside.toml")
    curve = curve_of(scene)
    assert curve.complete
    for omega, q, velocity in (
        (1.275, [5.6, -0.4, -0.7], [-37.8, 5.4, -6.7]),
        (1.2726, [4.3, 0.5, 0.8], [-39.1, 5.2, -4.7]),
    ):
        near = State(np.array(q), np.array(velocity), np.zeros(2))
        amplitude = simulate(scene, omega, 200, near).measures(last=1)[0].amplitude
        assert amplitude[0] > 40.0
        off = curve.frequency - omega
        across = np.flatnonzero((off[:-1] * off[1:] <= 0.0) & (curve.amplitude[:-1, 0] > 40.0))
        share = (off[across] / (off[across] - off[across + 1]))[:, None]
        there = (1.0 - share) * curve.amplitude[across] + share * curve.amplitude[across + 1]
        assert np.abs(there / amplitude - 1.0).max(axis=1).min() < 3e-3


@pytest.mark.slow
def test_a_branch_is_found_that_only_the_converged_balance_has():
    """Marched independently: a peaks at 23.4 near 1.5795 rad/s. At the ends of the range, and with one
    harmonic all over it, the contacts stick, and the greatest is 0.058."""
    (curve,) = trace_exact(fcm.load_scene(SCENES / "stuck_at_the_ends.toml")).curves
    assert curve.complete
    assert curve.peaks["a"].amplitude == pytest.approx(23.4, rel=2e-3)
    assert curve.peaks["a"].frequency == pytest.approx(1.5795, rel=1e-4)


@pytest.mark.slow
def test_a_curve_is_not_complete_while_the_balance_has_a_stable_branch_that_it_has_not(monkeypatch):
    """Where shooting leads to none of its motions, nor does the level of the forces."""
    scene = fcm.load_scene(SCENES / "stuck_at_the_ends.toml")
    without = replace(SHOOTING, start=replace(SHOOTING.start, max_guesses=0))
    monkeypatch.setattr(trace, "level_motions", lambda *_: iter(()))
    paths, missed, _ = explore(OrbitProblem(scene, options=without))
    assert paths and "from the stable branch of harmonic balance at 1.5794" in missed


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "dof", "amplitude", "frequency"),
    [("closed_impact", "y", 6.9203, 1.772), ("equal_stops", "x1", 0.31653, 1.7695)],
)
def test_exact_curves_have_the_closed_branches_and_those_without_symmetry(name, dof, amplitude, frequency):
    """The branch between 1.492 and 1.969 rad/s of an impact oscillator, at which marches settle at 1.6 rad/s
    with 0.5009; the peak of two motions, mirror images of one another, between equal stops."""
    scene = fcm.load_scene(SCENES.parents[1] / f"branches/scenes/{name}.toml")
    (curve,) = trace_exact(scene).curves
    assert curve.complete
    assert curve.peaks[dof].amplitude == pytest.approx(amplitude, rel=1e-4)
    assert curve.peaks[dof].frequency == pytest.approx(frequency, rel=1e-4)
    if name == "closed_impact":
        off, k = curve.frequency - 1.6, curve.stable == 1.0
        near = np.flatnonzero((off[:-1] * off[1:] < 0.0) & k[:-1] & k[1:])
        part = off[near] / (off[near] - off[near + 1])
        there = curve.amplitude[near, 0] + part * (curve.amplitude[near + 1, 0] - curve.amplitude[near, 0])
        assert np.abs(there / 0.5009 - 1.0).min() < 5e-3


def test_a_branch_followed_again_from_beside_its_fold_is_known_and_the_other_is_not():
    """It has other points than before."""
    problem = OrbitProblem(fcm.load_scene(Path(__file__).parent / "scenes/isolated.toml"))
    (other, isolated), *_ = explore(problem)
    beside = isolated.z[isolated.where(Mark.FOLD)[0] + 2]
    span = problem.scene.frequency_range
    again = follow(problem, beside, span, options=FollowOptions(0.7 * problem.scene.max_step))
    assert len(again.z) > 10
    assert is_known([isolated], distinct_motions(again), problem) and not is_known(
        [other], distinct_motions(again), problem
    )


@pytest.mark.slow
def test_both_branches_at_branch_points_of_the_exact_motion_are_followed():
    """Between two equal stops three pairs of mirrored motions leave the symmetric one. The balance of
    one harmonic has none of them. A march settles at one of them where the symmetric motion is unstable."""
    scene = KINDS["stops"](2033)
    found = explore(OrbitProblem(scene))
    symmetric, *others = sorted(found.paths, key=lambda path: -np.ptp(path.parameter))
    assert not found.missing and len(others) == found.mirrored == 3
    changes = np.flatnonzero(symmetric.orientation[:-1] * symmetric.orientation[1:] < 0.0)
    ends = sorted(float(end) for one in others for end in (one.parameter.min(), one.parameter.max()))
    assert np.allclose(symmetric.parameter[changes], ends, rtol=0.02)  # some begin beyond a fold

    omega, begin = 0.85, State(np.array([0.3, -0.1]), np.zeros(2), np.zeros(2))
    (march,) = simulate(scene, omega, 400, begin).measures(last=1)
    assert np.abs(march.mean).max() > 1e-3
    curve = trace_exact(scene).curves[0]
    off = curve.frequency - omega
    across = np.flatnonzero(off[:-1] * off[1:] <= 0.0)
    part = (off[across] / (off[across] - off[across + 1]))[:, None]
    there = (1.0 - part) * curve.amplitude[across] + part * curve.amplitude[across + 1]
    beside = np.abs(there / march.amplitude - 1.0).max(axis=1)
    assert curve.mirrored == 3 and len(beside) == 2 and beside.min() < 2e-3 < 0.05 < beside.max()


def lightly_damped(seed):
    scene = random_scene(seed)
    damping = np.full(scene.modal.mass.size, 1e-4)
    return replace(scene, modal=replace(scene.modal, damping=damping))


def off_after_a_period(scene, z):
    """By how much the simulated state after a period differs from that at its start, relative to its size."""
    m = scene.modal.mass.size
    x = np.zeros(2 * m + len(scene.contacts))
    x[OrbitProblem(scene).free] = z[:-1]
    start = State(x[:m], x[m : 2 * m], x[2 * m :])
    end = simulate(scene, z[-1], 1, start).end
    return np.abs(end.q - start.q).max() / np.abs(start.q).max()


def test_a_curve_goes_round_the_spike_at_which_a_slip_begins():
    """At 1.11365 most of the state turns back by nearly half a turn, and the frequency goes on."""
    scene = lightly_damped(8)
    problem = OrbitProblem(scene)
    (orbit,) = near_balance(scene, inner_resonances(scene)[0])
    path = follow(problem, first_point(problem, orbit), (0.9, 1.12), options=FollowOptions(scene.max_step))
    assert path.status is Status.COMPLETE and path.parameter[-1] == 1.12
    assert off_after_a_period(scene, path.z[-1]) < 1e-9
    at = int(np.argmin(np.abs(path.parameter - 1.11364864)))
    size = np.abs(path.z[at]).max()
    chord = [(path.z[at + k] - path.z[at])[:-1] / size for k in (-3, 3)]
    cosine = chord[0] @ chord[1] / np.linalg.norm(chord[0]) / np.linalg.norm(chord[1])
    assert cosine > 0.5  # where it goes on it is near -1


def test_a_curve_goes_on_from_a_corner_at_right_angles():
    """At 1.57431 it goes on where the frequency hardly changes, to motions a fifth of its size away."""
    scene = random_scene(21)
    problem = OrbitProblem(scene)
    begin = max(find_initial_orbits(problem)[0], key=lambda z: z[-1])
    path = follow(
        problem,
        begin,
        (1.574, scene.frequency_range[1]),
        options=FollowOptions(scene.max_step),
        forward=False,
    )
    assert path.status is Status.COMPLETE and path.parameter[-1] == 1.574
    for z in path.z[np.abs(path.parameter - 1.57431) < 1e-5]:
        assert off_after_a_period(scene, z) < 1e-9


def test_a_start_is_looked_for_anywhere_and_ends_that_are_not_reached_are_said():
    scene = lightly_damped(20)
    problem = OrbitProblem(scene)
    found, missed, sought, _ = find_initial_orbits(problem)
    (z,) = found
    low, high = scene.frequency_range
    assert sought and low < z[-1] < high and set(missed) == {low, high}
    assert off_after_a_period(scene, z) < 1e-9
    piece = follow(problem, z, (z[-1] - 1e-5, z[-1] + 1e-5), options=FollowOptions(scene.max_step))
    assert piece.status is Status.COMPLETE and incomplete(scene, [piece], missed[low]) == missed[low] != ""


def test_a_motion_is_reached_from_one_with_more_damping():
    scene = lightly_damped(22)
    easier, factor = more_damped(scene)
    assert easier.modal.damping == pytest.approx(factor * scene.modal.damping) and factor > 100.0
    low, high = scene.frequency_range
    omega = low + 5.0 / 12.0 * (high - low)
    z = first_point(OrbitProblem(easier), next(near_balance(easier, omega)))
    assert off_after_a_period(scene, z) > 1e-3
    reached = less_damped(scene, z, factor)
    assert reached[-1] == omega and off_after_a_period(scene, reached) < 1e-9
    assert more_damped(easier) is None  # it has enough


@pytest.mark.slow
def test_of_an_end_without_a_start_it_is_said_what_the_motion_does_there():
    """Simulated for thousands of periods it ranges as it did; the other rests on a friction of its own."""
    scene = lightly_damped(13)
    omega = scene.frequency_range[1]
    with pytest.raises(SimulationError) as error:
        periodic(scene, omega)
    said = re.search(
        r"last 160 lies between (\S+) and (\S+), and neither .*\. It is irregular", str(error.value)
    )
    assert said and "settles only in some 2e+04 cycles" in str(error.value)
    later = [one.amplitude.max() for one in simulate(scene, omega, 4000).measures(last=160)]
    least, greatest = float(said[1]), float(said[2])
    assert np.ptp(later) > 0.5 * (greatest - least) and least < np.mean(later) < greatest
    scene = lightly_damped(22)
    (orbit,) = near_balance(scene, scene.frequency_range[1])
    with pytest.raises(SimulationError, match=r"the contact c2 always sticks, on residual friction"):
        first_point(OrbitProblem(scene), orbit)
    contact, at = scene.contacts[2], scene.modal.shapes.T @ orbit.state.q
    assert set(orbit.states[2]) == {"E"}
    assert abs(orbit.state.friction[2] - contact.k_u * (contact.tangential @ at)) > 1.0


def test_an_interrupted_curve_goes_on_from_its_last_point(tmp_path):
    scene, keep = between(yang(), 1.15, 1.27), tmp_path / "kept"
    whole = curve_of(scene)
    first = curve_of(scene, keep=keep, progress=interrupted_after(20))
    again = curve_of(scene, keep=keep, progress=interrupted_after(20), resume=True)
    done = curve_of(scene, keep=keep, resume=True)
    assert 15 < first.points < again.points < whole.points
    assert again.reason.startswith("interrupted at ")
    assert len(again.folds) == 1 and again.reason.endswith(" rad/s, after 1 fold")
    np.testing.assert_array_equal(done.amplitude, whole.amplitude)
    assert done.folds == whole.folds and done.complete and not keep.exists()
    assert done.orbits.periods < 0.8 * whole.orbits.periods


def test_a_limit_of_time_is_said():
    curve = curve_of(between(yang(), 1.15, 1.27), options=within(1e-9))
    assert not curve.complete and curve.reason.startswith("not finished in 1e-09 s of processor time, at ")


@pytest.mark.slow
def test_of_a_contact_too_stiff_to_follow_it_is_said_what_would_do():
    """Without a limit of one's own, too; with what is said the curve is there, and nothing is said of it."""
    bundled = fcm.load_scene("den-hartog").each_curve()[0]

    def of(k_u):
        return replace(bundled, contacts=(replace(bundled.contacts[0], k_u=k_u),))

    curve = curve_of(of(1e12), options=ResponseOptions(exact=ExactOptions(stiff_seconds=1e-9)))
    said = re.fullmatch(
        r"not finished in 1e-09 s of processor time, at the start; the k_u of contact wall is 1e\+12 times "
        r"as stiff as the structure there, so that .*\. Try (\S+), nearly rigid, and "
        r"half of that to see how much it matters",
        curve.reason,
    )
    assert said and not curve.complete and not curve.points
    enough = of(float(said[1]))
    nearly, half = curve_of(enough), curve_of(of(0.5 * float(said[1])))
    assert nearly.complete and half.complete
    assert nearly.peaks["x"][0] == pytest.approx(half.peaks["x"][0], rel=1e-3)
    assert "stiff" not in curve_of(enough, options=within(1e-9)).reason


def test_sharp_resonances_take_few_periods_and_no_step_limit_changes_them():
    scene = between(yang(), 1.0, 1.4)
    light = replace(scene, modal=replace(scene.modal, damping=np.full(2, 1e-4)))
    long, short = (curve_of(replace(light, max_step=step)) for step in (0.2, 0.02))
    assert long.complete and short.complete and len(long.folds) == 4
    assert long.folds == pytest.approx(short.folds, rel=1e-10)
    for dof, (amplitude, *_) in long.peaks.items():
        assert amplitude == pytest.approx(short.peaks[dof][0], rel=1e-9)
    assert long.orbits.periods < 5.2 * long.points < 1000  # looks for windows between points and all


@pytest.mark.parametrize("n_0", [5.0, -5.0, 50.0])
def test_peaks_and_folds_alone_are_those_of_the_curve(n_0):
    whole, alone = curve_of(yang(n_0)), curve_of(yang(n_0), only="peaks")
    assert alone.complete and alone.points < 8
    assert sorted(alone.folds) == pytest.approx(sorted(whole.folds), rel=1e-8)
    for dof, (amplitude, omega, *_) in whole.peaks.items():
        assert alone.peaks[dof][0] == pytest.approx(amplitude, rel=1e-8)
        assert alone.peaks[dof][1] == pytest.approx(omega, rel=1e-5)
    assert [jump.sweep for jump in alone.jumps()] == [jump.sweep for jump in whole.jumps()]
    for one, other in zip(alone.jumps(), whole.jumps(), strict=True):
        assert one.after == pytest.approx(other.after, rel=1e-7)  # not only to the distance of its points
    for jump in alone.jumps():
        beyond = jump.frequency * (1.0 + 1e-4 * (1.0 if jump.sweep == "up" else -1.0))
        last = simulate(yang(n_0), beyond, 300).measures(last=1)[0]
        if jump.sweep == "down":  # the lower motion is the one from rest
            assert last.amplitude == pytest.approx(jump.after, rel=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(3))
def test_peaks_alone_of_dry_friction_are_those_of_the_curve(number):
    scene = replace(fcm.load_scene("den-hartog").each_curve()[number], curves=())
    whole, alone = curve_of(scene), curve_of(scene, only="peaks")
    assert alone.complete and alone.points < whole.points
    for dof, (amplitude, omega, *_) in whole.peaks.items():
        assert alone.peaks[dof][0] == pytest.approx(amplitude, rel=1e-8)
        assert alone.peaks[dof][1] == pytest.approx(omega, rel=1e-5)


@pytest.mark.slow
def test_jumps_that_the_balance_does_not_have_at_folds_are_found_with_peaks_alone():
    """Simulated beyond the one fold the motion comes to where it jumps; elsewhere its multipliers pass 1."""
    scene = fcm.load_scene(Path(__file__).parent / "scenes/lost_stability.toml")
    alone = curve_of(scene, only="peaks")
    first, second = (jump for jump in alone.jumps() if jump.sweep == "up")
    assert alone.complete and first.frequency in alone.folds and second.frequency not in alone.folds
    whole = curve_of(replace(scene, max_step=0.3 * scene.max_step))
    assert alone.folds == pytest.approx(whole.folds, rel=1e-9) and alone.points < 0.1 * whole.points
    for one, other in zip(alone.jumps(), whole.jumps(), strict=True):
        assert (one.sweep, one.frequency) == (other.sweep, pytest.approx(other.frequency, rel=1e-8))
        assert one.after == pytest.approx(other.after, rel=1e-4, nan_ok=True)
    (last,) = simulate(scene, first.frequency + 1e-4, 600).measures(last=1)
    assert last.amplitude == pytest.approx(first.after, rel=1e-2)
    for omega, stable in ((second.frequency - 1e-4, True), (second.frequency + 1e-4, False)):
        orbit = periodic(scene, omega, simulate(scene, 1.226, 600).end)
        assert orbit.stable == stable
    assert np.isnan(second.after).all()


@pytest.mark.parametrize("loads", [[], [{"dof": "y", "force": 0.4}]], ids=["none", "static"])
def test_a_peak_that_the_balance_has_exactly_is_that_of_its_own_dof(loads):
    """There the contact sticks, and the guess is the peak; close to it is one of the other dof."""
    modes = {"mass": [1, 1], "frequency": [1, 1.7], "damping": [0.02, 0.02], "shapes": [[1, 0.2], [0.1, 1]]}
    joint = {"name": "c", "tangential": "x", "normal": "y", "mu": 0.4, "k_u": 1, "k_v": 0.5, "n_0": 1}
    scene = scene_from_dict(
        {
            "modal": {"dofs": ["x", "y"], **modes},
            "contact": [joint],
            "force": [{"dof": "x", "amplitude": 0.3}],
            "load": loads,
            "response": {"frequency": [0.7, 2]},
        }
    )
    shapes, own = np.array(modes["shapes"]), np.diag(np.square(modes["frequency"]))
    stiff, damper = own + shapes @ np.diag([1.0, 0.5]) @ shapes.T, np.diag([0.04, 0.068])

    def height(omega):
        dynamic = stiff - omega**2 * np.eye(2) + 1j * omega * damper
        return -abs(shapes[:, 1] @ np.linalg.solve(dynamic, 0.3 * shapes[:, 0]))

    best = minimize_scalar(height, bounds=(1.84, 1.86), method="bounded", options={"xatol": 1e-9})
    alone = curve_of(scene, only="peaks")
    assert alone.complete
    assert alone.peaks["y"][:2] == pytest.approx((-best.fun, best.x), rel=1e-6)


def many(high):
    """The oscillator with thirty more modes from a frequency on."""
    scene, rng = yang(), np.random.default_rng(2)
    modal, more = scene.modal, 30
    shapes = np.concatenate((modal.shapes, rng.normal(size=(more, 2))))
    frequency = np.concatenate((modal.frequency, high * (1.0 + np.arange(more))))
    wider = Modal(
        modal.dofs, np.ones(more + 2), frequency, np.concatenate((modal.damping, np.full(more, 0.01))), shapes
    )
    return between(replace(scene, modal=wider), 1.05, 1.12, max_step=0.2)


def test_modes_that_follow_without_delay_are_left_out_with_a_bound():
    scene = many(5.0)
    light, full = trace_exact(scene, options=leaving_out(1e-5)), curve_of(scene, options=leaving_out(None))
    (said,) = light.left_out
    assert "30 modes of 32" in said and "changes the response by less than" in said
    for dof in full.peaks:
        assert light.curves[0].peaks[dof][0] == pytest.approx(full.peaks[dof][0], rel=1e-5)


def test_modes_that_nothing_moves_are_left_out():
    scene = between(one_mode(), 0.9, 1.1, max_step=0.2)
    modal = scene.modal
    still = Modal(
        modal.dofs, np.ones(2), np.array([1.0, 3.0]), np.full(2, 0.02), np.vstack((modal.shapes, np.zeros(2)))
    )
    response = trace_exact(replace(scene, modal=still))
    assert response.left_out == ["1 mode of 2: neither a force nor a contact moves it (no effect)"]
    np.testing.assert_array_equal(response.curves[0].amplitude, curve_of(scene).amplitude)


def test_a_force_elsewhere_has_no_range_to_be_without():
    """Without a force there is no motion, and its peaks are none."""
    curve = curve_of(replace(yang(), forces=(Force(np.array([1.0, 0.0]), 0.0, 0.0),)), only="peaks")
    assert not curve.amplitude[np.isfinite(curve.frequency)].any()
