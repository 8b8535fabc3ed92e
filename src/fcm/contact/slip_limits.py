"""Kernel: the limits of the slip motion over a cycle, their extremes, and what a contact does within them.

While the contact is closed, |f| <= n says that the slip motion w = u - f lies between

    lower(theta) = sin(theta) - n(theta) =  ell_1 cos(theta - theta_P) - n0_bar
    upper(theta) = sin(theta) + n(theta) = -ell_2 cos(theta - theta_N) + n0_bar

Where the greatest of the lower limit is no more than the least of the upper one, it sticks.
"""

import cython
from cython.cimports.libc.math import cos, hypot, isfinite, isnan, sin

LARGEST = cython.declare(cython.double, 1e300)  # beyond, sums of a few terms would overflow
FARTHEST = cython.declare(cython.double, 1e304)  # preloads beyond, infinite ones too, are this
SHRINK = cython.declare(cython.double, 2.0**-32)  # both by this, where b is beyond LARGEST

# what a contact does over a cycle, by the numbers that `periodic` has for it as well
OPEN = cython.declare(cython.int, 0)  # below n0 = -b
UNKNOWN = cython.declare(cython.int, 3)  # an argument is no number
STUCK = cython.declare(cython.int, 4)  # above the slip limit (25)
SLIPPING = cython.declare(cython.int, 5)


@cython.cclass
class SlipLimits:
    """`behaviour` takes the arguments of a contact and says what it does.

    n0 and b are the preload and the amplitude of the load as they are calculated with; ell_1 and ell_2 the
    amplitudes of the limits, lower_P the greatest of the lower one, at theta_P, upper_N the least of the
    upper one, at theta_N.
    """

    def behaviour(self, n0_bar: float, b_bar: float, phi: float) -> cython.int:
        """What a contact does. An infinite n0_bar is as any very large one."""
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
        """Amplitudes ell_1, ell_2 of (A9) and the directions of theta_P, theta_N, for every phi.

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
