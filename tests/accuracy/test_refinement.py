"""Harmonics chosen for an accuracy."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fcm.accuracy import outline, refinement
from fcm.accuracy.options import RefinementOptions
from fcm.accuracy.outline import UncheckedResponse, unchecked_response
from fcm.accuracy.refinement import enlarged, refined_response, with_errors, with_estimated_errors
from fcm.branches import force_level, shared_levels, trace
from fcm.continuation import follow
from fcm.continuation.all_branches import contains
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.modal_condensation import CONDENSATION
from fcm.harmonic_balance.options import HARMONIC_BALANCE
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.response.request import Request
from fcm.response.trace import traced_curve

from ..harmonic_balance.truth import scene

EXACT = {
    300: 7.517e-5,
    100: 2.590e-5,
    20: 6.147e-6,
    10: 3.853e-6,
    7.5: 6.806e-6,
}  # peaks of 40z, exact motion


def test_a_linear_response_takes_one_harmonic_and_one_pass(monkeypatch):
    passes = []
    traced = outline.traced
    monkeypatch.setattr(outline, "traced", lambda *args: passes.append(args) or traced(*args))
    found = refined_response(System(scene("yang1998", 100)), 1e-6)
    assert found.system.harmonics == (1,)
    assert found.reached
    assert found.max_error == 0.0
    assert len(passes) == 1


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
        shown.amplitude[:, at].max()
        for path, shown in zip(found.traced.branches.paths, found.shown, strict=True)
        if path.parameter.min() == one.frequency_range[0]
    ]
    assert max(heights) == pytest.approx(EXACT[preload], rel=2e-2)


@pytest.mark.parametrize("preload", [300, 100])
def test_a_blade_to_a_tenth_of_a_percent(preload):
    one = scene("shroud", preload)
    found = refined_response(System(one), 1e-3)
    assert found.reached
    at = list(one.modal.dofs).index("40z")
    height = max(shown.amplitude[:, at].max() for shown in found.shown)
    assert height == pytest.approx(EXACT[preload], rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("case", [("yang1998", 5), ("yang1998", -5), ("gap5", None), ("stuck_mean", None)])
def test_peaks_are_as_accurate_as_was_asked_for(case, accuracy):
    found = refined_response(System(scene(*case)), accuracy)
    assert found.reached
    many = with_estimated_errors(System(scene(*case), tuple(range(1, 32))), 0.0)
    true = many.shown[0].amplitude.max(axis=0)
    assert np.abs(found.shown[0].amplitude.max(axis=0) / true - 1.0).max() < 1.5 * accuracy


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


def test_folds_that_cannot_be_told_ask_for_no_more_harmonics(monkeypatch):
    """The same harmonics as where they can, and this is said."""
    system = System(scene("yang1998", 5))
    known, real = refined_response(system, 1e-2), refinement.with_nearest

    def untold(*args):
        return tuple(
            replace(one, fold=np.where(np.arange(one.fold.size) == 0, np.nan, one.fold))
            for one in real(*args)
        )

    monkeypatch.setattr(refinement, "with_nearest", untold)
    found = refined_response(system, 1e-2)
    assert known.reached and not found.reached
    assert found.system.harmonics == known.system.harmonics
    assert np.isnan(found.max_error) and not found.further
    assert np.count_nonzero(np.isnan(found.folds)) == 1
    assert found.max_known_error == max(found.peak.max(), np.nanmax(found.folds)) <= 1e-2


def test_levels_are_followed_with_the_last_harmonics_and_lead_to_no_branch_that_is_missed(monkeypatch):
    """The rounds between go on from the branches of fewer harmonics; every solution is on a branch."""
    followed, passes = [], []
    found_at, led = trace.solutions_at, outline.traced_from
    monkeypatch.setattr(
        trace, "solutions_at", lambda one, *a: followed.append(one.harmonics) or found_at(one, *a)
    )
    monkeypatch.setattr(outline, "traced_from", lambda one, *a: passes.append(one.harmonics) or led(one, *a))
    found = refined_response(System(scene("yang1998", 5)), 1e-4)
    last = found.system.harmonics
    assert found.reached and len(passes) == 2 and passes[-1] == last
    assert followed == [(1,), last]
    for omega in force_level.level_frequencies(found.system):
        for z in force_level.solutions(found.system, omega).solutions:
            assert any(contains(path, z, found.system.new_balance()) for path in found.traced.branches.paths)


def test_a_branch_that_fewer_harmonics_do_not_lead_to_is_found_by_the_level_at_last(monkeypatch):
    """As if there were no other way to a closed branch: that is another to be chosen for, too."""
    known = refined_response(System(scene("isola")), 1e-2)
    led, ahead = outline.traced_from, refinement.required_harmonics
    asked: list[int] = []

    def the_first_alone(*args):
        response = led(*args)
        asked.clear()
        return replace(response, branches=replace(response.branches, paths=response.branches.paths[:1]))

    monkeypatch.setattr(outline, "traced_from", the_first_alone)
    monkeypatch.setattr(
        refinement, "required_harmonics", lambda one, *a: asked.append(len(one.shown)) or ahead(one, *a)
    )
    found = refined_response(System(scene("isola")), 1e-2)
    assert asked == [1] and len(known.shown) == 2
    assert found.reached and found.system.harmonics == known.system.harmonics
    assert found.peak == pytest.approx(known.peak, rel=1e-3)
    assert sorted(one.amplitude.max() for one in found.shown) == pytest.approx(
        sorted(one.amplitude.max() for one in known.shown), rel=1e-6
    )


def test_where_the_levels_take_too_long_the_response_is_that_of_fewer_harmonics_and_says_so(monkeypatch):
    system = System(scene("yang1998", 5))
    last = refined_response(system, 1e-4).system.harmonics

    def too_long(one, before):
        if one.harmonics == last:
            raise WorkLimitError
        return with_levels(one, before)

    with_levels = outline.with_levels
    monkeypatch.setattr(outline, "with_levels", too_long)
    found = refined_response(System(system.scene), 1e-4)
    assert found.further == last and found.begun and not found.reached
    assert {1} < set(found.system.harmonics) < set(last)
    assert all(one.harmonics == found.system.harmonics for one in found.traced.found)


def test_what_has_been_taken_counts_in_what_takes_too_long(monkeypatch):
    """A round that alone is not too long is not begun after others."""
    system = System(scene("yang1998", 5))
    enough, taken = refined_response(system, 1e-4), system.work.seconds
    assert enough.reached and not enough.begun
    monkeypatch.setattr(outline, "MAX_SECONDS", taken)
    monkeypatch.setattr(UncheckedResponse, "seconds_with", lambda *_: 0.9 * taken)
    found = refined_response(System(system.scene), 1e-4)
    assert not found.reached and not found.begun
    assert set(found.system.harmonics) > {1}
    assert set(found.further) > set(found.system.harmonics)


def test_what_is_taken_is_levels_branches_and_error_points(monkeypatch):
    """Of levels and branches as counted from outside, by evaluations of balances of their sizes; curves of
    folds, which are followed in the level as well, take no more than these again."""
    shared_levels.clear()  # those that another test has followed
    system = System(scene("yang1998", 5), (1, 2, 3))
    paths = {}
    for module in (force_level, trace):
        some = paths[module] = []
        keep = some.append
        monkeypatch.setattr(
            module, "follow", lambda *a, keep=keep, **k: keep(path := follow(*a, **k)) or path
        )
    found = unchecked_response(system)
    assert paths[force_level] and paths[trace]
    evaluations = sum(path.evaluations for some in paths.values() for path in some)
    counted = seconds_of(system, evaluations, 3)
    assert counted <= found.seconds < 2.0 * counted
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


def test_a_round_that_takes_longer_than_was_foreseen_is_given_up(monkeypatch):
    """And that of fewer harmonics before it stays, with its error."""
    system = System(scene("yang1998", 5))
    first = unchecked_response(system)
    monkeypatch.setattr(UncheckedResponse, "seconds_with", lambda *_: 0.0)
    monkeypatch.setattr(outline, "MAX_SECONDS", 1.01 * first.seconds)
    found = refined_response(System(system.scene), 1e-3)
    assert found.begun and set(found.further) > {1, 2, 3}
    assert found.system.harmonics == (1,) and not found.reached
    assert found.max_error == pytest.approx(0.062, rel=0.1)
    assert found.system.work.limit == np.inf
    curve = traced_curve(system.scene, Request(harmonics=None, accuracy=1e-3))
    assert "with 1 harmonic an estimated error of 6" in curve.short_of
    assert "; more were given up after" in curve.short_of
    assert {int(h) for h in re.split("[, ]", curve.short_of.split("--harmonics ")[1])} <= set(found.further)


def test_what_would_take_too_long_is_said(monkeypatch):
    monkeypatch.setattr(outline, "MAX_SECONDS", 0.0)
    found = refined_response(System(scene("yang1998", 5)), 1e-3)
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


def test_where_nothing_is_told_of_more_harmonics_they_take_no_longer_than_some_seconds(monkeypatch):
    """The lowest three are added all the same: one harmonic may have a branch of no motion at all."""
    own = refinement.required_harmonics
    monkeypatch.setattr(
        refinement, "required_harmonics", lambda *a: replace(own(*a), change=0.0, is_known=False)
    )
    monkeypatch.setattr(outline, "REFINEMENT", RefinementOptions(max_doubtful_seconds=0.0))
    found = refined_response(System(scene("yang1998", 5)), 1e-4)
    assert found.system.harmonics == (1, 2, 3) and not found.reached
    assert set(found.further) > {1, 2, 3} and not found.begun
    monkeypatch.setattr(outline, "REFINEMENT", RefinementOptions(max_doubtful_seconds=np.inf))
    assert set(refined_response(System(scene("yang1998", 5)), 1e-4).system.harmonics) > {1, 2, 3}


def test_the_highest_of_more_harmonics_are_left_out_where_they_take_too_long():
    found = unchecked_response(System(scene("yang1998", 5)))
    every = (1, 2, 3, 5, 9)
    for count in (3, 4, 5):
        assert found.limited_harmonics(found.seconds_with(every[:count]), every) == every[:count]
    assert found.limited_harmonics(0.0, every) == (1, 2, 3)
    assert found.limited_harmonics(0.0, (1, 2)) == (1, 2)
