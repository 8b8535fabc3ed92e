"""The loop in the plane: its force at any angle, its states and measures."""

import numpy as np
import pytest

from fcm import periodic_loop, planar_loop

from .planar_march import March
from .planar_motions import random_planars

NODES, WEIGHTS = np.polynomial.legendre.leggauss(20)


def loops(n, seed):
    return [(case, planar_loop(*case.arguments())) for case in random_planars(n, seed, 3)]


def test_the_force_integrates_to_the_coefficients():
    for case, loop in loops(40, 40):
        cuts = np.unique(np.concatenate((np.linspace(0.0, 2.0 * np.pi, 60), loop.angles)))
        half = 0.5 * np.diff(cuts)[:, None]
        theta = cuts[:-1, None] + half * (1.0 + NODES)
        f = loop.force(theta) * (half * WEIGHTS)[..., None]
        wave = np.exp(-1j * np.multiply.outer(np.arange(case.u_x.size), theta))
        found = np.einsum("htn,tni->ih", wave, f) / np.pi
        found[:, 0] *= 0.5
        assert np.abs(found - np.stack(case.forces()[:2])).max() <= 2e-8 * case.size


def test_it_is_continuous_and_within_the_load():
    for case, loop in loops(60, 41):
        theta = np.linspace(-7.0, 7.0, 501)
        size = np.hypot(*np.moveaxis(loop.force(theta), -1, 0))
        assert np.all(size <= loop.slip_limit(theta) + 1e-9 * case.size)
        assert np.all(size <= loop.greatest_force * (1.0 + 1e-6))
        jump = loop.force(loop.angles + 1e-9) - loop.force(loop.angles - 1e-9)
        allowed = 1e-6 * (case.size + case.k_v * np.abs(case.v).sum())
        assert np.abs(jump).max(initial=0.0) <= allowed
        # where a slip begins an angle may be before it by rounding, after the slip before
        for aside in (0.0, -1e-15, 1e-15):
            jump = loop.force(loop.angles * (1.0 + aside)) - loop.force(loop.angles + 1e-9)
            assert np.abs(jump).max(initial=0.0) <= allowed


def test_the_slider_rests_or_moves_along_the_force():
    for case, loop in loops(40, 42):
        theta = np.linspace(0.0, 6.28, 300)
        h = 1e-6
        moved = (loop.slider(theta + h) - loop.slider(theta - h)) / (2.0 * h)
        state = loop.states(theta)
        steady = (loop.states(theta + h) == state) & (loop.states(theta - h) == state)
        size = np.abs(case.u_x).max() + np.abs(case.u_y).max()
        assert np.abs(moved[steady & (state == "E")]).max(initial=0.0) <= 1e-8 * size
        slips = steady & (state == "P")
        e = loop.direction(theta[slips])
        assert np.all(np.sum(moved[slips] * e, axis=-1) >= -1e-7 * size)
        light = loop.slip_limit(theta[slips]) > 1e-2 * case.size  # where it opens the direction turns fast
        across = moved[slips][:, 0] * e[:, 1] - moved[slips][:, 1] * e[:, 0]
        assert np.abs(across[light]).max(initial=0.0) <= 1e-4 * size


@pytest.mark.parametrize("seed", [0, 5, 7, 12])
def test_the_sequence_is_that_of_a_march(seed):
    case = random_planars(13, 1, 4)[seed]
    _, letters = March(*case.arguments(), 1).forces()
    joined = "".join(a for a, b in zip(letters, letters[1:] + letters[:1], strict=True) if a != b)
    found = planar_loop(*case.arguments()).sequence
    assert found in joined + joined and len(found) == len(joined)


def test_along_a_line_it_is_that_of_a_contact_on_a_line():
    u, v, law = np.array([0.2, -1j, 0.0, 0.4]), np.array([0, 1.0]), (0.4, 1.0, 1.0, 0.5)
    line, plane = periodic_loop(u, v, *law), planar_loop(u, 0.0 * u, v, *law)
    assert sorted(plane.sequence) == sorted(line.sequence.replace("N", "P"))
    np.testing.assert_allclose(np.sort(plane.angles), np.sort(line.angles), rtol=0.0, atol=1e-9)
    for name in ("dissipation", "slip_path", "greatest_force"):
        assert getattr(plane, name) == pytest.approx(getattr(line, name), rel=1e-7)
    theta = np.linspace(0.0, 6.0, 100)
    np.testing.assert_allclose(plane.force(theta)[:, 0], line.force(theta), rtol=0.0, atol=1e-9)


def test_of_tiny_friction_it_is_followed_in_few_panels():
    u, v = np.array([0.2, -1j, 0.0, 0.4]), np.array([0, 1.0])
    line = periodic_loop(u, v, 1e-3, 1.0, 1.0, 0.5)
    plane = planar_loop(u, 1e-8 * u, v, 1e-3, 1.0, 1.0, 0.5)
    assert plane._panels.shape[0] < 200
    assert plane.dissipation == pytest.approx(line.dissipation, rel=1e-7)
    assert plane.slip_path == pytest.approx(line.slip_path, rel=1e-7)


def test_a_circle_one_that_sticks_and_one_that_is_open():
    circle = planar_loop([0, 1], [0, -1j], [0], 1.0, 2.0, 1.0, 1.2)
    assert (circle.sequence, circle.angles.size) == ("P", 0)
    assert circle.dissipation == pytest.approx(2.0 * np.pi * 2.0 * 0.6 * 0.8, rel=1e-12)
    assert circle.slip_path == pytest.approx(2.0 * np.pi * 0.8, rel=1e-12)
    assert circle.greatest_force == pytest.approx(1.2, rel=1e-12)
    stuck = planar_loop([0.3, 1], [0, -1j], [0], 1.0, 2.0, 1.0, 9.0)
    assert (stuck.sequence, stuck.dissipation) == ("E", 0.0)
    np.testing.assert_allclose(stuck.force(0.0), (2.6, 0.0), atol=1e-15)
    opened = planar_loop([0.3, 1], [0, -1j], [0], 1.0, 2.0, 1.0, -9.0)
    assert (opened.sequence, opened.greatest_force) == ("S", 0.0)


def test_numbers_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="must be finite numbers"):
        planar_loop([0, np.nan], [0, 1], [0], 1.0, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="numbers and one motion"):
        planar_loop([0, 1], [0, 1], [0], [1.0, 2.0], 1.0, 1.0, 1.0)
