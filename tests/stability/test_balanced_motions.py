"""Stability of balanced solutions: against the exact motion's multipliers, and what must hold of any."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from fcm import load_scene
from fcm.branches.force_level import solutions
from fcm.continuation import FollowOptions, Mark, Status, follow
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.response.options import ResponseOptions
from fcm.scene import Contact, Force, Modal, Scene, scene_from_dict
from fcm.shooting import periodic
from fcm.stability.bifurcation_functions import multiplier_sample, predicted_minimum
from fcm.stability.bifurcations import stability, with_points
from fcm.stability.classification import Bifurcation, Classification, MultiplierSpectrum, classify_even
from fcm.stability.confirmation import confirmed_stable
from fcm.stability.floquet import multipliers
from fcm.stability.multipliers import Multipliers
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.time_domain import simulate

from ..harmonic_balance.strips import strip
from ..harmonic_balance.truth import state
from ..time_domain.cases import SCENES, one_mode, yang


def system(scene, highest=1, span=None):
    scene = scene if span is None else replace(scene, frequency_range=span)
    return System(scene, tuple(range(1, highest + 1)))


def only(scene, omega, highest):
    """The balanced solution where there is one."""
    found = solutions(system(scene, highest), omega)
    assert found.complete
    (z,) = found.solutions
    return z


def path(scene, highest, span):
    of = system(scene, highest, span)
    start = solutions(of, span[0]).solutions[0]
    found = follow(of.new_balance(), start, span, options=FollowOptions(scene.max_step))
    assert found.status is Status.COMPLETE
    return of, found


def exact(scene, omega):
    """Floquet's multipliers of the exact motion, without those of contacts that never slip."""
    values = periodic(scene, omega).multipliers
    return values[np.abs(values - 1.0) > 1e-9]


def error(found, true):
    """Greatest distance of the greater multipliers from those found."""
    left = list(found)
    greatest = 0.0
    for value in true[np.abs(true) > 0.2]:
        nearest = min(left, key=lambda x: abs(x - value))
        left.remove(nearest)
        greatest = max(greatest, abs(nearest - value))
    return greatest


@pytest.mark.parametrize("preload", [5.0, 0.0, -5.0])
def test_of_several_points_each_verdict_is_as_alone(preload):
    """However many matrices are held at once: what one needs of its motion is not that of another."""
    of, found = path(yang(preload), 1, (0.7, 1.7))
    at_fold = ((found.mark & Mark.FOLD) > 0).tolist()
    workspace = Multipliers(of, 1.7)
    alone = [workspace.classify(z, fold) for z, fold in zip(found.z, at_fold, strict=True)]
    assert preload != 0.0 or {0.0, 1.0} <= {one.stable for one in alone}
    for held in (1, 100, 100_000):
        options = replace(STABILITY, structure=replace(STABILITY.structure, max_entries=held))
        together = Multipliers(of, 1.7, options=options).classify_all(
            list(found.z), at_fold, [False] * len(at_fold)
        )
        assert repr(together) == repr(alone)  # NaN is not equal to itself


@pytest.mark.parametrize("preload", [5.0, 0.0, -5.0])
def test_few_points_tell_where_further_harmonics_confirm_one(preload):
    """Beside every point: without preload a window where they do not lies between two where they do."""
    of, found = path(yang(preload), 1, (0.7, 1.7))
    even = found.orientation * np.sign(found.direction[:, -1]) > 0.0
    workspace = Multipliers(of, 1.7)
    each = np.array([workspace.confirmation(z).stable == 1.0 for z in found.z]) & even
    assert 0.9 < each[even].mean() < 1.0
    np.testing.assert_array_equal(confirmed_stable(of, found.z, even).stable, each)


def test_each_look_at_a_motion_of_many_contacts_may_interrupt():
    of, found = path(strip(), 1, (0.9, 1.5))
    polled = []
    of.work.poll = lambda: polled.append(1)
    assert 0 < stability(of, found).evaluations <= len(polled)


def test_of_what_further_harmonics_are_to_confirm_the_finer_motion_is_enough():
    """The same is told, by fewer motions: that of the balanced harmonics is not looked at besides."""
    of, found = path(strip(), 1, (0.9, 1.5))
    told, looks = [], []
    for to_confirm in (False, True):
        polled = []
        of.work.poll = lambda polled=polled: polled.append(1)
        told.append(stability(of, found, to_confirm=np.full(len(found.z), to_confirm)).stable)
        looks.append(len(polled))
    both = ~np.isnan(told[0])
    assert both.any()
    np.testing.assert_array_equal(told[0][both], told[1][both])
    assert looks[1] < looks[0]


