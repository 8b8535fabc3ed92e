"""Each kind of tracked curve, and the curve of the optimum, against the ordinary runs that it replaces."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.accuracy.refinement import every_branch
from fcm.branches.trace import traced
from fcm.cli.track import as_table
from fcm.continuation import FollowOptions, Mark, Status, follow
from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.options import HarmonicBalanceOptions, WorkOptions
from fcm.harmonic_balance.reported_quantities import recorded
from fcm.harmonic_balance.system import System
from fcm.model.scene import Aim, Optimum
from fcm.response.optimum import optimise
from fcm.response.options import OptimumOptions, ResponseOptions
from fcm.response.tracking_task import conditions_of
from fcm.scene import load_scene
from fcm.scene.draft import number_of
from fcm.tracking.curves import tracked_curves
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.options import SearchOptions
from fcm.tracking.parameter_line import line_along
from fcm.tracking.tracked_point import TrackingSetup

from ..harmonic_balance.scenes import gap5

PRELOAD, STIFFNESS = "contact.shroud.n_0", "contact.shroud.k_u"
EXACT = 1e-9  # relative; the last point of both is that of Newton's method


@pytest.fixture(scope="module")
def scene():
    return load_scene("yang1998-n5")


def run(scene, key, value):
    """An ordinary run at a value of the number."""
    system = System(number_of(scene, key).put(scene, value))
    return system, traced(system).branches.paths


def frequencies(scene, key, value, mark):
    """Of the points that an ordinary run has marked."""
    paths = run(scene, key, value)[1]
    return np.sort(np.concatenate([path.parameter[path.where(mark)] for path in paths]))


def grid(scene, what, key, span):
    """Values of the number at which curves were followed through, and their frequencies there."""
    system, line = System(scene, (1,)), line_along(number_of(scene, key))
    found = tracked_curves(TrackingSetup(system, line, span), conditions_of(scene, what))
    assert not found.problems and all(curve.whole for curve in found.curves)
    for value in np.linspace(*span, 13)[::3]:
        there = [curve.frequency[np.abs(curve.s - value) < 1e-9] for curve in found.curves]
        yield value, np.unique(np.concatenate(there).round(11))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("preload", "key", "span"),
    [
        (5.0, PRELOAD, (-20.0, 10.0)),
        (5.0, "level", (0.4, 2.8)),
        (-5.0, STIFFNESS, (0.1, 3.0)),  # through a corner of the curve itself, at 0.39987
    ],
)
def test_folds(scene, preload, key, span):
    there = number_of(scene, PRELOAD).put(scene, preload)
    for value, found in grid(there, "folds", key, span):
        assert found == pytest.approx(frequencies(there, key, value, Mark.FOLD), rel=EXACT)


@pytest.mark.slow
@pytest.mark.parametrize(("what", "span"), [("slip", (20.0, 100.0)), ("separation", (2.0, 10.0))])
def test_onsets(scene, what, span):
    """They are corners of the ordinary curve, and all of those at which the contact just slips or opens."""
    for value, found in grid(scene, what, PRELOAD, span):
        _, paths = run(scene, PRELOAD, value)
        z = np.concatenate([path.z[path.where(Mark.CORNER)] for path in paths])
        u, v = z[:, 2] + 1j * z[:, 3], z[:, 4] + 1j * z[:, 5]
        load, mu = value + z[:, 1], scene.contacts[0].mu  # k_u and k_v are 1
        slips = 2.0 * mu * load - np.abs(u + mu * v) - np.abs(u - mu * v)
        off = slips if what == "slip" else load - np.abs(v)
        assert found == pytest.approx(np.sort(z[np.abs(off) < 1e-9, -1]), rel=EXACT)


def limited(seconds):
    """Options by which more harmonics in a search may take so long."""
    return HarmonicBalanceOptions(work=WorkOptions(max_seconds_repeated=seconds))


@pytest.mark.slow
def test_an_optimum_short_of_the_accuracy_says_so(scene):
    aimed = replace(scene, optimum=Optimum((PRELOAD,), ((2.0, 20.0),), (Aim("u"),)))
    enough = optimise(aimed, accuracy=1e-3)
    assert enough.tracking.optima[0].error <= 1e-3 and not enough.curves[0].short_of
    short = optimise(aimed, accuracy=1e-3, options=ResponseOptions(limited(0.0)))
    assert short.tracking.harmonics == (1,) and short.tracking.optima[0].error > 1e-3
    assert "with 1 harmonic the error of the least peak" in short.curves[0].short_of


@pytest.mark.slow
def test_an_optimum_short_of_the_accuracy_says_what_fewer_harmonics_found(scene):
    aimed = replace(scene, optimum=Optimum((PRELOAD,), ((2.0, 20.0),), (Aim("u"),)))
    (fewer,) = optimise(aimed, harmonics=1).tracking.optima
    options = ResponseOptions(limited(0.2), optimum=OptimumOptions(max_rounds=2))
    short = optimise(aimed, accuracy=1e-7, options=options)
    assert short.tracking.optima[0].error > 1e-7 and len(short.tracking.harmonics) > 1
    found = f"with 1 harmonic it is {fewer.value:.6g} at {PRELOAD} = {fewer.values[PRELOAD]:.6g}"
    assert f"; {found}. For smaller errors try" in short.curves[0].short_of


# no peak is high enough to be followed
UNFOLLOWED = ResponseOptions(optimum=OptimumOptions(search=SearchOptions(high_fraction=np.inf)))


def test_what_cannot_be_followed_is_found_by_trials(scene):
    aimed = replace(scene, optimum=Optimum((PRELOAD,), ((2.0, 30.0),), (Aim("u"),)))
    followed = optimise(aimed, harmonics=1).tracking.optima[0]
    tried = optimise(aimed, harmonics=1, options=UNFOLLOWED)
    (found,) = tried.tracking.optima
    low, high = found.between
    assert found.kind == "trials" and low < followed.values[PRELOAD] < high < low + 8.0
    assert low < found.values[PRELOAD] < high
    for value in (found.values[PRELOAD], 2.0, 9.0, 16.0, 23.0, 30.0):  # a plain sweep
        system, paths = run(scene, PRELOAD, value)
        peak = recorded(system, paths).amplitude[:, 0].max()
        if value == found.values[PRELOAD]:
            assert found.value == pytest.approx(peak, rel=EXACT)
        assert peak >= found.value * (1.0 - EXACT) >= followed.value * (1.0 - 2.0 * EXACT)
    result = {"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}
    assert f"by trials alone, between {low:.6g} and {high:.6g}" in as_table(result, "rad/s")


def test_the_error_of_a_higher_peak_beside_trials_counts(scene):
    """It decides which number is the least: its error is the change by more harmonics, where it was tried."""
    aimed = replace(scene, optimum=Optimum((PRELOAD,), ((2.0, 30.0),), (Aim("u"),)))
    (found,) = optimise(aimed, harmonics=1, options=UNFOLLOWED).tracking.optima
    beside = found.beside[PRELOAD]
    assert beside in found.between
    there = number_of(scene, PRELOAD).put(scene, beside)
    few, many = (
        max(one.amplitude[:, 0].max() for one in every_branch(System(there, harmonics)).quantities)
        for harmonics in ((1,), tuple(range(1, 16)))
    )
    assert few > found.value and found.end_error == pytest.approx(abs(many - few) / few, rel=0.05)
    told = {"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}
    assert "Between two of these the peak is unknown" in as_table(told, "rad/s")
    for error, said in (
        (None, "error of a higher one of these is unknown: more --harmonics"),
        (0.32, "by 3.2e-01"),
    ):
        told["optimum"][0]["end_error"] = error
        assert said in as_table(told, "rad/s")


def test_trials_that_are_least_at_a_bound_say_both(scene):
    aimed = replace(scene, optimum=Optimum((PRELOAD,), ((20.0, 60.0),), (Aim("u"),)))
    (found,) = optimise(aimed, harmonics=1, options=UNFOLLOWED).tracking.optima
    assert (found.kind, found.values[PRELOAD], found.between[0]) == ("bound", 20.0, 20.0)


def test_the_curve_of_the_optimum(scene):
    aimed = replace(scene, optimum=Optimum((PRELOAD,), ((2.0, 30.0),), (Aim("u"),)))
    (curve,) = optimise(aimed, harmonics=1).tracking.curves
    assert (curve.number[0], curve.number[-1]) == (2.0, 30.0) and not curve.trough.any()
    for i in range(0, curve.number.size, 5):
        system, paths = run(scene, PRELOAD, curve.number[i])
        expected = recorded(system, paths).amplitude[:, 0].max()
        assert curve.amplitude[i, 0] == pytest.approx(expected, rel=EXACT)


def test_a_bound_at_which_the_gap_closes_is_a_bound(scene):
    aimed = replace(scene, optimum=Optimum((PRELOAD,), ((-20.0, 0.0),), (Aim("u"),)))
    (found,) = optimise(aimed, harmonics=1).tracking.optima
    assert found.values[PRELOAD] == 0.0 and found.kind == "bound"
    system, paths = run(scene, PRELOAD, 0.0)
    assert found.value == pytest.approx(recorded(system, paths).amplitude[:, 0].max(), rel=EXACT)


@pytest.mark.slow
def test_an_isolated_branch_is_between_the_turns_that_are_told():
    """It is followed from a fold of the track, and is one of the branches of an ordinary run."""
    scene = gap5()
    gap, value = number_of(scene, "contact.c.gap"), 3.5
    setup = TrackingSetup(System(scene, (1, 3)), line_along(gap), (3.0, 4.0), (value,), 0.05)
    curves = tracked_curves(setup, [Condition(Kind.FOLD)], (value,)).curves
    turns = [(kind, curve.s[i]) for curve in curves for i, kind in curve.turns()]
    assert [kind for kind, _ in turns] == ["isola", "isola"]
    assert min(s for _, s in turns) < value < max(s for _, s in turns)
    tracked_points = [point for curve in curves for point in curve.points if abs(point.z[-1] - value) < 1e-9]
    folds = np.unique([point.z[-2] for point in tracked_points])
    ordinary = every_branch(setup.system.with_scene(gap.put(scene, value))).traced.branches.paths
    isolated = [path for path in ordinary if path.status is Status.CLOSED]
    others = [path for path in ordinary if path.status is not Status.CLOSED]
    at_ordinary = np.concatenate([path.parameter[path.where(Mark.FOLD)] for path in others])
    closed = follow(
        setup.system.with_scene(gap.put(scene, value)).new_balance(),
        beside_fold(setup, max(tracked_points, key=lambda point: point.z[-2]).z),
        (0.7, 1.5),
        options=FollowOptions(0.05),
    )
    at_closed = np.unique(closed.parameter[closed.where(Mark.FOLD)].round(10))
    assert closed.status is Status.CLOSED
    (same,) = isolated
    assert np.unique(same.parameter[same.where(Mark.FOLD)].round(10)) == pytest.approx(at_closed, rel=EXACT)
    assert folds == pytest.approx(np.sort(np.concatenate((at_ordinary, at_closed))), rel=EXACT)


def beside_fold(setup, z):
    """A point of the response next to a tracked fold."""
    problem = setup.tracked(Condition(Kind.FOLD))
    problem.evaluate_scale(z)
    direction = problem.along(z)[0] * np.asarray(problem.scale)[:-1]
    newton = Newton(problem.varied.balance)
    newton.scale[:], newton.z[:] = np.asarray(problem.scale)[:-1], z[:-1] + 1e-2 * direction
    newton.row[:] = direction / np.asarray(problem.scale)[:-1]
    assert newton.correct(1e-2)
    return np.array(newton.z)
