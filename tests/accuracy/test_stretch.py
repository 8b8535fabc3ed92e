"""Errors where no point of the curve of more harmonics lies beside that of fewer; what is called stable."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.accuracy import refinement
from fcm.accuracy.budget import Budget
from fcm.accuracy.embedded_pair import errors_along
from fcm.accuracy.options import OF_GIVEN, PAIR
from fcm.accuracy.reference_curve import ReferenceCurve
from fcm.accuracy.reference_harmonics import prolongation_to
from fcm.accuracy.reference_pieces import ReportedPath
from fcm.accuracy.reference_stretch import StretchFollower
from fcm.accuracy.refinement import with_given_harmonics
from fcm.branches.trace import traced
from fcm.continuation import Status
from fcm.harmonic_balance.contact_cycles import ContactRecord
from fcm.harmonic_balance.options import HARMONIC_BALANCE, WorkOptions
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.response.exact import trace_exact
from fcm.scene import scene_from_dict
from fcm.shooting import periodic
from fcm.shooting.harmonic_balance_state import state_of

from ..harmonic_balance.strips import elastic_strip, planar_strip, strip


def test_errors_where_a_corner_has_moved_are_those_at_the_same_frequency():
    """The exact motion differs by 6 to 9 % from that of three harmonics."""
    one = scene_from_dict(
        {
            "modal": {
                "dofs": ["p", "q", "r"], "frequency": [1.0, 2.534, 2.654],
                "damping": [0.0058, 0.0057, 0.0329],
                "shapes": [[-0.631, -0.37, 1.199], [-1.776, 1.221, -0.43], [1.571, 0.519, 1.129]],
            },
            "contact": [
                {"name": "c", "tangential": "p", "normal": "r", "mu": 0.2959, "k_u": 2.432, "k_v": 0.1821,
                 "n_0": 2.227}
            ],
            "force": [
                {"dof": {"p": -1.134, "q": 0.1549, "r": -0.5379}, "amplitude": 1.0, "phase": 6.208,
                 "proportional_to": "omega^2"},
                {"dof": {"p": -1.207, "q": -0.0488, "r": 0.2229}, "amplitude": 1.0, "phase": 2.22,
                 "proportional_to": "omega^2"},
            ],
            "response": {"frequency": [0.815, 1.3]},
        }
    )  # fmt: skip
    found = with_given_harmonics(System(one, (1, 2, 3)))
    (path,), (quantities,), (errors,) = found.traced.branches.paths, found.quantities, found.errors
    some = np.flatnonzero((path.parameter > 0.996) & (path.parameter < 1.0005))
    assert some.size > 8
    for i in some[:: some.size // 4]:
        exact = periodic(one, float(path.parameter[i]), state_of(one, (1, 2, 3), path.z[i]))
        off = np.abs(exact.measure.amplitude - quantities.amplitude[i]).max() / quantities.amplitude[i].max()
        assert 0.05 < off < 0.1
        np.testing.assert_allclose(errors.truncation[i], off, rtol=0.1)


@pytest.mark.slow
def test_a_wide_stretch_whose_error_is_not_known_is_not_called_stable():
    """Three harmonics have a branch of a hundred times the amplitude down to 0.7 rad/s, that of the exact
    motion ends before 0.74."""
    one = scene_from_dict(
        {
            "modal": {
                "dofs": ["p", "q", "r"], "frequency": [0.1536, 3.616], "damping": [0.0474, 0.0182],
                "shapes": [[0.956, -0.152, -1.186], [0.928, 0.961, -0.97]],
            },
            "contact": [
                {"name": "a", "tangential": "p", "normal": "r", "mu": 0.4963, "k_u": 0.3449, "k_v": 0.4722,
                 "n_0": 0.1783},
                {"name": "b", "tangential": "q", "normal": "r", "mu": 0.1279, "k_u": 0.1145, "k_v": 1.309,
                 "n_0": 2.562},
            ],
            "force": [{"dof": {"p": -2.018, "q": 0.7729, "r": -1.563}, "amplitude": 1.0, "phase": 3.45}],
            "response": {"frequency": [0.55, 1.2]},
        }
    )  # fmt: skip
    (exact,) = trace_exact(replace(one, frequency_range=(0.72, 0.76))).curves
    (curve,) = trace(one, harmonics=(1, 2, 3)).curves

    def stable_at(one):
        """Amplitudes at which a curve passes 0.74 rad/s where it is said to be stable."""
        ways = (one.frequency[:-1] - 0.74) * (one.frequency[1:] - 0.74) <= 0.0
        return one.amplitude[:-1][ways & (one.stable[:-1] == 1.0)].max(axis=1)

    assert exact.complete and stable_at(exact).max() < 0.2
    assert np.nanmax(curve.amplitude) > 10.0 and stable_at(curve).max(initial=0.0) < 0.2


def test_the_reference_is_followed_to_the_other_end_of_a_stretch_and_no_further():
    system, more = System(planar_strip(frequency=(1.0, 1.2)), (1,)), (1, 2, 3)
    path, finer = traced(system).branches.paths[0], system.with_harmonics(more)
    prolongation = prolongation_to(system, more)
    follower = StretchFollower(system, finer, prolongation, path, OF_GIVEN, Budget(1e3))
    first = int(np.flatnonzero(path.parameter > 1.05)[0])
    assert (np.diff(path.parameter[first : first + 3]) > 0.0).all()
    (piece,) = follower.between(first, first + 2, nowhere(path, prolongation))
    low, high = path.parameter[[first, first + 2]]
    assert piece.reached_end and piece.path.status is Status.EVENT
    assert piece.path.parameter.max() - piece.path.parameter.min() == pytest.approx(high - low, rel=0.1)


def nowhere(path, prolongation):
    """No motion of the reference is known at any point of a path."""
    return np.full((len(path.z), len(prolongation.newton.z)), np.nan)


def found_reference(system, path, more):
    """The reference of a path, beside which its points are looked for."""
    quantities, loads = reported_quantities(system, path), ContactRecord.at(system, path.z).contact_loads
    reported = ReportedPath(path, quantities, loads.reshape(len(loads), -1))
    reference = ReferenceCurve(system, reported, more, OF_GIVEN, Budget(1e3))
    reference.displacements(np.array([0, len(path.z) - 1]))
    return reference


def test_a_stretch_begins_where_the_reference_was_found_from_beside_another_point():
    """Of many contacts it is not found from these points alone."""
    system, more = System(strip(), (1,)), (1, 2, 3)
    (path,) = traced(system).branches.paths
    reference = found_reference(system, path, more)
    follower, found = reference.stretches, reference.reference_unknowns
    first, last = 96, 104
    assert np.isfinite(found[[first, last]]).all()
    (piece,) = follower.between(first, last, found)
    assert piece.reached_end
    for end, row in ((piece.path.z[0], first), (piece.path.z[-1], last)):
        np.testing.assert_allclose(end, found[row], rtol=0.0, atol=1e-5 * np.abs(found[row]).max())
    alone = prolongation_to(system, more)
    assert not any(alone.find_normal(path.z[row], path.direction[row], True) for row in (first, last))


def test_a_stretch_without_ends_is_followed_from_the_nearest_that_was_found():
    """At the beginning of a curve, from points there that are too far from the reference."""
    system, more = System(planar_strip(frequency=(1.0, 1.2)), (1,)), (1, 2, 3)
    path, prolongation = traced(system).branches.paths[0], prolongation_to(system, more)
    found = found_reference(system, path, more).reference_unknowns
    z, astray = path.z.copy(), 20
    z[:astray, :-1] *= 30.0
    found[:astray] = np.nan
    finer = system.with_harmonics(more)
    follower = StretchFollower(system, finer, prolongation, replace(path, z=z), OF_GIVEN, Budget(1e3))
    (piece,) = follower.between(-1, 6, found)
    assert piece.whole and piece.passes(path.parameter[:7])
    assert prolongation.find_at_frequency(finer.extended(path.z[0], system.harmonics), True)
    expected = np.array(prolongation.newton.z)
    np.testing.assert_allclose(piece.path.z[-1], expected, rtol=0.0, atol=1e-3 * np.abs(expected).max())


@pytest.mark.slow
def test_of_many_contacts_what_is_not_traced_again_has_the_errors_of_given_harmonics(monkeypatch):
    """Although the pair may not be followed while harmonics are chosen."""
    unfollowed = replace(PAIR, work_fraction=0.0, min_seconds=0.0)
    monkeypatch.setattr(refinement, "PAIR", unfollowed)
    short = replace(HARMONIC_BALANCE, work=WorkOptions(max_seconds=0.05, max_seconds_repeated=0.0))
    found = refinement.refined_response(System(elastic_strip((11.3, 20.0)), (1,), options=short), 1e-5)
    assert not found.agrees and found.system.harmonics == (1,)
    chosen, given = (refinement.with_errors(found, accuracy) for accuracy in (1e-5, np.inf))
    told = [[int(one.is_same_curve.sum()) for one in each.errors] for each in (chosen, given, found)]
    assert told[2] == told[1] and sum(told[1]) > sum(told[0])


def test_each_look_at_the_reference_of_many_contacts_may_interrupt():
    system = System(planar_strip(frequency=(1.0, 1.1)), (1,))
    path = traced(system).branches.paths[0]
    polled = []
    system.work.poll = lambda: polled.append(1)
    few = errors_along(system, path, options=replace(OF_GIVEN, point_interval=len(path.z)))
    assert np.isfinite(few.truncation).any()
    assert len(polled) > 8  # of the ends, and of peaks

    def interrupt():
        raise KeyboardInterrupt

    system.work.poll = interrupt
    with pytest.raises(KeyboardInterrupt):
        errors_along(system, path)
    system.work.poll = int
    again = errors_along(system, path, options=replace(OF_GIVEN, point_interval=len(path.z)))
    np.testing.assert_allclose(again.truncation, few.truncation, rtol=1e-6)
