"""Curves against the level of the forces: where they fold, beside curves against the frequency."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.branches import force_level
from fcm.branches.force_level import LevelRange, level_curve, linear_resonances, solutions
from fcm.branches.linear_limits import highest_linear_limit, lowest_linear_limit
from fcm.branches.shared_levels import clear, shared_curve
from fcm.continuation import Status
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.response.level import LevelRequest, trace_levels
from fcm.results.csv_file import write_csv
from fcm.results.output import to_dataset
from fcm.run import Execution
from fcm.scene import load_scene
from fcm.scene.draft import number_of
from fcm.shooting import periodic
from fcm.tracking.parameter_line import line_along

from ..harmonic_balance.scenes import isola, isola_stuck, up_to
from ..harmonic_balance.truth import state
from ..interrupted import interrupted_after
from ..time_domain.cases import yang
from .random_scenes import random_scene


@pytest.mark.parametrize("harmonics", [1, 3])
def test_both_kinds_of_curve_fold_at_the_same_solution(harmonics):
    """Where the equations are singular is no matter of the parameter."""
    scene = load_scene("yang1998-n5")
    (curve,) = trace(scene, harmonics=harmonics).curves
    for frequency in curve.folds:
        (raised,) = trace_levels(scene, LevelRequest([frequency], (0.5, 1.5)), harmonics=harmonics).curves
        assert min(abs(level - 1.0) for level in raised.level_folds) < 1e-6
        assert raised.folds == []


def test_the_motion_of_an_open_contact_is_in_proportion_to_the_level():
    scene = load_scene("yang1998-n5")
    away = replace(scene, contacts=tuple(replace(one, n_0=-1e3) for one in scene.contacts))
    (raised,) = trace_levels(away, LevelRequest([0.9], (0.1, 2.0))).curves
    assert raised.level_folds == [] and raised.complete
    each = raised.amplitude / raised.level[:, None]
    assert each == pytest.approx(np.broadcast_to(each[0], each.shape), rel=1e-9)


def test_what_is_said_of_a_curve_of_levels():
    response = trace_levels(load_scene("yang1998-n5"), LevelRequest([1.2], (0.0, 1.0)))
    data, said = to_dataset(response), response.curves[0].summary()
    assert data.fold_level.dims == ("curve", "level_fold")
    assert data.fold_level[0].values.tolist() == said["level_folds"] == response.curves[0].level_folds
    assert said["stable"] is False and said["folds"] == []  # between its two folds


def test_the_level_is_a_column_of_csv(tmp_path):
    response = trace_levels(load_scene("yang1998-n5"), LevelRequest([1.2], (0.0, 1.0)))
    write_csv(response, tmp_path / "a.csv")
    head, first, *_ = (line.split(",") for line in (tmp_path / "a.csv").read_text().splitlines())
    assert len(head) == len(first)
    assert float(first[head.index("level")]) == response.curves[0].level[0]


@pytest.mark.slow
def test_where_the_level_is_not_followed_to_its_end_branches_are_not_said_to_be_all():
    """Then a solution beyond may be missing: the curve says where."""
    scene = random_scene(112)
    (curve,) = trace(scene).curves
    system = System(scene)
    for frequency in (*scene.frequency_range, *linear_resonances(system)):
        end = highest_linear_limit(system, frequency)
        linear = min(0.9 * lowest_linear_limit(system, frequency), 1.0)  # from where the response begins, too
        exactly = level_curve(system, frequency, LevelRange((0.0, end), linear=linear))
        over_slight_corners, in_haste = (
            level_curve(
                system,
                frequency,
                LevelRange((0.0, end), linear=linear, user_points_only=True, over_corners=over),
            )
            for over in (True, False)
        )
        paths = exactly, over_slight_corners, in_haste
        reached = any(path.parameter[-1] == pytest.approx(end) for path in paths)
        assert (frequency in curve.uncertain_at) != reached
    assert curve.uncertain_at and curve.summary()["branches_unsure_at"] == curve.uncertain_at
    assert not trace(load_scene("yang1998-n5")).curves[0].uncertain_at


def test_a_curve_of_levels_is_followed_where_next_to_no_force_is_left():
    """A light preload opens under little; the stiffened resonance then takes a tenth of what led to it."""
    scene, level = isola_stuck(), 8e-4
    scene = replace(scene, contacts=(replace(scene.contacts[0], n_0=0.01),))
    weak = replace(scene, forces=tuple(replace(one, amplitude=level) for one in scene.forces))
    (raised,) = trace_levels(scene, LevelRequest([1.5], (0.0, 2.0)), harmonics=5).curves
    assert raised.complete and len(raised.level_folds) == 2 and min(raised.level_folds) < level
    system = System(scene, up_to(5))
    path = level_curve(
        system,
        1.5,
        LevelRange((0.0, 2.0), user_values=(level,), linear=0.9 * lowest_linear_limit(system, 1.5)),
    )
    passings = path.z[path.parameter == level]
    passings[:, -1] = 1.5
    amplitude = reported_at(system, passings, level=np.full(2, level)).amplitude
    for z, each in zip(passings, amplitude, strict=True):  # and one more on the way to where all is linear
        exact = periodic(weak, 1.5, state(System(weak, up_to(5)), z))
        assert exact.states == ("SEP",)
        assert each == pytest.approx(exact.measure.amplitude, rel=5e-3)
    assert solutions(system, 1.5).complete


@pytest.mark.parametrize(
    ("scene", "frequency"), [(isola(), 1.22), (isola(), 1.5), (isola_stuck(), 1.5), (yang(5.0), 1.21)]
)
def test_what_is_not_followed_of_a_level_has_no_solution(scene, frequency):
    """Beside the curve of as many harmonics, followed up to where nothing changes any more."""
    system = System(scene, up_to(7))
    whole = level_curve(system, frequency, LevelRange((0.0, highest_linear_limit(system, frequency))))
    passings = whole.z[whole.parameter == 1.0, :-1]
    found = solutions(system, frequency)
    assert found.complete and len(found.solutions) == len(passings)
    assert np.array([z[:-1] for z in found.solutions]) == pytest.approx(passings, rel=1e-6, abs=1e-7)


def test_a_passing_that_long_steps_lead_across_is_found():
    """The curve is not found between the ends of such a step: shorter ones find it."""
    scene = random_scene(13)
    scene = replace(scene, forces=tuple(replace(one, amplitude=5.0 * one.amplitude) for one in scene.forces))
    system = System(scene)
    for frequency in (*linear_resonances(system), 1.1800850503105396):
        path = level_curve(system, frequency, LevelRange((0.0, highest_linear_limit(system, frequency))))
        passings = path.z[path.parameter == 1.0, :-1]
        found = solutions(system, frequency)
        assert path.status is Status.COMPLETE and found.complete
        assert np.array(found.solutions)[:, :-1] == pytest.approx(passings, rel=1e-6, abs=1e-7)


def preloaded(scene, n_0):
    """A curve of a sweep of preloads."""
    contacts = tuple(replace(one, n_0=n_0) for one in scene.contacts)
    return replace(scene, contacts=contacts, parameters={"contact.c.n_0": n_0})


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize(
    ("scene", "frequency", "preloads"),
    [(isola(), 1.22, (-15.0, -15.5, -3.0, -300.0)), (isola_stuck(), 1.5, (6.0, 5.5, 0.1, 500.0))],
)
def test_curves_of_other_preloads_share_a_curve_of_levels(scene, frequency, preloads, count):
    """Each has the solutions on the curve of its own, whichever has come first."""
    sweep, found = [preloaded(scene, n_0) for n_0 in preloads], []
    for order in (sweep, sweep[::-1]):
        clear()
        systems = {one.parameters["contact.c.n_0"]: System(one, up_to(count)) for one in order}
        found.append({n_0: solutions(system, frequency) for n_0, system in systems.items()})
    numbers = set()
    for n_0, one in found[0].items():
        assert one.complete and np.array_equal(one.solutions, found[1][n_0].solutions)
        own = System(replace(preloaded(scene, n_0), parameters={}), up_to(count))
        path = level_curve(own, frequency, LevelRange((0.0, highest_linear_limit(own, frequency))))
        passings = path.z[path.parameter == 1.0, :-1]
        assert np.array(one.solutions)[:, :-1] == pytest.approx(passings, rel=1e-6, abs=1e-7)
        numbers.add(len(passings))
    assert numbers == {1, 3}  # some of them have three


def test_one_curve_of_levels_is_followed_for_a_sweep_of_preloads():
    """For draws of friction and preload there is none in common."""
    followed = []

    def counted(system, omega, top):
        followed.append(system)
        return level_curve(system, omega, LevelRange((0.0, top)))

    clear()
    systems = [System(preloaded(isola(), n_0)) for n_0 in (-15.0, -15.5, -60.0)]
    paths = [shared_curve(one, 1.22, 6.0 / one.preload_unit, counted) for one in systems]
    ends = [one.preload_unit * path.parameter[-1] for one, path in zip(systems, paths, strict=True)]
    assert len(followed) == 1 and ends[0] == pytest.approx(6.0) and min(ends) > 6.0 * (1.0 - 1e-9)
    assert all(np.array_equal(path.z, paths[0].z[: len(path.z)]) for path in paths)
    assert len(paths[2].z) < len(paths[0].z)
    further = shared_curve(systems[0], 1.22, 12.0 / systems[0].preload_unit, counted)
    assert len(followed) == 2 and np.array_equal(further.z[: len(paths[2].z)], paths[2].z)
    scene = systems[0].scene
    drawn = System(replace(scene, parameters={**scene.parameters, "contact.c.mu": 0.05}))
    assert all(one.preload_unit for one in systems) and not drawn.preload_unit


def test_responses_of_a_search_over_a_preload_share_curves_of_levels(monkeypatch):
    """That of few harmonics to its end, and that of more as far as the least preload needs it."""
    followed = []

    def counted(system, omega, levels):
        followed.append((len(system.harmonics), levels.span[1]))
        return level_curve(system, omega, levels)

    monkeypatch.setattr(force_level, "level_curve", counted)
    clear()
    scene = load_scene("yang1998-n5")
    system, line = System(scene, tuple(range(1, 8))), line_along(number_of(scene, "contact.shroud.n_0"))
    for n_0 in (4.0, 8.0, 6.0):
        assert solutions(system.with_scene(line.scene(scene, n_0)), 1.22).solutions
    assert len(followed) == 2 and followed[0][0] < followed[1][0] and followed[1][1] < followed[0][1]


def test_a_curve_of_levels_in_common_is_interrupted_as_that_of_a_system_of_its_own():
    """By what is polled now: later that may be nothing."""

    def stop():
        raise KeyboardInterrupt

    def followed(system, omega, top):
        return level_curve(system, omega, LevelRange((0.0, top)))

    system = System(preloaded(isola(), -15.0))
    system.normalised.work.poll()
    system.work.poll = stop
    clear()
    with pytest.raises(KeyboardInterrupt):
        shared_curve(system, 1.22, 1.0, followed)


@pytest.mark.parametrize("harmonics", [1, 3])
def test_the_errors_of_a_curve_of_levels_are_those_of_the_exact_motion(harmonics):
    """Half the peak-to-peak of v where a march of the contact law settles, of `isola` at 1.22 rad/s: 1.838
    from rest, and 17.82 from half of all random states, where one harmonic has 22.77."""
    (curve,) = trace_levels(isola(), LevelRequest([1.22], (0.0, 2.0)), harmonics=harmonics).curves
    low, middle, high = np.flatnonzero(curve.level == 1.0)
    assert curve.amplitude[low, 1] == pytest.approx(1.838, rel=1e-3) and curve.error[low, 1] == 0.0
    true = abs(17.82 / curve.amplitude[high, 1] - 1.0)
    assert 0.5 * true < curve.error[high, 1] < 2.0 * true
    assert curve.stable[low] == 1.0 and curve.stable[middle] == 0.0
    assert curve.peaks["v"].error == curve.error[np.nanargmax(curve.amplitude[:, 1]), 1] < 0.25


def test_a_curve_of_levels_has_the_harmonics_that_an_accuracy_takes():
    """Of `isola` at 1.22 rad/s a march of the contact law settles at 17.82 in v; one harmonic has 22.77."""
    (curve,) = trace_levels(isola(), LevelRequest([1.22], (0.0, 2.0))).curves
    high = np.flatnonzero(curve.level == 1.0)[-1]
    assert abs(17.82 / curve.amplitude[high, 1] - 1.0) < 1e-2
    assert curve.error[high, 1] < 1e-2 and curve.peaks["v"].error < 1e-2 and not curve.short_of


@pytest.mark.slow
def test_a_curve_of_levels_that_has_not_the_accuracy_says_so():
    (curve,) = trace_levels(isola(), LevelRequest([1.22], (0.0, 2.0)), accuracy=1e-12).curves
    assert curve.complete and curve.short_of.startswith(f"with {len(curve.harmonics)} harmonics an estimated")


@pytest.mark.parametrize(("stops_at", "kept"), [(1, 0), (2, 1), (4, 2)])
def test_an_interruption_keeps_the_curves_of_levels_that_are_finished(stops_at, kept):
    """Each is followed with one harmonic and with three: one that is known with one alone is kept as well."""
    progress = interrupted_after(stops_at - 1)
    if not kept:
        with pytest.raises(KeyboardInterrupt):
            trace_levels(
                isola(), LevelRequest([1.22, 1.23, 1.24], (0.0, 2.0)), execution=Execution(progress=progress)
            )
        return
    response = trace_levels(
        isola(), LevelRequest([1.22, 1.23, 1.24], (0.0, 2.0)), execution=Execution(progress=progress)
    )
    assert [curve.level.size > 0 for curve in response.curves] == [i < kept for i in range(3)]
    assert [curve.complete for curve in response.curves] == [i < kept - 1 for i in range(3)]
    assert response.curves[kept - 1].reason == "interrupted before it was known with 3 harmonics"
    assert response.curves[kept].reason == "interrupted before it was traced" and response.interrupted


def test_a_solution_that_may_not_be_there_is_not_called_stable():
    """The branch of large amplitudes of `isola` begins at the level 0.86, and with one harmonic at 0.53."""
    (curve,) = trace_levels(isola(), LevelRequest([1.22], (0.0, 2.0)), harmonics=1).curves
    (more,) = trace_levels(isola(), LevelRequest([1.22], (0.0, 2.0)), harmonics=7).curves
    upper = np.arange(curve.level.size) > int(np.argmin(np.abs(curve.level - min(curve.level_folds))))
    false = upper & (curve.level < min(more.level_folds))
    assert false.any() and np.isnan(curve.error[false, 1]).all() and not (curve.stable[false] == 1.0).any()


def test_a_curve_of_levels_is_stable_where_that_of_the_frequency_is():
    """Both pass three solutions of the paper's oscillator at 1.21 rad/s; its motions bear the same."""
    scene = yang(5.0)
    (raised,) = trace_levels(scene, LevelRequest([1.21], (0.5, 1.5)), harmonics=5).curves
    (curve,) = trace(replace(scene, frequency_range=(1.21, 1.7)), harmonics=5).curves
    here = [
        {round(float(a), 5): float(s) for a, s in zip(one.amplitude[at, 0], one.stable[at], strict=True)}
        for one, at in ((raised, raised.level == 1.0), (curve, curve.frequency == 1.21))
    ]
    assert here[0] == here[1] and sorted(here[0].values()) == [0.0, 1.0, 1.0]
