"""Kernel: one steady cycle of the contact, and its Fourier coefficients, in closed form.

The cycle is that of sections 3.2 to 3.4 of the paper and its appendix, event by event.

While the contact is closed, |f| <= n says that the slip motion w = u - f lies between

    lower(theta) = sin(theta) - n(theta) =  ell_1 cos(theta - theta_P) - n0_bar
    upper(theta) = sin(theta) + n(theta) = -ell_2 cos(theta - theta_N) + n0_bar

If the greatest value of the lower limit does not exceed the least value of the upper, it sticks
(`SlipLimits`).

In positive slip the lower limit pushes w up, so it ends at theta_P, where that limit is greatest. In negative
slip the upper limit pushes w down, and slip ends at theta_N. Between successive extremes of the two limits,
sections 3.2.1 to 3.2.4 are one clip, ``w_end = max(lower, min(w_start, upper))``. There is at most one slip,
which lasts until the end of that *span*. A cycle has at most three spans: those ended by theta_P, by theta_N,
and by the separation (or by theta_N again if the contact never opens). No search is needed. A rounding error
can shift an event, but cannot choose a wrong sequence by more than that shift (`HarmonicCycle`).

`Sequence` holds the states of the cycle as a word, with the angles at which they begin.

The Fourier coefficients of the friction force, equation (27), and their derivatives follow from the cycle. In
slip the force is +-n, in stick it is u - w with w at rest. So (27) is a sum over the spans of a cycle of
integrals of sines and cosines. The force is continuous in theta, so the derivative of the integral is the
integral of the derivative: +-(dn/dx) in slip, and in stick the constant value from its start.

The closed form is one `CoefficientLaw`, a table another. The numbers of a point are stored in sequence: F_b,
F_s, F_c, then the derivatives of each by n0_bar, b_bar and phi, twelve in all. A third law gives the
`Boundaries` between the regimes. A contact is fully open where n0 + b < 0, and opens and closes within the
cycle where n0 - b < 0 < n0 + b. Otherwise it slips where n0 - (ell_1 + ell_2) / 2 < 0, the slip limit (25),
and sticks above. These functions are smooth except at b = 1, phi = 0 or pi, where ell_1 or ell_2 is a cone.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import atan2, cos, fabs, hypot, isfinite, isnan, sin, sqrt

from fcm.contact.options import CLOSED_FORM, ClosedFormOptions

LARGEST = cython.declare(cython.double, 1e300)  # beyond, sums of a few terms would overflow
FARTHEST = cython.declare(cython.double, 1e304)  # preloads beyond, also infinite ones, are limited to this
SHRINK = cython.declare(cython.double, 2.0**-32)  # scales n0 and b if b is beyond LARGEST

# behaviour of a contact over a cycle, with the numbers that `periodic` uses as well
OPEN = cython.declare(cython.int, 0)  # below n0 = -b
UNKNOWN = cython.declare(cython.int, 3)  # an argument is NaN
STUCK = cython.declare(cython.int, 4)  # above the slip limit (25)
SLIPPING = cython.declare(cython.int, 5)


@cython.cclass
class SlipLimits:
    """Limits of the slip motion of a contact; `behaviour` takes its arguments and classifies its cycle.

    n0 and b are the preload and the load amplitude used in the calculation. ell_1 and ell_2 are the
    amplitudes of the limits, lower_P is the greatest value of the lower limit, at theta_P, and upper_N the
    least value of the upper one, at theta_N.
    """

    def behaviour(self, n0_bar: float, b_bar: float, phi: float) -> cython.int:
        """Behaviour of a contact: OPEN, STUCK, SLIPPING or UNKNOWN.

        An infinite n0_bar counts as a very large one.
        """
        if isnan(n0_bar) or not isfinite(b_bar) or not isfinite(phi):
            return UNKNOWN
        # above LARGEST only the ratio matters: the spacing of float64 is far more than 1 there
        shrink: float = SHRINK if b_bar > LARGEST else 1.0
        self.n0 = min(max(n0_bar * shrink, -FARTHEST), FARTHEST)
        self.b = b_bar * shrink
        self._limits(phi)
        if self.n0 <= -self.b or (self.b == 0.0 and self.n0 <= 0.0):
            return OPEN
        if self.n0 >= self.b and self.lower_P <= self.upper_N:
            return STUCK
        return SLIPPING

    def stuck_force(self) -> cython.double:
        """Mean force of a contact that never slips: the admissible one nearest to zero."""
        return min(max(0.0, -self.upper_N), max(-self.lower_P, -self.upper_N))

    def _limits(self, phi: float) -> None:
        """Computes the amplitudes ell_1, ell_2 of (A9) and the directions of theta_P, theta_N, for every phi.

        theta_P = atan2(1 - b cos phi, -b sin phi) and theta_N = atan2(-(1 + b cos phi), -b sin phi) are the
        branch-free forms of (A4), (A5). Only their sines and cosines are needed. Where an amplitude vanishes
        (b = 1 at phi = 0 or pi) the limit is constant, and any angle serves.
        """
        b: float = self.b
        sin_half: float = sin(0.5 * phi)
        cos_half: float = cos(0.5 * phi)
        self.sin_phi = 2.0 * sin_half * cos_half
        self.cos_phi = (cos_half - sin_half) * (cos_half + sin_half)
        # 1 -+ b cos(phi), written so that nothing cancels near b = 1 with phi near 0 or pi
        minus: float = (1.0 - b) + 2.0 * b * sin_half * sin_half
        plus: float = (1.0 - b) + 2.0 * b * cos_half * cos_half
        side: float = b * self.sin_phi
        self.ell_1, self.ell_2 = hypot(minus, side), hypot(plus, side)
        self.sin_P, self.cos_P, self.sin_N, self.cos_N = 1.0, 0.0, -1.0, 0.0
        if self.ell_1 > 0.0:
            self.sin_P, self.cos_P = minus / self.ell_1, -side / self.ell_1
        if self.ell_2 > 0.0:
            self.sin_N, self.cos_N = -plus / self.ell_2, -side / self.ell_2
        # the extremes of the limits, by ell - b without the cancellation at large b
        twice: float = 2.0 * b * self.cos_phi
        self.lower_P = (1.0 - twice) / (self.ell_1 + b) - (self.n0 - b)
        self.upper_N = (self.n0 - b) - (1.0 + twice) / (self.ell_2 + b)


PI = cython.declare(cython.double, 3.141592653589793)


def arc(y: float) -> tuple[float, float, float]:
    """sin(y), 1 - cos(y) and y - sin(y), each to a relative error of a few roundings; see `beyond_sine`."""
    sin_half: float = sin(0.5 * y)
    sine: float = 2.0 * sin_half * cos(0.5 * y)
    return sine, 2.0 * sin_half * sin_half, beyond_sine(y, sine)


def beyond_sine(y: float, sine: float) -> float:
    """y - sin(y) to a relative error of 2e-14.

    Small y use its series, whose first omitted term is 1e-15 at most.
    """
    square: float = y * y
    if y < 0.25:
        rest: float = 1.0 - square / 72.0 * (1.0 - square / 110.0)
        return y * square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * rest))
    return y - sine


def angle_from(sin_0: float, cos_0: float, sin_1: float, cos_1: float) -> float:
    """Angle from direction 0 forward to direction 1, in [0, 2 pi) [rad]."""
    turn: float = atan2(sin_1 * cos_0 - cos_1 * sin_0, cos_1 * cos_0 + sin_1 * sin_0)
    return turn + 2.0 * PI if turn < 0.0 else turn


@cython.cclass
class HarmonicCycle(SlipLimits):
    """Passes through the cycle of a contact span by span; subclasses define in `take` what to do with a span.

    For the cycle: ``theta_1`` is half the contact duration [rad], pi if the contact never opens.
    ``closing_rate`` is b sin(theta_1), d n / d theta when it closes. The cycle starts in the direction
    ``first``, at the end of the separation or, without one, of negative slip. There d w = -``pull`` d n at
    fixed theta, which a first stick remembers.

    For a span, from the direction ``start`` to ``end``: ``length`` [rad] is that of stick, then slip; either
    may be absent. ``slip`` [rad] is that of the slip, which begins in the direction ``begin``; ``sin``,
    ``versine`` and ``deficit`` are its three values of `arc`. ``side`` is +1 for positive slip, -1 for
    negative, 0 for none. w changes from ``w_start`` to ``w_end``; in the last y [rad] it changes by side
    (slope sin(y) + curvature (1 - cos(y))).
    """

    def take(self) -> None:
        """Hook called at the end of each span; a subclass defines it."""

    def find(self, n0_bar: float, b_bar: float, phi: float) -> cython.int:
        """Classifies a contact as `behaviour` does, and passes through its cycle if it is SLIPPING."""
        behaviour: cython.int = self.behaviour(n0_bar, b_bar, phi)
        if behaviour == SLIPPING:
            self._pass()
        return behaviour

    def _pass(self) -> None:
        """Passes through all spans, in the order of theta_P and theta_N while the contact is closed."""
        self._start()
        length: float = 2.0 * self.theta_1
        to_P: float = angle_from(self.first_sin, self.first_cos, self.sin_P, self.cos_P)
        to_N: float = length
        if self.opens:
            to_N = angle_from(self.first_sin, self.first_cos, self.sin_N, self.cos_N)
        else:  # always comes by theta_P, at the very end at the latest
            to_P = min(to_P, length)
        P_comes: cython.bint = to_P < length or not self.opens
        N_comes: cython.bint = to_N < length
        if P_comes and N_comes and to_P <= to_N:
            self._until_P(to_P)
            self._until_N(to_N - to_P)
            length -= to_N
        elif P_comes and N_comes:
            self._until_N(to_N)
            self._until_P(to_P - to_N)
            length -= to_P
        elif P_comes:
            self._until_P(to_P)
            length -= to_P
        elif N_comes:
            self._until_N(to_N)
            length -= to_N
        if self.opens:
            self._until_open(length)
        else:
            self._until_N(length)

    def _start(self) -> None:
        """Sets the start of the cycle, (A3), and the state after a separation, (20) to (22)."""
        self.span = 0
        self.opens = self.n0 < self.b
        self.goes_on, self.side = False, 0.0
        if not self.opens:
            self.theta_1, self.closing_rate, self.pull = PI, 0.0, -1.0
            self.first_sin, self.first_cos, self.w_end = self.sin_N, self.cos_N, self.upper_N
        else:
            # b +- n0 are exact or nearly so where they are small: theta_1 is accurate at both ends
            above: float = sqrt(self.b + self.n0)
            below: float = sqrt(self.b - self.n0)
            self.theta_1, self.closing_rate = 2.0 * atan2(above, below), above * below
            cos_1: float = -self.n0 / self.b
            sin_1: float = self.closing_rate / self.b
            self.first_sin = self.cos_phi * cos_1 - self.sin_phi * sin_1
            self.first_cos = self.sin_phi * cos_1 + self.cos_phi * sin_1
            self.w_end = self.first_sin
            self.goes_on = fabs(self.first_cos) >= self.closing_rate
            if self.goes_on:
                self.side = self.pull = 1.0 if self.first_cos >= 0.0 else -1.0
            else:
                self.pull = self.first_cos / self.closing_rate
        self.end_sin, self.end_cos = self.first_sin, self.first_cos

    def _until_P(self, length: float) -> None:
        """Passes the span up to theta_P, where positive slip ends."""
        self._until(self.lower_P, 2.0 * self.sin_P - self.lower_P, length)
        self.end_sin, self.end_cos = self.sin_P, self.cos_P
        if self.side > 0.0:
            self._slip(0.0, self.ell_1, True)
        elif self.side < 0.0:
            self._slip(-2.0 * self.cos_P, self.ell_1 - 2.0 * self.sin_P, False)
        self._end()

    def _until_N(self, length: float) -> None:
        """Passes the span up to theta_N, where negative slip ends."""
        self._until(2.0 * self.sin_N - self.upper_N, self.upper_N, length)
        self.end_sin, self.end_cos = self.sin_N, self.cos_N
        if self.side < 0.0:
            self._slip(0.0, self.ell_2, True)
        elif self.side > 0.0:
            self._slip(2.0 * self.cos_N, self.ell_2 + 2.0 * self.sin_N, False)
        self._end()

    def _until_open(self, length: float) -> None:
        """Passes the span up to the separation, (A2), where both limits equal sin(theta)."""
        cos_1: float = -self.n0 / self.b
        sin_1: float = self.closing_rate / self.b
        sin_end: float = self.cos_phi * cos_1 + self.sin_phi * sin_1
        self._until(sin_end, sin_end, length)
        self.end_sin, self.end_cos = sin_end, self.sin_phi * cos_1 - self.cos_phi * sin_1
        if self.side != 0.0:
            self._slip(
                self.closing_rate + self.side * self.end_cos, self.n0 + self.side * self.end_sin, False
            )
        self._end()

    def _until(self, lower: float, upper: float, length: float) -> None:
        """Sets the slider at the end of a span: w clipped between the limits there."""
        self.start_sin, self.start_cos, self.length = self.end_sin, self.end_cos, length
        self.w_start = self.w_end
        self.w_end = max(lower, min(self.w_start, upper))
        before: float = self.side
        self.side = 0.0
        if self.w_end > self.w_start:
            self.side = 1.0
        elif self.w_end < self.w_start:
            self.side = -1.0
        self.goes_on = self.goes_on and self.side == before

    def _slip(self, slope: float, curvature: float, turns: bool) -> None:
        """Sets the duration of a span's slip from slope sin(y) + curvature (1 - cos(y)) = change of w.

        This is (A8), (A11) to (A13) measured back from the end of the slip, in the form that keeps its
        relative accuracy for the shortest slips and has no arccos of a number that may exceed 1.
        """
        self.slope, self.curvature, self.slip = slope, curvature, self.length
        if not self.goes_on:
            scale: float = 1.0 / max(1.0, self.b)
            change: float = fabs(self.w_end - self.w_start) * scale
            rise: float = slope * scale
            root: float = sqrt(max(rise * rise + change * (2.0 * curvature * scale - change), 0.0))
            self.slip = min(2.0 * atan2(change, max(rise + root, 0.0)), self.length)
        # a slip that its own limit ends is over; a slip by a receding limit is rounding
        self.goes_on = not turns and slope >= 0.0

    def _end(self) -> None:
        """Completes a span: sets its slip and start direction, and calls `take`."""
        if self.side == 0.0:
            self.goes_on = False
            self.slip = self.sin = self.versine = self.deficit = 0.0
            self.begin_sin, self.begin_cos = self.end_sin, self.end_cos
        else:
            self.sin, self.versine, self.deficit = arc(self.slip)
            self.begin_sin = self.end_sin - self.end_sin * self.versine - self.end_cos * self.sin
            self.begin_cos = self.end_cos - self.end_cos * self.versine + self.end_sin * self.sin
        self.take()
        self.span += 1


NAN = cython.declare(cython.double, float("nan"))

LETTER_E = cython.declare(cython.int, ord("E"))
LETTER_P = cython.declare(cython.int, ord("P"))
LETTER_N = cython.declare(cython.int, ord("N"))
LETTER_S = cython.declare(cython.int, ord("S"))
MOST = cython.declare(cython.int, 7)  # greatest number of states of a cycle, and one more


@cython.cclass
class Sequence(HarmonicCycle):
    """The states of a cycle that float64 resolves, and those that a consistent sequence needs.

    Between opposite slips there is always a stick, however short. A stick after a slip ends in the opposite
    slip: the limit that pushed w is past its extreme, and w must leave it to be at the other one at the end.

    ``regions`` has a row for each, ``count`` in all: its letter, its angle relative to the first, and w if it
    is a stick. ``state`` is +1 in positive slip, -1 in negative slip, 0 in stick, 2 in separation.
    """

    def __init__(self, options: ClosedFormOptions = CLOSED_FORM) -> None:
        self.min_change = options.min_change
        self.regions = np.empty((MOST, 3))

    def of(self, n0_bar: float, b_bar: float, phi: float) -> None:
        """Fills the regions of a contact; none if its behaviour is UNKNOWN."""
        self.count = 0
        behaviour: cython.int = self.find(n0_bar, b_bar, phi)
        if behaviour == STUCK:
            self._region(LETTER_E, 0.0, -self.stuck_force())
        elif behaviour == OPEN:
            self._region(LETTER_S, 0.0, NAN)
        elif behaviour == SLIPPING and self.opens and self.state == 0.0 and self.last_slip != 0.0:
            self._region(LETTER_N if self.last_slip > 0.0 else LETTER_P, self.since, NAN)

    def take(self) -> None:
        """Adds the regions of the present span."""
        if self.span == 0:
            self.since, self.last_slip = 2.0 * (PI - self.theta_1), 0.0
            self.state = 2.0 if self.opens else -1.0
            if self.opens:
                self._region(LETTER_S, 0.0, NAN)
        side: float = self._seen()
        slip: float = self.slip if side == self.side else 0.0
        stick: float = self.length - (self.slip if side != 0.0 else 0.0)
        if self.state != 0.0 and (stick > self.min_change or (side != 0.0 and self.state == -side)):
            self._region(LETTER_E, self.since, self.w_start)
            self.state = 0.0
        self.since += self.length
        if side != 0.0 and side != self.state:
            self._region(LETTER_P if side > 0.0 else LETTER_N, self.since - slip, NAN)
        if side != 0.0:
            self.state = self.last_slip = side

    def _seen(self) -> float:
        """Side (+1 or -1) of the slip in a span, 0 if float64 resolves none."""
        if self.opens:
            return self.side if fabs(self.w_end - self.w_start) > self.min_change else 0.0
        if self.lower_P - self.upper_N <= self.min_change:  # both slips occur, equally large, or none
            return 0.0
        return 1.0 if self.span == 0 else -1.0

    def _region(self, letter: cython.int, since: float, w: float) -> None:
        self.regions[self.count, 0], self.regions[self.count, 1], self.regions[self.count, 2] = (
            letter,
            since,
            w,
        )
        self.count += 1

    def loop(
        self, n0_bar: cython.double, b_bar: cython.double, phi: cython.double
    ) -> tuple[float, np.ndarray]:
        """Angle [rad] at which the first region begins, and the regions (region, 3); for finite arguments."""
        self.of(n0_bar, b_bar, phi)
        at: float = 0.0
        if self.count > 1:
            at = atan2(self.end_sin, self.end_cos) if self.opens else atan2(self.first_sin, self.first_cos)
        return at, np.array(self.regions[: self.count])

    def words(self, points: cython.double[:, ::1]) -> np.ndarray:
        """State sequences (point,) of contacts, as words; points has rows n0_bar, b_bar, phi (3, point)."""
        i: cython.Py_ssize_t
        k: cython.int
        letters = np.zeros((points.shape[1], MOST - 1), dtype=np.uint32)
        out: cython.uint[:, ::1] = letters
        with cython.nogil:
            for i in range(points.shape[1]):
                self.of(points[0, i], points[1, i], points[2, i])
                for k in range(min(self.count, MOST - 1)):
                    out[i, k] = cython.cast(cython.uint, self.regions[k, 0])
        return letters.view(f"U{MOST - 1}")[:, 0]


@cython.cclass
class CoefficientLaw:
    """Base class of laws for the Fourier coefficients of a contact; a subclass defines `evaluate`."""

    def evaluate(
        self,
        n0_bar: float,
        b_bar: float,
        phi: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """Writes the numbers of one point to out[at:]: three coefficients, or all twelve with the gradient.

        b_bar is not negative. The numbers are NaN if an argument is NaN, or if b_bar or phi is infinite.
        """

    def unknown(self, gradient: bool, out: cython.double[::1], at: cython.Py_ssize_t) -> None:
        """Writes NaN for each of the numbers of a point."""
        i: cython.Py_ssize_t
        for i in range(12 if gradient else 3):
            out[at + i] = NAN

    def many(self, n0_bar: object, b_bar: object, phi: object, gradient: cython.bint) -> np.ndarray:
        """Numbers (3 or 12, ...) of many points, whose arguments are broadcast.

        Raises ValueError if an element of b_bar is negative.
        """
        n0, b, ph = (np.asarray(x, dtype=np.float64) for x in (n0_bar, b_bar, phi))
        if not n0.shape == b.shape == ph.shape:
            n0, b, ph = np.broadcast_arrays(n0, b, ph)
        shape = n0.shape
        numbers: cython.Py_ssize_t = 12 if gradient else 3
        out = np.empty((n0.size, numbers))
        # ravel copies what is not contiguous; elements of a memoryview, unlike an array's, are plain floats
        points = n0.ravel().data, b.ravel().data, ph.ravel().data
        if self._fill(points[0], points[1], points[2], gradient, out.reshape(-1).data, numbers):
            raise ValueError("b_bar is an amplitude and must not be negative; shift phi by pi instead")
        return out.T.reshape(numbers, *shape)

    def _fill(
        self,
        n0_bar: cython.const[cython.double][::1],  # type: ignore[valid-type]
        b_bar: cython.const[cython.double][::1],  # type: ignore[valid-type]
        phi: cython.const[cython.double][::1],  # type: ignore[valid-type]
        gradient: bool,
        out: cython.double[::1],
        numbers: cython.Py_ssize_t,
    ) -> bool:
        """Evaluates all points; stops and returns True at the first negative element of b_bar."""
        i: cython.Py_ssize_t
        with cython.nogil:
            for i in range(b_bar.shape[0]):
                if b_bar[i] < 0.0:
                    return True
                self.evaluate(n0_bar[i], b_bar[i], phi[i], gradient, out, i * numbers)
        return False


@cython.final
@cython.cclass
class CoefficientIntegrals(HarmonicCycle):
    """Integrals of one contact's force over its cycle: three coefficients and nine derivatives.

    During the summation over the spans they are pi times the coefficients.

    ``b_n`` is the derivative of F_b by n0_bar, ``c_phi`` that of F_c by phi. ``kept_n``, ``kept_b``,
    ``kept_phi`` are dw/dx in stick. For a ``light`` load the force is integrated; this keeps the relative
    error of the arguments, however small they are against the motion, 1. Otherwise u - w is integrated, which
    is faster, and exact because the load is not small.
    """

    def __init__(self, options: ClosedFormOptions = CLOSED_FORM) -> None:
        self.light_load = options.light_load

    def sum(self, n0_bar: float, b_bar: float, phi: float, gradient: bool) -> cython.int:
        """Computes all coefficients of one contact and returns its behaviour."""
        self.gradient = gradient
        self.F_b = self.F_s = self.F_c = 0.0
        self.b_n = self.b_b = self.b_phi = self.s_n = self.s_b = self.s_phi = 0.0
        self.c_n = self.c_b = self.c_phi = 0.0
        behaviour: cython.int = self.find(n0_bar, b_bar, phi)
        if behaviour == SLIPPING:
            self._divide()
        elif behaviour == STUCK:
            self._stuck()
        return behaviour

    def _divide(self) -> None:
        """Turns integrals over the cycle into coefficients, and adds the integral of the motion u."""
        if not self.light and self.opens:
            sines: float = self.first_sin * self.first_cos - self.end_sin * self.end_cos
            self.F_b += self.first_cos - self.end_cos
            self.F_s += self.theta_1 + 0.5 * sines
            self.F_c += 0.5 * (self.end_sin - self.first_sin) * (self.end_sin + self.first_sin)
        elif not self.light:
            self.F_s += PI
        self.F_b *= 0.5 / PI
        self.F_s /= PI
        self.F_c /= PI
        self.b_n, self.b_b, self.b_phi = self.b_n * 0.5 / PI, self.b_b * 0.5 / PI, self.b_phi * 0.5 / PI
        self.s_n, self.s_b, self.s_phi = self.s_n / PI, self.s_b / PI, self.s_phi / PI
        self.c_n, self.c_b, self.c_phi = self.c_n / PI, self.c_b / PI, self.c_phi / PI

    def _stuck(self) -> None:
        """Sets the coefficients of a contact that never slips, F_b = clip(0, ell_2 - n0, n0 - ell_1)."""
        self.F_b, self.F_s = self.stuck_force(), 1.0
        # (b +- cos(phi)) / ell by the directions theta_P and theta_N, which stay bounded
        if self.F_b > 0.0:
            self.b_n = -1.0
            self.b_b = -(self.cos_phi * self.sin_N + self.sin_phi * self.cos_N)
            self.b_phi = self.cos_N
        elif self.F_b < 0.0:
            self.b_n = 1.0
            self.b_b = self.cos_phi * self.sin_P + self.sin_phi * self.cos_P
            self.b_phi = self.cos_P

    def take(self) -> None:
        """Adds the integrals over the present span."""
        if self.span == 0:
            self.light = max(abs(self.n0), self.b) < self.light_load
            self.force = 0.0 if self.opens else -self._load(self.start_sin, self.start_cos)
            self._keep(self.pull, self.start_sin, self.start_cos)
        if self.light:
            self._stick_force()
        else:
            self._motion()
        if self.gradient:
            self._stick_gradient()
        if self.side != 0.0 and (self.light or self.gradient):
            self._slipped()
        # a whole span at a time: the spans of a symmetric loop cancel to the last digit
        self.F_b, self.F_s, self.F_c = self.F_b + self.span_b, self.F_s + self.span_s, self.F_c + self.span_c
        if self.side != 0.0:
            self._keep(self.side, self.end_sin, self.end_cos)
            self.force = self.side * self._load(self.end_sin, self.end_cos)
        else:
            self.force = self.end_sin - self.w_end

    def _load(self, sin_theta: float, cos_theta: float) -> cython.double:
        """Normal load n at an angle given by its sine and cosine."""
        return self.n0 + self.b * (sin_theta * self.cos_phi + cos_theta * self.sin_phi)

    def _keep(self, pull: float, sin_theta: float, cos_theta: float) -> None:
        """Derivatives dw/dx = -pull dn/dx of the slider during a stick that begins at a given angle."""
        self.kept_n = -pull
        self.kept_b = -pull * (sin_theta * self.cos_phi + cos_theta * self.sin_phi)
        self.kept_phi = -pull * self.b * (cos_theta * self.cos_phi - sin_theta * self.sin_phi)

    def _motion(self) -> None:
        """Computes the integrals of -w, -w sin(theta) and -w cos(theta) over a span."""
        stick_sin: float = self.start_cos - self.begin_cos
        stick_cos: float = self.begin_sin - self.start_sin
        self.span_b = -(self.w_start * (self.length - self.slip) + self.w_end * self.slip)
        self.span_s = -(self.w_start * stick_sin + self.w_end * (self.begin_cos - self.end_cos))
        self.span_c = -(self.w_start * stick_cos + self.w_end * (self.end_sin - self.begin_sin))
        if self.side != 0.0:
            half_cube: float = 0.5 * self.sin * self.versine
            rise: float = self.side * self.slope
            bend: float = self.side * self.curvature
            g_cos: float = bend * (0.5 * self.deficit - half_cube) - 0.5 * rise * self.sin * self.sin
            g_sin: float = -0.5 * bend * self.versine * self.versine - rise * (0.5 * self.deficit + half_cube)
            self.span_b += bend * self.deficit + rise * self.versine
            self.span_s -= self.end_sin * g_cos - self.end_cos * g_sin
            self.span_c -= self.end_cos * g_cos + self.end_sin * g_sin

    def _stick_force(self) -> None:
        """Computes the integrals of the force over the stick of a span, for a light load."""
        length: float = self.length - self.slip
        sine, versine, deficit = arc(length)
        start_sin: float = self.start_sin
        start_cos: float = self.start_cos
        half_cube: float = 0.5 * sine * versine
        g_cos: float = (
            self.force * sine + start_cos * 0.5 * sine * sine - start_sin * (half_cube - 0.5 * deficit)
        )
        g_sin: float = (
            self.force * versine
            + start_cos * (half_cube + 0.5 * deficit)
            - start_sin * 0.5 * versine * versine
        )
        self.span_b = self.force * length + start_cos * versine - start_sin * deficit
        self.span_s = start_sin * g_cos + start_cos * g_sin
        self.span_c = start_cos * g_cos - start_sin * g_sin

    def _stick_gradient(self) -> None:
        """Adds the integrals of df/dx = -dw/dx over the stick of a span."""
        length: float = self.length - self.slip
        sines: float = self.start_cos - self.begin_cos
        cosines: float = self.begin_sin - self.start_sin
        self.b_n -= length * self.kept_n
        self.b_b -= length * self.kept_b
        self.b_phi -= length * self.kept_phi
        self.s_n -= sines * self.kept_n
        self.s_b -= sines * self.kept_b
        self.s_phi -= sines * self.kept_phi
        self.c_n -= cosines * self.kept_n
        self.c_b -= cosines * self.kept_b
        self.c_phi -= cosines * self.kept_phi

    def _slipped(self) -> None:
        """Adds the integrals of +-n and +-dn/dx, dn/dx = 1, sin(theta + phi), b cos(theta + phi)."""
        sin: float = self.end_sin
        cos: float = self.end_cos
        s: float = self.side * self.sin_phi
        c: float = self.side * self.cos_phi
        sin_2: float = 0.5 * (self.deficit + self.sin * self.versine)  # integral of sin(y)^2
        sin_cos: float = 0.5 * self.sin * self.sin
        one_s: float = sin * self.sin - cos * self.versine  # integral of sin(theta)
        one_c: float = sin * self.versine + cos * self.sin
        s_s: float = sin * sin * (self.slip - sin_2) + cos * cos * sin_2 - 2.0 * sin * cos * sin_cos
        c_c: float = self.slip - s_s
        s_c: float = sin * cos * (self.slip - 2.0 * sin_2) + (sin - cos) * (sin + cos) * sin_cos
        b_n: float = self.side * self.slip
        s_n: float = self.side * one_s
        c_n: float = self.side * one_c
        b_b: float = c * one_s + s * one_c
        s_b: float = c * s_s + s * s_c
        c_b: float = c * s_c + s * c_c
        if self.light:
            self.span_b += self.n0 * b_n + self.b * b_b
            self.span_s += self.n0 * s_n + self.b * s_b
            self.span_c += self.n0 * c_n + self.b * c_b
        self.b_n += b_n
        self.b_b += b_b
        self.b_phi += self.b * (c * one_c - s * one_s)
        self.s_n += s_n
        self.s_b += s_b
        self.s_phi += self.b * (c * s_c - s * s_s)
        self.c_n += c_n
        self.c_b += c_b
        self.c_phi += self.b * (c * c_c - s * s_c)


@cython.final
@cython.cclass
class ClosedForm(CoefficientLaw):
    """The coefficient law in closed form."""

    def __init__(self, options: ClosedFormOptions = CLOSED_FORM) -> None:
        self.integrals = CoefficientIntegrals(options)

    def evaluate(
        self,
        n0_bar: float,
        b_bar: float,
        phi: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """Writes the coefficients of one point, from their closed form; see `CoefficientLaw.evaluate`."""
        if self.integrals.sum(n0_bar, b_bar, phi, gradient) == UNKNOWN:
            self.unknown(gradient, out, at)
            return
        out[at], out[at + 1], out[at + 2] = self.integrals.F_b, self.integrals.F_s, self.integrals.F_c
        if gradient:
            at += 3
            out[at], out[at + 1], out[at + 2] = self.integrals.b_n, self.integrals.b_b, self.integrals.b_phi
            out[at + 3], out[at + 4], out[at + 5] = (
                self.integrals.s_n,
                self.integrals.s_b,
                self.integrals.s_phi,
            )
            out[at + 6], out[at + 7], out[at + 8] = (
                self.integrals.c_n,
                self.integrals.c_b,
                self.integrals.c_phi,
            )


@cython.cclass
class Boundaries(CoefficientLaw):
    """The functions n0 + b, n0 - b and n0 - (ell_1 + ell_2) / 2 of the regimes, as a coefficient law."""

    def __init__(self) -> None:
        self.limits = SlipLimits()

    def evaluate(
        self,
        n0_bar: float,
        b_bar: float,
        phi: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """Writes the three boundary functions of one point; see `CoefficientLaw.evaluate`."""
        i: cython.Py_ssize_t
        if self.limits.behaviour(n0_bar, b_bar, phi) == UNKNOWN:
            self.unknown(gradient, out, at)
            return
        out[at] = self.limits.n0 + self.limits.b
        out[at + 1] = self.limits.n0 - self.limits.b
        out[at + 2] = 0.5 * (self.limits.upper_N - self.limits.lower_P)
        if gradient:
            for i in range(3):
                out[at + 3 + 3 * i] = 1.0
            out[at + 4], out[at + 5] = 1.0, 0.0
            out[at + 7], out[at + 8] = -1.0, 0.0
            # d ell / d(b, phi) by the directions theta_P and theta_N, which stay bounded
            cos_phi: float = self.limits.cos_phi
            sin_phi: float = self.limits.sin_phi
            cosines: float = self.limits.cos_P + self.limits.cos_N
            out[at + 10] = 0.5 * (cos_phi * (self.limits.sin_P + self.limits.sin_N) + sin_phi * cosines)
            out[at + 11] = 0.5 * (self.limits.cos_P - self.limits.cos_N)
