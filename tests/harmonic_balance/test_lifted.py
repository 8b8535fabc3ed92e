"""Points of a balance of fewer harmonics moved to one of more, where there are many unknowns."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.branches.trace import traced
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene

from .strips import strip

ENOUGH = 0.1  # of a displacement


@pytest.fixture(scope="module")
def blade():
    """Ten contacts, the path of one harmonic, and a balance of 260 unknowns."""
    system = System(load_scene("blade").each_curve()[0], (1,))
    more = [1, 2, 3, 4, 5, 6]
    lifted = Prolongation(system.with_harmonics(tuple(more)).new_balance(), [1], more, ENOUGH)
    assert len(system.scene.contacts) == 10
    return traced(system).branches.paths[0], lifted


def test_where_nothing_slips_more_harmonics_change_nothing(blade):
    path, lifted = blade
    assert lifted.find_normal(path.z[0], path.direction[0])
    assert lifted.found[0] == pytest.approx(path.parameter[0], rel=1e-9)
    assert np.linalg.norm(lifted.newton.z[:-1]) == pytest.approx(np.linalg.norm(path.z[0, :-1]), rel=1e-9)


def test_what_is_nowhere_is_given_up_within_few_evaluations(blade):
    path, lifted = blade
    top = np.abs(path.z[:, :-1]).max(axis=1).argmax()
    for factor in (2.0, 4.0, -1.0):
        before = lifted.newton.evaluations
        z = np.append(factor * path.z[top, :-1], path.parameter[top])
        assert not lifted.find_normal(z, path.direction[top])
        assert 0 < lifted.newton.evaluations - before <= 8  # Newton steps of one guess


def test_one_among_many_points_is_given_up_where_a_single_one_is_sought_by_parts(blade):
    """Of 140 unknowns."""
    path, _ = blade
    some = Prolongation(
        System(load_scene("blade").each_curve()[0], (1, 2, 3)).new_balance(), [1], [1, 2, 3], ENOUGH
    )
    top = np.abs(path.z[:, :-1]).max(axis=1).argmax()
    z, taken = np.append(2.0 * path.z[top, :-1], path.parameter[top]), []
    for briefly in (True, False):
        before = some.newton.evaluations
        assert not some.find_normal(z, path.direction[top], briefly)
        taken.append(some.newton.evaluations - before)
    assert 0 < taken[0] <= 8 < taken[1]
    assert some.find_normal(path.z[0], path.direction[0], True)


@pytest.fixture(scope="module")
def stiff():
    """Twelve contacts, stiff beside five modes that lie close together."""
    one = strip(kept=(1.2, 1.25, 1.3, 1.35, 1.4), n_0=2.4)
    contacts = tuple(replace(c, k_u=3.0 * c.k_u, k_v=3.0 * c.k_v) for c in one.contacts)
    system = System(replace(one, contacts=contacts), (1,))
    more = (1, 2, 3)
    lifted = Prolongation(system.with_harmonics(more).new_balance(), [1], list(more), 0.01)
    return traced(system).branches.paths[0], lifted, lambda z: system.with_harmonics(more).extended(z, (1,))


def newton(lifted, guess, along, begin, steps):
    """Newton's method as it is from a place, in the plane through a guess: where it comes to, or None."""
    balance, z = lifted.balance, begin.copy()
    balance.evaluate_scale(guess)
    scale = np.array(balance.scale)
    row = along / scale
    for _ in range(steps):
        balance.evaluate(z)
        matrix = np.vstack((np.array(balance.jacobian) * scale, row))
        step = np.linalg.solve(matrix, -np.append(balance.residual, row @ ((z - guess) / scale)))
        z += scale * step
        if np.linalg.norm(step) < 1e-9:
            return z
        if not np.linalg.norm(step) < 1e6:
            return None
    return None


def test_steps_that_lead_too_far_are_shortened(stiff):
    """Newton's method as it is finds fewer; what is found solves the balance."""
    path, lifted, extended = stiff
    found, plain = [], []
    for z, direction in zip(path.z[::4], path.direction[::4], strict=True):
        guess, along = extended(z), extended(direction)
        plain.append(newton(lifted, guess, along, guess, 8) is not None)
        found.append(lifted.find_normal(z, direction))
        if found[-1]:
            there = np.array(lifted.newton.z)
            true = newton(lifted, guess, along, there, 4)
            assert np.linalg.norm(there - true) < 0.02 * np.linalg.norm(true - guess) + 1e-9
    assert np.mean(found) > 0.9 and np.mean(plain) < np.mean(found) - 0.25


