"""Values beside a curve, on curves that are known."""

from types import SimpleNamespace

import numpy as np
import pytest

from fcm.accuracy.curve_distance import ReferenceCurveData, rises, shifted
from fcm.accuracy.reference_curve import ComparedQuantities


def beside(place, parameter, rate, value, slope, wanted, forward):
    out = np.empty((len(wanted), 1))
    other = ReferenceCurveData(place, parameter, rate)
    other.values(wanted, np.asarray(forward, dtype=float), value[:, None], slope[:, None], out)
    return out[:, 0]


def test_a_cubic_is_found_exactly():
    s = np.linspace(0.0, 2.0, 9)
    wanted = s[1:-1] ** 3 + s[1:-1] + 0.1
    wanted = np.concatenate((s[:1], wanted, s[-1:]))
    value = beside(s, s**3 + s, 3.0 * s**2 + 1.0, 2.0 * s**3 - s, 6.0 * s**2 - 1.0, wanted, np.ones(9))
    roots = [next(r.real for r in np.roots([1.0, 0.0, 1.0, -w]) if abs(r.imag) < 1e-9) for w in wanted[1:-1]]
    assert value[1:-1] == pytest.approx(2.0 * np.array(roots) ** 3 - np.array(roots), rel=1e-9)


def test_beyond_its_ends_a_curve_goes_on_straight():
    s = np.array([0.0, 1.0, 2.0])
    value = beside(s, s, np.ones(3), s**2, 2.0 * s, np.array([-0.5, 1.0, 2.5]), np.ones(3))
    assert value == pytest.approx([0.0, 1.0, 4.0 + 0.5 * 4.0])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_lies_beyond_a_fold_has_no_value(sign):
    """The circle's right half, and one whose fold comes earlier: near the fold there is nothing beside it."""
    s = np.linspace(0.0, np.pi, 41)
    mine, other = np.sin(s), np.sin(s) - 0.02
    forward = sign * np.cos(s)
    place, rate = s, sign * np.cos(s)
    value = beside(place, sign * other, rate, -np.cos(s), np.sin(s), sign * mine, np.sign(forward))
    beyond = mine > 0.98
    assert np.isnan(value[beyond]).all()
    inside = ~beyond & (mine > 0.1)
    assert np.isfinite(value[inside]).all()
    true = -np.sqrt(1.0 - (mine + 0.02) ** 2, where=mine + 0.02 < 1.0, out=np.zeros(41)) * np.sign(np.cos(s))
    assert value[inside] == pytest.approx(true[inside], abs=2e-4)


def test_an_unknown_stretch_has_no_value():
    s = np.arange(5.0)
    moved = s + np.array([0.0, 0.0, np.nan, 0.0, 0.0])
    value = beside(s, moved, np.ones(5), s, np.ones(5), s + 0.5, np.ones(5))
    assert np.isnan(value).tolist() == [False, True, True, False, False]


def test_a_curve_moved_along_itself_and_across_differs_by_what_it_is_across():
    """Amplitudes of p = 1 + s: p**2, and p**2 + 0.01 of a curve whose points lie further on, where it is as
    far off all the same; the unit is what the amplitudes are."""
    s = np.linspace(0.0, 1.0, 21)
    p, on = 1.0 + s, 0.02
    z, direction = np.column_stack((np.zeros_like(p), p)), np.tile([0.0, 1.0], (21, 1))
    amplitude, growth = (p**2)[:, None], (2.0 * p)[:, None]
    change = np.column_stack((on / p, ((p + on) ** 2 + 0.01) / p**2 - 1.0))
    compared = ComparedQuantities(amplitude, growth, amplitude, change)
    off = shifted(s, z, direction, compared)
    assert off[1:, 0] == pytest.approx(0.01 / p[1:] ** 2, rel=2e-3)  # at p = 1 it goes on straight
    amplitude, growth, change = amplitude[::-1].copy(), -growth[::-1].copy(), change[::-1].copy()
    compared = ComparedQuantities(amplitude, growth, amplitude, change)
    back = shifted(s, z[::-1].copy(), -direction, compared)
    assert back[::-1] == pytest.approx(off, rel=1e-9)


def test_between_points_a_parabola_is_higher_than_at_the_highest():
    """Points a quarter of the way and three quarters beside the top; of a flat curve moved by a straight line
    none is, nor is anything told beside a corner."""
    s = np.array([-0.75, 0.25, 1.25])
    none = np.zeros((3, 1))
    parabola = SimpleNamespace(amplitude=1.0 - s[:, None] ** 2, growth=-2.0 * s[:, None])
    flat = SimpleNamespace(amplitude=none, growth=none)
    corner, top = np.zeros(3, dtype=np.uint8), np.array([1])
    assert rises(s, parabola, none, corner, top) == pytest.approx([0.0625], rel=1e-9)
    assert rises(s, flat, s[:, None].copy(), corner, np.array([2])) == pytest.approx([0.0])
    assert rises(s, parabola, none, np.array([1, 0, 1], dtype=np.uint8), top) == 0.0
