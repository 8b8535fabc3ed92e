"""The equations y' = A y of each combination, as what they make of one Taylor coefficient: the next."""

from __future__ import annotations

import cython

if cython.compiled:
    from cython.cimports.fcm.motion.pool import Pool
else:
    from fcm.motion.pool import Pool

_OPEN = cython.declare(cython.int, 0)
_STICK = cython.declare(cython.int, 1)
_POSITIVE = cython.declare(cython.int, 2)


@cython.cclass
class Equations(Pool):
    """What is done for a whole series is done in one call: y' = A y is little work."""

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
                grade(self, z, a, factor * y[a, self.linear], factor * y[a, self.linear + 1])


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def structure(
    system: Equations, z: cython.double[:, ::1], a: cython.Py_ssize_t, factor: cython.double
) -> cython.void:
    """Row a + 1 of z becomes the factor times what modes and forces make of row a."""
    m: cython.Py_ssize_t = system.modes
    end: cython.Py_ssize_t = system.linear
    i: cython.Py_ssize_t
    b: cython.Py_ssize_t = a + 1
    one: cython.double = z[a, end - 1]
    sine: cython.double = z[a, end]
    cosine: cython.double = z[a, end + 1]
    z[b, end - 1] = 0.0
    z[b, end] = factor * system.omega * cosine
    z[b, end + 1] = -factor * system.omega * sine
    for i in range(m):
        z[b, i] = factor * z[a, m + i]
        z[b, m + i] = factor * (
            system.drive[0, i] * sine + system.drive[1, i] * cosine + system.hold[i] * one
            - system.stiffness[i] * z[a, i] - system.damping[i] * z[a, m + i]
        )  # fmt: skip


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def spring(
    system: Equations,
    j: cython.Py_ssize_t,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    factor: cython.double,
) -> cython.void:
    """Add what spring j does."""
    m: cython.Py_ssize_t = system.modes
    i: cython.Py_ssize_t
    u: cython.double = 0.0
    for i in range(m):
        u += system.stretch[j, i] * z[a, i]
    u *= factor
    for i in range(m):
        z[a + 1, m + i] -= system.pull[j, i] * u


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def contact(
    system: Equations,
    j: cython.Py_ssize_t,
    state: cython.int,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    factor: cython.double,
) -> cython.void:
    """Add what contact j does in a state, and how its forces change."""
    m: cython.Py_ssize_t = system.modes
    v: cython.double = factor * system.k_v[j] * velocity(system.normal, j, z, a)
    u: cython.double = 0.0
    f: cython.double = z[a, 2 * m + j]
    n: cython.double = z[a, 2 * m + system.contacts + j]
    if state == _OPEN:  # the preload is missing
        f, n = 0.0, -max(system.n_0[j], 0.0) * z[a, system.linear - 1]
    else:  # a gap is not pressed
        n += min(system.n_0[j], 0.0) * z[a, system.linear - 1]
        if state != _STICK:
            u = system.mu[j] * v if state == _POSITIVE else -system.mu[j] * v
        elif system.rough[j]:
            u = factor * system.k_u[j] * velocity(system.tangential, j, z, a)
    push(system.push_u, j, f * factor, z, a + 1)
    push(system.push_v, j, n * factor, z, a + 1)
    z[a + 1, 2 * m + j] = u
    z[a + 1, 2 * m + system.contacts + j] = v


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def grade(
    system: Equations,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    sine: cython.double,
    cosine: cython.double,
) -> cython.void:
    """Add what the derivative of A by the frequency makes of the forces' phase."""
    i: cython.Py_ssize_t
    b: cython.Py_ssize_t = a + 1
    z[b, system.linear] += cosine
    z[b, system.linear + 1] -= sine
    for i in range(system.modes):
        z[b, system.modes + i] += system.slope[0, i] * sine + system.slope[1, i] * cosine


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
