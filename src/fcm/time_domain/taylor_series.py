"""The motion of each combination as a power series by the position, which is counted in steps."""

from __future__ import annotations

import cython
import numpy as np

from fcm.time_domain.equations import Matrices
from fcm.time_domain.flow_cache import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow_cache import Pool
else:
    from fcm.time_domain.flow_cache import Pool

_SEPARATED = cython.declare(cython.int, 0)
_STICKING = cython.declare(cython.int, 1)
_POSITIVE_SLIP = cython.declare(cython.int, 2)


@cython.cclass
class Series(Pool):
    """Flows as power series. What is done for a whole series is done in one call: y' = A y is little work."""

    def __init__(self, matrices: Matrices) -> None:
        Pool.__init__(self, matrices)
        self._own = np.zeros((ORDER + 1, self.size))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def derive(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        a: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        b: cython.Py_ssize_t,
    ) -> cython.void:
        """Row b of z becomes A y, y being row a."""
        i: cython.Py_ssize_t
        for i in range(self.size):
            self._own[0, i] = y[a, i]
        self.extend(slot, self._own, 1, 1.0, self._own, False)
        for i in range(self.size):
            z[b, i] = self._own[1, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def extend(
        self,
        slot: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        last: cython.Py_ssize_t,
        step: cython.double,
        y: cython.double[:, ::1],
        graded: cython.bint,
    ) -> cython.void:
        """Taylor coefficients from row 0 of z on, by the position in a step of that length [s].

        If it is graded, those of the derivative by the frequency of the motion with the coefficients y:
        z[a + 1] = step / (a + 1) (A z[a] + dA / d omega y[a]).
        """
        a: cython.Py_ssize_t
        j: cython.Py_ssize_t
        factor: cython.double
        for a in range(last):
            factor = step / (a + 1)
            structure(self, z, a, factor)
            for j in range(self.springs):
                spring(self, j, z, a, factor)
            for j in range(self.contacts):
                contact(self, j, self.states[slot, j], z, a, factor)
            if graded:
                grade(self, z, a, y, factor)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def structure(
    series: Series, z: cython.double[:, ::1], a: cython.Py_ssize_t, factor: cython.double
) -> cython.void:
    """Row a + 1 of z becomes the factor times what modes and forces make of row a."""
    m: cython.Py_ssize_t = series.modes
    end: cython.Py_ssize_t = series.linear
    i: cython.Py_ssize_t
    b: cython.Py_ssize_t = a + 1
    h: cython.Py_ssize_t
    one: cython.double = z[a, end - 1]
    sine: cython.double = z[a, end]
    cosine: cython.double = z[a, end + 1]
    z[b, end - 1] = 0.0
    for h in range(series.waves):
        z[b, end + 2 * h] = factor * series.omega * series.harmonic[h] * z[a, end + 2 * h + 1]
        z[b, end + 2 * h + 1] = -factor * series.omega * series.harmonic[h] * z[a, end + 2 * h]
    for i in range(m):
        z[b, i] = factor * z[a, m + i]
        z[b, m + i] = factor * (
            series.drive[0, i] * sine + series.drive[1, i] * cosine + series.hold[i] * one
            - series.stiffness[i] * z[a, i] - series.damping[i] * z[a, m + i]
        )  # fmt: skip
    for h in range(2, 2 * series.waves, 2):  # of most scenes there is none
        sine, cosine = factor * z[a, end + h], factor * z[a, end + h + 1]
        for i in range(m):
            z[b, m + i] += series.drive[h, i] * sine + series.drive[h + 1, i] * cosine


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def spring(
    series: Series,
    j: cython.Py_ssize_t,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    factor: cython.double,
) -> cython.void:
    """Add what spring j does."""
    m: cython.Py_ssize_t = series.modes
    i: cython.Py_ssize_t
    u: cython.double = 0.0
    for i in range(m):
        u += series.stretch[j, i] * z[a, i]
    u *= factor
    for i in range(m):
        z[a + 1, m + i] -= series.pull[j, i] * u


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def contact(
    series: Series,
    j: cython.Py_ssize_t,
    state: cython.int,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    factor: cython.double,
) -> cython.void:
    """Add what contact j does in a state, and how its forces change."""
    m: cython.Py_ssize_t = series.modes
    v: cython.double = factor * series.k_v[j] * velocity(series.normal, j, z, a)
    u: cython.double = 0.0
    f: cython.double = z[a, 2 * m + j]
    n: cython.double = z[a, 2 * m + series.contacts + j]
    if state == _SEPARATED:  # the preload is missing
        f, n = 0.0, -max(series.n_0[j], 0.0) * z[a, series.linear - 1]
    else:  # a gap is not pressed
        n += min(series.n_0[j], 0.0) * z[a, series.linear - 1]
        if state != _STICKING:
            u = series.mu[j] * v if state == _POSITIVE_SLIP else -series.mu[j] * v
        elif series.rough[j]:
            u = factor * series.k_u[j] * velocity(series.tangential, j, z, a)
    push(series.push_u, j, f * factor, z, a + 1)
    push(series.push_v, j, n * factor, z, a + 1)
    z[a + 1, 2 * m + j] = u
    z[a + 1, 2 * m + series.contacts + j] = v


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def grade(
    series: Series,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    y: cython.double[:, ::1],
    factor: cython.double,
) -> cython.void:
    """Add what the derivative of A by the frequency makes of the forces' phase in row a of y."""
    i: cython.Py_ssize_t
    h: cython.Py_ssize_t
    b: cython.Py_ssize_t = a + 1
    n: cython.Py_ssize_t = series.linear
    sine: cython.double
    cosine: cython.double
    for h in range(series.waves):
        sine, cosine = factor * y[a, n + 2 * h], factor * y[a, n + 2 * h + 1]
        z[b, n + 2 * h] += series.harmonic[h] * cosine
        z[b, n + 2 * h + 1] -= series.harmonic[h] * sine
        for i in range(series.modes):
            z[b, series.modes + i] += series.slope[2 * h, i] * sine + series.slope[2 * h + 1, i] * cosine


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def velocity(
    shape: cython.double[:, ::1], j: cython.Py_ssize_t, z: cython.double[:, ::1], a: cython.Py_ssize_t
) -> cython.double:
    """Of contact j along its shape, by row a of z."""
    m: cython.Py_ssize_t = shape.shape[1]
    half: cython.Py_ssize_t = m // 2
    i: cython.Py_ssize_t
    one: cython.double = 0.0
    other: cython.double = 0.0  # two sums, for one would wait for each addition
    for i in range(half):
        one += shape[j, i] * z[a, m + i]
        other += shape[j, half + i] * z[a, m + half + i]
    if m % 2:
        other += shape[j, m - 1] * z[a, m + m - 1]
    return one + other


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def push(
    shape: cython.double[:, ::1],
    j: cython.Py_ssize_t,
    force: cython.double,
    z: cython.double[:, ::1],
    b: cython.Py_ssize_t,
) -> cython.void:
    """Take the force of contact j, by its shape over the masses, from the accelerations in row b of z."""
    m: cython.Py_ssize_t = shape.shape[1]
    i: cython.Py_ssize_t
    if force != 0.0:
        for i in range(m):
            z[b, m + i] -= shape[j, i] * force
