"""The linear system of many contacts on few modes, condensed to the modes, beside the system itself."""

import itertools
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from fcm.branches.linear_limits import precompute
from fcm.continuation import Events, Mark, follow
from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.modal_condensation import CondensationOptions
from fcm.harmonic_balance.options import HARMONIC_BALANCE, DigitOptions, HarmonicBalanceOptions
from fcm.harmonic_balance.reported_quantities import recorded
from fcm.harmonic_balance.rounding import moved_across_curve, with_precise_fundamental
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict

from .strips import strip

EVERY_MODE = CondensationOptions(min_unknowns=1, max_fraction=1.0, compliance_limits=(0.0,))
WHOLE, CONDENSED = (
    CondensationOptions(min_unknowns=10**9),
    CondensationOptions(min_unknowns=1, max_fraction=1.0),
)


def many_contacts(contacts=36, modes=4):
    rng = np.random.default_rng(5)
    dofs = [f"x{i}" for i in range(2 * contacts)]
    return scene_from_dict(
        {
            "modal": {
                "dofs": dofs,
                "frequency": [1.0, 1.7, 2.9, 4.1][:modes],
                "damping": [0.02] * modes,
                "shapes": rng.normal(size=(modes, len(dofs))).tolist(),
            },
            "contact": [
                {
                    "name": f"c{i}",
                    "tangential": dofs[2 * i],
                    "normal": dofs[2 * i + 1],
                    "mu": 0.3,
                    "k_u": 0.1,
                    "k_v": 0.2,
                    "n_0": float(rng.uniform(-0.5, 1.0)),
                }
                for i in range(contacts)
            ],
            "force": [{"dof": "x0", "amplitude": 1.0}],
            "response": {"frequency": [0.8, 1.3]},
        }
    )


def mostly(n_0, contacts=24, slipping=(0, 23)):
    """A strip of which all contacts but some stay as they are at rest, stuck or open."""
    scene = strip(contacts)
    preloads = [0.02 / contacts if i in slipping else n_0 / contacts for i in range(contacts)]
    held = tuple(replace(one, n_0=n) for one, n in zip(scene.contacts, preloads, strict=True))
    return replace(scene, contacts=held)


def mostly_stuck():
    return mostly(40.0)


def mostly_open():
    return mostly(-40.0)


def jacobian(system, z):
    """By central differences of the residual, (unknown, unknown + 1)."""
    columns = []
    for i in range(z.size):
        step = 1e-6 * max(abs(z[i]), 1e-2)
        ends = []
        for sign in (1.0, -1.0):
            problem, moved = system.new_balance(), z.copy()
            moved[i] += sign * step
            problem.evaluate(moved)
            ends.append(np.array(problem.residual))
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    return np.array(columns).T


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [(1,), (1, 3)])
@pytest.mark.parametrize(
    ("scene", "options"),
    [
        (many_contacts, CONDENSED),
        (strip, CONDENSED),
        (mostly_stuck, EVERY_MODE),
        (mostly_open, EVERY_MODE),
    ],
)
def test_direction_and_orientation_are_those_of_the_whole_system(scene, options, harmonics):
    system = System(scene(), harmonics, condensation=options)
    problem = system.new_balance()
    assert 0 < problem.rank < problem.unknowns
    rng = np.random.default_rng(2)
    z = np.append(rng.normal(size=problem.unknowns), 1.05)
    newton = Newton(problem)
    problem.evaluate_scale(z)
    scale = np.array(problem.scale)
    row = rng.normal(size=z.size)
    row /= np.linalg.norm(row)
    newton.scale[:], newton.row[:], newton.z[:] = scale, row, z
    assert newton.take_tangent()
    whole = np.vstack((jacobian(system, z) * scale / scale[:-1, None], row))
    tangent = np.linalg.solve(whole, np.append(np.zeros(z.size - 1), 1.0))
    np.testing.assert_allclose(newton.tangent, tangent / np.linalg.norm(tangent), atol=1e-6)
    assert newton.orientation == np.sign(np.linalg.det(whole))


