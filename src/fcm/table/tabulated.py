"""Kernel: the coefficients of a table as a law, with the exact derivatives of their interpolant.

A point is located on the atlas by its coordinates (`AtlasPoint`); `atlas` explains these and has their
inverses. `Cubic` evaluates three tensor-product cubic B-splines with their derivatives, see `spline`: for q =
i + f a spline is the sum of c_k B(q - k) over k from i - 1 to i + 2, with the weights

    B = (1-f)^3/6, (4 - 6f^2 + 3f^3)/6, (1 + 3f + 3f^2 - 3f^3)/6, f^3/6

The chain rule leads back to (n0_bar, b_bar, phi) (`Tabulated`).
"""

from __future__ import annotations

from typing import NamedTuple

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import asin, atan, atan2, cbrt, fabs, fmod, hypot, isfinite, sin, sqrt
from cython.cimports.libc.math import cos as cosine

from fcm.table import constants
from fcm.table.options import NODE_OPTIONS

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import PI, ClosedForm, CoefficientLaw
else:
    from fcm.contact.closed_form import PI, ClosedForm, CoefficientLaw

Resolution = tuple[int, int, int, int]  # nodes along u in separation, u in slip, x, z
NODES_BETWEEN = 3  # distance of the last separation node and the first slip node in the stacked coefficients

FOLD_Z = cython.declare(cython.double, constants.FOLD_Z)
FOLD_U = cython.declare(cython.double, constants.FOLD_U)
CONE = cython.declare(cython.double, constants.CONE)
TIP = cython.declare(cython.double, constants.TIP)
LARGEST_B = cython.declare(cython.double, constants.LARGEST_B)
HUGE_B = cython.declare(cython.double, constants.HUGE_B)
SIN_FOLD_Z = cython.declare(cython.double, sin(constants.FOLD_Z))
SIN_FOLD_U = cython.declare(cython.double, sin(constants.FOLD_U))
TINY = cython.declare(cython.double, 1e-300)  # least divisor, in place of 0


