"""The Jacobian of the forces in the plane: against differences that are extrapolated, and closed forms."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from fcm import periodic_gradients, planar_gradients
from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.plane.cycle import PlanarContact
from fcm.contact.plane.options import FINEST, OPTIONS

from ..scale import SCALE
from .motions import decaying, random_cases
from .planar_motions import Planar, kernel, random_planars
from .test_planar_forces import EXTREMES, extreme


def differences(contact, x, law, column, step):
    """By one unknown, from steps that are halved three times."""

    def forces(t):
        y = x.copy()
        y[column] += t
        contact.at(y, ContactParameters(*law), gradient=False)
        return np.array(contact.forces)

    rows = [(forces(step / 2**i) - forces(-step / 2**i)) / (2.0 * step / 2**i) for i in range(4)]
    before = rows[-1]
    for order in range(1, 4):
        before = rows[-1]
        rows = [b + (b - a) / (4**order - 1) for a, b in itertools.pairwise(rows)]
    return rows[-1], np.abs(rows[-1] - before).max()


def along_a_line(case, rng):
    """The motion of u_x in any direction, but for a little."""
    u_y = rng.normal() * case.u_x + rng.choice([0.0, 1e-8, 1e-4]) * case.u_y
    return replace(case, u_y=u_y)


@pytest.mark.parametrize("nearly_straight", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_against_differences(seed, nearly_straight):
    """Where the differences themselves settle: not at a tangency, which their steps go past."""
    settled, rng = 0, np.random.default_rng(seed)
    for case in random_planars(12, 20 + seed, 3):
        case = along_a_line(case, rng) if nearly_straight else case
        contact, x = kernel(case, case.u_x.size + 1)
        law = (case.mu, case.k_u, case.k_v, case.n_0)
        contact.at(x, ContactParameters(*law))
        J, size = np.array(contact.jacobian), max(case.k_u, case.k_v)
        contact.cycle.slider.tolerance = 1e-11
        for column in range(x.size):
            tried = [differences(contact, x, law, column, step) for step in (1e-2, 1e-3)]
            found, error = min(tried, key=lambda one: one[1])
            if error > 2e-9 * size:
                continue
            settled += 1
            assert np.abs(J[:, column] - found).max() <= 1e-8 * size, (case, column)
    assert settled > 100


def test_along_a_line_as_a_balance_uses_it():
    """The derivatives of the finest options, to a millionth."""
    rng = np.random.default_rng(0)
    for case in random_planars(150, 20, 5):
        found, case = [], along_a_line(case, rng)
        for options in (OPTIONS, FINEST):
            contact, x = kernel(case, options=options)
            contact.at(x, ContactParameters(case.mu, case.k_u, case.k_v, case.n_0))
            found.append(np.array(contact.jacobian))
        assert np.abs(found[0] - found[1]).max() <= 1e-6 * max(case.k_u, case.k_v), case


def test_across_a_line_from_closing_to_opening():
    """Slip in one direction from closing to opening: only what turns it needs small panels."""
    u = np.array([0.0, -0.27540 - 2.72263j, -0.95127 - 1.72890j])
    v = np.array([-2.4976, -0.3159 - 0.0248j, 0.1809 - 0.4311j])
    case = Planar(0.8 * u, 0.6 * u, v, 0.318, 1.419, 7.636, 14.0126)
    assert case.sequence() == "PS"
    contact, x = kernel(case)
    law = (case.mu, case.k_u, case.k_v, case.n_0)
    contact.at(x, ContactParameters(*law))
    J = np.array(contact.jacobian)
    for column in range(x.size):
        found, error = differences(contact, x, law, column, 1e-2)
        assert error < 1e-8
        assert np.abs(J[:, column] - found).max() <= 1e-8 * case.k_v


@pytest.mark.parametrize("options", [OPTIONS, FINEST])
@pytest.mark.parametrize("small", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("k_v", [1.0, 10.0, 100.0])
def test_motions_far_smaller_than_the_load_allows(small, k_v, options):
    """They slip an instant before the contact opens, at a load that is nearly nothing, and matter only as the
    place where it closed: the derivatives by v are as small as they are."""
    contact, law = PlanarContact([1], [1], options=options), (1.0, 1.0, k_v)
    for n_0, phase in itertools.product((0.0, 0.3, -0.3), (0.3, 1.0, 2.0, 4.0)):
        x = np.array([0, 0, 0, 1, 0, 0.4 * np.sin(1), -0.4 * np.cos(1), 0, 0]) * small
        x[7:] = np.cos(phase), np.sin(phase)
        contact.at(x, ContactParameters(*law, k_v * n_0))
        J = np.array(contact.jacobian)
        assert [contact.cycle.slider.state[p] for p in range(contact.cycle.slider.pieces)] == [0, 1, 2]
        for column in (7, 8):
            found, _ = differences(contact, x, (*law, k_v * n_0), column, 1e-3)
            assert np.abs(J[:2, column] - found[:2]).max() < 1e-3 * small
            assert np.abs(J[3:7, column] - found[3:7]).max() < 1e-3 * small


@pytest.mark.parametrize("small", [1e-2, 1e-4, 1e-6])
def test_load_that_is_small_beside_the_motion(small):
    """A direction that is off fades at once, and panels are as long as those of the forces alone."""
    rng = np.random.default_rng(7)
    u_x, u_y, v = (decaying(rng, 9, 1.0) for _ in range(3))
    case = Planar(u_x, u_y, small * v, 0.5, 1.0, 1.0, small)
    contact, x = kernel(case)
    law = (case.mu, case.k_u, case.k_v, case.n_0)
    contact.at(x, ContactParameters(*law), gradient=False)
    panels = contact.cycle.slider.panels
    contact.at(x, ContactParameters(*law))
    assert contact.cycle.slider.panels < 1.2 * panels
    J = np.array(contact.jacobian)
    contact.cycle.slider.tolerance = 1e-11
    settled = 0
    for column in range(2, x.size):
        by = small if column == 2 or (column - 3) % 6 > 3 else 1.0
        tried = [differences(contact, x, law, column, by * step) for step in (1e-3, 1e-4)]
        found, error = min(tried, key=lambda one: one[1])
        if error > 2e-9:
            continue
        settled += 1
        assert np.abs(J[:, column] - found).max() <= 1e-8, column
    assert settled > 40


def test_of_a_circle():
    """f = (r^2 + i r sqrt(1 - r^2)) exp(i theta), as a complex number; by v at constant load."""
    r = 0.6
    G = planar_gradients([0, 1], [0, -1j], [0], mu=0.5, k_u=1.0, k_v=1.0, n_0=2.0 * r)
    slope = 0.5 * (2.0 * r + 1j * (1.0 - 2.0 * r * r) / np.sqrt(1.0 - r * r))
    assert G.df_x[1, 2, 0, 0] == pytest.approx(slope, abs=1e-11)
    assert G.df_y[1, 2, 0, 0] == pytest.approx(-1j * slope, abs=1e-11)
    assert G.dn[0, 2, 0, 0] == pytest.approx(1.0, abs=1e-15)


def test_along_a_line_are_those_of_a_contact_on_a_line():
    for case in random_cases(40, 31, most=4):
        on_line = periodic_gradients(*case.arguments())
        G = planar_gradients(case.u, 0.0 * case.u, *case.arguments()[1:])
        count = min(case.u.size, on_line.df.shape[2])
        for mine, theirs in ((G.df_x, on_line.df), (G.dn, on_line.dn)):
            size = max(case.k_u, case.k_v)
            assert np.abs(mine[:, 0, :count] - theirs[:, 0, :count]).max() <= 1e-8 * size, case
            assert np.abs(mine[:, 2] - theirs[:, 1]).max() <= 1e-8 * size, case
        assert np.abs(G.df_y[:, 0]).max() <= 1e-8 * case.k_u


def test_turning_the_axes_turns_the_derivatives():
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s], [s, c]])
    for case in random_planars(30, 32, 3):
        u_x, u_y = c * case.u_x - s * case.u_y, s * case.u_x + c * case.u_y
        G, H = case.gradients(), planar_gradients(u_x, u_y, *case.arguments()[2:])
        one, other = np.stack((G.df_x, G.df_y))[:, :, :2], np.stack((H.df_x, H.df_y))[:, :, :2]
        turned = np.einsum("ij,jhkmp,lk->ihlmp", turn, one, turn)
        assert np.abs(turned - other).max() <= 1e-7 * case.k_u


def test_shape_and_a_motion_that_is_open_or_stuck():
    G = planar_gradients(np.zeros((2, 3)), [0, 1], [0, 1j], 0.5, 2.0, 3.0, np.array([[9.0], [-9.0]]))
    assert G.df_x.shape == G.df_y.shape == G.dn.shape == (2, 2, 3, 3, 3, 2)
    stuck = Planar(
        np.array([0.1, 0.2]), np.array([0.3, 0.1j]), np.array([0, 0.1]), 0.5, 2.0, 3.0, 9.0
    ).gradients()
    identity = np.zeros((2, 2, 2), complex)
    identity[0, 0, 0], identity[1, 1, 0], identity[1, 1, 1] = 1.0, 1.0, 1j
    np.testing.assert_allclose(stuck.df_x[:, 0], 2.0 * identity, atol=1e-15)
    np.testing.assert_allclose(stuck.df_y[:, 1], 2.0 * identity, atol=1e-15)
    np.testing.assert_allclose(stuck.dn[:, 2], 3.0 * identity, atol=1e-15)
    assert not stuck.df_x[:, 1:].any() and not stuck.dn[:, :2].any()
    assert not np.abs(np.stack(G[3:5]))[:, 1].any()


@pytest.mark.parametrize(
    "x",
    [
        # two discs hold the slider
        [-0.00398, 1e-4, 0, -0.02218, -0.79968, -0.79968, 0.02218, -3e-5, -0.00997],
        # less apart than the angles at which discs are compared at first
        [-0.20118, 0.0019, 0, -0.01671, -0.72676, -0.72676, 0.01671, -0.00991, -0.68553],
    ],
)
def test_a_slider_at_rest_that_two_discs_hold_in_a_kernel_that_has_not_slipped(x):
    x, law = np.array(x), (0.4, 1.0, 1.0, 2.0)
    contact = PlanarContact([1], [1])
    contact.at(x, ContactParameters(*law))
    assert contact.cycle.resting.held == 2
    J = np.array(contact.jacobian)
    assert np.abs(J[:2, 3:7]).max() > 0.1
    for column in range(x.size):
        found, _ = differences(contact, x, law, column, 1e-7)
        assert np.abs(J[:, column] - found).max() <= 1e-6
    # and no disc is missed
    contact.at(x, ContactParameters(*law))
    theta, force = np.linspace(0.0, 2.0 * np.pi, 20001), np.array(contact.forces)
    u_x, u_y, v = (x[i + 3 + i] * np.cos(theta) - x[i + 4 + i] * np.sin(theta) for i in range(3))
    held = np.hypot(u_x + force[0], u_y + force[1]) - 0.4 * (2.0 + v)
    assert held.max() <= 1e-12


@pytest.mark.slow
@settings(max_examples=max(int(300 * SCALE), 10), deadline=None, derandomize=True)
@given(*EXTREMES)
def test_extremes_have_finite_derivatives(parts, mu, k_u, k_v, n_0):
    assert all(np.all(np.isfinite(part)) for part in extreme(parts, mu, k_u, k_v, n_0).gradients())
