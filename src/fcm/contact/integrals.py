"""Integrals of the slip motion, of the normal load and of the friction force over one span, in closed form.

Angles are measured from the end of a slip or from the start of a stick, so that the shortest ones keep their
relative accuracy.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.contact.cycle import Direction, Span
from fcm.contact.limits import FloatArray, SlipLimits


def arc(y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """sin(y), 1 - cos(y) and y - sin(y), each to full relative accuracy."""
    sin_half, cos_half = np.sin(0.5 * y), np.cos(0.5 * y)
    sin, versine = 2.0 * sin_half * cos_half, 2.0 * sin_half * sin_half
    square = y * y
    series = y * square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))
    return sin, versine, np.where(y < 0.02, series, y - sin)


class Slip(NamedTuple):
    """Trigonometry of a slip of duration y, measured back from its end."""

    begin: Direction
    sin: FloatArray  # sin(y)
    versine: FloatArray  # 1 - cos(y)
    deficit: FloatArray  # y - sin(y)

    @classmethod
    def of(cls, span: Span) -> Slip:
        sin, versine, deficit = arc(span.slip)
        begin = Direction(
            span.end.sin - span.end.sin * versine - span.end.cos * sin,
            span.end.cos - span.end.cos * versine + span.end.sin * sin,
        )
        return cls(begin, sin, versine, deficit)


def slip_motion_integrals(
    start: Direction, span: Span, slip: Slip
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrals over a span of w, w sin(theta), w cos(theta).

    In the slip, y before its end, w - w_end = -side (slope sin(y) + curvature (1 - cos(y))).
    """
    half_cube = 0.5 * slip.sin * slip.versine
    g_1 = -span.curvature * slip.deficit - span.slope * slip.versine
    g_cos = span.curvature * (0.5 * slip.deficit - half_cube) - 0.5 * span.slope * slip.sin**2
    g_sin = -0.5 * span.curvature * slip.versine**2 - span.slope * (0.5 * slip.deficit + half_cube)
    end, begin, w, w_end = span.end, slip.begin, span.w_start, span.w_end
    w_b = w * (span.length - span.slip) + w_end * span.slip + span.side * g_1
    w_s = w * (start.cos - begin.cos) + w_end * (begin.cos - end.cos)
    w_c = w * (begin.sin - start.sin) + w_end * (end.sin - begin.sin)
    w_s += span.side * (end.sin * g_cos - end.cos * g_sin)
    w_c += span.side * (end.cos * g_cos + end.sin * g_sin)
    return w_b, w_s, w_c


def load_gradient_integrals(
    span: Span, slip: Slip, limits: SlipLimits, b_bar: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrals over the slip of dn/dx_j times 1, sin(theta), cos(theta)."""
    sin, cos = span.end
    s, c = limits.sin_phi, limits.cos_phi
    sin_2 = 0.5 * (slip.deficit + slip.sin * slip.versine)  # of sin(y)^2 over the slip
    cos_2 = span.slip - sin_2
    sin_cos = 0.5 * slip.sin * slip.sin
    one_s = sin * slip.sin - cos * slip.versine
    one_c = sin * slip.versine + cos * slip.sin
    s_s = sin * sin * cos_2 + cos * cos * sin_2 - 2.0 * sin * cos * sin_cos
    c_c = span.slip - s_s
    s_c = sin * cos * (cos_2 - sin_2) + (sin - cos) * (sin + cos) * sin_cos
    return (
        np.stack((span.slip, c * one_s + s * one_c, b_bar * (c * one_c - s * one_s))),
        np.stack((one_s, c * s_s + s * s_c, b_bar * (c * s_c - s * s_s))),
        np.stack((one_c, c * s_c + s * c_c, b_bar * (c * c_c - s * s_c))),
    )


def stick_force_integrals(
    start: Direction, force: FloatArray, length: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrals over a stick of the force times 1, sin(theta), cos(theta).

    At y after the start the force has become force + cos(start) sin(y) - sin(start) (1 - cos(y)).
    """
    sin, versine, deficit = arc(length)
    half_cube = 0.5 * sin * versine
    one = force * length + start.cos * versine - start.sin * deficit
    g_cos = force * sin + start.cos * 0.5 * sin * sin - start.sin * (half_cube - 0.5 * deficit)
    g_sin = force * versine + start.cos * (half_cube + 0.5 * deficit) - start.sin * 0.5 * versine**2
    return one, start.sin * g_cos + start.cos * g_sin, start.cos * g_cos - start.sin * g_sin
