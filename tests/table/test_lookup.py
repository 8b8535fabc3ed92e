"""Look-up: shapes, special arguments, symmetry, continuity, derivatives of the interpolant."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fcm import fourier_coefficients
from fcm.contact import fourier_gradients
from fcm.table.error import sample, seam

from ..program import python
from ..scale import SCALE

COUNT = int(20_000 * SCALE)  # points of a test; see `tests.scale`


def points(count=COUNT, seed=11):
    return sample(count, seed)


def test_arguments_broadcast(default):
    n0, b, phi = np.array([0.2, 0.5, 2.0])[:, None], np.array([0.3, 1.0]), 0.7
    F = default(n0, b, phi)
    assert all(f.shape == (3, 2) for f in F)
    assert F[1][2, 1] == default(2.0, 1.0, 0.7)[1]
    values, slopes = default.gradients(n0, b, phi)
    assert values.shape == (3, 3, 2) and slopes.shape == (3, 3, 3, 2)
    assert np.array_equal(values, np.stack(F))


def test_scalars_lists_integers_and_nothing(default):
    assert np.ndim(default(1, 0, 0)[0]) == 0
    assert default([1, 2], 0, 0)[1].tolist() == [1.0, 1.0]
    assert default([], [], [])[0].shape == (0,)
    assert default.gradients([], [], [])[1].shape == (3, 3, 0)
    assert default.gradients(0.5, 0.2, 0.1)[1].shape == (3, 3)


def test_bulk_is_the_same_as_one_by_one(default):
    n0, b, phi = points(COUNT // 2)
    F, dF = default.gradients(n0, b, phi)
    assert np.allclose(F, np.stack(default(n0, b, phi)), rtol=0, atol=1e-14)
    for k in range(0, COUNT // 2, COUNT // 40):
        one, slope = default.gradients(n0[k], b[k], phi[k])
        assert np.allclose(one, F[:, k], rtol=0, atol=1e-13)
        assert np.allclose(slope, dF[:, :, k], rtol=1e-7, atol=1e-7)


def test_nan_gives_nan_there_alone(default):
    n0, b, phi = np.full(6, 0.5), np.full(6, 0.4), np.full(6, 0.3)
    n0[1] = b[2] = phi[3] = np.nan
    b[4], phi[5] = np.inf, np.inf
    F, dF = default.gradients(n0, b, phi)
    assert np.isnan(F[:, 1:]).all() and np.isnan(dF[:, :, 1:]).all()
    assert np.isfinite(F[:, 0]).all() and np.isfinite(dF[:, :, 0]).all()


def test_negative_variation_is_refused(default):
    with pytest.raises(ValueError, match="b_bar is an amplitude"):
        default(1.0, [0.5, -1e-300], 0.0)
    with pytest.raises(ValueError, match="b_bar is an amplitude"):
        default.gradients(1.0, -1.0, 0.0)


def test_infinite_preload_is_stuck_and_infinite_gap_open(default):
    assert np.allclose(default(np.inf, 1.0, 0.5), (0, 1, 0), atol=0)
    assert np.allclose(default(-np.inf, 1.0, 0.5), (0, 0, 0), atol=0)


CORNERS = [
    0.0,
    5e-324,
    1e-300,
    1e-12,
    0.5,
    np.nextafter(1, 0),
    1.0,
    np.nextafter(1, 2),
    3.0,
    1e4,
    1e8,
    1e12,
    1e300,
]
PHASES = [
    0.0,
    -0.0,
    1e-300,
    1e-9,
    0.5 * np.pi,
    np.nextafter(np.pi, 0),
    np.pi,
    np.nextafter(np.pi, 4),
    -1e-17,
    40.0,
]


def test_every_corner_is_finite_and_right(default):
    b, phi, ratio = np.meshgrid(CORNERS, PHASES, [-2, -1, -0.5, 0, 0.5, 1, 2], indexing="ij")
    for n0 in (b * ratio, np.nextafter(b * ratio, np.inf), np.nextafter(b * ratio, -np.inf), b + 1e-17):
        F, dF = default.gradients(n0, b, phi)
        assert np.abs(F - np.stack(fourier_coefficients(n0, b, phi))).max() < 2e-4
        assert np.isfinite(dF).all()
        assert np.abs(dF).max() < 4.0


@settings(max_examples=200, deadline=None)
@given(
    n0=st.floats(allow_nan=False),
    b=st.floats(0.0, 1e300),
    phi=st.floats(-1e6, 1e6),
)
def test_any_argument_gives_the_closed_form(default, n0, b, phi):
    F, dF = default.gradients(n0, b, phi)
    assert np.abs(F - np.stack(fourier_coefficients(n0, b, phi))).max() < 2e-4
    assert np.isfinite(dF).all()


def test_largest_numbers_make_no_warning(default):
    for n0 in (-1.7e308, 0.0, 1.7e308):
        assert np.isfinite(default.gradients(n0, 1.7e308, 1e300)[1]).all()


def test_symmetry_is_exact(default):
    n0, b, phi = points()
    phi = np.mod(phi, np.pi)
    F, dF = default.gradients(n0, b, phi)
    G, dG = default.gradients(n0, b, phi - np.pi)
    sign = np.array([-1.0, 1.0, 1.0])
    assert np.abs(G - sign[:, None] * F).max() < 1e-12
    # a phase turned and turned back is another by a rounding error, and next to phi = 0 that is felt
    inner = np.abs(np.sin(phi)) > 1e-3
    assert np.abs(dG - sign[:, None, None] * dF)[..., inner].max() < 1e-5


@pytest.mark.parametrize("at", [-1.0, 1.0])
def test_continuous_where_the_contact_opens(default, at):
    b = 10.0 ** np.random.default_rng(0).uniform(-6, 6, COUNT)
    phi = np.random.default_rng(1).uniform(-4, 4, b.size)
    jump = np.stack(default(np.nextafter(at * b, -np.inf), b, phi)) - np.stack(default(at * b, b, phi))
    assert np.abs(jump).max() < (2e-5 if at > 0 else 1e-10)


def test_continuous_at_the_slip_limit_and_across_the_fold(default):
    random = np.random.default_rng(2)
    b, phi = 10.0 ** random.uniform(-6, 2, COUNT), random.uniform(0, 2 * np.pi, COUNT)
    limit = 0.5 * (np.abs(1.0 - b * np.exp(1j * phi)) + np.abs(1.0 + b * np.exp(1j * phi)))
    jump = np.stack(default(limit * (1 + 1e-12), b, phi)) - np.stack(default(limit * (1 - 1e-12), b, phi))
    assert np.abs(jump).max() < 1e-9
    n0 = random.uniform(-1, 1.2, b.size) * b
    for fold in (0.0, np.pi):
        jump = np.stack(default(n0, b, fold + 1e-12)) - np.stack(default(n0, b, fold - 1e-12))
        assert np.abs(jump).max() < 1e-7


@pytest.mark.parametrize("variable", [0, 1, 2])
@pytest.mark.parametrize("regime", ["separation", "slip", "stick"])
def test_derivatives_are_those_of_the_interpolant(default, variable, regime):
    """Central differences, a part in 1e5 away from every boundary and in moderate b."""
    random = np.random.default_rng(variable)
    b, phi = 10.0 ** random.uniform(-1.5, 1.5, 3000), random.uniform(0.05, np.pi - 0.05, 3000)
    phi += np.pi * random.integers(-2, 3, b.size)
    limit = 0.5 * (np.abs(1.0 - b * np.exp(1j * phi)) + np.abs(1.0 + b * np.exp(1j * phi)))
    share = random.uniform(0.02, 0.98, b.size)
    n0 = {"separation": (2 * share - 1) * b, "slip": b + share * (limit - b), "stick": limit * (1 + share)}[
        regime
    ]
    at = np.stack((n0, b, phi))
    step = np.zeros((3, 1))
    step[variable] = 1.0
    width = 1e-3 * np.minimum(limit - b, 0.01 * b) if regime == "slip" else 1e-6 * np.minimum(b, 1.0)
    plus, minus = at + step * width, at - step * width
    difference = (np.stack(default(*plus)) - np.stack(default(*minus))) / (plus - minus)[variable]
    slope = default.gradients(*at)[1][:, variable]
    tolerance = 1e-5 + 2e-15 / width
    assert np.all(np.abs(difference - slope) < tolerance + 1e-4 * np.abs(slope))


def test_derivatives_are_near_those_of_the_closed_form(default):
    n0, b, phi = points(2 * COUNT)
    error = np.abs(default.gradients(n0, b, phi)[1] - fourier_gradients(n0, b, phi)[1])
    assert np.quantile(error, 0.5) < 1e-4
    assert np.quantile(error, 0.95) < 2e-2


def test_newton_on_the_table_converges_quadratically(default):
    """Find the n0 and b with given F_s and F_c: the errors of a step are squares of those before."""
    aim = np.array(default(0.31, 0.22, 0.9)[1:])
    at = np.array([0.35, 0.25])
    errors = []
    for _ in range(6):
        F, dF = default.gradients(*at, 0.9)
        errors.append(np.abs(F[1:] - aim).max())
        at = at - np.linalg.solve(dF[1:, :2], F[1:] - aim)
    assert errors[-1] < 1e-14
    assert errors[3] < 1e-6


def test_look_up_needs_numpy_alone():
    code = (
        "import sys, fcm.table.lookup, fcm.table.store;"
        "print(sorted({'click', 'xarray', 'matplotlib', 'scipy', 'netCDF4'} & set(sys.modules)))"
    )
    assert python("-c", code).out == "[]\n"


class ClosedForm:
    """As a table without an error."""

    resolution = (25, 9, 37, 29)

    def __call__(self, n0_bar, b_bar, phi):
        return fourier_coefficients(n0_bar, b_bar, phi)


@pytest.mark.slow
def test_the_seam_is_as_far_apart_as_both_sides_err(default, fast):
    """At random places where separation begins, most near the cones; the closed form has no jump there."""
    random = np.random.default_rng(3)
    near = 10.0 ** random.uniform(-4.0, 0.0, (2, COUNT)) * random.choice([-1.0, 1.0], (2, COUNT))
    b, phi = 1.0 + 0.99 * near[0], near[1] % np.pi
    exact = np.stack(fourier_coefficients(b, b, phi))
    for table in (default, fast):
        before, beyond = (np.stack(table(n0, b, phi)) for n0 in (np.nextafter(b, 0.0), b))
        assert (np.abs(beyond - before) <= np.abs(before - exact) + np.abs(beyond - exact) + 1e-15).all()
        seen = np.abs(beyond - before).max(axis=1)
        assert (seen > 1e-6).all() and (seen < 1.05 * seam(table)).all() and (seam(table) < 10.0 * seen).all()
    assert (seam(ClosedForm()) < 1e-7).all()