def test_orientation_does_not_hang_on_what_is_left_out_of_the_condensed_system():
    """Condensed to one mode the determinant has another sign at some motions near the resonance."""
    few = CondensationOptions(min_unknowns=1, max_fraction=1.0, compliance_limits=(10.0,))
    problem, whole = (System(strip(), (1,), condensation=one).new_balance() for one in (few, WHOLE))
    rng, condensed, found, expected = np.random.default_rng(2), [], [], []
    for omega in np.linspace(0.9, 1.5, 25):
        z = np.append(0.1 * rng.normal(size=problem.unknowns), omega)
        row = rng.normal(size=z.size)
        row /= np.linalg.norm(row)
        for one, signs in ((problem, found), (whole, expected)):
            one.evaluate_scale(z)
            newton = Newton(one)
            newton.scale[:], newton.row[:], newton.z[:] = one.scale, row, z
            assert newton.take_tangent()
            signs.append(newton.orientation)
        condensed.append(problem.factor(row, np.array(problem.scale)))
    assert found == expected != condensed


@pytest.mark.parametrize("harmonics", [(1,), (1, 3)])
@pytest.mark.parametrize("scene", [mostly_stuck, mostly_open])
def test_contacts_that_stay_stuck_or_open_are_condensed(scene, harmonics):
    """The equations are no more than those of the forces that two contacts have beside them."""
    at, solutions, parts = (1.0, 1.15, 1.3), [], 1 + 2 * len(harmonics)
    for options in (EVERY_MODE, WHOLE):
        problem = System(scene(), harmonics, condensation=options).new_balance()
        path = follow(problem, np.append(np.zeros(problem.unknowns), 0.9), (0.9, 1.5), Events(at))
        solutions.append(path.z[np.isin(path.parameter, at)])
        problem.evaluate(path.z[np.flatnonzero(path.parameter == 1.15)[0]])
        assert any(law.nonlinear for law in problem.laws)  # contacts slip or separate
        if options is EVERY_MODE:
            assert problem.condensed is not None and problem.condensed.by_contacts
            assert parts < problem.condensed.linear_contacts.size <= 4 * parts + 1
    found, expected = solutions
    assert len(found) == 3
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected[:, :-1]).max())


def test_a_small_condensed_system_is_solved_as_it_is():
    """Of the same contacts: to condense it to their forces takes longer, as each solution is corrected."""
    rows, solutions = np.append(np.zeros(144), 1.0), []
    for least, by_contacts in ((1, True), (18, True), (19, False)):
        system = System(mostly_stuck(), (1,), condensation=replace(EVERY_MODE, min_unknowns=least))
        problem = system.new_balance()
        assert (problem.unknowns, problem.rank) == (144, 18)
        newton, z = Newton(problem), np.append(np.zeros(problem.unknowns), 1.15)
        problem.evaluate_scale(z)
        newton.scale[:], newton.z[:], newton.row[:] = problem.scale, z, rows
        assert newton.correct(1.0)
        assert problem.condensed.by_contacts == by_contacts
        solutions.append(np.array(newton.z))
    np.testing.assert_allclose(solutions[2], solutions[0], atol=1e-9 * np.abs(solutions[0][:-1]).max())


def test_contacts_that_begin_to_slip_or_open_are_taken_back():
    """By a level of the forces at which all stick, one at which all slip, and back."""
    system = System(strip(24, n_0=3.0), (1, 3), condensation=EVERY_MODE)
    problem, whole = system.new_balance(), System(system.scene, (1, 3), condensation=WHOLE).new_balance()
    rng, holds = np.random.default_rng(3), []
    for size in (1e-3, 1.0, 1e-3):
        z = np.append(size * rng.normal(size=problem.unknowns), 1.05)
        tangents = []
        for one in (problem, whole):
            one.evaluate_scale(z)
            newton = Newton(one)
            newton.scale[:], newton.z[:] = one.scale, z
            newton.row[:] = np.append(np.zeros(problem.unknowns), 1.0)
            assert newton.take_tangent()
            tangents.append((newton.orientation, *newton.tangent))
        np.testing.assert_allclose(*tangents, atol=1e-7)
        holds.append(problem.condensed.by_contacts)
    assert holds == [True, False, True]


def test_points_of_the_curve_balance():
    system = System(many_contacts(), (1,), condensation=CONDENSED)
    newton = Newton(system.new_balance())
    z = np.append(np.zeros(newton.problem.unknowns), 0.9)
    newton.problem.evaluate_scale(np.append(np.ones(newton.problem.unknowns), 0.9))
    newton.scale[:] = newton.problem.scale
    newton.row[:] = np.append(np.zeros(newton.problem.unknowns), 1.0)
    newton.z[:] = z
    assert newton.correct(1.0)
    newton.problem.evaluate(newton.z)
    assert np.abs(newton.problem.residual).max() < 1e-12 * np.abs(newton.z).max()