@cython.final
@cython.cclass
class AtlasPoint:
    """A point of the atlas: F = base + scale G(u, x, z), base = (mean, closed, 0); F_b is multiplied by sign.

    u, x and z are in nodes of the table, u through separation, then slip. ``u_n``, ``u_b``, ``u_phi`` and the
    like are derivatives by n0_bar, b_bar, phi; those of u, x and z are multiplied by scale. ``mean`` is the
    mean force of a contact at or above the slip limit; ``closed`` is 1 where the contact does not open.
    """

    def __init__(self, resolution: Resolution) -> None:
        nodes_1, nodes_2, nodes_x, nodes_z = resolution
        self.span_1, self.span_2 = nodes_1 - 1, nodes_2 - 1
        self.span_x, self.span_z = nodes_x - 1, nodes_z - 1
        self.first_slip = nodes_1 - 1 + NODES_BETWEEN
        self.near = NODE_OPTIONS.end_distance

    def find(self, n0: float, b: float, phi: float, gradient: bool) -> None:
        """Locate a point (all finite, b not negative); with gradient, also for the chain rule."""
        phi = fmod(phi, 2.0 * PI)
        if phi < 0.0:
            phi += 2.0 * PI
        self.sign = 1.0
        if phi >= PI:  # phi -> phi + pi changes the sign of F_b alone
            phi, self.sign = phi - PI, -1.0
        self.set_phase(phi)
        self._phase(phi)
        self._variation(b)
        if n0 < b:
            self._separation(n0, b, gradient)
        else:
            self.geometry(b)
            self._slip(b, n0 - b, gradient)
        if gradient:
            self.x_b *= self.scale
            self.x_phi *= self.scale
            self.z_phi *= self.scale

    def set_phase(self, phi: float) -> None:
        """Set the sines and cosines of the phase."""
        self.sin_half, self.cos_half = sin(0.5 * phi), cosine(0.5 * phi)
        self.sin_phi = 2.0 * self.sin_half * self.cos_half
        self.cos_phi = (self.cos_half - self.sin_half) * (self.cos_half + self.sin_half)

    def geometry(self, b_bar: float) -> None:
        """Set ell_1, ell_2 of (A9), low = ell_1 - b, high = ell_2 - b and width = (low + high) / 2 of slip.

        The width has full relative accuracy, however small it is.
        """
        b: float = min(b_bar, HUGE_B)
        gap: float = b - 1.0
        root: float = 2.0 * sqrt(b)
        self.ell_1, self.ell_2 = hypot(gap, root * self.sin_half), hypot(gap, root * self.cos_half)
        sum_1: float = self.ell_1 + b
        sum_2: float = self.ell_2 + b
        self.low, self.high = (1.0 - 2.0 * b * self.cos_phi) / sum_1, (1.0 + 2.0 * b * self.cos_phi) / sum_2
        # width (ell_1 + ell_2 + 2 b) = ell_1 ell_2 + 1 - b^2, for b > 1 as a quotient
        total: float = self.ell_1 * self.ell_2 + fabs(gap) * (b + 1.0)
        if gap > 0.0:
            side: float = 2.0 * b * self.sin_phi
            total = side * side / total
        self.width = total / (sum_1 + sum_2)

    def _variation(self, b: float) -> None:
        """Set x (0 at b = 0, the last node at infinity) and its slopes; that by b is infinite at b = 0."""
        root: float = sqrt(min(b, LARGEST_B))
        s: float = atan(root) * (4.0 / PI) - 1.0
        cone: float = CONE * (self.sin_phi * self.sin_phi + TIP)
        inverse: float = 1.0 / (s * s + cone)
        other: float = 1.0 / (1.0 + cone)
        half: float = 0.5 * cbrt(inverse / other)
        self.x = (s * half + 0.5) * self.span_x
        by_s: float = half * (1.0 - s * s * inverse * (2.0 / 3.0)) * (2.0 / PI)
        self.x_b = by_s / ((1.0 + root * root) * sqrt(max(b, self.near))) * self.span_x
        by_cone: float = s * half * (other - inverse) * (2.0 * CONE / 3.0)
        self.x_phi = by_cone * self.sin_phi * self.cos_phi * self.span_x

    def _phase(self, phi: float) -> None:
        """Set z and its slope, for phi in [0, pi]."""
        sine: float = phi * (2.0 * SIN_FOLD_Z / PI) - SIN_FOLD_Z
        self.z = (asin(sine) * (0.5 / FOLD_Z) + 0.5) * self.span_z
        self.z_phi = SIN_FOLD_Z / (PI * FOLD_Z) / sqrt(1.0 - sine * sine) * self.span_z

    def _separation(self, n0: float, b: float, gradient: bool) -> None:
        """Set the place for n0 < b, where F = b / (1 + b) G; u is 0 at n0 = b, the last node at n0 = -b."""
        safe_b: float = max(b, TINY)
        bounded: float = max(n0, -safe_b)
        below: float = max((safe_b - bounded) / safe_b, self.near)  # 1 - n0 / b
        above: float = max((safe_b + bounded) / safe_b, self.near)
        root_below: float = sqrt(below)
        root_above: float = sqrt(above)
        delta: float = 2.0 * atan2(root_below, root_above)
        layer: float = 1.0 / (1.0 + b)
        near: float = 1.0 / (delta + layer)
        far: float = 1.0 / (PI + layer)
        ratio: float = sqrt(near / far) * (SIN_FOLD_U / PI)
        sine: float = delta * ratio
        inside: float = 1.0 if n0 > -b else 0.0
        self.u = asin(sine) / FOLD_U * self.span_1
        self.scale = b * layer * inside
        self.mean = self.closed = 0.0
        if gradient:
            slope: float = self.span_1 / (FOLD_U * sqrt(1.0 - sine * sine))
            by_delta: float = slope * ratio * (1.0 - 0.5 * delta * near)
            by_b: float = slope * sine * 0.5 * (near - far) * layer * layer
            # d delta / d n0 = -1 / (b sin(delta)), d delta / d b = cos(delta) / (b sin(delta))
            self.u_n = -by_delta * layer * inside / (root_below * root_above)
            self.u_b = self.scale * by_b - self.u_n * (0.5 * (above - below))
            self.scale_b = layer * layer * inside
            self.u_phi = self.scale_phi = self.mean_n = self.mean_b = self.mean_phi = 0.0

    def _slip(self, b: float, excess: float, gradient: bool) -> None:
        """Set u and F for n0 = b + excess: F_edge + width G in slip, F_edge above; t = sin(pi u / 2)^2."""
        share: float = min(excess, self.width) / max(self.width, TINY)
        t: float = min(max(share, self.near), 1.0 - self.near)
        root: float = sqrt(t)
        rest: float = sqrt(1.0 - t)
        slips: cython.bint = excess < self.width
        self.u = atan2(root, rest) * (2.0 / PI) * self.span_2 + self.first_slip
        self.scale = self.width if slips else 0.0
        # the admissible mean force nearest to zero; below the slip limit that at the limit, for both bounds
        reach: float = max(excess, self.width)
        least: float = self.high - reach
        self.mean, self.closed = min(max(0.0, least), max(reach - self.low, least)), 1.0
        if gradient:
            self._slip_slopes(b, t, self.span_2 / (PI * root * rest) if slips else 0.0)

    def _slip_slopes(self, b: float, t: float, by_t: float) -> None:
        """Set the derivatives in slip and stick; by_t is du/dt, 0 in stick."""
        slips: cython.bint = by_t > 0.0
        b = min(b, HUGE_B)
        side: float = b * self.sin_phi
        ell_1_b: float = (b - self.cos_phi) / max(self.ell_1, TINY)
        ell_2_b: float = (b + self.cos_phi) / max(self.ell_2, TINY)
        ell_1_phi: float = side / max(self.ell_1, TINY)
        ell_2_phi: float = -side / max(self.ell_2, TINY)
        width_b: float = 0.5 * (ell_1_b + ell_2_b) - 1.0
        width_phi: float = 0.5 * (ell_1_phi + ell_2_phi)
        self.u_n = by_t
        self.u_b = -(1.0 + t * width_b) * by_t
        self.u_phi = -t * width_phi * by_t
        self.scale_b = width_b if slips else 0.0
        self.scale_phi = width_phi if slips else 0.0
        # shares of the lower and of the upper bound in the derivative of the mean force
        at_low: float = 0.5 if slips else (1.0 if self.mean > 0.0 else 0.0)
        at_high: float = 0.5 if slips else (1.0 if self.mean < 0.0 else 0.0)
        self.mean_n = at_high - at_low
        self.mean_b = at_low * ell_2_b - at_high * ell_1_b
        self.mean_phi = at_low * ell_2_phi - at_high * ell_1_phi