def test_a_displacement_leads_to_the_next(stiff):
    """With fewer Jacobians, to the same place where there is one."""
    path, lifted, extended = stiff
    taken, both = [0, 0], 0
    before = None
    for z, direction in zip(path.z, path.direction, strict=True):
        places = []
        for led in (False, True):
            lifted.predict_from(z, extended(z))  # by nothing
            if led and before is not None:
                lifted.predict_from(*before)
            count = lifted.newton.evaluations
            places.append(np.array(lifted.newton.z) if lifted.find_normal(z, direction) else None)
            taken[led] += lifted.newton.evaluations - count
        if places[0] is not None and places[1] is not None:
            both += 1
            way = np.linalg.norm(places[0] - extended(z))
            assert np.linalg.norm(places[0] - places[1]) < 0.05 * way + 1e-9
        before = before if places[1] is None else (z, places[1])
    assert both > 0.7 * len(path.z)
    assert taken[1] < 0.8 * taken[0]


def test_a_step_with_the_jacobian_from_before_leaves_little_of_a_displacement(blade):
    """Against Newton's method to the precision of numbers: it takes more Jacobians and comes to the same.

    Beside a corner it may not come to that precision: there nothing is compared.
    """
    path, lifted = blade
    exact = Prolongation(lifted.balance, [1], [1, 2, 3, 4, 5, 6], 1e-9)
    moved = taken = needed = corners = 0
    for i in range(0, len(path.z), 2):
        before = lifted.newton.evaluations, exact.newton.evaluations
        if not lifted.find_normal(path.z[i], path.direction[i]):
            continue
        found = np.array(lifted.newton.z)
        unit = np.array(lifted.balance.scale)
        if not exact.find_normal(path.z[i], path.direction[i]):
            corners += 1
            continue
        true, way = np.array(exact.newton.z), exact.newton.moved
        if way > 1e-6:
            moved += 1
            assert np.linalg.norm((found - true) / unit) < 0.05 * way
            taken += lifted.newton.evaluations - before[0]
            needed += exact.newton.evaluations - before[1]
    assert moved > 5 and corners < 0.1 * len(path.z[::2])
    assert 3 * taken < 2 * needed


def test_a_jacobian_is_kept_as_long_as_its_steps_shrink(blade):
    """Of points of the same displacement as to the precision of numbers most take one alone.

    Beside a corner there may be none of that precision.
    """
    path, lifted = blade
    exact = Prolongation(lifted.balance, [1], [1, 2, 3, 4, 5, 6], 1e-9)
    taken, corners = list[int](), 0
    for z, direction in zip(path.z[::2], path.direction[::2], strict=True):
        before = lifted.newton.evaluations
        if lifted.find_normal(z, direction):
            now = lifted.newton.evaluations - before
            if not exact.find_normal(z, direction):
                corners += 1
                continue
            taken += [now] if exact.newton.moved > 1e-6 else []
    assert len(taken) > 5 and corners < 0.1 * len(path.z[::2])
    assert taken.count(1) > 0.75 * len(taken)


def test_a_balance_is_left_as_it_was_made():
    """Whatever contacts it was of, and whatever fewer harmonics its points had."""
    one, other = (System(load_scene(name), (1,)) for name in ("yang1998-n5", "yang1998-jump"))
    more = (1, 2, 3, 4, 5, 6)
    used, new = (
        Prolongation(one.with_harmonics(more).new_balance(), [1], list(more), ENOUGH) for _ in range(2)
    )
    of_one = [(c.mu, c.k_u, c.k_v, c.n_0) for c in one.scene.contacts]
    few = one.with_harmonics((1, 2, 3))
    (path, *_), (longer, *_) = (traced(system).branches.paths for system in (one, few))
    used.reset(list(few.harmonics), [(c.mu, c.k_u, c.k_v, 2.0 * c.n_0) for c in other.scene.contacts])
    top = np.abs(longer.z[:, 6:-1]).max(axis=1).argmax()  # of the second and third harmonic
    used.find_normal(longer.z[top], longer.direction[top])
    used.reset([1], of_one)
    compared = 0
    for i in range(0, len(path.z), 2):
        found = [lifted.find_normal(path.z[i], path.direction[i]) for lifted in (used, new)]
        assert found[0] == found[1]
        assert not found[0] or np.array_equal(used.found, new.found)
        compared += found[0]
    assert compared > 5
