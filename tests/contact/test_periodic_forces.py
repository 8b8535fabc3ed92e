"""Forces of any periodic motion: against a march, on every boundary; with one harmonic the closed form."""

import numpy as np
import pytest

from fcm import fourier_coefficients, normal_coefficients, periodic_forces, periodic_gradients
from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.periodic.cycle import PeriodicContact

from . import periodic_march
from .cases import all_boundaries, points
from .motions import BOUNDARIES, Case, errors, near, random_cases

ALLOWED = 1e-12
MISSES = [s * 10.0**-k for k in (4, 10, 15) for s in (-1.0, 1.0)]


@pytest.mark.parametrize(
    "seed", [*range(4), *(pytest.param(k, marks=pytest.mark.slow) for k in range(4, 10))]
)
def test_random_motions(seed):
    """Four hundred; ten thousand with FCM_TEST_SCALE=25."""
    worst = max(max(errors(case)) for case in random_cases(40, seed))
    assert worst <= ALLOWED


@pytest.mark.parametrize("name", BOUNDARIES)
def test_boundaries(name):
    assert max(errors(BOUNDARIES[name], depth=18)) <= ALLOWED


@pytest.mark.parametrize("name", BOUNDARIES)
def test_beside_the_boundaries(name):
    for miss in MISSES:
        assert max(errors(near(BOUNDARIES[name], miss), depth=18)) <= ALLOWED, miss


@pytest.mark.parametrize(
    "name", ["linear", "near_boundaries", "near_degenerate", "between_sequences", "turned_often"]
)
def test_with_one_harmonic_it_is_the_closed_form(name):
    check_closed_form(*points(name, 1000))


def test_with_one_harmonic_it_is_the_closed_form_on_every_boundary():
    check_closed_form(*all_boundaries())


def check_closed_form(n0, b, phi):
    """u = sin(theta), v = b sin(theta + phi)."""
    u = np.array([0.0, -1j])
    v = np.stack((0.0 * b, b * (np.sin(phi) - 1j * np.cos(phi))), axis=-1)
    f, n = periodic_forces(u, v, 1.0, 1.0, 1.0, n0)
    F = f[:, 0].real, -f[:, 1].imag, f[:, 1].real
    # theta + phi is rounded in the closed form, and b sin(phi) here
    rounding = 2.0 * b * np.spacing(10.0 + np.abs(phi)) * (b > 1e-200)
    for mine, closed in zip(F, fourier_coefficients(n0, b, phi), strict=True):
        assert np.all(np.abs(mine - closed) <= 4e-15 + 2e-15 * b + rounding)
    varies = b > 1e-200
    N_b, N_s = normal_coefficients(n0[varies] / b[varies])
    allowed = 4e-15 * (b + np.abs(n0))[varies]
    assert np.all(np.abs(n[varies, 0] - N_b * b[varies]) <= allowed)
    assert np.all(np.abs(np.abs(n[varies, 1]) - N_s * b[varies]) <= allowed)


def test_light_loads_keep_their_digits():
    """With one harmonic, against the closed form, which integrates them as forces."""
    rng = np.random.default_rng(0)
    b = 10.0 ** rng.uniform(-10.0, -2.0, 2000)
    n0, phi = b * rng.uniform(-0.9, 3.0, b.size), rng.uniform(-7.0, 7.0, b.size)
    v = np.stack((0.0 * b, b * (np.sin(phi) - 1j * np.cos(phi))), axis=-1)
    f, _ = periodic_forces([0.0, -1j], v, 1.0, 1.0, 1.0, n0)
    F = np.array(fourier_coefficients(n0, b, phi))
    error = np.abs(f[:, 0] - F[0]) + np.abs(f[:, 1] - (F[2] - 1j * F[1]))
    assert np.all(error <= 1e-11 * np.maximum(b, n0))
    heavier = b > 1e-8
    assert np.all(error[heavier] <= 1e-12 * np.maximum(b, n0)[heavier])