class AtlasPoints(NamedTuple):
    """Points of the atlas: F = base + scale G(q); F_b is multiplied by sign."""

    q: npt.NDArray[np.float64]  # (3, point), in nodes
    scale: npt.NDArray[np.float64]  # (point,)
    base: npt.NDArray[np.float64]  # (3, point)
    sign: npt.NDArray[np.float64]  # (point,)


def locate(points: cython.double[:, ::1], resolution: Resolution) -> AtlasPoints:
    """Locate points on the atlas: rows (3, point) of n0_bar, b_bar, phi, all finite, b not negative."""
    i: cython.Py_ssize_t
    count: cython.Py_ssize_t = points.shape[1]
    rows = np.zeros((8, count))
    out: cython.double[:, ::1] = rows
    place: AtlasPoint = AtlasPoint(resolution)
    for i in range(count):
        place.find(points[0, i], points[1, i], points[2, i], False)
        out[0, i], out[1, i], out[2, i] = place.u, place.x, place.z
        out[3, i], out[4, i], out[5, i], out[7, i] = place.scale, place.mean, place.closed, place.sign
    return AtlasPoints(rows[:3], rows[3], rows[4:7], rows[7])


def slip_geometry(b_bar: cython.double[::1], phi: cython.double[::1]) -> np.ndarray:
    """low, high and width of `AtlasPoint.geometry`, shape (3, point)."""
    i: cython.Py_ssize_t
    rows = np.empty((3, b_bar.shape[0]))
    out: cython.double[:, ::1] = rows
    place: AtlasPoint = AtlasPoint((2, 2, 2, 2))
    for i in range(b_bar.shape[0]):
        place.set_phase(phi[i])
        place.geometry(b_bar[i])
        out[0, i], out[1, i], out[2, i] = place.low, place.high, place.width
    return rows


def weights(f: float) -> tuple[float, float, float, float]:
    """Weights of the four coefficients of a cubic B-spline at a fraction f of an interval."""
    g: float = 1.0 - f
    third: float = (1.0 + 3.0 * f * (1.0 + f * (1.0 - f))) / 6.0
    return g * g * g / 6.0, (4.0 + 3.0 * f * f * (f - 2.0)) / 6.0, third, f * f * f / 6.0


