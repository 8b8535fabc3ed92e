"""Kernel: three tensor-product cubic B-splines at a point, with their derivatives; see `spline`.

For q = i + f a spline is the sum of c_k B(q - k) over k from i - 1 to i + 2, with the weights

    B = (1-f)^3/6, (4 - 6f^2 + 3f^3)/6, (1 + 3f + 3f^2 - 3f^3)/6, f^3/6.
"""

import cython
import numpy as np


def weights(
    f: float,
) -> tuple[float, float, float, float]:
    """Those of the four coefficients."""
    g: float = 1.0 - f
    third: float = (1.0 + 3.0 * f * (1.0 + f * (1.0 - f))) / 6.0
    return g * g * g / 6.0, (4.0 + 3.0 * f * f * (f - 2.0)) / 6.0, third, f * f * f / 6.0


def slopes(
    f: float,
) -> tuple[float, float, float, float]:
    """Their derivatives by f."""
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
        self,
        u: float,
        x: float,
        z: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """Values of the three at (u, x, z), in nodes, to out[at:], then their derivatives by u, x and z."""
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
        """At many points q (3, point): values (3, 1, point), or with the derivatives (3, 4, point)."""
        i: cython.Py_ssize_t
        numbers: cython.Py_ssize_t = 12 if gradient else 3
        found = np.empty(numbers * q.shape[1])
        out: cython.double[::1] = found
        for i in range(q.shape[1]):
            self.evaluate(q[0, i], q[1, i], q[2, i], gradient, out, numbers * i)
        return np.moveaxis(found.reshape(q.shape[1], -1, 3), 0, -1).swapaxes(0, 1)