def user_points(condensing, harmonics):
    system = System(strip(), harmonics, condensation=condensing)
    problem = system.new_balance()
    at = (1.0, 1.15, 1.3)
    path = follow(problem, np.append(np.zeros(problem.unknowns), 0.9), (0.9, 1.5), Events(at))
    return problem, path.z[np.isin(path.parameter, at)]


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3)])
def test_few_modes_and_the_contacts_themselves_have_the_same_solutions(harmonics):
    condensed, found = user_points(CONDENSED, harmonics)
    whole, expected = user_points(WHOLE, harmonics)
    modes, parts = 3, 1 + 2 * len(harmonics)
    assert (condensed.rank, whole.rank) == (modes * parts, 0)
    assert len(found) == 3
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected[:, :-1]).max())
    whole.evaluate(expected[1])
    assert any(law.nonlinear for law in whole.laws)  # contacts slip or separate


def test_modes_that_yield_too_much_to_be_left_out_are_taken_after_all():
    left_out = CondensationOptions(
        min_unknowns=1, max_fraction=1.0, compliance_limits=(1e9,), max_corrections=1
    )
    problem, found = user_points(left_out, (1,))
    expected = user_points(WHOLE, (1,))[1]
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected[:, :-1]).max())
    assert problem.condensed is not None and problem.condensed.modes > 3


def test_many_contacts_make_no_arrays_of_ports_by_ports():
    problem = System(strip(contacts=80), (1, 2, 3)).new_balance()
    assert problem.rank == 3 * 7
    assert np.asarray(problem.receptance.G_re).size == 0
    assert np.asarray(problem.jacobian).shape == (problem.unknowns, 1)


@pytest.mark.parametrize("stiff", [0.3, 1.0])
def test_modes_left_out_that_yield_as_much_as_contacts_are_in_the_solutions(stiff):
    """As in a joint, where no mode is stiff beside the contacts."""
    soft = {"kept": (1.0, 1.6, 2.7), "stiff": (4.7, 5.3, 6.1)}
    solutions = []
    for options in (CondensationOptions(min_unknowns=1, max_fraction=1.0, compliance_limits=(stiff,)), WHOLE):
        system = System(strip(**soft), (1, 3), condensation=options)
        problem, at = system.new_balance(), (1.0, 1.15, 1.3)
        path = follow(problem, np.append(np.zeros(problem.unknowns), 0.9), (0.9, 1.5), Events(at))
        solutions.append(path.z[np.isin(path.parameter, at)])
        if options is not WHOLE:
            left_out = system.modal_compliance[system.modal_compliance <= stiff]
            assert problem.condensed is not None and problem.condensed.modes < 6 and left_out.max() > 0.05
    found, expected = solutions
    assert len(found) == 3
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected[:, :-1]).max())


def test_a_kept_jacobian_is_that_of_the_frequency_where_it_was_factored():
    """Modes left out answered at the frequency of the last residual: beside a resonance nothing converged."""
    options = CondensationOptions(min_unknowns=1, max_fraction=1.0, compliance_limits=(1.0,))
    scene = strip(kept=(1.0, 1.6, 2.7), stiff=(4.7, 5.3, 6.1))
    condensed, whole = (System(scene, (1, 3), condensation=one).new_balance() for one in (options, WHOLE))
    rng = np.random.default_rng(8)
    z, row = np.append(rng.normal(size=whole.unknowns), 1.0), rng.normal(size=whole.unknowns + 1)
    right, scale = rng.normal(size=z.size), np.ones(z.size)
    whole.evaluate(z)
    expected = np.linalg.solve(np.vstack((jacobian_of(whole), row)), right)
    condensed.evaluate(z)
    condensed.factor(row, scale)
    assert condensed.condensed.modes < 6
    condensed.evaluate_residual(np.append(z[:-1], 1.1))
    condensed.condensed.solve(right, step=False)
    np.testing.assert_allclose(right, expected, atol=1e-7 * np.abs(expected).max())