def slopes(f: float) -> tuple[float, float, float, float]:
    """Derivatives of the four B-spline weights by f."""
    g: float = 1.0 - f
    return -0.5 * g * g, f * (1.5 * f - 2.0), 0.5 + f * (1.0 - 1.5 * f), 0.5 * f * f


@cython.final
@cython.cclass
class Cubic:
    """Splines with coefficients (plane, nx + 2, nz + 2, 3), as from `spline.stack`."""

    def __init__(self, coefficients: np.ndarray) -> None:
        planes, rows, columns, _ = coefficients.shape
        self.step_x = columns
        self.step_u = rows * columns
        self.last = planes * self.step_u - (3 * self.step_u + 3 * self.step_x + 4)
        self.coefficients = coefficients.reshape(-1).data

    def evaluate(
        self, u: float, x: float, z: float, gradient: bool, out: cython.double[::1], at: cython.Py_ssize_t
    ) -> None:
        """Writes the three values at (u, x, z), in nodes, to out[at:], then the derivatives by u, x and z."""
        i: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, u)
        j: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, x)
        k: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, z)
        w_u: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
        w_x: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
        w_z: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
        d_u: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
        d_x: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
        d_z: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
        w_u[0], w_u[1], w_u[2], w_u[3] = weights(u - i)
        w_x[0], w_x[1], w_x[2], w_x[3] = weights(x - j)
        w_z[0], w_z[1], w_z[2], w_z[3] = weights(z - k)
        if gradient:
            d_u[0], d_u[1], d_u[2], d_u[3] = slopes(u - i)
            d_x[0], d_x[1], d_x[2], d_x[3] = slopes(x - j)
            d_z[0], d_z[1], d_z[2], d_z[3] = slopes(z - k)
        corner: cython.Py_ssize_t = min(i * self.step_u + j * self.step_x + k, self.last)
        m: cython.Py_ssize_t
        p: cython.Py_ssize_t
        c_0: float
        c_1: float
        c_2: float
        c_3: float
        for m in range(3):
            value: float = 0.0
            by_u: float = 0.0
            by_x: float = 0.0
            by_z: float = 0.0
            for i in range(4):
                plane: float = 0.0
                plane_x: float = 0.0
                plane_z: float = 0.0
                for j in range(4):
                    p = 3 * (corner + i * self.step_u + j * self.step_x) + m
                    c_0, c_1 = self.coefficients[p], self.coefficients[p + 3]
                    c_2, c_3 = self.coefficients[p + 6], self.coefficients[p + 9]
                    row: float = w_z[0] * c_0 + w_z[1] * c_1 + w_z[2] * c_2 + w_z[3] * c_3
                    plane += w_x[j] * row
                    if gradient:
                        plane_x += d_x[j] * row
                        plane_z += w_x[j] * (d_z[0] * c_0 + d_z[1] * c_1 + d_z[2] * c_2 + d_z[3] * c_3)
                value += w_u[i] * plane
                if gradient:
                    by_u += d_u[i] * plane
                    by_x += w_u[i] * plane_x
                    by_z += w_u[i] * plane_z
            out[at + m] = value
            if gradient:
                out[at + 3 + m], out[at + 6 + m], out[at + 9 + m] = by_u, by_x, by_z

    def many(self, q: cython.double[:, ::1], gradient: cython.bint) -> np.ndarray:
        """Values (3, 1, point) at points q (3, point), or values with derivatives (3, 4, point)."""
        i: cython.Py_ssize_t
        numbers: cython.Py_ssize_t = 12 if gradient else 3
        found = np.empty(numbers * q.shape[1])
        out: cython.double[::1] = found
        for i in range(q.shape[1]):
            self.evaluate(q[0, i], q[1, i], q[2, i], gradient, out, numbers * i)
        return np.moveaxis(found.reshape(q.shape[1], -1, 3), 0, -1).swapaxes(0, 1)


LARGEST = cython.declare(cython.double, 1e300)  # of b_bar
FARTHEST = cython.declare(cython.double, 2e300)  # of n0_bar: an infinite preload or gap is limited to it


