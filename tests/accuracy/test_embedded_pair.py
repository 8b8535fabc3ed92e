"""Estimated errors beside the true ones."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from fcm.accuracy.budget import Budget, share_of
from fcm.accuracy.embedded_pair import errors_along
from fcm.accuracy.options import PAIR, VALIDITY
from fcm.accuracy.refinement import with_errors
from fcm.accuracy.stability_validity import on_other_branch
from fcm.accuracy.unchecked_response import unchecked_response
from fcm.continuation import Mark, Status
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkCount
from fcm.response import trace
from fcm.response.exact import trace_exact
from fcm.scene import load_scene, scene_from_dict
from fcm.shooting import periodic
from fcm.shooting.harmonic_balance_state import state_of
from fcm.shooting.problem import OrbitProblem
from fcm.stability.floquet import multipliers

from ..harmonic_balance.scenes import up_to
from ..harmonic_balance.strips import strip
from ..harmonic_balance.truth import Truth, exact, scene
from ..response.random_peaks import height
from ..response.random_scenes import random_scene
from .calibration import points, with_estimated_errors

EXACT_FOLDS = {5: (1.239829, 1.193559)}  # of the exact motion: `trace_exact`, to 1e-6


def test_where_nothing_slips_or_opens_there_is_no_error():
    for preload in (100, -60):
        for harmonics in ((1,), (1, 2, 3)):
            found = with_estimated_errors(System(scene("yang1998", preload), harmonics), 0.0)
            assert found.max_error == 0.0
            assert (found.errors[0].amplitude == 0.0).all()
            assert (found.errors[0].truncation == 0.0).all()


@pytest.mark.parametrize("preload", [5, 0, -5])
@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3)])
def test_points_beside_the_exact_motion(preload, harmonics):
    """Nine in ten within a factor of two, none low by more than three."""
    pairs, _, _, exact = points(System(scene("yang1998", preload), harmonics), 60)
    pairs = pairs[pairs.max(axis=1) > 1e-3]
    assert len(pairs) > 5
    assert exact > 10
    ratio = pairs[:, 0] / pairs[:, 1]
    assert np.mean((ratio > 0.5) & (ratio < 2.0)) >= 0.9
    assert ratio.min() > 1.0 / 3.0


def test_points_at_which_harmonics_left_out_meet_a_mode_beside_the_exact_motion():
    """The mode at 10 rad/s and the tenth to fourteenth: the error swings from a point to the next."""
    pairs, _, _, exact = points(System(scene("yang1998", 0), (1, 2, 3)), 1000)
    pairs = pairs[pairs.max(axis=1) > 1e-3]
    assert min(len(pairs), exact) > 100
    assert (pairs[:, 0] / pairs[:, 1]).min() > 1.0 / 3.0


@pytest.mark.parametrize("preload", [20, 10, 5, 2, 0, -5, -20])
def test_peaks_beside_those_of_many_harmonics(preload):
    system = System(scene("yang1998", preload))
    many = with_estimated_errors(system.with_harmonics(tuple(range(1, 22))), 0.0)
    height = many.quantities[0].amplitude.max(axis=0)
    for harmonics in ((1,), (1, 2), (1, 2, 3)):
        found = with_estimated_errors(system.with_harmonics(harmonics), 0.0)
        true = np.abs(height / found.quantities[0].amplitude.max(axis=0) - 1.0)
        for known, is_really in zip(found.peak, true, strict=True):
            if is_really > 1e-3:
                assert is_really / 2.0 < known < is_really * 2.0
            else:
                assert known < 3e-3


def test_folds_beside_those_of_the_exact_motion():
    found = with_estimated_errors(System(scene("yang1998", 5)), 0.0)
    (path,) = found.traced.branches.paths
    folds = path.parameter[path.where(Mark.FOLD)]
    true = np.abs(np.array(EXACT_FOLDS[5]) / folds - 1.0)
    assert true.max() > 4e-3
    assert found.errors[0].fold == pytest.approx(true, rel=0.5)


def test_the_error_of_a_closed_branch_of_twice_the_true_height():
    """That of one harmonic of `isola`, where no point of more harmonics lies normal to the curve."""
    system = System(scene("isola"))
    found, many = (
        with_estimated_errors(system, 0.0),
        with_estimated_errors(system.with_harmonics(up_to(15)), 0.0),
    )
    height, true = (
        np.max([one.amplitude.max(axis=0) for one in each.quantities], axis=0) for each in (found, many)
    )
    off = np.abs(true / height - 1.0)
    assert off.max() > 0.4
    assert found.peak == pytest.approx(off, rel=0.1)


def test_errors_and_multipliers_do_not_depend_on_the_curve_before():
    """What the contacts of one curve were looked at with is taken again for the next, in the same thread."""

    def errors_of(preload):
        found = with_estimated_errors(System(scene("yang1998", preload)), 0.0)
        (path,) = found.traced.branches.paths
        top = found.quantities[0].amplitude[:, 0].argmax()
        return found.errors[0].amplitude, found.peak, multipliers(found.system, path.z[top])

    with ThreadPoolExecutor(1) as alone:
        expected = alone.submit(errors_of, 5).result()
    for before in (-5, 20):
        errors_of(before)
        for found, value in zip(errors_of(5), expected, strict=True):
            assert np.array_equal(found, value, equal_nan=True)


def test_errors_do_not_depend_on_the_direction():
    """But for the points between which they are interpolated, and the harmonics shared between them."""
    found = with_estimated_errors(System(scene("gap5"), (1, 2, 3)), 0.0)
    (path,) = found.traced.branches.paths
    back = errors_along(found.system, path.backwards())
    assert back.peak == pytest.approx(found.errors[0].peak, rel=0.1)
    assert back.fold[::-1] == pytest.approx(found.errors[0].fold, rel=0.1)
    for errors in (back, found.errors[0]):
        assert (errors.truncation[np.isfinite(errors.truncation)] >= 0.0).all()


def test_a_fold_at_a_corner_has_an_error_too():
    found = with_estimated_errors(System(scene("fam2").unstressed(), (1, 2, 3, 4, 5)), 0.0)
    (errors,) = found.errors
    assert len(errors.fold) == 2
    assert (errors.fold < 1e-4).all()


def test_an_unstable_closed_branch_has_the_error_of_the_exact_motion():
    """Its peak lies beside a fold: Newton at once leads elsewhere, by and by to it."""
    system = System(scene("shroud", 10))
    found, truth = with_estimated_errors(system, 0.0), Truth(system)
    path, amplitude = max(
        (
            (path, quantities.amplitude)
            for path, quantities in zip(found.traced.branches.paths, found.quantities, strict=True)
        ),
        key=lambda one: one[1].max(),
    )
    for d in (0, 2):
        top = int(amplitude[:, d].argmax())
        motion = exact(truth.many, truth.beside(path.z[top], path.direction[top]))
        true = abs(motion[d] / amplitude[top, d] - 1.0)
        assert true > 0.05
        assert found.peak[d] == pytest.approx(true, rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "harmonics", "span", "dofs"),
    [(100, (*up_to(8), 12, 17), (1.5, 1.6), (3,)), (181, up_to(6), (2.0, 2.2), (2, 3, 4))],
)
def test_the_errors_of_peaks_of_irregular_curves_are_those_of_the_exact_motion(seed, harmonics, span, dofs):
    """One is a corner that moves along its curve; the others lie where each place is corrected by chance."""
    one = replace(random_scene(seed), harmonics=harmonics, frequency_range=span)
    found = with_estimated_errors(System(one, harmonics), 0.0)
    problem, known = OrbitProblem(one), []
    for d in dofs:
        now = found.quantities[0].amplitude[:, d].max()
        true = abs(now / height(found, problem, known, 0, d) - 1.0)
        assert true > 4e-4 and found.peak[d] == pytest.approx(true, rel=0.25)


def test_what_hardly_moves_says_nothing_of_what_moves():
    """Rounding alone moves v, by one part in 1e16 of u."""
    system = System(load_scene("extreme/no-normal-motion"), (1, 2, 3))
    found, many = (
        with_estimated_errors(system, 0.0),
        with_estimated_errors(system.with_harmonics((1, 3, 5, 7, 9)), 0.0),
    )
    u = list(system.scene.modal.dofs).index("u")
    top, true = (max(one.amplitude[:, u].max() for one in each.quantities) for each in (found, many))
    assert abs(top / true - 1.0) <= 3.0 * found.peak[u] <= 3e-4
    truncation = np.concatenate([one.truncation for one in found.errors])
    assert np.nanmax(truncation) < 0.1


@pytest.mark.slow
def test_a_peak_that_more_harmonics_have_elsewhere_is_as_wrong_as_their_greatest():
    """None of their motions lies beside that of three harmonics."""
    one = random_scene(15)
    found, many = (
        with_estimated_errors(System(one, up_to(3)), 0.0),
        unchecked_response(System(one, up_to(9))),
    )
    assert not any(errors.is_same_curve.any() for errors in found.errors)
    top, true = (
        np.max([quantities.amplitude.max(axis=0) for quantities in each.quantities], axis=0)
        for each in (found, many)
    )
    error = np.abs(true / top - 1.0)
    extends = top.argmax()
    assert 0.5 * error[extends] < found.peak[extends] < 2.0 * error[extends]
    assert (found.peak > error / 3.0).all()


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "harmonics"), [(12, (1,)), (14, (1, 2, 3))])
def test_beside_what_is_astray_many_harmonics_have_no_motion(seed, harmonics):
    """Nor is it called stable in a response. A stretch is astray by how many points it has."""
    one = replace(random_scene(seed), harmonics=None, max_step=0.03)
    found = with_estimated_errors(System(one, harmonics), 0.0)
    (path,), (errors,) = found.traced.branches.paths, found.errors
    far = np.flatnonzero(on_other_branch(errors.on_same_branch))
    assert len(far) > 64
    assert (
        np.mean(errors.truncation[far] <= VALIDITY.max_error) < 0.1
    )  # from what else there is at that frequency
    truth = Truth(found.system)
    some = far[np.linspace(0, len(far) - 1, 12).astype(int)]
    lost = [truth.beside(path.z[i], path.direction[i]) is None for i in some]
    assert np.mean(lost) > 0.9
    (curve,) = trace(one, harmonics=harmonics).curves
    beyond = np.isfinite(curve.frequency) & ~(curve.truncation_error <= VALIDITY.max_error)
    assert beyond.sum() > 64
    assert not (curve.stable[beyond] == 1.0).any()


def test_a_branch_that_more_harmonics_do_not_have_is_as_far_as_the_motion_there():
    """The closed branch of one harmonic has up to ten times the amplitude of the motion from rest."""
    one = random_scene(8)
    found = with_estimated_errors(System(one), 0.0)
    path, quantities, errors = found.traced.branches.paths[1], found.quantities[1], found.errors[1]
    assert path.status is Status.CLOSED and not errors.is_same_curve.any()
    assert np.isfinite(errors.amplitude).all()
    for i in range(5, len(path.z), 40):
        motion = periodic(one, float(path.parameter[i])).measure.amplitude
        off = np.abs(motion / quantities.amplitude[i] - 1.0)
        whole = np.abs(motion - quantities.amplitude[i]).max() / quantities.amplitude[i].max()
        assert errors.amplitude[i] == pytest.approx(np.maximum(off, whole), rel=0.1)


@pytest.mark.parametrize(
    ("name", "omegas"),
    [("stiff-tangential", (1.015, 1.025, 1.035)), ("stiff-tangential-soft-normal", (1.04, 1.052, 1.06))],
)
def test_where_curve_and_reference_cross_the_error_is_that_of_the_reference(name, omegas):
    """Their amplitudes are the same to 6e-4 where the exact motion is 8e-2 off."""
    one = load_scene(f"extreme/{name}")
    found = with_estimated_errors(System(one), 0.0)
    (path,), (quantities,), (errors,) = found.traced.branches.paths, found.quantities, found.errors
    for omega in omegas:
        i = int(np.abs(path.parameter - omega).argmin())
        start = state_of(one, (1,), path.z[i])
        motion = periodic(one, float(path.parameter[i]), start).measure.amplitude
        true = np.abs(motion / quantities.amplitude[i] - 1.0)
        assert (errors.amplitude[i] > true / 3.0).all()


def test_a_harmonic_that_moves_a_peak_by_nothing_does_not_speak_for_the_others():
    """The second meets a mode of little damping and moves peaks by 3e-6, all of them by 200 times as much."""
    one = replace(random_scene(7309), harmonics=None)
    (first,), (many,) = (trace(one, harmonics=tuple(range(1, h + 1))).curves for h in (1, 9))
    for dof, peak in first.peaks.items():
        true = abs(many.peaks[dof].amplitude / peak.amplitude - 1.0)
        assert true > 1e-4 and true / 2.0 < peak.error < 2.0 * true


@pytest.mark.slow
def test_what_is_lost_beside_what_is_not_believed_is_not_called_stable():
    """One harmonic has a branch of three times the amplitude down to 1.643 rad/s; that of the exact motion
    ends before, so that at 1.6487 there is nothing but the low motion."""
    contacts = [
        {"name": "a", "tangential": "p", "normal": "s", "mu": 0.0539, "k_u": 0.6884, "k_v": 7.7463},
        {"name": "b", "tangential": "s", "normal": "q", "mu": 0.017, "k_u": 0.2485, "k_v": 0.1655},
    ]
    isolated = scene_from_dict(
        {
            "modal": {
                "dofs": ["p", "q", "r", "s"], "frequency": [1.0], "damping": [0.04328],
                "shapes": [[0.783, 1.287, 1.769, 0.903]],
            },
            "contact": [one | {"n_0": n_0} for one, n_0 in zip(contacts, (1.0859, 3.0617), strict=True)],
            "force": [{"dof": "s", "amplitude": 0.8124, "phase": 3.0352}],
            "response": {"frequency": [0.645, 1.8362], "harmonics": 1},
        }
    )  # fmt: skip
    (exact,), (curve,) = trace_exact(isolated).curves, trace(isolated).curves

    def passing(one):
        """Amplitudes of r at which a curve passes 1.6487 rad/s where it is said to be stable."""
        ways = (one.frequency[:-1] - 1.6487) * (one.frequency[1:] - 1.6487) <= 0.0
        return one.amplitude[:-1][ways & (one.stable[:-1] == 1.0), 2]

    assert exact.complete and curve.amplitude[:, 2][np.isfinite(curve.frequency)].max() > 8.0
    (true,), (found,) = passing(exact), passing(curve)
    assert found == pytest.approx(true, rel=0.05) and true < 0.3


@pytest.mark.slow
def test_a_row_of_contacts_in_partial_slip_is_told_of_everywhere():
    """Of one harmonic, by more than a tenth; the peaks beside those of six harmonics."""
    few, many = (with_estimated_errors(System(strip(), tuple(up_to(count))), 0.0) for count in (1, 6))
    (errors,) = few.errors
    assert np.isfinite(errors.truncation).mean() > 0.9
    heights = np.array(
        [
            np.max([quantities.amplitude.max(axis=0) for quantities in x.quantities], axis=0)
            for x in (few, many)
        ]
    )
    true = np.abs(heights[1] / heights[0] - 1.0)
    assert np.median(true) > 0.1
    assert (few.peak > true / 1.1).all() and (few.peak < 1.1 * true).all()


def test_points_are_moved_to_the_reference_as_the_work_allows():
    """An interrupted curve is not looked at for longer than somebody waits."""
    system = System(strip(), (1,))
    outline = with_estimated_errors(system, np.inf)
    path = outline.traced.branches.paths[0]
    every = errors_along(system, path)
    none = replace(PAIR, max_seconds=0.0, max_point_seconds=0.0, max_second_unknowns=0)
    some = errors_along(system, path, options=none)
    assert np.isfinite(every.truncation).mean() > 0.9
    told = np.isfinite(some.truncation)
    assert not told.any()


@pytest.mark.slow
def test_a_curve_of_which_more_harmonics_have_another_is_told_of():
    """Four contacts that rattle: from hardly a point of three harmonics Newton's method leads to one of more.

    The true errors are those to the nearest motion of 15 harmonics, of which all branches were traced from
    levels of the forces: 3.7 % or less of a tenth of the points, 12.6 % of half, 55 % of nine tenths.
    """
    found = with_estimated_errors(System(random_scene(4), (1, 2, 3)), 1e-2)
    beside = np.concatenate([one.is_same_curve for one in found.errors])
    told = np.concatenate([one.truncation for one in found.errors])
    assert beside.mean() < 0.2 and np.isfinite(told).mean() > 0.9
    less, half, most = np.nanquantile(told, (0.1, 0.5, 0.9))
    assert half == pytest.approx(0.126, rel=0.3)
    assert 0.037 / 2.0 < less < 0.037 * 2.0 and 0.552 / 2.0 < most < 0.552 * 2.0


@pytest.mark.slow
def test_a_reference_that_is_another_curve_is_told_of_by_fewer_harmonics_where_its_own_take_long():
    """As far as the work allows three times as many harmonics come along a curve that four times do not: a
    fifth of all points are told of by them alone."""
    outline = unchecked_response(System(random_scene(7), (1, 2, 3)))
    told, count = [], []
    for options in (PAIR, replace(PAIR, fewer_factors=())):
        errors = with_errors(outline, 1e-2, options=options).errors
        told.append(np.concatenate([np.isfinite(one.truncation) for one in errors]).mean())
        count.append(len(errors[0].reference))
    assert count[0] < count[1] and told[0] > told[1] + 0.2


def test_the_reference_of_a_further_branch_takes_no_more_than_its_part_of_the_work():
    """A branch that took a tenth of the evaluations is not looked at as long as all of them are."""
    work, part = WorkCount(), share_of([900, 100], 1)
    work.add(1.0)
    (one,) = Budget.of(work, PAIR, part).shares(1)
    assert one.seconds == pytest.approx(0.1 * max(PAIR.work_fraction, PAIR.min_seconds))
    assert Budget.elsewhere(work, PAIR, part).seconds == pytest.approx(0.1 * PAIR.work_fraction_elsewhere)


def test_points_of_a_curve_without_length_have_no_neighbours_to_be_compared_with():
    """Two points that are one, as of a branch that is lost where it begins: nothing is told of them."""
    system = System(scene("yang1998", 5), (1,))
    path = unchecked_response(system).traced.branches.paths[0]
    twice = np.repeat(path.where(Mark.PEAK)[:1], 2)
    found = errors_along(system, path.part(twice))
    assert not found.pieces
    assert not found.is_same_curve.any()
