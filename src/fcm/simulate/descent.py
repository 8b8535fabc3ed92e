"""The first descent of a polynomial through zero on [0, 1], none missed.

The Bernstein coefficients of a polynomial enclose its values: where none is negative, neither is the
polynomial; where their sign changes once, it has exactly one root. Otherwise the interval is halved.
The way from powers to Bernstein coefficients is a sum with weights between 0 and 1, so it is accurate.
"""

from __future__ import annotations

from itertools import pairwise
from math import comb

import numpy as np

from fcm.scene.model import FloatArray
from fcm.simulate.flow import ORDER

DEEPEST = 50  # halvings


def _to_bernstein(n: int) -> FloatArray:
    """b = _to_bernstein(n) @ a for the polynomial sum a_i x**i."""
    return np.array(
        [[comb(j, i) / comb(n, i) if i <= j else 0.0 for i in range(n + 1)] for j in range(n + 1)]
    )


def _left_half(n: int) -> FloatArray:
    """Coefficients on [0, 1/2] (de Casteljau); those on [1/2, 1] mirror them."""
    return np.array([[comb(j, i) / 2.0**j if i <= j else 0.0 for i in range(n + 1)] for j in range(n + 1)])


BERNSTEIN = _to_bernstein(ORDER)
LEFT = _left_half(ORDER)
RIGHT = LEFT[::-1, ::-1]


def first_descent(powers: FloatArray, floor: float) -> float | None:
    """Where sum powers[i] x**i, not negative at 0, first descends through zero to below -floor.

    Parameters
    ----------
    powers : (ORDER + 1,)
    floor : float
        Depth that is rounding, >= 0.

    Returns
    -------
    float or None
        The root in [0, 1], to rounding; None where there is none.

    Examples
    --------
    >>> import numpy as np
    >>> p = np.zeros(20); p[:3] = 0.24, -1.0, 1.0  # (x - 0.4) (x - 0.6)
    >>> round(first_descent(p, 0.0), 15)
    0.4
    >>> p[0] = 0.25  # touches
    >>> first_descent(p, 1e-15) is None
    True
    """
    bernstein = BERNSTEIN @ powers
    if bernstein.min() >= -floor:
        return None
    return _search(powers.tolist(), bernstein, 0.0, 1.0, floor)


def _search(powers: list[float], b: FloatArray, low: float, high: float, floor: float) -> float | None:
    if b.min() >= -floor:
        return None
    signs = [x > 0.0 for x in b.tolist() if abs(x) > floor]
    if not signs[0] or high - low < 2.0**-DEEPEST:
        return low  # it descends from rounding at the very start
    if not signs[-1] and sum(p != q for p, q in pairwise(signs)) == 1:
        return _root(powers, low, high)
    middle = 0.5 * (low + high)
    found = _search(powers, LEFT @ b, low, middle, floor)
    return _search(powers, RIGHT @ b, middle, high, floor) if found is None else found


def _root(powers: list[float], low: float, high: float) -> float:
    """Newton's method, kept inside a bracket with the only root: positive at low, negative at high."""
    x = 0.5 * (low + high)
    for _ in range(100):
        value, slope = _horner(powers, x)
        if value > 0.0:
            low = x
        elif value < 0.0:
            high = x
        else:
            return x
        step = -value / slope if slope < 0.0 else np.inf
        new = x + step if low < x + step < high else 0.5 * (low + high)
        if abs(new - x) <= 1e-16 or not low < new < high:
            return new
        x = new
    return x


def _horner(powers: list[float], x: float) -> tuple[float, float]:
    value = slope = 0.0
    for coefficient in reversed(powers):
        slope = slope * x + value
        value = value * x + coefficient
    return value, slope
