"""Kernel: one steady cycle of the contact, event by event in closed form (sections 3.2 to 3.4, appendix).

Positive slip is the lower limit of w, see `slip_limits`, pushing it up, so it ends at theta_P, where that
limit is greatest; negative slip is the upper limit pushing w down, and ends at theta_N. Between consecutive
extremes of the two limits the whole of sections 3.2.1 to 3.2.4 is one clip, ``w_end = max(lower, min(w_start,
upper))``, and at most one slip, which lasts until the end of that *span*. A cycle has at most three spans:
those ended by theta_P, by theta_N, and by the separation (or by theta_N again when the contact never opens).
Nothing has to be searched for, and a rounding error can shift an event but never choose a wrong sequence by
more than that.
"""

import cython
from cython.cimports.libc.math import atan2, cos, fabs, sin, sqrt

if cython.compiled:
    from cython.cimports.fcm.contact.slip_limits import SLIPPING, SlipLimits
else:
    from fcm.contact.slip_limits import SLIPPING, SlipLimits

PI = cython.declare(cython.double, 3.141592653589793)


def arc(y: float) -> tuple[float, float, float]:
    """sin(y), 1 - cos(y) and y - sin(y), each with a relative error of some roundings, see `beyond_sine`."""
    sin_half: float = sin(0.5 * y)
    sine: float = 2.0 * sin_half * cos(0.5 * y)
    return sine, 2.0 * sin_half * sin_half, beyond_sine(y, sine)


def beyond_sine(y: float, sine: float) -> float:
    """y - sin(y) to 2e-14 of itself, where it is small by its series: the term left out is 1e-15 at most."""
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
class Cycle(SlipLimits):
    """Goes through the cycle of a contact, span by span; what is made of the spans is for subclasses to say.

    Of the cycle: ``theta_1`` is half the contact duration [rad], pi where the contact never opens, and
    ``closing_rate`` is b sin(theta_1), d n / d theta when it closes. It starts in the direction ``first``, at
    the end of the separation or, where there is none, of negative slip. ``pull``: there d w = -pull d n at
    fixed theta, which is what a first stick remembers.

    Of a span: from the direction ``start`` to ``end`` it is ``length`` [rad]: stick, then slip; either may be
    absent. The slip is ``slip`` [rad], from the direction ``begin`` on; ``sin``, ``versine`` and ``deficit``
    are the three of `arc`. ``side`` is +1 for positive slip, -1 for negative, 0 for none; w goes from
    ``w_start`` to ``w_end``, and side (slope sin(y) + curvature (1 - cos(y))) of it in the last y [rad].
    """

    def take(self) -> None:
        """What is made of a span; called at the end of each."""

    def find(self, n0_bar: float, b_bar: float, phi: float) -> cython.int:
        """What a contact does; where it is SLIPPING, its cycle has been gone through."""
        behaviour: cython.int = self.behaviour(n0_bar, b_bar, phi)
        if behaviour == SLIPPING:
            self._pass()
        return behaviour

    def _pass(self) -> None:
        """Through the spans, in the order in which theta_P and theta_N come while the contact is closed."""
        self._start()
        length: float = 2.0 * self.theta_1
        to_P: float = angle_from(self.first_sin, self.first_cos, self.sin_P, self.cos_P)
        to_N: float = length
        if self.opens:
            to_N = angle_from(self.first_sin, self.first_cos, self.sin_N, self.cos_N)
        else:  # always comes by theta_P, if only at the very end
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
        """Where the cycle starts, (A3), and what follows a separation, (20) to (22)."""
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
        """Up to theta_P, where positive slip ends."""
        self._until(self.lower_P, 2.0 * self.sin_P - self.lower_P, length)
        self.end_sin, self.end_cos = self.sin_P, self.cos_P
        if self.side > 0.0:
            self._slip(0.0, self.ell_1, True)
        elif self.side < 0.0:
            self._slip(-2.0 * self.cos_P, self.ell_1 - 2.0 * self.sin_P, False)
        self._end()

    def _until_N(self, length: float) -> None:
        """Up to theta_N, where negative slip ends."""
        self._until(2.0 * self.sin_N - self.upper_N, self.upper_N, length)
        self.end_sin, self.end_cos = self.sin_N, self.cos_N
        if self.side < 0.0:
            self._slip(0.0, self.ell_2, True)
        elif self.side > 0.0:
            self._slip(2.0 * self.cos_N, self.ell_2 + 2.0 * self.sin_N, False)
        self._end()

    def _until_open(self, length: float) -> None:
        """Up to the separation, (A2), where both limits are sin(theta)."""
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
        """The whole of a span in one clip: w between the limits as they are at its end."""
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
        """How long the slip of a span lasts: slope sin(y) + curvature (1 - cos(y)) = change of w.

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
        # one that its own limit ends is over; one by a limit that recedes, a rounding error made up
        self.goes_on = not turns and slope >= 0.0

    def _end(self) -> None:
        """The end of a span."""
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
