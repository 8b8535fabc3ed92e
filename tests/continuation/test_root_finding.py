"""Where a function changes its sign, between two sides."""

import math

import pytest
from scipy.optimize import brentq

from fcm.continuation.events import SignChange
from fcm.continuation.options import SIGN_CHANGE, SignChangeOptions


def looked(f, low, high, within, zero=1e-10, may_jump=True, options=SIGN_CHANGE):
    """The sides, and at how many places the function was looked at until it was known."""
    sides, count = SignChange(low, high, f(low), f(high), may_jump, options), 0
    while sides.width > within and count < 200:
        at = sides.at
        assert sides.low <= at <= sides.high
        value, count = f(at), count + 1
        if abs(value) < zero:
            return at, count
        sides.update(at, value)
        assert f(sides.low) * f(sides.high) < 0.0
    return 0.5 * (sides.low + sides.high), count


@pytest.mark.parametrize(
    "f",
    [lambda t: math.exp(t) - 1.5, lambda t: 0.2 - math.sin(t), lambda t: t - 0.4 + max(0.0, 4.0 * (t - 0.5))],
)
@pytest.mark.parametrize("may_jump", [False, True])
def test_the_zero_of_a_function_without_jumps(f, may_jump):
    at, count = looked(f, 0.0, 1.0, 1e-12, may_jump=may_jump)
    assert at == pytest.approx(brentq(f, 0.0, 1.0), abs=1e-9)
    assert count <= 12


@pytest.mark.parametrize("jump", [0.0137, 0.5, 0.77])
@pytest.mark.parametrize(("before", "after"), [(-0.085, 0.0006), (0.03, -0.0008), (-1.0, 1.0)])
def test_a_jump_is_halved(jump, before, after):
    at, count = looked(lambda t: (before if t < jump else after) * (1.0 + 0.1 * t), 0.0, 1.0, 1e-7)
    assert at == pytest.approx(jump, abs=1e-7)
    assert count < math.log2(1e7) + 10


def test_where_a_jump_is_not_looked_for_and_looks_seldom_halve_it_takes_more():
    def lopsided(t):
        return -1e-3 if t < 0.77 else 1.0

    blind = SignChangeOptions(jump_difference=2.0, halving_interval=6)
    counts = [looked(lopsided, 0.0, 1.0, 1e-7, options=one)[1] for one in (SIGN_CHANGE, blind)]
    assert counts[1] > 1.5 * counts[0]
