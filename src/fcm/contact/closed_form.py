"""Kernel: Fourier coefficients of the friction force, equation (27), and their derivatives, in closed form.

While the contact slips the force is +-n, while it sticks u - w with w at rest. So (27) is a sum over the
spans of a cycle of integrals of sines and cosines. The force is continuous in theta: the derivative of the
integral is the integral of the derivative, +-(dn/dx) in a slip, and in a stick the constant that the contact
brought into it.

The closed form is one `CoefficientLaw`, a table another. The numbers of a point lie one after the other: F_b,
F_s, F_c, then the derivatives of each by n0_bar, b_bar and phi, twelve in all. A third gives the `Boundaries`
between the regimes. A contact is fully open where n0 + b < 0, opens and closes within the cycle where
n0 - b < 0 < n0 + b, and of the rest slips where n0 - (ell_1 + ell_2) / 2 < 0, the slip limit (25), and sticks
above. These functions are smooth but for b = 1 at phi = 0 and pi, where ell_1 or ell_2 is a cone.
"""

from __future__ import annotations

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.fcm.contact.cycle import PI, SLIPPING, STUCK, UNKNOWN, Cycle, SlipLimits, arc
else:
    from fcm.contact.cycle import PI, SLIPPING, STUCK, UNKNOWN, Cycle, SlipLimits, arc

NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class CoefficientLaw:
    """Base class; a subclass defines `evaluate`."""

    def evaluate(
        self,
        n0_bar: float,
        b_bar: float,
        phi: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """The numbers of one point to out[at:], the first three or with the gradient all twelve.

        b_bar is not negative. Where an argument is NaN, or b_bar or phi infinite, they are NaN.
        """

    def unknown(self, gradient: bool, out: cython.double[::1], at: cython.Py_ssize_t) -> None:
        """NaN for each of the numbers."""
        i: cython.Py_ssize_t
        for i in range(12 if gradient else 3):
            out[at + i] = NAN

    def many(self, n0_bar: object, b_bar: object, phi: object, gradient: cython.bint) -> np.ndarray:
        """The numbers of many points, shape (3 or 12, ...); the arguments broadcast to the shape of the rest.

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
        """Whether an element of b_bar is negative; if none is, all is done."""
        i: cython.Py_ssize_t
        with cython.nogil:
            for i in range(b_bar.shape[0]):
                if b_bar[i] < 0.0:
                    return True
                self.evaluate(n0_bar[i], b_bar[i], phi[i], gradient, out, i * numbers)
        return False


LIGHT = cython.declare(cython.double, 0.01)  # loads below are integrated as forces, see `Integrals`


@cython.final
@cython.cclass
class Integrals(Cycle):
    """Twelve numbers of one contact; pi times the integrals while they are summed over the spans.

    ``b_n`` is the derivative of F_b by n0_bar, ``c_phi`` that of F_c by phi. ``kept_n``, ``kept_b``,
    ``kept_phi`` are dw/dx while the contact sticks. A ``light`` load is integrated as a force, with the
    relative error of the arguments, however small they are against the motion, 1; else u - w is: exact where
    the load is not small, and faster.
    """

    def sum(self, n0_bar: float, b_bar: float, phi: float, gradient: bool) -> cython.int:
        """All of one contact; says what it does."""
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
        """From integrals over the cycle to coefficients; u is still to be integrated, the spans had w."""
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
        """F_b = clip(0, ell_2 - n0, n0 - ell_1), with ell from (A9)."""
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
        """Adds the integrals over a span."""
        if self.span == 0:
            self.light = max(abs(self.n0), self.b) < LIGHT
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
        # a whole span at a time: those of a symmetric loop cancel to the last digit
        self.F_b, self.F_s, self.F_c = self.F_b + self.span_b, self.F_s + self.span_s, self.F_c + self.span_c
        if self.side != 0.0:
            self._keep(self.side, self.end_sin, self.end_cos)
            self.force = self.side * self._load(self.end_sin, self.end_cos)
        else:
            self.force = self.end_sin - self.w_end

    def _load(self, sin_theta: float, cos_theta: float) -> cython.double:
        """The normal load n at an angle."""
        return self.n0 + self.b * (sin_theta * self.cos_phi + cos_theta * self.sin_phi)

    def _keep(self, pull: float, sin_theta: float, cos_theta: float) -> None:
        """What a stick keeps of a slip, or a closing, that ended at an angle: dw/dx = -pull dn/dx."""
        self.kept_n = -pull
        self.kept_b = -pull * (sin_theta * self.cos_phi + cos_theta * self.sin_phi)
        self.kept_phi = -pull * self.b * (cos_theta * self.cos_phi - sin_theta * self.sin_phi)

    def _motion(self) -> None:
        """Less the integrals of w, w sin(theta), w cos(theta): w at rest, and w_end with what it lacks."""
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
        """The integrals of the force in a stick: y after the start, force + cos(start) sin(y) - ... of it."""
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
        """The integrals of df/dx = -dw/dx in a stick."""
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
        """The integrals of +-n and of +-dn/dx, with dn/dx = 1, sin(theta + phi), b cos(theta + phi)."""
        sin: float = self.end_sin
        cos: float = self.end_cos
        s: float = self.side * self.sin_phi
        c: float = self.side * self.cos_phi
        sin_2: float = 0.5 * (self.deficit + self.sin * self.versine)  # of sin(y)^2
        sin_cos: float = 0.5 * self.sin * self.sin
        one_s: float = sin * self.sin - cos * self.versine  # of 1 times sin(theta)
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
    """The closed form as a law."""

    def __init__(self) -> None:
        self.integrals = Integrals()

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