@pytest.mark.parametrize(("preload", "looks"), [(5.0, 0.6), (0.0, 0.8), (-5.0, 0.6)])
def test_few_points_tell_the_stability_of_three_harmonics(preload, looks):
    """Beside the multipliers of every point: without preload a pair leaves, and comes back."""
    of, found = path(yang(preload), 3, (0.7, 1.7))
    judged = stability(of, found)
    assert judged.evaluations < looks * len(found.z)
    even = found.orientation * np.sign(found.direction[:, -1]) > 0.0
    workspace = Multipliers(of, 1.7)
    each = np.array([workspace.classify(z).stable for z in found.z[even]])
    told = ~np.isnan(each) & ~np.isnan(judged.stable[even])
    assert told.mean() > 0.9
    assert (each[told] == judged.stable[even][told]).all()


@pytest.mark.parametrize(
    ("scene", "omega"),
    [
        (SCENES["n_0 = 5"], 1.3),
        (SCENES["n_0 = 0"], 1.1),
        (SCENES["n_0 = -2"], 1.2),
        (SCENES["one mode"], 1.1),
        (SCENES["two contacts"], 1.3),
        (SCENES["two contacts"], 2.3),
        (yang(0.0), 0.745),  # where only an unstable motion has the forces' period
        (yang(-2.0, mu=0.0), 1.2),  # impacts without friction
        (yang(5.0, k_v=0.0), 1.2),  # a constant load
    ],
)
def test_multipliers_come_to_those_of_the_exact_motion(scene, omega):
    true = exact(scene, omega)
    errors = [error(multipliers(system(scene, h), only(scene, omega, h)), true) for h in (1, 3, 9, 21)]
    assert errors[0] < 0.5
    assert errors[-1] < 1e-4
    assert errors[-1] < 0.1 * max(errors[:2]) or errors[0] < 1e-8


def test_a_linear_motion_has_the_multipliers_of_its_matrix():
    scene, omega = yang(100.0), 0.9
    contact, modal = scene.contacts[0], scene.modal
    ports = modal.shapes @ np.array([contact.tangential, contact.normal]).T
    stiffness = np.diag(modal.frequency**2) + ports @ np.diag([contact.k_u, contact.k_v]) @ ports.T
    matrix = np.block(
        [[np.zeros((2, 2)), np.eye(2)], [-stiffness, -np.diag(2.0 * modal.damping * modal.frequency)]]
    )
    true = np.linalg.eigvals(expm(matrix * 2.0 * np.pi / omega))
    assert error(multipliers(system(scene), only(scene, omega, 1)), true) < 1e-11


@pytest.mark.parametrize("n_0", [400.0, -60.0])
def test_what_stays_stuck_or_open_is_stable(n_0):
    of, found = path(yang(n_0), 1, (0.9, 1.6))
    assert (stability(of, found).stable == 1.0).all()


@pytest.mark.parametrize("highest", [1, 3, 9])
def test_stability_changes_at_the_folds_and_nowhere_else(highest):
    of, found = path(yang(5.0), highest, (1.15, 1.3))
    first, last = found.where(Mark.FOLD)
    result = stability(of, found)
    assert result.crossings == ()
    expected = np.ones(found.z.shape[0])
    expected[first + 1 : last] = 0.0
    np.testing.assert_array_equal(result.stable, expected)


def test_the_same_backwards():
    of, found = path(yang(5.0), 3, (1.15, 1.3))
    np.testing.assert_array_equal(stability(of, found.backwards()).stable[::-1], stability(of, found).stable)


def test_the_determinant_of_a_path_from_within():
    of = system(yang(5.0), 3, (1.15, 1.3))
    start = solutions(of, 1.25).solutions[0]
    found = follow(
        of.new_balance(), start, (1.15, 1.3), options=FollowOptions(0.05), forward=False
    ).backwards()
    problem = of.new_balance()
    for z, direction, orientation in zip(found.z, found.direction, found.orientation, strict=True):
        problem.evaluate(z)
        sign = np.linalg.slogdet(np.asarray(problem.jacobian)[:, :-1])[0]
        assert abs(direction[-1]) < 1e-8 or sign == orientation * np.sign(direction[-1])