def test_a_contact_that_never_slips_rests_where_it_started():
    """F = k_u (u - rest), held by the limits: of a pure sine clip(u_mean - start, ell_2 - n0, n0 - ell_1)."""
    n0, b, phi = 2.5, 0.5, 0.8
    v = [0.0, b * (np.sin(phi) - 1j * np.cos(phi))]
    ell_1, ell_2 = (np.sqrt(1.0 + b * b + s * 2.0 * b * np.cos(phi)) for s in (-1.0, 1.0))
    for mean, start in [(0.0, 0.0), (0.4, 0.0), (-0.4, 0.0), (7.0, 0.0), (-7.0, 0.0), (7.0, 6.8), (0.0, 9.0)]:
        f, _ = periodic_forces([mean, -1j], v, 1.0, 1.0, 1.0, n0, start=start)
        assert f[0] == pytest.approx(np.clip(mean - start, ell_2 - n0, n0 - ell_1), abs=1e-15)
        assert f[1] == pytest.approx(-1j, abs=1e-15)


def test_the_mean_of_u_does_not_matter_once_it_slips():
    case = BOUNDARIES["no preload"]
    for mean in (0.0, -3.0, 1e3):
        moved = Case(np.concatenate(([mean], case.u[1:])), case.v, n_0=0.0)
        np.testing.assert_array_equal(moved.forces(), case.forces())


@pytest.mark.parametrize("harmonics", [0, 1, 4, 40])
def test_any_number_of_harmonics_of_the_forces(harmonics):
    case = BOUNDARIES["no preload"]
    f, n = case.forces(harmonics=harmonics)
    more_f, more_n = case.forces(harmonics=60)
    assert f.shape == n.shape == (harmonics + 1,)
    np.testing.assert_allclose(f, more_f[: harmonics + 1], atol=1e-15)
    np.testing.assert_allclose(n, more_n[: harmonics + 1], atol=1e-15)


@pytest.mark.parametrize(
    ("inside", "outside"), [([1, 2, 3, 9], [2, 9, 14]), ([4], [1, 4, 8, 12]), ([], [1]), ([3], [])]
)
def test_a_set_of_harmonics_is_as_all_with_zeros_between(inside, outside):
    """What other kernels use: forces and derivatives of the harmonics that they ask for."""
    rng = np.random.default_rng(4)
    sparse = PeriodicContact(inside, outside)
    full = PeriodicContact(list(range(1, 15)), list(range(1, 15)))
    columns, rows = (
        np.array([0, 1, *(4 * h - 2 + i for h in some for i in range(4))]) for some in (inside, outside)
    )
    for n_0 in (-0.5, 0.0, 0.7, 30.0):
        x, whole = rng.standard_normal(sparse.unknowns), np.zeros(full.unknowns)
        whole[columns] = x
        assert sparse.at(x, ContactParameters(0.4, 2.0, 1.5, n_0)) == full.at(
            whole, ContactParameters(0.4, 2.0, 1.5, n_0)
        )
        np.testing.assert_allclose(sparse.forces, np.array(full.forces)[rows], atol=1e-14)
        np.testing.assert_allclose(
            sparse.jacobian, np.array(full.jacobian)[np.ix_(rows, columns)], atol=1e-13
        )


@pytest.mark.parametrize("of", [periodic_forces, periodic_gradients])
def test_no_motions_have_no_forces(of):
    f, n, *slopes = of(np.zeros((2, 0, 3)), [0, 1], 1.0, 1.0, 1.0, 1.0)
    assert f.shape == n.shape == (2, 0, 3)
    assert all(one.shape == (2, 0, 3, 2, 3, 2) for one in slopes)


def test_arguments_broadcast():
    rng = np.random.default_rng(3)
    u, v = rng.standard_normal((4, 1, 3)) + 0j, rng.standard_normal((5, 2)) + 0j
    mu, n_0 = rng.uniform(0.1, 1.0, 5), rng.uniform(-1.0, 1.0, (4, 1))
    f, n = periodic_forces(u, v, mu, 1.0, 2.0, n_0)
    assert f.shape == n.shape == (4, 5, 3)
    for i, j in np.ndindex(4, 5):
        alone = periodic_forces(u[i, 0], v[j], mu[j], 1.0, 2.0, n_0[i, 0])
        np.testing.assert_array_equal(alone, (f[i, j], n[i, j]))


def test_the_imaginary_part_of_a_mean_does_not_count():
    u, v = [1.0 + 5.0j, 2.0, 1j], [0.5 - 3.0j, 1.0j]
    np.testing.assert_array_equal(
        periodic_forces(u, v, 0.4, 1.0, 1.0, 1.0),
        periodic_forces([1.0, *u[1:]], [0.5, *v[1:]], 0.4, 1.0, 1.0, 1.0),
    )


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("where", range(6))
def test_what_is_not_finite_gives_nan_there_only(bad, where):
    arguments = [np.tile([0.1, 1.0, 0.3], (2, 1)) + 0j, np.tile([0.2, 1j], (2, 1)), *np.ones((4, 2))]
    arguments[where] = arguments[where].copy()
    arguments[where][1, ...] = abs(bad) if where in (2, 3, 4) else bad
    f, n = periodic_forces(*arguments)
    assert np.isfinite([f[0], n[0]]).all() and np.isnan([f[1], n[1]]).all()


