"""Isolated branches, which only the folds of the level of the forces lead to."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from fcm.accuracy.refinement import every_branch, with_errors
from fcm.accuracy.unchecked_response import unchecked_response
from fcm.branches.fold_continuation import FoldCurveEnding, Folds, folds_from
from fcm.branches.force_level import level_frequencies, solutions
from fcm.branches.isolas import level_one_crossings
from fcm.branches.options import FoldOptions, LevelCurveOptions, LevelOptions
from fcm.branches.surface import Surface
from fcm.branches.trace import traced
from fcm.continuation import Mark, Status
from fcm.harmonic_balance.modal_condensation import CONDENSATION, CondensationOptions
from fcm.harmonic_balance.options import HARMONIC_BALANCE, WorkOptions
from fcm.harmonic_balance.system import System
from fcm.model.scene import Force
from fcm.response.options import ResponseOptions
from fcm.response.refined import refined
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import load_scene

from ..program import AS_A_MODULE, python
from ..response.random_scenes import random_scene

SCENES = Path(__file__).parent / "scenes"
EVERY_MODE = CondensationOptions(min_unknowns=1, max_fraction=2.0)  # as of many contacts
ACCURACY = 1e-2  # relative, that is asked for of peaks and folds


def scene(name):
    return load_scene(SCENES / f"{name}.toml").each_curve()[0]


def branches_of(curve):
    """Frequencies and amplitudes of each branch, and whether its points are stable."""
    cut = np.concatenate(([-1], np.flatnonzero(np.isnan(curve.frequency)), [len(curve.frequency)]))
    parts = [slice(a + 1, b) for a, b in pairwise(cut)]
    return [(curve.frequency[one], curve.amplitude[one], curve.stable[one]) for one in parts]


def passings(curve, omega):
    """Amplitudes (dof,) and stability where the branches pass a frequency."""
    for frequency, amplitude, stable in branches_of(curve):
        off = frequency - omega
        for i in np.flatnonzero(off[:-1] * off[1:] < 0.0):
            part = off[i] / (off[i] - off[i + 1])
            yield (1.0 - part) * amplitude[i] + part * amplitude[i + 1], stable[i]


@pytest.mark.slow
@pytest.mark.parametrize(("harmonics", "within"), [(None, ACCURACY), (7, 1e-3)])
def test_a_closed_branch_of_an_impact_oscillator_is_found(harmonics, within):
    """At 1.6 rad/s an independent march settles at 0.5009; the branch spans 1.492 to 1.969 rad/s. Neither the
    ends of the range nor the resonance have more solutions than one."""
    given = None if harmonics is None else tuple(range(1, harmonics + 1))
    curve = traced_curve(scene("closed_impact"), Request(given, ACCURACY))
    assert curve.complete
    there = [amplitude for amplitude, stable in passings(curve, 1.6) if stable == 1.0]
    assert min(abs(float(one[0]) / 0.5009 - 1.0) for one in there) < 5e-3
    spans = [(frequency.min(), frequency.max()) for frequency, _, _ in branches_of(curve)]
    assert min(max(abs(low / 1.492 - 1.0), abs(high / 1.969 - 1.0)) for low, high in spans) < within


def folds_of(system, omega):
    """The curves of folds from the turns of the level at a frequency."""
    for turn in solutions(system, omega, np.inf).folds:
        surface = Surface(system.reset_balance())
        z = np.append(turn.z, turn.level)
        yield turn, folds_from(surface, z, turn.directions, system.scene.frequency_range)


@pytest.mark.slow
@pytest.mark.parametrize("condensation", [CONDENSATION, EVERY_MODE])
def test_a_curve_of_folds_passes_where_the_level_turns_at_other_frequencies(condensation):
    """With four harmonics: at 1.6 rad/s the level turns at 2.308 and 0.896, as following it there says."""
    system = System(scene("closed_impact"), (1, 2, 3, 4), condensation=condensation)
    assert (system.new_balance().rank > 0) == (condensation is EVERY_MODE)
    expected = sorted(turn.level for turn in solutions(system, 1.6, np.inf).folds)[:2]
    assert expected == pytest.approx([0.896, 2.308], abs=1e-3)
    found = []
    for turn, curve in folds_of(system, 1.0):
        if curve is None or not turn.unfinished:
            continue
        off = curve.frequency - 1.6
        for i in np.flatnonzero(off[:-1] * off[1:] < 0.0):
            found.append(curve.level[i] + off[i] / (off[i] - off[i + 1]) * np.diff(curve.level[i : i + 2])[0])
    for level in expected:
        assert min(abs(one / level - 1.0) for one in found) < 2e-2


def levels_at(curve, omega):
    """At which levels a curve of folds passes a frequency."""
    off = curve.frequency - omega
    return [
        curve.level[i] + off[i] / (off[i] - off[i + 1]) * (curve.level[i + 1] - curve.level[i])
        for i in np.flatnonzero(off[:-1] * off[1:] < 0.0)
    ]


@pytest.mark.parametrize("preload", [2.0, 10.0, 20.0])
@pytest.mark.parametrize("condensation", [CONDENSATION, EVERY_MODE])
def test_where_two_curves_of_folds_touch_the_one_leads_to_the_other(preload, condensation):
    """They come together at 1.27 rad/s, where the level turns no more: below, it does on either."""
    (one,) = (one for one in load_scene("yang1998").each_curve() if one.contacts[0].n_0 == preload)
    system = System(one, condensation=condensation)
    (omega,) = (
        w for w in level_frequencies(system) if any(turn.unfinished for turn in solutions(system, w).folds)
    )
    (curve,) = (curve for turn, curve in folds_of(system, omega) if turn.unfinished)
    assert curve is not None and set(curve.endings) == {FoldCurveEnding.LEVEL}
    turns = sorted(turn.level for turn in solutions(system, 1.255, np.inf).folds)
    met = np.array(levels_at(curve, 1.255))
    assert len(turns) == 2 and all(np.abs(met / level - 1.0).min() < 1e-2 for level in turns)


@pytest.mark.parametrize(
    ("mu", "preload", "frequencies"),
    [
        (0.3219, 4.768, (1.15, 1.2)),  # passes close by a closed curve of folds, which is another
        (0.4386, 5.568, (1.2, 1.245, 1.28, 1.315)),  # two strips beside it end
    ],
)
@pytest.mark.parametrize("condensation", [CONDENSATION, EVERY_MODE])
def test_a_curve_of_folds_along_thin_strips_meets_every_turn_of_the_level(
    mu, preload, frequencies, condensation
):
    """Up to the greatest level that is looked at, and no other."""
    one = load_scene("yang1998").each_curve()[0]
    contact = replace(one.contacts[0], mu=mu, n_0=preload)
    system = System(replace(one, contacts=(contact,), forces=one.forces[:1]), condensation=condensation)
    (curve,) = (curve for turn, curve in folds_of(system, 1.20695) if turn.unfinished)
    assert curve is not None and curve.endings == (FoldCurveEnding.LEVEL, FoldCurveEnding.LEVEL)
    for omega in frequencies:
        turns = sorted(turn.level for turn in solutions(system, omega, np.inf).folds)
        assert sorted(levels_at(curve, omega)) == pytest.approx(turns, rel=5e-3)


def test_a_closed_curve_of_folds_beside_another_is_followed_once_round():
    """It turns the level where the other does not, at 1.28 rad/s."""
    one = load_scene("yang1998").each_curve()[0]
    contact = replace(one.contacts[0], mu=0.3219, n_0=4.768)
    system = System(replace(one, contacts=(contact,), forces=one.forces[:1]))
    turns = sorted(turn.level for turn in solutions(system, 1.28, np.inf).folds)
    assert len(turns) == 2
    for _, curve in folds_of(system, 1.28):
        assert curve is not None and curve.endings == (FoldCurveEnding.CLOSED, FoldCurveEnding.CLOSED)
        assert sorted(levels_at(curve, 1.28)) == pytest.approx(turns, rel=1e-3)


def test_folds_in_corners_are_followed_round_a_closed_curve():
    """From a corner, through others, back to it: each of its points has a fold there by its level curve."""
    system = System(scene("closed_two_modes"), (1, 2, 3, 4, 5))
    curve, *_ = (
        curve
        for turn, curve in folds_of(system, 2.0001)
        if turn.unfinished and abs(turn.level - 1.4895) < 1e-2 and curve is not None
    )
    assert curve.endings == (FoldCurveEnding.CLOSED, FoldCurveEnding.CLOSED)
    for omega in (1.9, 2.1):
        levels = levels_at(curve, omega)
        turns = np.array([turn.level for turn in solutions(system, omega, np.inf).folds])
        assert levels
        for level in levels:
            assert np.abs(turns / level - 1.0).min() < 1e-2


@pytest.mark.parametrize("few", [4, 1])
def test_where_a_curve_of_folds_passes_the_level_one_the_response_has_a_fold(few):
    """The solutions beside the crossings are on branches with folds there, and on none that was known; also
    where folds are followed with fewer harmonics first, which do not have them."""
    options = (LevelCurveOptions(few_harmonics=few, max_gap=np.inf),)
    system = System(scene("closed_impact"), (1, 2, 3, 4), other_options=options)
    known = traced(system)
    found = level_one_crossings(system, known.found, known.branches.paths)
    assert found.uncertain == () and len(found.solutions) == 2
    low, high = sorted(z[-1] for z in found.solutions)
    before = [len(solutions(system, omega, np.inf).solutions) for omega in (low - 0.01, low + 0.01)]
    after = [len(solutions(system, omega, np.inf).solutions) for omega in (high - 0.01, high + 0.01)]
    assert before == [1, 3] and after[0] - after[1] == 2
    assert all(low > omega or omega > high for omega in level_frequencies(system))


@pytest.mark.parametrize(
    "options",
    [
        FoldOptions(max_steps=3),  # steps of a curve
        FoldOptions(max_tangent=0.0),  # no fold is found near the start
        FoldOptions(work_fraction=0.0, min_seconds=0.0),
    ],
)
def test_where_curves_of_folds_are_not_followed_to_their_end_the_crossings_say_so(options):
    """Their points or their work come to an end, or they do not begin."""
    system = System(scene("closed_impact"), (1, 2, 3, 4), other_options=(options,))
    known = traced(system)
    found = level_one_crossings(system, known.found, known.branches.paths)
    low, high = system.scene.frequency_range
    assert found.solutions == () and found.uncertain
    assert all(low <= omega <= high for omega in found.uncertain)


def test_a_closed_curve_of_folds_has_lost_nothing_and_others_their_open_ends():
    z = np.array([[0.0, 1.0, 2.0], [0.0, 3.0, 2.0]])
    assert Folds(z, z, (FoldCurveEnding.STALLED, FoldCurveEnding.LEVEL)).lost == [1.0]
    assert Folds(z, z, (FoldCurveEnding.RANGE, FoldCurveEnding.LONG)).lost == [3.0]
    assert Folds(z, z, (FoldCurveEnding.STALLED, FoldCurveEnding.CLOSED)).lost == []
    assert Folds(z, z, (FoldCurveEnding.CLOSED, FoldCurveEnding.LEVEL)).lost == [1.0]


@pytest.mark.slow
@pytest.mark.parametrize("distance, looked", [(0.4, True), (0.6, False)])
@pytest.mark.parametrize("more", [(), tuple(range(1, 12))])
def test_where_more_harmonics_have_no_motion_beside_a_curve_isolated_branches_are_not_looked_for(
    distance, looked, more
):
    """If these would take too long, and as far as half the motion away; from where they may come is said."""
    options = replace(HARMONIC_BALANCE, work=WorkOptions(max_seconds_repeated=0.0))
    none = (LevelOptions(strong_harmonics=1),)
    system = System(scene("closed_impact"), (1, 2, 3, 4), options=options, other_options=none)
    every = unchecked_response(system)
    main, *isolated = every.traced.branches.paths
    assert isolated
    alone = replace(every.traced, branches=replace(every.traced.branches, paths=(main,)))
    found = with_errors(replace(every, traced=alone, quantities=every.quantities[:1]), ACCURACY)
    (one,) = found.errors
    far = np.full_like(one.truncation, distance), np.zeros_like(one.is_same_curve), np.ones_like(one.peak)
    error = replace(one, truncation=far[0], is_same_curve=far[1], peak=far[2])
    found = replace(found, errors=(error,), max_error=1.0, further=more)
    there = refined(found, ACCURACY, system.scene, lambda *_: None, lambda *_: None).found
    lost, (low, high) = there.traced.folds_lost, system.scene.frequency_range
    assert bool(lost) == (bool(more) and not looked)
    assert all(low <= omega <= high for omega in lost)


def test_where_folds_are_lost_a_response_says_from_where_on():
    """And with what is left of them the closed branch is not found."""
    none = ResponseOptions(others=(FoldOptions(work_fraction=0.0, min_seconds=0.0),))
    curve = traced_curve(scene("closed_impact"), Request((1, 2, 3, 4), ACCURACY, options=none))
    assert curve.complete and curve.folds_uncertain_at and not curve.uncertain_at
    assert curve.summary()["folds_unsure_at"] == curve.folds_uncertain_at
    curve = traced_curve(scene("closed_impact"), Request((1, 2, 3, 4), ACCURACY))
    assert curve.folds_uncertain_at == [] and "folds_unsure_at" not in curve.summary()


KNOWN = Path(__file__).parents[1] / "harmonic_balance/scenes"
MARCHED = [
    # where the curve of folds leads to them, and motions at which marches of the contact law from random
    # states settle, by the method of Runge and Kutta or with steps of a fixed length
    ("loose_isola", (0.977, 1.15), None, 1.05324, (0.4170, np.nan, np.nan, 0.1473), 2e-2),
    ("between_levels", None, 4, 1.266, (9.174, 27.28), 5e-3),
    ("between_levels", None, 6, 1.266, (9.174, 27.28), 5e-3),
    ("far_isola", None, 5, 1.3, (1.107, 3.222, 4.367, 1.662), 5e-3),
    ("far_isola", None, 7, 1.3, (1.107, 3.222, 4.367, 1.662), 5e-3),
    ("cornered_isola", None, 5, 1.0384, (2.51734, 1.44807), 2e-2),
    ("between_resonances", None, 5, 2.0 * np.pi * 222.0, (*[np.nan] * 2, 3.565, *[np.nan] * 4), 1e-2),
]


@pytest.mark.parametrize(("name", "span", "harmonics", "omega", "marched", "within"), MARCHED)
def test_closed_branches_that_marches_settle_on_are_found(name, span, harmonics, omega, marched, within):
    """Each is closed, and the level of the forces passes 1 on it at none of the frequencies that are looked
    at, but for the last: that lies in a wide gap through which a resonance moves as the contacts open. The
    first comes to be with more harmonics than one, the last but one has corners on its curve of folds."""
    one = load_scene(KNOWN / f"{name}.toml").each_curve()[0]
    one = one if span is None else replace(one, frequency_range=span)
    given = None if harmonics is None else tuple(range(1, harmonics + 1))
    curve = traced_curve(one, Request(given, 1e-2))
    off = [np.nanmax(np.abs(amplitude / marched - 1.0)) for amplitude, _ in passings(curve, omega)]
    assert curve.complete and min(off) < within


def isolated_by_harmonics(span):
    """Two blades with shrouds, over a range [Hz]."""
    (one,) = load_scene(KNOWN / "isolated_by_harmonics.toml").each_curve()
    return replace(one, frequency_range=(2.0 * np.pi * span[0], 2.0 * np.pi * span[1]))


def with_a_force_on_the_first_mode(one, amplitude):
    """On a degree of freedom of its own, which moves with the first mode alone, and no contact has."""
    modal = one.modal
    column = np.eye(len(modal.frequency))[:, :1]
    contacts = [
        replace(contact, tangential=np.append(contact.tangential, 0.0), normal=np.append(contact.normal, 0.0))
        for contact in one.contacts
    ]
    forces = [replace(force, direction=np.append(force.direction, 0.0)) for force in one.forces]
    dofs = (*modal.dofs, "first")
    return replace(
        one,
        modal=replace(modal, dofs=dofs, shapes=np.hstack([modal.shapes, column])),
        reported=dofs,
        contacts=tuple(contacts),
        forces=(*forces, Force(np.eye(len(dofs))[-1], amplitude, 0.0)),
    )


def off_at_886_hz(one, harmonics, marched):
    """How far the nearest branch is from what marches by the method of Runge and Kutta settle at."""
    given = None if harmonics is None else tuple(range(1, harmonics + 1))
    curve = traced_curve(one, Request(given, 1e-2))
    at = list(one.modal.dofs).index("9x")
    near = [amplitude[at] for amplitude, _ in passings(curve, 2.0 * np.pi * 886.0)]
    assert curve.complete
    return min(abs(one / marched - 1.0) for one in near)


@pytest.mark.parametrize("span", [(150.0, 950.0), (500.0, 1100.0), (700.0, 1100.0), (850.0, 1100.0)])
@pytest.mark.parametrize("harmonics", [3, None])
def test_a_peak_that_more_harmonics_have_isolated_is_found_in_any_range(span, harmonics):
    """One harmonic has it connected, at 895 Hz. Three have it from 884.4 to 907.5 Hz, and no level of the
    forces is followed there, but for where the peak was. Of 96 random states 14 settle on it."""
    assert off_at_886_hz(isolated_by_harmonics(span), harmonics, 0.02561) < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize(("amplitude", "marched"), [(-50.0, 0.02544), (600.0, 0.02864)])
def test_a_peak_that_more_harmonics_have_isolated_is_found_under_other_forces(amplitude, marched):
    """Of 96 random states 15 and 9 settle on it."""
    one = with_a_force_on_the_first_mode(isolated_by_harmonics((150.0, 1100.0)), amplitude)
    assert off_at_886_hz(one, 3, marched) < 1e-2


def test_a_closed_branch_is_traced_once():
    """From 1.2585 to 1.3581 rad/s; two crossings of the level 1 lead to it."""
    one = load_scene(KNOWN / "far_isola.toml").each_curve()[0]
    found = every_branch(System(one, (1, 2, 3, 4, 5))).traced.branches
    (closed,) = (path for path in found.paths if path.status is Status.CLOSED)
    assert len(closed.where(Mark.FOLD)) == 2


@pytest.mark.slow
def test_a_strip_that_ends_nowhere_is_crossed_once():
    """Crossed again and again, a search for folds never ended, and heeded no signal: so in a process."""
    done = python(*AS_A_MODULE, "respond", SCENES / "endless_strip.toml", "--json", "--peaks-only")
    assert done.code == 0 and json.loads(done.out)["curves"][0]["complete"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [22, 23, 611])
def test_curves_of_folds_from_narrow_strips_are_followed_to_their_end(seed):
    """Some begin within strips that a circle of the first step's length reaches beyond. Where a curve touches
    others, rounding may end it: so of several scenes that differ by that, most."""
    scene, ended = random_scene(seed), []
    for rounding in (0.0, 1e-15, -1e-15, 1e-14, -1e-14):
        contacts = tuple(replace(one, n_0=one.n_0 * (1.0 + rounding)) for one in scene.contacts)
        response = traced_curve(replace(scene, contacts=contacts), Request((1, 2, 3)))
        ended.append(bool(response.folds_uncertain_at))
    assert sum(ended) < 3


@pytest.mark.slow
def test_curves_of_folds_with_sharp_tips_lead_to_closed_branches():
    """Where a tip was not passed, or not seen by tangents of the step before, two branches were missing."""
    curve = traced_curve(random_scene(25), Request((1, 2, 3)))
    closed = [part for part in branches_of(curve) if part[0][0] == part[0][-1]]
    ranges = [(omega.min(), omega.max()) for omega, *_ in closed]
    for low, high in ((0.5065, 0.5118), (0.684, 0.718)):
        assert any(begin < low and high < end for begin, end in ranges)
        assert len(list(passings(curve, 0.5 * (low + high)))) >= 3


@pytest.mark.parametrize("count", [8, pytest.param(17, marks=pytest.mark.slow)])
def test_an_isolated_branch_that_few_harmonics_place_elsewhere_is_found_with_more(count):
    """With five harmonics it is no branch of its own; with more its end at 1.117 is below their peak.

    Its height by ten harmonics, where that of the other branch is 21.
    """
    curve = traced_curve(random_scene(1), Request(tuple(range(1, count + 1))))
    assert curve.complete and not curve.folds_uncertain_at and len(curve.isolated) == 1
    ten = every_branch(System(random_scene(1), tuple(range(1, 11))))
    highest = max(one.amplitude[:, 0].max() for one in ten.quantities)
    assert highest > 27.0 and curve.peaks["d0"].amplitude == pytest.approx(highest, rel=5e-3)