def test_what_is_not_finite_is_refused_without_a_warning():
    newton = Newton(System(strip(), (1,), condensation=CONDENSED).new_balance())
    newton.z[:] = np.append(np.full(newton.problem.unknowns, np.nan), 1.0)
    newton.row[:] = np.append(np.zeros(newton.problem.unknowns), 1.0)
    assert not newton.correct(1.0)


def test_linear_responses_at_many_frequencies_take_one_matrix_at_a_time():
    """All at once they took 1.6 GB for 800 contacts."""
    system, ports = System(many_contacts(40)), 80
    frequencies = np.linspace(0.5, 1.5, 60)
    system.linear.at(1.0)
    tracemalloc.start()
    precompute(system, frequencies)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    (G,), (X,) = system.linear.at(frequencies[7])
    stuck = system.springs(stuck=True)
    assert system.port_responses[frequencies[7]][1, 0] == pytest.approx(
        np.linalg.solve(np.eye(ports) + G * stuck, X)
    )
    assert most < 16 * ports**2 * 16


@pytest.mark.parametrize("condensation", [EVERY_MODE, CondensationOptions(min_unknowns=10**6)])
def test_rounding_of_many_contacts_is_that_of_random_errors(condensation):
    """Three times the root of the sum of squares of the inverse of the whole system times each error."""
    system = System(mostly_stuck(), (1, 3), condensation=condensation)
    balance = system.new_balance()
    path = follow(balance, np.append(np.zeros(balance.unknowns), 0.9), (0.9, 1.5), Events((1.15,)))
    (i,) = np.flatnonzero(path.parameter == 1.15)
    balance.evaluate(path.z[i])
    errors = np.random.default_rng(4).uniform(0.5, 1.0, balance.unknowns)
    many = replace(HARMONIC_BALANCE.digits, min_unknowns=balance.unknowns)
    found = moved_across_curve(balance, path.z[i], path.direction[i], errors, many)
    scale = np.array(balance.scale)
    row = path.direction[i] / scale
    matrix = np.vstack((jacobian_of(balance) * scale, row / np.linalg.norm(row)))
    inverse = np.linalg.inv(matrix)[:-1, :-1]
    np.testing.assert_array_less(found, 3.0 * scale[:-1] * (np.abs(inverse) @ errors) * (1.0 + 1e-6))
    typical = 3.0 * scale[:-1] * np.sqrt(np.square(inverse * errors).sum(axis=1))
    assert 0.8 < np.sqrt(np.mean(np.square(found / typical))) < 1.25


def test_rounding_between_points_that_are_looked_at_is_the_greater_of_theirs():
    scene = mostly_stuck()
    hard = tuple(replace(one, k_u=1e3, k_v=1e3, n_0=10.0) for one in scene.contacts)
    system = System(replace(scene, contacts=hard), (1,), condensation=EVERY_MODE)
    balance = system.new_balance()
    path = follow(balance, np.append(np.zeros(balance.unknowns), 0.9), (0.9, 1.5))
    roundings = []
    for points in (10**6, 3):
        options = HarmonicBalanceOptions(digits=DigitOptions(stiff_ratio=0.0, max_points=points))
        looking = replace(system, options=options)
        roundings.append(with_precise_fundamental(looking, recorded(looking, [path]))[1])
    told = np.arange(len(path.z)) % 2 == 0
    quick = with_precise_fundamental(looking, recorded(looking, [path]), told)[1]
    assert quick[told].min() > 0.0 and not quick[~told].any()
    every, some = roundings
    last = len(path.z) - 1
    looked = [0, round(0.5 * last), last]
    assert last > 4 and every.min() > 0.0
    np.testing.assert_array_equal(some[looked], every[looked])
    for a, b in itertools.pairwise(looked):
        between = some[a + 1 : b]
        np.testing.assert_array_equal(between, np.tile(np.maximum(every[a], every[b]), (len(between), 1)))


def test_degrees_of_freedom_that_are_greatest_together_have_one_point():
    problem = System(strip(contacts=30), (1,), condensation=CONDENSED).new_balance()
    path = follow(problem, np.append(np.zeros(problem.unknowns), 0.9), (0.9, 1.5))
    peaks = path.parameter[path.where(Mark.PEAK)]
    assert 1 < len(peaks) < problem.outputs and np.unique(peaks).size == len(peaks)
