"""Higher harmonics of the exact friction and normal force, which a single-harmonic balance leaves out.

f(theta) = sum over k of Im(F_k exp(i k theta)). Since the slip motion w is continuous, its harmonics are
those of its rate, W_k = 1 / (pi k) times the integral of w' exp(-i k theta), and w moves only while the
contact slips or is open. For k > 1 the friction force u - w has F_k = -W_k.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.contact.normal import contact_angle
from fcm.contact.record import Cycles, Record, Spans

ComplexArray = npt.NDArray[np.complex128]


def friction_harmonics(
    n0_bar: FloatArray, b_bar: FloatArray, phi: FloatArray, orders: npt.ArrayLike
) -> ComplexArray:
    """Harmonics F_k / (k_u a) [-] of the friction force for k > 1; arguments (point,), result (order, point).

    >>> F = friction_harmonics(np.array([0.5]), np.array([0.0]), np.array([0.0]), [2, 3])
    >>> [round(float(size), 6) for size in abs(F[:, 0])]  # a symmetric loop has no even harmonics
    [0.0, 0.106103]
    """
    k = np.asarray(orders, dtype=np.float64)[:, None]
    cycles = Record().of(np.stack((n0_bar, b_bar, phi)))
    total = sum(_slip(Spans(*span), k) for span in np.stack(cycles.spans, axis=1))
    F: ComplexArray = -(total + _separation(cycles, k)) / (np.pi * k)
    return F


def normal_harmonics(n0_star: FloatArray, orders: npt.ArrayLike) -> ComplexArray:
    """Harmonics N_k [-] of max(n0_star + sin(theta), 0) for k > 1; (point,) gives (order, point)."""
    k = np.asarray(orders, dtype=np.float64)[:, None]
    theta_1 = contact_angle(n0_star)
    rate = _of_cosine(0.5 * np.pi - theta_1, 0.5 * np.pi + theta_1, k)
    N: ComplexArray = rate * (np.abs(n0_star) < 1.0) / (np.pi * k)
    return N


def _slip(span: Spans, k: FloatArray) -> ComplexArray:
    """Over the slip of one span w' = side (slope cos(y) + curvature sin(y)), y before its end."""
    plus, minus = _exponential(k + 1.0, span.slip), _exponential(k - 1.0, span.slip)
    rate = 0.5 * span.slope * (plus + minus) - 0.5j * span.curvature * (plus - minus)
    end = np.arctan2(span.end_sin, span.end_cos)
    moved: ComplexArray = span.side * np.exp(-1j * k * end) * rate
    return moved


def _separation(cycles: Cycles, k: FloatArray) -> ComplexArray:
    """While the contact is open w = sin(theta)."""
    closes = np.arctan2(cycles.first_sin, cycles.first_cos) + 2.0 * np.pi
    opens = closes - 2.0 * np.pi + 2.0 * cycles.theta_1
    return np.where(cycles.opens, _of_cosine(opens, closes, k), 0.0)


def _of_cosine(start: FloatArray, end: FloatArray, k: FloatArray) -> ComplexArray:
    """Integral of cos(theta) exp(-i k theta)."""
    whole = np.zeros((k.size, start.size), dtype=np.complex128)
    for order in (k - 1.0, k + 1.0):
        whole += 0.5j * (np.exp(-1j * order * end) - np.exp(-1j * order * start)) / order
    return whole


def _exponential(order: FloatArray, end: FloatArray) -> ComplexArray:
    """Integral of exp(i order y) from 0 to end."""
    whole: ComplexArray = (np.exp(1j * order * end) - 1.0) / (1j * order)
    return whole