def test_flips_are_where_the_exact_motion_has_them():
    scene = yang(0.0)
    of, found = path(scene, 5, (0.7, 0.82))
    result = stability(of, found)
    assert [crossing.kind for crossing in result.crossings] == [
        Bifurcation.PERIOD_DOUBLING,
        Bifurcation.PERIOD_DOUBLING,
    ]
    for crossing, inwards in zip(result.crossings, (1.0, -1.0), strict=True):
        assert 0.0 < found.parameter[crossing.after + 1] - crossing.frequency
        assert abs(multipliers(of, crossing.z)[0] + 1.0) < 1e-6
        for side in (-1.0, 1.0):
            omega = crossing.frequency + side * inwards * 2e-3
            assert periodic(scene, omega).stable == (side < 0.0)
    between = (found.parameter > result.crossings[0].frequency) & (
        found.parameter < result.crossings[1].frequency
    )
    assert between.any()
    np.testing.assert_array_equal(result.stable, np.where(between, 0.0, 1.0))
    unsaid = stability(of, found, between)
    np.testing.assert_array_equal(unsaid.stable, np.where(between, np.nan, 1.0))
    assert not unsaid.crossings and unsaid.evaluations < result.evaluations


@pytest.mark.parametrize(
    ("n_0", "damping", "window"), [(0.0, 0.02, (0.72, 0.78)), (0.5, 0.013, (0.765, 0.795))]
)
@pytest.mark.parametrize("step", [0.2, 0.1])
def test_a_window_between_two_points_is_found(n_0, damping, window, step):
    scene = yang(n_0)
    scene = replace(scene, modal=replace(scene.modal, damping=np.array([damping, 0.01])), max_step=step)
    of, found = path(scene, 3, (0.6, 0.95))
    result = stability(of, found)
    first, last = (crossing.frequency for crossing in result.crossings)
    grown = []  # slowly: at one frequency after the other
    for omega in np.linspace(*window, 25):
        (z,) = solutions(of, omega).solutions
        grown += [omega] if np.abs(multipliers(of, z)).max() > 1.0 else []
    assert window[0] < first < grown[0] < grown[-1] < last < window[1]
    assert last - first < grown[-1] - grown[0] + 2.0 * (window[1] - window[0]) / 24
    assert [crossing.kind for crossing in result.crossings] == [
        Bifurcation.PERIOD_DOUBLING,
        Bifurcation.PERIOD_DOUBLING,
    ]
    whole = with_points(found, result.inserted)
    stable = np.insert(
        result.stable, [one.after + 1 for one in result.inserted], [one.stable for one in result.inserted]
    )
    inside = (whole.parameter > first) & (whole.parameter < last)
    assert inside.any()
    expected = np.where(inside, 0.0, 1.0)
    expected[np.isin(whole.parameter, (first, last))] = np.nan
    np.testing.assert_array_equal(stable, expected)
    middle = 0.5 * (first + last)
    assert not periodic(scene, middle).stable
    assert all(periodic(scene, omega).stable for omega in window)


def test_a_window_within_one_step_is_the_same_with_points_inside():
    scene = yang(0.5)
    scene = replace(scene, modal=replace(scene.modal, damping=np.array([0.013, 0.01])))
    several = []
    for step in (0.2, 0.05, 0.01, 0.002):
        of, found = path(replace(scene, max_step=step), 3, (0.6, 0.95))
        several.append([crossing.frequency for crossing in stability(of, found).crossings])
    assert len(several[0]) == 2
    for frequencies in several[1:]:
        assert frequencies == pytest.approx(several[0], abs=1e-8)


CHAOS = {
    "modal": {
        "dofs": ["x0", "x1", "x2", "x3"],
        "frequency": [1.0, 1.62696, 4.23908],
        "damping": [0.02276, 0.02928, 0.00643],
        "shapes": [
            [0.3077, 0.5392, -0.5561, -0.6345],
            [0.5528, -0.6721, -0.6525, 0.2908],
            [-0.3247, 0.4356, -0.6287, 0.622],
        ],
    },
    "contact": [
        {"name": "c", "tangential": "x0", "normal": "x1",
         "mu": 0.925, "k_u": 39.978, "k_v": 34.4086, "n_0": 0.6462},
    ],
    "force": [{"dof": "x0", "amplitude": 0.884, "phase": 3.259}],
    "response": {"frequency": [1.37, 1.38]},
}  # fmt: skip


