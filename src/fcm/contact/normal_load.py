"""Kernel: Fourier coefficients of the normal load, equations (30) and (31), with their derivatives."""

import cython
from cython.cimports.libc.math import atan2, fabs, sqrt

PI = cython.declare(cython.double, 3.141592653589793)


def normal_load(n0_star: float) -> tuple[float, float, float, float]:
    """N_b, N_s and their derivatives by n0_star: theta_1 / pi and 2 sin(theta_1) / pi."""
    inside: float = min(max(n0_star, -1.0), 1.0)
    # 1 +- n0_star are exact where they are small, and carry theta_1 to full accuracy at both ends
    closed: float = sqrt(1.0 + inside)
    open_: float = sqrt(1.0 - inside)
    theta_1: float = 2.0 * atan2(closed, open_)
    sin_1: float = closed * open_
    N_b: float = (sin_1 + inside * theta_1) / PI
    if fabs(n0_star) > 1.0:
        N_b = max(n0_star, 0.0)
    return N_b, (inside * sin_1 + theta_1) / PI, theta_1 / PI, 2.0 * sin_1 / PI


def normal_loads(
    n0_star: cython.const[cython.double][::1],  # type: ignore[valid-type]
    N: cython.double[:, ::1],
) -> None:
    """The four numbers of `normal_load` of many contacts: n0_star (point,), N (4, point)."""
    i: cython.Py_ssize_t
    with cython.nogil:
        for i in range(n0_star.shape[0]):
            N[0, i], N[1, i], N[2, i], N[3, i] = normal_load(n0_star[i])