@pytest.mark.parametrize("name", ["mu", "k_u", "k_v"])
def test_negative_parameters_are_refused(name):
    arguments = {"mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0} | {name: -1.0}
    with pytest.raises(ValueError, match=f"{name} must not be negative"):
        periodic_forces([0.0, 1.0], [0.0], **arguments)


def test_motions_without_coefficients_are_refused():
    with pytest.raises(ValueError, match="at least one coefficient"):
        periodic_forces(np.zeros((3, 0)), [0.0], 0.4, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="number of harmonics"):
        periodic_forces([0.0], [0.0], 0.4, 1.0, 1.0, 1.0, harmonics=-1)


@pytest.mark.parametrize("size", [1e-150, 1e-75, 1e75, 1e150])
def test_huge_and_tiny_numbers(size):
    """Lengths, forces and stiffness in other units."""
    for case in random_cases(20, 11, most=5):
        f, n = case.forces()
        longer = periodic_forces(case.u * size, case.v * size, case.mu, case.k_u, case.k_v, case.n_0 * size)
        stronger = periodic_forces(case.u, case.v, case.mu, case.k_u * size, case.k_v * size, case.n_0 * size)
        most = max(np.abs(f).max(), 1e-4 * case.mu * np.abs(n).max())
        for other in (longer, stronger):
            np.testing.assert_allclose(other[0] / size, f, atol=1e-13 * most)
            np.testing.assert_allclose(other[1] / size, n, atol=1e-13 * np.abs(n).max())


def test_a_light_motion_beside_a_huge_load_and_the_reverse():
    rng = np.random.default_rng(5)
    for exponent in (-300, -150, -20, 20, 150, 290):
        u, v = rng.standard_normal((2, 4)) + 0j
        for n_0 in (-1.0, 0.0, 0.5, 20.0):
            f, n = periodic_forces(u * 10.0**exponent, v, 0.5, 1.0, 1.0, n_0)
            assert np.isfinite(f).all() and np.isfinite(n).all()
            assert np.abs(f).max() <= 2.0 * 0.5 * np.abs(n).sum() + 1e-15


def test_the_march_knows_the_closed_form():
    """The reference of these tests, against the closed form of one harmonic."""
    for n0, b, phi in zip(*points("linear", 60), strict=True):
        u, v = [0.0, -1j], [0.0, b * (np.sin(phi) - 1j * np.cos(phi))]
        f, _, _, _ = periodic_march.forces(u, v, 1.0, 1.0, 1.0, n0, 1)
        F = fourier_coefficients(n0, b, phi)
        assert [float(f[0].real), -float(f[1].imag), float(f[1].real)] == pytest.approx(F, abs=4e-15)


def test_the_march_is_where_small_steps_go():
    """A plain march of 20 000 steps, which knows of no cell, is within its own error of the reference."""
    steps = 20_000
    theta = 2.0 * np.pi * np.arange(steps) / steps
    for case in random_cases(25, 7, most=6):
        wave = np.exp(1j * np.multiply.outer(theta, np.arange(case.u.size)))
        u, load = (wave @ case.u).real, np.maximum(case.n_0 + case.k_v * (wave @ case.v).real, 0.0)
        limit, force = case.mu * load / case.k_u, np.empty(steps)
        w = 0.0
        for i in range(2 * steps):
            j = i % steps
            w = max(u[j] - limit[j], min(w, u[j] + limit[j]))
            force[j] = case.k_u * (u[j] - w)
        F = 2.0 * np.exp(-1j * np.multiply.outer(np.arange(case.u.size), theta)) @ force / steps
        F[0] *= 0.5
        arguments = (case.u, case.v, case.mu, case.k_u, case.k_v, case.n_0)
        f, _, _, _ = periodic_march.forces(*arguments, case.u.size - 1)
        rates = np.arange(case.u.size) @ (case.k_u * np.abs(case.u) + case.mu * case.k_v * np.abs(case.v))
        assert np.abs(f - F).max() <= 4.0 * rates * 2.0 * np.pi / steps