@pytest.mark.parametrize("highest", [3, 9])
def test_an_irregular_motion_is_near_no_stable_solution(highest):
    scene, omega = scene_from_dict(CHAOS), 1.3773
    of = system(scene, highest)
    judge = Multipliers(of, omega)
    found = solutions(of, omega).solutions
    assert found
    assert all(np.abs(judge.of(z)).max() > 1.05 for z in found)
    motion = simulate(scene, omega, 320)
    ends = np.array([measure.amplitude[0] for measure in motion.measures(last=40)])
    assert np.ptp(ends) > 0.02 * ends.mean()


def test_many_modes_that_follow_are_as_good_as_all():
    random = np.random.default_rng(3)
    count = 40
    frequency = np.concatenate(([1.0, 1.7], np.sort(random.uniform(4.0, 60.0, count - 2))))
    shapes = np.concatenate(([[0.7, 0.7], [0.8, -0.6]], 0.5 * random.normal(size=(count - 2, 2))))
    modal = Modal(("u", "v"), np.ones(count), frequency, np.full(count, 0.01), shapes)
    contact = Contact("c", np.array([1.0, 0.0]), np.array([0.0, 1.0]), 0.4, 1.0, 1.0, 0.5)
    scene = Scene("many", modal, (contact,), (Force(np.array([1.0, 0.0]), 0.3, 0.0),), (0.8, 1.2), 0.05)
    z = only(scene, 1.1, 3)
    few = multipliers(system(scene, 3), z)
    followed = replace(STABILITY, structure=replace(STABILITY.structure, many_modes=count))
    all_modes = multipliers(system(scene, 3), z, followed)
    assert few.size < 0.5 * all_modes.size
    assert error(all_modes, few) < 5e-3


def test_a_mode_far_stiffer_than_the_others_changes_nothing_beside_a_rigid_body():
    """Whose eigenvectors are dependent. In steps of the stiff mode a period would be 1e9 of them."""
    frequency = np.array([0.0, 1.0, 1.9, 2.5, 3.1, 4.3, 5.2, 1e9])
    shapes = 0.4 * np.random.default_rng(3).normal(size=(8, 2))
    shapes[0] = 0.5, 0.0
    contact = Contact("c", np.array([1.0, 0.0]), np.array([0.0, 1.0]), 0.4, 1.0, 1.0, 0.5)

    def multipliers_with(modes):
        damping = np.where(frequency > 0.0, 0.01, 0.0)
        modal = Modal(("u", "v"), np.ones(modes), frequency[:modes], damping[:modes], shapes[:modes])
        scene = Scene("stiff", modal, (contact,), (Force(np.array([1.0, 0.0]), 0.5, 0.0),), (0.8, 1.3), 0.05)
        return multipliers(system(scene, 3), only(scene, 1.1, 3))

    without = multipliers_with(7)
    assert without.size >= 14
    assert error(multipliers_with(8), without) < 1e-9


def test_a_rigid_body_that_nothing_holds_is_no_instability():
    free = one_mode(frequency=0.0, damping=0.0, shape=(1.0, 0.0))
    z = only(free, 1.1, 3)
    classified = Multipliers(system(free, 3), 1.1).classify(z)
    assert classified.stable == 1.0


def test_what_is_not_finite_has_no_multipliers():
    scene = yang(5.0)
    z = only(scene, 1.3, 3)
    z[1] = np.nan
    assert multipliers(system(scene, 3), z).size == 0
    assert math.isnan(Multipliers(system(scene, 3), 1.3).classify(z).stable)


PAIR = [0.6 + 0.9j, 0.6 - 0.9j]