@cython.final
@cython.cclass
class Frame:
    """Ranges of chart coordinates, low to high in nodes (chart, 3), for which a part of a table answers.

    ``here`` converts nodes of the whole table (in the slip chart counted from its first) to nodes of the
    part.
    """

    def __init__(self, low: np.ndarray, high: np.ndarray, here: np.ndarray) -> None:
        self.low, self.high, self.here = low, high, here

    def within(self, place: AtlasPoint) -> cython.bint:
        """Convert a place to the nodes of the part; return whether the part answers for it.

        Outside of both charts F needs no table, and any coordinates serve.
        """
        chart: cython.Py_ssize_t = 1 if place.u > place.first_slip - 1 else 0
        u: float = place.u - chart * place.first_slip
        inside: cython.bint = (
            self.low[chart, 0] <= u <= self.high[chart, 0]
            and self.low[chart, 1] <= place.x <= self.high[chart, 1]
            and self.low[chart, 2] <= place.z <= self.high[chart, 2]
        )
        place.u = max(min(u, self.high[chart, 0]), self.low[chart, 0]) + self.here[chart, 0]
        place.x = max(min(place.x, self.high[chart, 1]), self.low[chart, 1]) + self.here[chart, 1]
        place.z = max(min(place.z, self.high[chart, 2]), self.low[chart, 2]) + self.here[chart, 2]
        return inside or place.scale == 0.0


@cython.final
@cython.cclass
class Tabulated(CoefficientLaw):
    """Look-up in the splines of a table; outside the frame of a partial table, the closed form is evaluated.

    Two threads must not share it: each makes its own from the same splines, at no cost. ``outside`` counts
    the points for which the closed form was evaluated.
    """

    def __init__(self, cubic: Cubic, resolution: tuple[int, int, int, int], frame: Frame | None) -> None:
        self.cubic, self.place, self.frame, self.outside = cubic, AtlasPoint(resolution), frame, 0
        self.exact = ClosedForm()

    def evaluate(
        self,
        n0_bar: float,
        b_bar: float,
        phi: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """Writes the coefficients of one point from the table; see `CoefficientLaw.evaluate`."""
        n0: float = min(max(n0_bar, -FARTHEST), FARTHEST)
        if not (n0_bar == n0_bar and isfinite(b_bar) and isfinite(phi)):
            self.unknown(gradient, out, at)
            return
        self.place.find(n0, min(b_bar, LARGEST), phi, gradient)
        if self.frame is not None and not self.frame.within(self.place):
            self.outside += 1
            self.exact.evaluate(n0_bar, b_bar, phi, gradient, out, at)
            return
        self.cubic.evaluate(self.place.u, self.place.x, self.place.z, gradient, out, at)
        if gradient:
            self._chain(out, at)
        out[at] = self.place.sign * (self.place.scale * out[at] + self.place.mean)
        out[at + 1] = self.place.scale * out[at + 1] + self.place.closed
        out[at + 2] = self.place.scale * out[at + 2]

    def _chain(self, out: cython.double[::1], at: cython.Py_ssize_t) -> None:
        """Convert derivatives of G by the coordinates to derivatives of F by n0_bar, b_bar and phi."""
        by_u: cython.double[3] = [0.0, 0.0, 0.0]
        by_x: cython.double[3] = [0.0, 0.0, 0.0]
        by_z: cython.double[3] = [0.0, 0.0, 0.0]
        i: cython.Py_ssize_t
        for i in range(3):
            by_u[i], by_x[i], by_z[i] = out[at + 3 + i], out[at + 6 + i], out[at + 9 + i]
        for i in range(3):
            out[at + 3 + 3 * i] = self.place.u_n * by_u[i]
            out[at + 4 + 3 * i] = (
                self.place.scale_b * out[at + i] + self.place.u_b * by_u[i] + self.place.x_b * by_x[i]
            )
            out[at + 5 + 3 * i] = (
                self.place.scale_phi * out[at + i]
                + self.place.u_phi * by_u[i]
                + self.place.x_phi * by_x[i]
                + self.place.z_phi * by_z[i]
            )
        out[at + 3] = self.place.sign * (out[at + 3] + self.place.mean_n)
        out[at + 4] = self.place.sign * (out[at + 4] + self.place.mean_b)
        out[at + 5] = self.place.sign * (out[at + 5] + self.place.mean_phi)
