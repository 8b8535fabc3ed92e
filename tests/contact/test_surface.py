"""The coefficients over the plane: what the paper says of figures 10 and 11, and where the regimes meet."""

import numpy as np
import pytest

from fcm.contact import hysteresis_loop
from fcm.contact.surface import COEFFICIENTS, ParameterPlane, boundaries, regions, surface

DEGREES = np.pi / 180.0
OFF = 1e-6  # beside a boundary


def constant_load(n0):
    """Stiffness and damping of a contact of constant load n0 in [0, 1] times its slip limit.

    Of the parallelogram u - f from the first principles: slip until cos(theta) = 1 - 2 n0, f = 1 - n0 - cos.
    """
    turn = np.arccos(1.0 - 2.0 * n0)
    return (turn - 0.5 * np.sin(2.0 * turn)) / np.pi, 4.0 * n0 * (1.0 - n0) / np.pi


@pytest.mark.parametrize("phi", [0.0, 15.0, 30.0, 90.0, 180.0])
def test_without_load_variation_it_is_the_contact_of_constant_load(phi):
    plane = ParameterPlane(phi * DEGREES, n0_range=(0.0, 1.0), b_range=(0.0, 2.0))
    stiffness, damping = (surface(name, plane) for name in ("F_s", "F_c"))
    expected_stiffness, expected_damping = constant_load(stiffness.n0_bar)
    np.testing.assert_allclose(stiffness.values[0], expected_stiffness, atol=1e-12)
    np.testing.assert_allclose(damping.values[0], expected_damping, atol=1e-12)
    assert not surface("F_b", plane).values[0].any()


def test_in_phase_there_is_no_damping_above_b_1_and_out_of_phase_there_is():
    beyond = {
        phi: surface("F_c", ParameterPlane(phi * DEGREES, b_range=(1.05, 2.0))).values for phi in (0, 15, 30)
    }
    assert not beyond[0].any()
    assert beyond[15].max() > 0.15 and beyond[30].max() > 0.35
    assert beyond[15][-1].max() > 0.08 and beyond[30][-1].max() > 0.2  # at b = 2


def test_the_in_phase_damping_ends_at_b_1():
    drawn = surface("F_c", ParameterPlane())
    damped = (drawn.values > 1e-9).any(axis=1)
    np.testing.assert_array_equal(damped, drawn.b_bar < 1.0)


@pytest.mark.parametrize("phi", [0.0, 15.0, 30.0, 100.0, 180.0, -40.0])
@pytest.mark.parametrize("b", [0.1, 0.7, 1.3, 2.0])
def test_on_each_boundary_the_sequence_changes(phi, b):
    phi *= DEGREES
    edges = {name: float(n0[0]) for name, n0 in boundaries(np.array([b]), phi).items()}
    below, above = (
        {n: hysteresis_loop(x + d, b, phi).sequence for n, x in edges.items()} for d in (-OFF, OFF)
    )
    assert below["open"] == "S" and above["open"] not in ("S", "E", "EPEN")
    assert "S" in below["separation"] and "S" not in above["separation"]
    assert below["slip"] != "E" and above["slip"] == "E"


def test_a_boundary_is_where_the_formulas_say():
    b = np.linspace(0.0, 3.0, 31)
    phi = 30.0 * DEGREES
    ell = [np.sqrt(1.0 + b**2 + sign * 2.0 * b * np.cos(phi)) for sign in (-1.0, 1.0)]
    edges = boundaries(b, phi)
    np.testing.assert_array_equal(edges["open"], -b)
    np.testing.assert_array_equal(edges["separation"], b)
    np.testing.assert_allclose(edges["slip"], sum(ell) / 2.0, atol=1e-12)


@pytest.mark.parametrize("phi", [0.0, 15.0, 180.0, 250.0])
def test_regions_are_the_sequences_of_the_loop(phi):
    plane = ParameterPlane(phi * DEGREES)
    found = regions(plane, steps=(37, 23))
    assert np.array_equal(sum(found.where.values()), np.ones((23, 37)))
    for name, where in found.where.items():
        for row, column in np.argwhere(where)[::7]:
            at = found.n0_bar[column], found.b_bar[row]
            assert hysteresis_loop(*at, plane.phi).sequence == name
            assert found.separates[row, column] == (len(name) > 1 and "S" in name)


def test_in_phase_the_regions_meet_at_b_1_without_slivers():
    found = regions(ParameterPlane())
    assert set(found.where) == {"E", "EPEN", "S", "SE", "SPEN"}
    np.testing.assert_array_equal(found.where["SE"].any(axis=1), found.b_bar > 1.0)


def test_another_law_is_drawn_as_it_is():
    law = lambda n0, b, phi: tuple(np.broadcast_to(k + n0 + b + phi, (b.size, n0.size)) for k in range(3))  # noqa: E731
    for k, name in enumerate(COEFFICIENTS):
        drawn = surface(name, ParameterPlane(0.5), steps=(5, 4), law=law)
        assert drawn.values.shape == (5, 6) and drawn.values[-1, 0] == pytest.approx(k - 2.0 + 2.0 + 0.5)