@pytest.mark.parametrize(
    ("fine", "plain", "stable"),
    [
        ([0.9, 0.5], [0.9, 0.5], 1.0),
        ([0.9, *PAIR], [0.8, *PAIR], 0.0),
        ([0.9, -1.1], [0.9, -1.1], 0.0),
        ([0.9, -1.1], [0.9, -0.9], math.nan),  # truncation decides
        ([1.3, 1.2], [1.3, 1.2], 0.0),  # an even number
        ([1.01, 0.5], [1.01, 0.5], 1.0),  # the fold is a little farther on, the balance says
        ([1.10, 0.5], [1.16, 0.5], 1.0),  # as it may be
        ([1.30, 0.5], [1.30, 0.5], math.nan),  # and cannot be
        ([1.10, -1.2], [1.16, -1.2], 0.0),
    ],
)
def test_verdicts_of_spectra_with_an_even_number_above_one(fine, plain, stable):
    found = classify_even(*(MultiplierSpectrum([complex(v) for v in values]) for values in (fine, plain)))
    assert found.stable == stable or (math.isnan(stable) and math.isnan(found.stable))
    assert math.isnan(stable) or (found.growth > 0.0) == (stable == 0.0)


GAPS = {
    "structure": {
        "dofs": ["a", "b"],
        "mass": [[1.174, 0.1528], [0.1528, 0.9865]],
        "stiffness": [[6.716, -0.7506], [-0.7506, 5.245]],
        "damping": 0.0134,
    },
    "contact": [
        {"name": "one", "tangential": {"a": 0.39}, "normal": {"b": -1.92}}
        | {"mu": 0.442, "k_u": 0.745, "k_v": 4.082, "n_0": -2.485},
        {"name": "other", "tangential": {"a": -0.74, "b": -0.23}, "normal": {"b": 0.42}}
        | {"mu": 0.52, "k_u": 0.675, "k_v": 5.497, "n_0": -1.127},
    ],
    "force": [{"dof": "b", "amplitude": 1.0, "phase": 1.205}],
    "load": [{"dof": "a", "force": -1.285}],
}


def test_a_window_that_begins_beside_a_place_that_was_looked_at_is_found():
    """From 1.687 to 1.7115; what foretells a window leads to 1.7128, where two pairs have hardly parted."""
    scene = scene_from_dict(GAPS | {"response": {"frequency": [1.5386, 2.872], "harmonics": 7}})
    (curve,) = trace(scene).curves
    inside = (curve.frequency > 1.688) & (curve.frequency < 1.71)
    assert np.abs(exact(scene, 1.70)).max() > 1.0 and (curve.stable[inside] != 1.0).all()
    crossings = curve.frequency[np.isnan(curve.stable) & (curve.frequency < 1.75)]
    assert crossings.size == 2
    for omega, growing in ((crossings.min(), 1.0), (crossings.max(), -1.0)):
        sides = [np.abs(exact(scene, omega + d)).max() for d in (-0.005, 0.005)]
        assert growing * (sides[1] - 1.0) > 0.0 > growing * (sides[0] - 1.0)


def test_multipliers_beyond_all_bounds_are_no_trouble():
    one, other = (
        multiplier_sample(s, Classification(0.0, g, Bifurcation.REAL, values=(1e200 + 0j, 1e160 + 0j)))
        for s, g in ((0.0, 9.0), (1.0, 8.0))
    )
    assert predicted_minimum(one, other, [one, other]) is None


def test_a_pair_and_a_flip_are_told_apart():
    assert MultiplierSpectrum([0.5 + 0j, *PAIR]).classify().kind is Bifurcation.NEIMARK_SACKER
    assert MultiplierSpectrum([0.5 + 0j, -1.2 + 0j]).classify().kind is Bifurcation.PERIOD_DOUBLING


def test_small_disturbances_grow_as_the_multipliers_say():
    scene, omega = yang(5.0), 1.21  # where three solutions are, the middle one unstable
    of = system(scene, 13)
    for z in solutions(of, omega).solutions:
        first = multipliers(of, z)[0]
        orbit = periodic(scene, omega, state(of, z))
        ends = simulate(scene, omega, 6, replace(orbit.state, q=orbit.state.q * (1.0 + 1e-7))).end
        left = np.abs(ends.q - orbit.state.q).max() / np.abs(1e-7 * orbit.state.q).max()
        grows = abs(first) > 1.0
        assert (left > 1.0) == grows


def test_options_that_are_given_with_a_response_are_those_of_its_stability():
    """With a growth that none has, no motion is stable but those without an event, which are linear."""
    strict = StabilityOptions(classification=replace(STABILITY.classification, growth_tolerance=-1e3))
    options = ResponseOptions(others=(strict,))
    (curve,) = trace(load_scene("yang1998-n5"), "closed-form", harmonics=(1,), options=options).curves
    assert set(curve.regime[curve.stable == 1.0].ravel()) == {"E"} < set(curve.regime.ravel())
