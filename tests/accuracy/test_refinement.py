"""Harmonics chosen for an accuracy."""

import re
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from fcm.accuracy.options import RefinementOptions
from fcm.accuracy.refinement import enlarged, refined_response, with_errors
from fcm.accuracy.unchecked_response import prolongated_solutions, unchecked_response, with_more
from fcm.branches import force_level, shared_levels
from fcm.continuation.all_branches import contains
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.modal_condensation import CONDENSATION
from fcm.harmonic_balance.options import HARMONIC_BALANCE, HarmonicBalanceOptions, WorkOptions
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.harmonic_balance.system import System
from fcm.response.accuracy_shortfall import shortfall

from ..harmonic_balance.strips import planar_strip
from ..harmonic_balance.truth import scene
from .calibration import with_estimated_errors


def limited(seconds):
    """Options by which more harmonics may take so long."""
    return HarmonicBalanceOptions(work=WorkOptions(max_seconds=seconds))


EXACT = {
    300: 7.517e-5,
    100: 2.590e-5,
    20: 6.147e-6,
    10: 3.853e-6,
    7.5: 6.806e-6,
}  # peaks of 40z, exact motion


def test_a_linear_response_takes_one_harmonic_and_one_pass():
    kept = []
    found = refined_response(System(scene("yang1998", 100)), 1e-6, on_traced=lambda *told: kept.append(told))
    assert found.system.harmonics == (1,)
    assert found.reached
    assert found.max_error == 0.0
    ((traced, error, more),) = kept  # as soon as it is there, before its error is known; and nothing after it
    assert traced.system.harmonics == (1,) and np.isnan(error) and more == ()


@pytest.mark.slow
@pytest.mark.parametrize("preload", EXACT)
def test_a_blade_to_one_percent(preload):
    one = scene("shroud", preload)
    found = refined_response(System(one), 1e-2)
    assert found.reached
    assert found.max_error <= 1e-2
    at = list(one.modal.dofs).index("40z")
    # closed branches with light preloads are higher at 5500 rad/s and more, and unstable all along
    heights = [
        quantities.amplitude[:, at].max()
        for path, quantities in zip(found.traced.branches.paths, found.quantities, strict=True)
        if path.parameter.min() == one.frequency_range[0]
    ]
    assert max(heights) == pytest.approx(EXACT[preload], rel=2e-2)


