"""One steady cycle of the contact, event by event in closed form (sections 3.2 to 3.4).

The slip motion w moves only when a limit of `limits` pushes it. Between consecutive extremes of the two
limits each limit has no maximum (minimum) inside, so over such a *span* the whole of sections 3.2.1 to
3.2.4 is one clip, ``w_end = max(lower, min(w_start, upper))``, and at most one slip, which lasts until
the end of the span. A cycle has at most three spans: those ended by theta_P, by theta_N, and by the
separation (or by theta_N again when the contact never opens). Nothing has to be searched for,
and a rounding error can shift an event but never choose a wrong sequence by more than that error.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.contact.limits import BoolArray, FloatArray, SlipLimits, angle_from, slip_limits

STUCK, SLIPPING, OPEN = 0, 1, 2  # what a contact does over a cycle, see `behaviour`


class Direction(NamedTuple):
    """An angle by its sine and cosine."""

    sin: FloatArray
    cos: FloatArray


class Span(NamedTuple):
    """Stick, then slip (either may be absent), up to the next extreme of a limit or the separation."""

    length: FloatArray  # [rad]
    slip: FloatArray  # the last part of length, [rad]
    side: FloatArray  # +1 positive slip, -1 negative slip, 0 none
    w_start: FloatArray
    w_end: FloatArray
    end: Direction
    slope: FloatArray  # d w / d theta at the end of the slip, times side
    curvature: FloatArray  # -d2 w / d theta2 there, times side
    turns: BoolArray  # True where the slip ends because its own limit turns there


class Cycle(NamedTuple):
    """The cycle from its start: the end of separation or, where there is none, the end of negative slip."""

    limits: SlipLimits
    opens: BoolArray  # True where the contact separates
    theta_1: FloatArray  # half the contact duration [rad], pi where the contact never opens
    closing_rate: FloatArray  # b sin(theta_1), d n / d theta when the contact closes
    start: Direction
    pull: FloatArray  # at the start, d w = -pull d n at fixed theta: what the first stick region remembers
    spans: tuple[Span, Span, Span]


def behaviour(n0_bar: FloatArray, b_bar: FloatArray, limits: SlipLimits) -> FloatArray:
    """STUCK above the slip limit (25), OPEN below n0 = -b, else SLIPPING."""
    code = np.where(overlap(n0_bar, b_bar, limits) > 0.0, SLIPPING, STUCK)
    code = np.where(n0_bar < b_bar, SLIPPING, code)
    return np.where((n0_bar <= -b_bar) | ((b_bar == 0.0) & (n0_bar <= 0.0)), OPEN, code)


def overlap(n0_bar: FloatArray, b_bar: FloatArray, limits: SlipLimits) -> FloatArray:
    """How far the greatest lower limit exceeds the least upper one: ell_1 + ell_2 - 2 n0, see (25)."""
    return (limits.ell_1_excess - (n0_bar - b_bar)) + (limits.ell_2_excess - (n0_bar - b_bar))


def stuck_force(n0_bar: FloatArray, b_bar: FloatArray, limits: SlipLimits) -> FloatArray:
    """Mean force of a contact that never slips: the admissible one nearest to zero."""
    low = limits.ell_2_excess - (n0_bar - b_bar)
    high = (n0_bar - b_bar) - limits.ell_1_excess
    return np.minimum(np.maximum(0.0, low), np.maximum(high, low))


class _Mark(NamedTuple):
    """What a span needs to know of the angle that ends it; index 0 for positive, 1 for negative slip."""

    at: Direction
    lower: FloatArray
    upper: FloatArray
    slope: tuple[FloatArray, FloatArray]
    curvature: tuple[FloatArray, FloatArray]


def _marks(n0_bar: FloatArray, b_bar: FloatArray, limits: SlipLimits) -> tuple[_Mark, _Mark]:
    """theta_P and theta_N."""
    zero = np.zeros_like(b_bar)
    lower_P = limits.ell_1_excess - (n0_bar - b_bar)
    upper_N = (n0_bar - b_bar) - limits.ell_2_excess
    end_P = _Mark(
        at=Direction(limits.sin_P, limits.cos_P),
        lower=lower_P,
        upper=2.0 * limits.sin_P - lower_P,
        slope=(zero, -2.0 * limits.cos_P),
        curvature=(limits.ell_1, limits.ell_1 - 2.0 * limits.sin_P),
    )
    end_N = _Mark(
        at=Direction(limits.sin_N, limits.cos_N),
        lower=2.0 * limits.sin_N - upper_N,
        upper=upper_N,
        slope=(2.0 * limits.cos_N, zero),
        curvature=(limits.ell_2 + 2.0 * limits.sin_N, limits.ell_2),
    )
    return end_P, end_N


def cycle(n0_bar: FloatArray, b_bar: FloatArray, phi: FloatArray, limits: SlipLimits | None = None) -> Cycle:
    """The steady cycle of contacts that slip (`behaviour` is SLIPPING); all arguments of one shape."""
    limits = slip_limits(b_bar, phi) if limits is None else limits
    mark_P, mark_N = _marks(n0_bar, b_bar, limits)
    opens = n0_bar < b_bar
    # b +- n0 are exact or nearly so where they are small, and carry theta_1 to full accuracy at both ends
    above = np.sqrt(np.where(opens, b_bar + n0_bar, 1.0))
    below = np.sqrt(np.where(opens, b_bar - n0_bar, 0.0))
    theta_1 = 2.0 * np.arctan2(above, below)
    closing_rate = above * below
    start, last = _ends(n0_bar, b_bar, limits, mark_N, opens, closing_rate)
    length = 2.0 * theta_1
    to_P = angle_from(*start, limits.sin_P, limits.cos_P)
    to_N = np.where(opens, angle_from(*start, limits.sin_N, limits.cos_N), length)

    # The marks in the order in which they come; one that the contact does not reach is replaced by the last.
    # A contact that never opens always comes by theta_P, if only at the very end.
    to_P = np.where(opens, to_P, np.minimum(to_P, length))
    has_P, has_N = (to_P < length) | ~opens, to_N < length
    P_first = has_P & (~has_N | (to_P <= to_N))
    N_first = has_N & ~P_first
    P_second, N_second = has_P & N_first, has_N & P_first
    to_1 = np.where(P_first, to_P, np.where(N_first, to_N, length))
    to_2 = np.where(P_second, to_P, np.where(N_second, to_N, length))
    marks = (
        _choose(P_first, mark_P, N_first, mark_N, last),
        _choose(P_second, mark_P, N_second, mark_N, last),
        last,
    )
    turns = ((P_first, N_first), (P_second, N_second), (np.zeros_like(opens), ~opens))

    # (20) to (22): what follows the separation
    slips_at_once = np.where(
        opens & (start.cos >= closing_rate), 1.0, np.where(opens & (-start.cos >= closing_rate), -1.0, 0.0)
    )
    w = np.where(opens, start.sin, mark_N.upper)
    spans: list[Span] = []
    for mark, (is_P, is_N), span_length in zip(marks, turns, (to_1, to_2 - to_1, length - to_2), strict=True):
        span = _span(w, mark, span_length, slips_at_once, b_bar, is_P, is_N)
        spans.append(span)
        w = span.w_end
        # A slip that did not end here goes on; but one by a limit that recedes, a rounding error made up.
        slips_at_once = np.where(span.turns | (span.slope < 0.0), 0.0, span.side)
    safe_rate = np.where(closing_rate > 0.0, closing_rate, 1.0)
    pull = np.where(opens, np.clip(start.cos, -safe_rate, safe_rate) / safe_rate, -1.0)
    return Cycle(limits, opens, theta_1, closing_rate, start, pull, (spans[0], spans[1], spans[2]))


def _ends(
    n0_bar: FloatArray,
    b_bar: FloatArray,
    limits: SlipLimits,
    mark_N: _Mark,
    opens: BoolArray,
    closing_rate: FloatArray,
) -> tuple[Direction, _Mark]:
    """Start and last mark: (A3) and (A2) where the contact opens, twice theta_N where it does not."""
    safe_b = np.where(opens, b_bar, 1.0)
    cos_1, sin_1 = -n0_bar / safe_b, closing_rate / safe_b  # of theta_1
    s, c = limits.sin_phi, limits.cos_phi
    start = Direction(
        np.where(opens, c * cos_1 - s * sin_1, limits.sin_N),
        np.where(opens, s * cos_1 + c * sin_1, limits.cos_N),
    )
    end = Direction(
        np.where(opens, c * cos_1 + s * sin_1, limits.sin_N),
        np.where(opens, s * cos_1 - c * sin_1, limits.cos_N),
    )
    last = _Mark(
        at=end,
        lower=np.where(opens, end.sin, mark_N.lower),
        upper=np.where(opens, end.sin, mark_N.upper),
        slope=(
            np.where(opens, closing_rate + end.cos, mark_N.slope[0]),
            np.where(opens, closing_rate - end.cos, mark_N.slope[1]),
        ),
        curvature=(
            np.where(opens, n0_bar + end.sin, mark_N.curvature[0]),
            np.where(opens, n0_bar - end.sin, mark_N.curvature[1]),
        ),
    )
    return start, last


def _choose(is_P: BoolArray, P: _Mark, is_N: BoolArray, N: _Mark, last: _Mark) -> _Mark:
    def pick(p: FloatArray, n: FloatArray, o: FloatArray) -> FloatArray:
        return np.where(is_P, p, np.where(is_N, n, o))

    return _Mark(
        Direction(pick(P.at.sin, N.at.sin, last.at.sin), pick(P.at.cos, N.at.cos, last.at.cos)),
        pick(P.lower, N.lower, last.lower),
        pick(P.upper, N.upper, last.upper),
        (pick(P.slope[0], N.slope[0], last.slope[0]), pick(P.slope[1], N.slope[1], last.slope[1])),
        (
            pick(P.curvature[0], N.curvature[0], last.curvature[0]),
            pick(P.curvature[1], N.curvature[1], last.curvature[1]),
        ),
    )


def _span(
    w: FloatArray,
    mark: _Mark,
    length: FloatArray,
    slips_at_once: FloatArray,
    b_bar: FloatArray,
    is_P: BoolArray,
    is_N: BoolArray,
) -> Span:
    w_end = np.maximum(mark.lower, np.minimum(w, mark.upper))
    side = np.sign(w_end - w)
    positive = side >= 0.0
    slope = np.where(positive, mark.slope[0], mark.slope[1])
    curvature = np.where(positive, mark.curvature[0], mark.curvature[1])
    slip = np.minimum(_slip_angle(np.abs(w_end - w), slope, curvature, b_bar), length)
    slip = np.where((side != 0.0) & (slips_at_once == side), length, slip)
    turns = (is_P & (side > 0.0)) | (is_N & (side < 0.0))
    return Span(length, slip, side, w, w_end, mark.at, slope, curvature, turns)


def _slip_angle(
    change: FloatArray, slope: FloatArray, curvature: FloatArray, b_bar: FloatArray
) -> FloatArray:
    """Duration y of a slip that moves w by change: slope sin(y) + curvature (1 - cos(y)) = change.

    This is (A8), (A11) to (A13) measured back from the end of the slip, in the form that keeps its
    relative accuracy for the shortest slips and has no arccos of a number that may exceed 1.
    """
    scale = 1.0 / np.maximum(1.0, b_bar)
    change, slope, curvature = change * scale, slope * scale, curvature * scale
    root = np.sqrt(np.maximum(slope * slope + change * (2.0 * curvature - change), 0.0))
    return 2.0 * np.arctan2(change, np.maximum(slope + root, 0.0))
