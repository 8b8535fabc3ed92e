"""Derivatives of the forces of any periodic motion: differences in extended precision, Euler's theorem."""

import numpy as np
import pytest

from fcm import periodic_gradients
from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.periodic.cycle import PeriodicContact

from . import periodic_march
from .cases import points
from .motions import BOUNDARIES, SINE, STILL, Case, near, random_cases

STEP = 1e-6  # of the difference; the reference has 64 bits, so that it is good to some 1e-12
CLEAR = 300.0  # so many steps to both sides the sequence is the same: no event grazes


def moved(case, direction, step):
    du, dv = direction
    return Case(case.u + step * du, case.v + step * dv, *case.arguments()[2:])


def sequence(case):
    """The states, and what brought the slider to rest."""
    count = case.u.size
    contact = PeriodicContact(list(range(1, count)), [])
    x = np.stack((case.u.real, case.u.imag, case.v.real, case.v.imag), axis=-1).ravel()
    contact.at(np.delete(x, (1, 3)), ContactParameters(*case.arguments()[2:]))
    cycle = contact.cycle
    return [(cycle.state[p], cycle.cause[p]) for p in range(cycle.pieces)]


def difference(case, direction, step):
    """Central difference of both forces along a direction."""
    ends = []
    for sign in (1, -1):
        moved_by = [sign * np.longdouble(step) * x for x in direction]
        u, v = (x.astype(np.clongdouble) + dx for x, dx in zip((case.u, case.v), moved_by, strict=True))
        ends.append(periodic_march.forces(u, v, *case.arguments()[2:], case.u.size + 1)[:2])
    return [(after - before) / (2 * np.longdouble(step)) for after, before in zip(*ends, strict=True)]


def marched(case, direction):
    """The same without the error of second order."""
    coarse, fine = (difference(case, direction, step) for step in (STEP, 0.5 * STEP))
    return [(4 * y - x) / 3 for x, y in zip(coarse, fine, strict=True)]


def along(gradients, direction):
    """The derivatives of both forces along a direction."""
    parts = np.stack([np.stack((x.real, x.imag), axis=-1) for x in direction])
    return [np.einsum("hjkp,jkp->h", d, parts) for d in gradients[2:]]


@pytest.mark.parametrize("seed", range(8))
def test_differences(seed):
    rng = np.random.default_rng(seed)
    compared = 0
    cases = random_cases(10, 100 + seed, most=9)
    for case in cases:
        direction = [
            rng.standard_normal(case.u.size) + 1j * rng.standard_normal(case.u.size) for _ in range(2)
        ]
        if any(sequence(moved(case, direction, s * CLEAR * STEP)) != sequence(case) for s in (-1, 0.3, 1)):
            continue
        compared += 1
        gradients = periodic_gradients(*case.arguments(), harmonics=case.u.size + 1)
        size = np.array([case.k_u + case.mu * case.k_v, case.k_v]) * np.linalg.norm(direction)
        for mine, theirs, scale in zip(
            along(gradients, direction), marched(case, direction), size, strict=True
        ):
            assert np.abs(mine - theirs).max() <= 1e-9 * scale
    assert compared >= 0.5 * len(cases)


def check_homogeneous(case):
    """Twice the motion and preload, twice the forces: F = dF/du u + dF/dv (v + n_0 / k_v), also at kinks."""
    G = periodic_gradients(*case.arguments())
    if case.k_v == 0.0:
        return
    count = max(case.u.size, case.v.size)
    u, v = (np.pad(x, (0, count - x.size)) for x in (case.u, case.v))
    v = v + np.eye(1, count)[0] * case.n_0 / case.k_v
    motion = np.sum(np.abs(case.k_u * u)) + np.sum(np.abs(case.mu * case.k_v * v))
    for force, slope, scale in zip(
        G[:2], along(G, (u, v)), (motion, case.k_v * np.sum(np.abs(v))), strict=True
    ):
        assert np.abs(force - slope).max() <= 3e-13 * scale


@pytest.mark.parametrize("seed", range(5))
def test_forces_are_homogeneous(seed):
    for case in random_cases(200, seed):
        check_homogeneous(case)


@pytest.mark.parametrize("name", BOUNDARIES)
def test_forces_are_homogeneous_on_the_boundaries(name):
    for miss in (0.0, 1e-3, -1e-3, 1e-9, -1e-9, 1e-15, -1e-15):
        check_homogeneous(near(BOUNDARIES[name], miss))


def test_forces_are_homogeneous_with_one_harmonic():
    for name in ("near_boundaries", "between_sequences"):
        for n0, b, phi in zip(*points(name, 300), strict=True):
            check_homogeneous(Case(SINE, np.array([0.0, b * (np.sin(phi) - 1j * np.cos(phi))]), 1.0, n_0=n0))


def test_coefficients_are_those_of_the_forces():
    case = BOUNDARIES["no preload"]
    G = periodic_gradients(*case.arguments(), harmonics=8)
    np.testing.assert_array_equal(G[:2], case.forces(harmonics=8))
    assert G.df.shape == G.dn.shape == (9, 2, 6, 2)


def test_gradients_broadcast():
    rng = np.random.default_rng(2)
    u, v = rng.standard_normal((3, 1, 3)) + 0j, rng.standard_normal((2, 3)) + 0j
    G = periodic_gradients(u, v, 0.4, 1.0, 1.0, 0.5)
    assert G.f.shape == (3, 2, 3) and G.df.shape == (3, 2, 3, 2, 3, 2)
    alone = periodic_gradients(u[2, 0], v[1], 0.4, 1.0, 1.0, 0.5)
    np.testing.assert_array_equal(G.dn[2, 1], alone.dn)


def test_where_it_just_does_not_slip_the_derivative_is_that_of_sticking():
    """u = sin(theta) at its slip limit: stiffness k_u inside; beyond, the slip takes some of it."""
    derivative = [
        periodic_gradients(SINE, STILL, 1.0, 1.0, 1.0, n_0).df[1, 0, 1, 1] for n_0 in (1.0, 1.0 - 1e-9)
    ]
    assert derivative[0] == 1j
    assert derivative[1].imag == pytest.approx(1.0, abs=1e-3)  # the stiffness is continuous, its mean is not:
    mean = [
        periodic_gradients([0.0, -1j], STILL, 1.0, 1.0, 1.0, n_0).df[0, 0, 0, 0] for n_0 in (1.0, 1.0 - 1e-9)
    ]
    assert mean == [1.0, 0.0]


def test_where_it_just_does_not_open_the_derivative_is_that_of_contact():
    G = periodic_gradients(SINE, SINE, 0.5, 1.0, 1.0, 1.0)
    np.testing.assert_allclose(G.dn[1, 1, 1], [1.0, 1j], atol=1e-15)
    np.testing.assert_allclose(G.dn[:, 1, 0, 0], [1.0, 0.0], atol=1e-15)
    G = periodic_gradients(SINE, SINE, 0.5, 1.0, 1.0, -1.0)  # just does not close
    assert not G.dn.any() and not G.df.any()
