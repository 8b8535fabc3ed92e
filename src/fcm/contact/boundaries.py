"""Kernel: the boundaries between the regimes of a contact, as signed functions with their derivatives.

A contact is fully open where n0 + b < 0, opens and closes within the cycle where n0 - b < 0 < n0 + b, and of
the rest slips where n0 - (ell_1 + ell_2) / 2 < 0, the slip limit (25), and sticks above. The functions are
smooth but for b = 1 at phi = 0 and pi, where ell_1 or ell_2 is a cone.
"""

import cython

if cython.compiled:
    from cython.cimports.fcm.contact.coefficient_law import CoefficientLaw
    from cython.cimports.fcm.contact.slip_limits import UNKNOWN, SlipLimits
else:
    from fcm.contact.coefficient_law import CoefficientLaw
    from fcm.contact.slip_limits import UNKNOWN, SlipLimits


@cython.cclass
class Boundaries(CoefficientLaw):
    """n0 + b, n0 - b and n0 - (ell_1 + ell_2) / 2, laid out as coefficients and their gradients."""

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
        """See `CoefficientLaw`."""
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
