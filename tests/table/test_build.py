"""Nodes, limits and splines that a table is built of."""

import numpy as np
import pytest

from fcm import fourier_coefficients
from fcm.table import atlas, build_table, open_table, spline
from fcm.table.constant_load_limit import vanishing_variation
from fcm.table.nodes import PRESETS, all_nodes
from fcm.table.partial_table import TablePart
from fcm.table.tabulated import Cubic, locate


def coordinates(n0, b, phi):
    """u, x and z, each from 0 to 1."""
    arrays = np.broadcast_arrays(n0, b, phi)
    q = locate(np.stack([x.ravel() for x in arrays]), (2, 2, 2, 2)).q.reshape(3, *arrays[0].shape)
    return np.where(q[0] > 1.0, q[0] - 4.0, q[0]), q[1], q[2]


def test_coordinates_invert():
    b = np.array([0.0, 1e-9, 0.3, 0.9999, 1.0, 1.0001, 7.0, 1e5, 1e7])[:, None, None]
    phi = np.linspace(0.0, 3.14, 7)[:, None]
    delta = np.linspace(1e-3, 3.14, 50)
    u, x, z = coordinates(b * np.cos(delta), b, phi)
    assert np.allclose(atlas.phi_phase(z), phi, atol=1e-14)
    assert np.allclose(atlas.b_variation(x, np.broadcast_to(phi, x.shape)), b, rtol=1e-9, atol=1e-15)
    assert np.allclose(atlas.delta_separation(u, b)[1:], delta, rtol=1e-9)
    t, phi = np.linspace(1e-9, 1.0 - 1e-9, 50), np.array(0.4)
    u, _, _ = coordinates(0.5 + t * atlas.geometry(np.array(0.5), phi).width, 0.5, phi)
    assert np.allclose(atlas.t_slip(u), t, rtol=1e-6)


def test_width_of_slip_keeps_its_relative_accuracy():
    from mpmath import mp, mpf

    with mp.workdps(60):
        for b, phi in ((1e6, 0.7), (3.0, 1e-5), (0.999, 1e-6), (1.0, 1e-8), (1e-9, 2.0)):
            exact = (
                mp.sqrt(1 - 2 * mpf(b) * mp.cos(mpf(phi)) + mpf(b) ** 2)
                + mp.sqrt(1 + 2 * mpf(b) * mp.cos(mpf(phi)) + mpf(b) ** 2)
            ) / 2 - mpf(b)
            found = atlas.geometry(np.array([b]), np.array([phi])).width[0]
            assert found == pytest.approx(float(exact), rel=1e-12)


@pytest.mark.parametrize("b", [1e-4, 1e-6, 1e-8])
def test_vanishing_variation_is_the_limit_of_the_closed_form(b):
    delta, phi = np.meshgrid(np.linspace(0, np.pi, 15), np.linspace(0, np.pi, 13))
    found = np.stack(fourier_coefficients(b * np.cos(delta), b, phi)) / b
    assert np.abs(found - vanishing_variation(delta, phi)).max() < 3.0 * np.sqrt(b)


def test_nodes_rise_from_open_to_the_slip_limit():
    n0, b, phi = all_nodes(TablePart.all_of(PRESETS["fast"]))
    assert np.all(np.diff(n0, axis=0) >= -1e-15 * b[1:])
    assert np.array_equal(n0[0], -b[0])
    assert np.all(np.diff(b[0], axis=0) > 0) and np.all(np.diff(phi[0, 0]) > 0)
    assert (phi[0, 0, 0], phi[0, 0, -1]) == (0.0, np.pi)


def test_spline_returns_its_nodes_and_reproduces_cubics():
    axes = np.meshgrid(*(np.arange(n, dtype=float) for n in (6, 7, 8)), indexing="ij")
    ends = ((spline.FREE, spline.FREE),) * 3

    def function(i, j, k):
        """Cubics whose coefficients are whole numbers, so that single precision has them exactly."""
        return 3 * np.stack((i**3 - 2 * i * j * k, j**3 + k, k**3 * j - i**2))

    cubic = Cubic(spline.stack(spline.interpolate(function(*axes), ends)))
    q = np.random.default_rng(0).uniform(0, 1, (3, 700)) * np.array([[5.0], [6.0], [7.0]])
    q[:, :2] = [[0.0, 5.0], [0.0, 6.0], [0.0, 7.0]]
    values = cubic.many(q, True)
    i, j, k = q
    assert np.allclose(values[:, 0], function(i, j, k), atol=1e-9)
    assert np.allclose(values[0, 1:], (9 * i**2 - 6 * j * k, -6 * i * k, -6 * i * j), atol=1e-9)
    assert np.array_equal(cubic.many(q, False), values[:, :1])


def test_flat_ends_have_no_slope():
    values = np.random.default_rng(0).normal(size=(3, 6, 6, 6))
    flat = (spline.FLAT, spline.FLAT)
    cubic = Cubic(spline.stack(spline.interpolate(values, (flat, flat, flat))))
    slopes = cubic.many(np.array([[0.0, 5.0]] * 3), True)[:, 1:]
    assert np.abs(slopes).max() < 1e-12


def test_table_passes_through_its_nodes(tiny_file):
    table = open_table(tiny_file)
    n0, b, phi = (field[1:, 1:-1, 1:-1] for field in all_nodes(table.part))
    error = np.abs(np.stack(table(n0, b, phi)) - np.stack(fourier_coefficients(n0, b, phi)))
    assert error[:, b < 100.0].max() < 1e-6


def test_build_is_reproducible(tiny_file, tmp_path):
    again = build_table(tmp_path / "again.nc", open_table(tiny_file).resolution, points=10_000)
    first = open_table(tiny_file)
    assert again.error == first.error
    n0, b, phi = np.random.default_rng(0).uniform(0, 2, (3, 500))
    assert np.array_equal(again(n0, b, phi), first(n0, b, phi))


@pytest.mark.parametrize("resolution", [(4, 9, 9, 9), (9, 9, 9, 3000), (900, 900, 900, 900)])
def test_resolution_that_cannot_be_built_is_refused(tmp_path, resolution):
    with pytest.raises(ValueError, match="resolution"):
        build_table(tmp_path / "table.nc", resolution)
    assert not list(tmp_path.iterdir())


def test_progress_rises_to_the_end(tmp_path):
    shares = []
    build_table(
        tmp_path / "t.nc", (5, 5, 5, 5), points=10_000, progress=lambda share, what: shares.append(share)
    )
    assert shares == sorted(shares) and shares[0] >= 0.0 and shares[-1] <= 1.0
