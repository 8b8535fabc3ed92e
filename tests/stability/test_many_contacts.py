"""Stability along a curve of many contacts: of which few points are looked at, and of few harmonics."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.accuracy.embedded_pair import errors_along
from fcm.branches.trace import traced
from fcm.cli.caveats import not_confirmed
from fcm.harmonic_balance.residual_spectrum import enriched_harmonics
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.response.options import ResponseOptions
from fcm.shooting import periodic
from fcm.stability.bifurcations import stability
from fcm.stability.confirmation import ConfirmedPoints, confirmed_stable
from fcm.stability.floquet import multipliers_of
from fcm.stability.known_motions import KnownMotions
from fcm.stability.options import STABILITY
from fcm.stability.rebalanced import Rebalancing

from ..harmonic_balance.strips import elastic_strip, strip
from ..harmonic_balance.truth import state


@pytest.mark.slow
@pytest.mark.parametrize(("harmonics", "looks"), [((1,), 0.4), ((1, 2, 3), 0.5)])
def test_few_points_tell_the_stability_of_all(harmonics, looks):
    """Beside the multipliers of every point, as far as these tell."""
    system = System(strip(), harmonics)
    path = traced(system).branches.paths[0]
    found = stability(system, path)
    assert found.evaluations < looks * len(path.z)
    of = multipliers_of(system, float(path.parameter.max()))
    even = path.orientation * np.sign(path.direction[:, -1]) > 0.0
    assert not found.stable[~even & (path.mark == 0)].any()
    each = np.array([of.classify(z).stable for z in path.z[even]])
    told = ~np.isnan(each) & ~np.isnan(found.stable[even])
    assert told.mean() > 0.9
    assert (each[told] == found.stable[even][told]).all()


def exact(system, z):
    """The exact motion beside a solution, from that with further harmonics at its frequency."""
    refined = Rebalancing(system, enriched_harmonics(list(system.harmonics)))
    there = refined.rebalance(z, refined.system.extended(z, system.harmonics)[:-1])
    return periodic(system.scene, float(z[-1]), state(refined.system, there))


def test_one_harmonic_tells_where_the_exact_motion_of_many_contacts_flips():
    """Its own multipliers have a real one of 1.5 there, which the determinant of its balance denies."""
    system = System(elastic_strip((12.4, 20.0)), (1,))
    path = traced(system).branches.paths[-1]  # lifted off at one end
    found = stability(system, path)
    assert np.isnan(found.stable).mean() < 0.02
    first, last = (one.frequency for one in found.crossings)
    for omega in (0.98 * first, 1.01 * first, 0.99 * last, 1.02 * last):
        z = path.z[np.abs(path.parameter - omega).argmin()]
        assert exact(system, z).stable == (not first < z[-1] < last)
    told = np.where((path.parameter > first) & (path.parameter < last), 0.0, 1.0)
    assert np.nanmax(np.abs(told - found.stable)) == 0.0


def test_what_errs_by_a_fifth_is_told_where_further_harmonics_confirm_it():
    """Of one harmonic; the exact motion says the same."""
    scene = elastic_strip((11.04, 11.2))
    curve = trace(scene, harmonics=1).curves[0]
    assert curve.truncation_error.min() > 0.2
    assert (curve.stable == 1.0).all()
    system = System(scene, (1,))
    path = traced(system).branches.paths[0]
    for z in path.z[:: len(path.z) - 1]:
        assert exact(system, z).stable


@pytest.mark.slow
def test_what_more_harmonics_do_not_have_is_no_steady_state():
    """Of one harmonic, below the fold at which the upper branch of five turns back."""
    one, five = (trace(elastic_strip((11.0, 20.0)), harmonics=h).curves[0] for h in (1, 5))
    upper = one.amplitude.max(axis=1) > 0.2
    (fold,) = (f for f in five.folds if 11.6 < f < 11.7)
    below, above = upper & (one.frequency < 0.998 * fold), upper & (one.frequency > 1.005 * fold)
    assert below.sum() > 20 and (one.truncation_error[below] > 0.9).all()
    assert not one.stable[below].any()
    assert (one.stable[above] == 1.0).sum() > 5 and not np.isnan(one.stable[above]).any()


def test_points_between_two_that_are_confirmed_are_confirmed():
    """Against looks at single points; the upper branch of more harmonics ends at 11.64 rad/s."""
    system = System(elastic_strip((11.3, 20.0)), (1,))
    path = traced(system).branches.paths[-1]
    to_confirm = (path.parameter > 11.35) & (path.parameter < 13.0)
    found = confirmed_stable(system, path.z, to_confirm).stable
    of = multipliers_of(system, float(path.parameter.max()))
    some = np.flatnonzero(to_confirm)[::4]
    assert not found[~to_confirm].any()
    assert found[some].tolist() == [of.confirms(z, 1.0) for z in path.z[some]]
    assert 0.2 < found[to_confirm].mean() < 0.9


def test_of_many_contacts_no_more_than_a_part_of_the_points_are_looked_at():
    """Without any look nothing is confirmed; fewer looks confirm no other points."""
    system = System(elastic_strip((11.3, 20.0)), (1,))
    path = traced(system).branches.paths[-1]
    to_confirm = (path.parameter > 11.35) & (path.parameter < 13.0)
    whole = confirmed_stable(system, path.z, to_confirm)
    assert not whole.limited
    for part in (0.0, 0.02):
        few = replace(STABILITY, confirmation=replace(STABILITY.confirmation, max_fraction_of_many=part))
        looks = ConfirmedPoints(system, path.z, few)
        known = [looks.at(int(i)) for i in np.flatnonzero(to_confirm)]
        assert len(looks.known) <= part * len(path.z)
        assert sum(not np.isnan(one.stable) for one in known) <= len(looks.known)
        found = confirmed_stable(system, path.z, to_confirm, options=few)
        assert found.limited and not (found.stable & ~whole.stable).any()


def test_that_no_more_points_were_looked_at_is_said_with_their_number():
    few = replace(STABILITY, confirmation=replace(STABILITY.confirmation, max_fraction_of_many=0.02))
    curves = [
        trace(elastic_strip((11.04, 11.2)), harmonics=1, options=options).curves[0]
        for options in (ResponseOptions(others=(few,)), ResponseOptions())
    ]
    unknown = [int(np.isnan(one.stable[np.isfinite(one.frequency)]).sum()) for one in curves]
    assert [one.not_confirmed for one in curves] == unknown == [unknown[0], 0] and unknown[0] > 10
    said = not_confirmed({"curves": [{"stability_not_confirmed": one.not_confirmed} for one in curves]})
    assert said.startswith(f"at {unknown[0]} points stability is unknown. ")
    assert not_confirmed({"curves": [{}]}) == ""


def test_what_confirms_lacks_little_with_twice_the_harmonics_if_need_be():
    """Of one harmonic: seven may lack more than is believed, and fourteen less."""
    system = System(elastic_strip((11.3, 20.0)), (1,))
    path, told = traced(system).branches.paths[-1], []
    z = path.z[int(np.abs(path.parameter - 12.0).argmin())]
    left = []
    for more in (enriched_harmonics([1]), enriched_harmonics(enriched_harmonics([1]))):
        finer = system.with_harmonics(tuple(more))
        motion = multipliers_of(finer, float(path.parameter.max())).finer
        motion.at(Rebalancing(system, more).rebalance(z, finer.extended(z, (1,))[:-1]))
        left.append(motion.shift)
    assert left[1] < 0.5 * left[0]
    for most in (1.5 * left[0], 0.5 * sum(left), 0.5 * left[1]):
        strict = replace(STABILITY, confirmation=replace(STABILITY.confirmation, max_addition=most))
        told.append(multipliers_of(system, float(path.parameter.max()), strict).confirms(z, 1.0))
    assert told == [True, True, False]


@pytest.mark.slow
def test_a_motion_that_is_far_is_found_from_beside_the_next_points():
    """As at each point by itself, down to 11.64 rad/s, where the upper branch of more harmonics ends."""
    system = System(elastic_strip((11.3, 20.0)), (1,))
    path = traced(system).branches.paths[-1]
    inside = np.flatnonzero((path.parameter > 11.35) & (path.parameter < 13.0))
    way = inside if path.parameter[inside[0]] > path.parameter[inside[-1]] else inside[::-1]
    found, looks = np.zeros(len(path.z), dtype=bool), ConfirmedPoints(system, path.z, STABILITY)
    looks.along(int(way[0]), int(way[-1]), found)
    assert not found[np.setdiff1d(np.arange(len(found)), inside)].any()
    reached = path.parameter[way[1:]][found[way[1:]]].min()
    assert 11.64 < reached < 11.75
    assert found[way[1:]].tolist() == (path.parameter[way[1:]] >= reached).tolist()
    alone = ConfirmedPoints(system, path.z, STABILITY)
    assert found[way[1:]].tolist() == [alone.confirms(int(i)) for i in way[1:]]


def test_what_tells_the_error_leads_to_the_motion_that_confirms():
    """The same is confirmed, down to 11.64 rad/s, where the upper branch of more harmonics ends."""
    system = System(elastic_strip((11.3, 20.0)), (1,))
    path = traced(system).branches.paths[-1]
    motions = errors_along(system, path).motions
    inside = np.flatnonzero((path.parameter > 11.35) & (path.parameter < 13.0))
    looks = ConfirmedPoints(system, path.z, STABILITY, np.ones(len(path.z), dtype=bool), motions)
    found = np.array([looks.confirms(int(i)) for i in inside])
    assert not found[path.parameter[inside] < 11.64].any()
    assert found[path.parameter[inside] > 11.75].all()


def test_of_known_motions_the_nearest_at_the_frequency_is_taken():
    """Between two of each piece, on a curve that passes the frequency twice."""
    system = System(strip(), (1,))
    size = system.new_balance().unknowns
    z = np.append(np.full(size, 0.4), 1.05)
    up = np.column_stack((np.outer([0.0, 1.0], np.ones(size)), [1.0, 1.1]))
    down = np.column_stack((np.outer([2.0, 1.0], np.ones(size)), [1.0, 1.1]))
    known = KnownMotions((1,), (np.concatenate((up, down[::-1])), down[:1]))
    np.testing.assert_allclose(known.interpolate(system, z), np.append(np.full(size, 0.5), 1.05))
    np.testing.assert_allclose(
        known.interpolate(system, z + 1.2 * (z < 1.0)), np.append(np.full(size, 1.5), 1.05)
    )
    assert known.interpolate(system, np.append(np.full(size, 0.4), 1.2)) is None


def test_close_to_the_last_solution_the_same_is_found_sooner():
    """As each by itself, beside points of the upper branch one after the other."""
    system = System(elastic_strip((11.3, 20.0)), (1,))
    path = traced(system).branches.paths[-1]
    more = enriched_harmonics([1])
    row = Rebalancing(system, more)
    evaluations = []
    for z in path.z[(path.parameter > 13.0) & (path.parameter < 15.0)][:4]:
        alone = Rebalancing(system, more)
        x = row.system.extended(z, (1,))[:-1]
        expected = alone.rebalance(z, x)
        before = row.newton.evaluations + row.damped.newton.evaluations
        found = row.rebalance(z, x)
        each = row.newton.evaluations + row.damped.newton.evaluations - before
        evaluations.append((each, alone.newton.evaluations + alone.damped.newton.evaluations))
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * np.abs(z[:-1]).max())
    assert evaluations[0][0] == evaluations[0][1]
    assert sum(each for each, _ in evaluations[1:]) < sum(alone for _, alone in evaluations[1:])


@pytest.mark.slow
def test_where_the_pair_has_no_neighbour_none_is_sought(monkeypatch):
    """There a doubt is left, as it is where one is sought and not found; elsewhere the same is told."""
    looked = []
    rebalance = Rebalancing.rebalance

    def recorded(self, z, *rest):
        looked.append(float(z[-1]))
        return rebalance(self, z, *rest)

    monkeypatch.setattr(Rebalancing, "rebalance", recorded)
    system = System(elastic_strip((11.3, 20.0)), (1,))
    path = traced(system).branches.paths[-1]
    sought = stability(system, path)
    alone = path.parameter < 11.45  # the upper branch of more harmonics ends at 11.64 rad/s
    assert any(omega < 11.45 for omega in looked)
    looked.clear()
    left = stability(system, path, without_neighbour=alone)
    assert looked and not any(omega < 11.45 for omega in looked)
    np.testing.assert_array_equal(left.stable, sought.stable)
    every = stability(system, path, without_neighbour=np.ones(len(path.z), dtype=bool))
    lost = np.isnan(every.stable) & ~np.isnan(sought.stable)
    assert lost.any() and (every.stable[~lost] == sought.stable[~lost])[~np.isnan(sought.stable[~lost])].all()


@pytest.mark.slow
def test_three_harmonics_tell_the_stability_beside_the_fold_at_which_the_upper_branch_ends():
    """One of both motions, balanced and finer, has a real multiplier above 1; the exact motion is stable."""
    system = System(elastic_strip((11.3, 20.0)), (1, 2, 3))
    path = traced(system).branches.paths[-1]
    of = multipliers_of(system, float(path.parameter.max()))
    even = path.orientation * np.sign(path.direction[:, -1]) > 0.0
    beside = path.z[even & (path.parameter > 11.7) & (path.parameter < 11.9)]
    assert len(beside) > 4
    for z in beside[:: len(beside) // 4]:
        assert of.classify(z).stable == 1.0
    assert exact(system, beside[0]).stable