@pytest.mark.parametrize("preload", [300, 100])
def test_a_blade_to_a_tenth_of_a_percent(preload):
    one = scene("shroud", preload)
    found = refined_response(System(one), 1e-3)
    assert found.reached
    at = list(one.modal.dofs).index("40z")
    height = max(quantities.amplitude[:, at].max() for quantities in found.quantities)
    assert height == pytest.approx(EXACT[preload], rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("case", [("yang1998", 5), ("yang1998", -5), ("gap5", None), ("stuck_mean", None)])
def test_peaks_are_as_accurate_as_was_asked_for(case, accuracy):
    found = refined_response(System(scene(*case)), accuracy)
    assert found.reached
    many = with_estimated_errors(System(scene(*case), tuple(range(1, 32))), 0.0)
    true = many.quantities[0].amplitude.max(axis=0)
    assert np.abs(found.quantities[0].amplitude.max(axis=0) / true - 1.0).max() < 1.5 * accuracy


def test_a_degree_of_freedom_that_never_moves_changes_no_harmonics():
    """Its amplitude was taken for infinite, and the shares of all for none: one harmonic was enough."""
    alone = scene("yang1998-n5", 5)
    modal = replace(
        alone.modal,
        dofs=(*alone.modal.dofs, "still"),
        shapes=np.column_stack((alone.modal.shapes, np.zeros(len(alone.modal.mass)))),
    )
    contacts = tuple(
        replace(one, tangential=np.append(one.tangential, 0.0), normal=np.append(one.normal, 0.0))
        for one in alone.contacts
    )
    forces = tuple(replace(one, direction=np.append(one.direction, 0.0)) for one in alone.forces)
    beside = replace(alone, modal=modal, contacts=contacts, forces=forces)
    found, other = (refined_response(System(one), 1e-3) for one in (alone, beside))
    assert len(found.system.harmonics) > 1
    assert other.system.harmonics == found.system.harmonics


def test_harmonics_are_chosen_by_need():
    """At n_0 = -5 the ninth meets the mode at 10 rad/s; the fourth to eighth do next to nothing."""
    found = refined_response(System(scene("yang1998", -5)), 2e-3)
    assert 9 in found.system.harmonics
    assert len(found.system.harmonics) < 9


def test_folds_that_cannot_be_told_ask_for_no_more_harmonics():
    """Peaks that cannot be told do."""
    known = refined_response(System(scene("yang1998", 5)), 1e-2)
    assert known.reached and known.agrees
    folds = replace(known, max_error=np.nan)
    peaks = replace(folds, peak=np.full_like(known.peak, np.nan))
    assert not folds.reached and folds.agrees and not peaks.agrees
    assert not replace(folds, max_known_error=2e-2).agrees


def test_levels_are_followed_with_the_last_harmonics_and_lead_to_no_branch_that_is_missed():
    """The rounds between go on from the branches of fewer harmonics; every solution is on a branch."""
    kept = []
    found = refined_response(System(scene("yang1998", 5)), 1e-4, on_traced=lambda one, *_: kept.append(one))
    rounds = [set(h) for h in dict.fromkeys(one.system.harmonics for one in (*kept, found))]
    assert found.reached and len(rounds) == 3 and all(few < more for few, more in pairwise(rounds))
    assert found.before is None  # the levels are followed
    assert {one.harmonics for one in found.traced.found} == {found.system.harmonics}
    for omega in force_level.level_frequencies(found.system):
        for z in force_level.solutions(found.system, omega).solutions:
            assert any(contains(path, z, found.system.new_balance()) for path in found.traced.branches.paths)


def test_a_branch_that_fewer_harmonics_do_not_lead_to_is_found_by_the_level_at_last():
    first, more = unchecked_response(System(scene("isola"))), (1, 2, 3)
    known = unchecked_response(first.system.with_harmonics(more))
    led = first.prolongated(more, prolongated_solutions(first, more), None)
    found = led.with_levels()
    assert len(led.quantities) == 1 and len(found.quantities) == len(known.quantities) == 2
    assert sorted(one.amplitude.max() for one in found.quantities) == pytest.approx(
        sorted(one.amplitude.max() for one in known.quantities), rel=1e-6
    )


def test_where_the_levels_take_too_long_the_branches_of_fewer_harmonics_stay_and_no_level_is_complete():
    first, more = unchecked_response(System(scene("yang1998", 5))), (1, 2, 3)
    then = first.prolongated(more, prolongated_solutions(first, more), None)
    work, begin = then.system.work, then.system.work.seconds
    found = then.with_levels(1.001 * begin)
    spent = work.seconds - begin
    assert work.limit == np.inf
    assert found.system.harmonics == more and found.traced.branches.paths == then.traced.branches.paths
    levels = {one.omega: one.complete for one in found.traced.found}
    assert list(levels) == list(force_level.level_frequencies(found.system)) and not any(levels.values())
    assert all(one.complete for one in then.with_levels().traced.found)
    assert work.seconds - begin - spent > spent


def test_what_has_been_taken_counts_in_what_takes_too_long():
    """A round that alone is not too long is not begun after others."""
    first, more = unchecked_response(System(scene("yang1998", 5))), (1, 2, 3)
    most, work = first.system.options.work.max_seconds, first.system.work
    then, further, _ = with_more(first, more, is_known=True)
    assert then.system.harmonics == more and not further
    work.add(most - work.seconds - 0.5 * first.seconds_with(more))
    assert with_more(first, more, is_known=True) == (None, more, False)


def test_what_is_taken_is_levels_branches_and_error_points():
    """Of branches no less than counted from outside, by evaluations of balances of their size."""
    shared_levels.clear()  # those that another test has followed
    system = System(scene("yang1998", 5), (1, 2, 3))
    found = unchecked_response(system)
    evaluations = sum(path.evaluations for path in found.traced.branches.paths)
    assert found.seconds == system.work.seconds > seconds_of(system, evaluations, 3) > 0.0
    with_errors(found, 1e-3)
    assert system.work.seconds > found.seconds
    assert found.seconds_with((1, 2, 3)) == pytest.approx(found.seconds)


@pytest.mark.parametrize(
    ("contacts", "modes", "taken"),
    [
        (1, 30, (8.7, 23.7, 83, 565)),
        (3, 7, (20.6, 98, 477, 5330)),  # the others are condensed from 20 or 9 harmonics on
        (3, 2, (27, 145, 255, 1205)),
        (10, 4, (199, 360, 1029, 7350)),
    ],
)
def test_an_evaluation_takes_what_was_measured(contacts, modes, taken):
    """Microseconds of processor time of following curves of 3, 9, 20 and 50 harmonics, for each evaluation.

    Measured once where numpy's sine took 15.7 ns, and divided by 1.57; of contacts that stick and slip, or
    open. Where they stick it is down to half as long.
    """
    sizes = SimpleNamespace(
        scene=SimpleNamespace(contacts=[None] * contacts, directions_of_contact=2),
        linear=SimpleNamespace(natural=[1.0] * modes),
        modal_compliance=np.full(modes, np.inf),
        condensation=CONDENSATION,
        options=HARMONIC_BALANCE,
    )
    told = [1e6 * seconds_of(sizes, 1, harmonics) for harmonics in (3, 9, 20, 50)]
    assert np.log(told) == pytest.approx(np.log(taken), abs=np.log(1.3))


def test_a_round_that_takes_longer_than_was_foreseen_is_given_up():
    """And that of fewer harmonics before it stays, with its error."""
    first, more = unchecked_response(System(scene("yang1998", 5))), (1, 2, 3)
    first.prolongated(more, prolongated_solutions(first, more), None)
    system = System(first.system.scene, options=limited(0.99 * first.system.work.seconds))
    foreseen = replace(unchecked_response(system), seconds=0.0)
    assert with_more(foreseen, more, is_known=True) == (None, more, True)
    assert system.work.limit == np.inf


def test_what_was_given_up_is_said():
    found = refined_response(System(scene("yang1998", 5), options=limited(0.0)), 1e-3)
    said = shortfall(replace(found, begun=True), (), 1e-3)
    assert "with 1 harmonic an estimated error of 6" in said
    assert ". More harmonics were given up after some 0 s of work" in said
    more = said.split("--harmonics ")[1].removesuffix(" uses them")
    assert {int(h) for h in re.split("[, ]", more)} <= set(found.further)


def test_what_would_take_too_long_is_said():
    found = refined_response(System(scene("yang1998", 5), options=limited(0.0)), 1e-3)
    assert not found.reached
    assert found.system.harmonics == (1,)
    assert found.max_error == found.max_known_error == pytest.approx(0.062, rel=0.1)
    assert set(found.further) > {1, 2, 3}


def test_no_more_harmonics_are_added_than_some_seconds_allow():
    found = with_estimated_errors(System(scene("yang1998", -5)), 1e-3)
    every = enlarged(found, 1e-4)
    assert {2, 9} < set(every)
    for count in range(1, len(every)):
        seconds = found.seconds_with(every[: count + 1])
        fewer = enlarged(found, 1e-4, seconds)
        assert len(fewer) == count + 1 and {1} < set(fewer) <= set(every)
        assert found.seconds_with(fewer) <= seconds
    assert enlarged(found, 1e-4, 0.0) == (1,)


def test_where_nothing_is_told_of_more_harmonics_they_take_no_longer_than_some_seconds():
    """The lowest three are added all the same: one harmonic may have a branch of no motion at all."""
    first, more = unchecked_response(System(scene("yang1998", 5))), (1, 2, 3, 4, 5)
    for seconds, harmonics in ((0.0, (1, 2, 3)), (np.inf, more)):
        options = RefinementOptions(max_seconds_without_progress=seconds)
        found, further, _ = with_more(first, more, is_known=False, options=options)
        assert found.system.harmonics == harmonics and not further
    none = RefinementOptions(max_seconds_without_progress=0.0)
    assert with_more(found, (*more, 7), is_known=False, options=none) == (None, (*more, 7), False)


@pytest.mark.parametrize("is_known", [True, False])
def test_where_all_that_an_accuracy_takes_is_too_long_the_lowest_three_are_taken(is_known):
    first, more = unchecked_response(System(scene("yang1998", 5))), (1, 2, 3, 4, 5)
    allowed = first.seconds + 0.5 * (first.seconds_with((1, 2, 3)) + first.seconds_with(more))
    first = unchecked_response(System(first.system.scene, options=limited(allowed)))
    quick = RefinementOptions(max_seconds_without_progress=0.0)
    found, further, _ = with_more(first, more, is_known=is_known, options=quick)
    assert found.system.harmonics == (1, 2, 3) and not further
    assert with_more(found, more, is_known=is_known, options=quick) == (None, more, False)


def test_the_highest_of_more_harmonics_are_left_out_where_they_take_too_long():
    found = unchecked_response(System(scene("yang1998", 5)))
    every = (1, 2, 3, 5, 9)
    for count in (3, 4, 5):
        assert found.limited_harmonics(found.seconds_with(every[:count]), every) == every[:count]
    assert found.limited_harmonics(0.0, every) == (1, 2, 3)
    assert found.limited_harmonics(0.0, (1, 2)) == (1, 2)


def test_what_is_shown_of_few_points_is_that_of_all():
    whole = unchecked_response(System(planar_strip(frequency=(1.0, 1.1)), (1,)))
    few = whole.thinned(12)
    (path,), (kept,) = few.traced.branches.paths, few.quantities
    assert len(path.z) < len(whole.traced.branches.paths[0].z)
    np.testing.assert_array_equal(kept.amplitude, reported_quantities(few.system, path).amplitude)
