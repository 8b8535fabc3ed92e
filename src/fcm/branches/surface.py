r"""The solutions of a balance at all frequencies and levels of the forces: a surface, and its folds.

With the displacements x, the frequency omega and the level lambda the n equations F(x, omega, lambda) = 0
have a surface of solutions, also where they are singular in x alone. A place on it is found in the plane
through a known place, of two axes e_1, e_2 in the scaled unknowns z = (x, omega, lambda):

    F(z) = 0,   e_1 . (z - c) = a,   e_2 . (z - c) = b.

The same matrix has the two tangents t_1, t_2 of the surface there: DF t = 0; e_i . t_j = 1 if i = j, else 0.
Where the surface folds over (omega, lambda), its tangents are not independent in these two:

    g = t_1,omega t_2,lambda - t_1,lambda t_2,omega = 0,

which is the bordered test function of a fold with a border of two rows (Govaerts, "Numerical Methods for
Bifurcations of Dynamical Equilibria", 2000, chapters 3 and 4). Its sign changes also at a fold in a corner.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite, sqrt

from fcm.branches.options import SURFACE, SurfaceOptions
from fcm.continuation.dense_solver import Solver
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.residual import Balance


@cython.cclass
class Surface:
    """`begin` at a place, then `put`: z is a place near it, value its test function g.

    z, centre, scale (n + 2,): displacements, frequency [rad/s], level; axes, tangents (2, n + 2), scaled.
    """

    def __init__(self, balance: Balance, options: SurfaceOptions = SURFACE) -> None:
        n: cython.int = balance.unknowns
        self.least, self.far, self.iterations = options.least, options.far, options.iterations
        self.close, self.flat, self.share = options.close, options.flat, options.share
        self.balance, self.n, self.evaluations, self.value = balance, n, 0, 0.0
        self.z, self.centre, self.right = np.zeros(n + 2), np.zeros(n + 2), np.zeros(n + 2)
        self.scale, self.at = np.ones(n + 2), np.zeros(n + 1)
        self.axes, self.tangents = np.zeros((2, n + 2)), np.zeros((2, n + 2))
        self.solver = Solver(n + 2)

    def begin(self, z: cython.double[::1], along: cython.double[::1], across: cython.double[::1]) -> bool:
        """Go to the surface from near it, in the plane across two directions (n + 2,), in the units of z;
        false where there is none. The first axis is then the tangent nearest to the first of them.
        """
        self.z[:] = z
        if not (self.recentre(across, along) and self.put(0.0, 0.0)):
            return False
        return self.recentre(np.asarray(self.tangents)[1] * self.scale, across)

    def recentre(self, along: cython.double[::1], across: cython.double[::1]) -> bool:
        """Take the place that z is for the centre of other axes (n + 2,), in the units of z."""
        i: cython.Py_ssize_t
        self.centre[:] = self.z
        self.measure(self.z)
        for i in range(self.n + 2):
            self.axes[0, i], self.axes[1, i] = along[i] / self.scale[i], across[i] / self.scale[i]
        return bool(self.upright())

    def measure(self, z: cython.double[::1]) -> None:
        """Units of lengths at a place: those of the balance, and the level by itself."""
        i: cython.Py_ssize_t
        for i in range(self.n + 1):
            self.at[i] = z[i]
        self.balance.measure(self.at)
        for i in range(self.n + 1):
            self.scale[i] = self.balance.scale[i]
        self.scale[self.n + 1] = max(fabs(z[self.n + 1]), self.least)

    def upright(self) -> bool:
        """Make the axes unit vectors at right angles; false if they are none."""
        axes = np.asarray(self.axes)
        first = float(np.linalg.norm(axes[0]))
        if not (first > 0.0 and np.isfinite(axes).all()):
            return False
        axes[0] /= first
        axes[1] -= (axes[0] @ axes[1]) * axes[0]
        second = float(np.linalg.norm(axes[1]))
        axes[1] /= second or 1.0
        return second > 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def put(self, ahead: cython.double, aside: cython.double) -> cython.bint:
        """Whether there is a place at these lengths along the axes, from where z was put last."""
        i: cython.Py_ssize_t
        count: cython.int
        step: cython.double
        one: cython.double = ahead
        other: cython.double = aside
        for i in range(self.n + 2):
            one -= self.axes[0, i] * (self.z[i] - self.centre[i]) / self.scale[i]
            other -= self.axes[1, i] * (self.z[i] - self.centre[i]) / self.scale[i]
        for i in range(self.n + 2):
            self.z[i] += self.scale[i] * (one * self.axes[0, i] + other * self.axes[1, i])
        for count in range(self.iterations):  # noqa: B007
            if not self.factor():
                return False
            step = self.correct(ahead, aside)
            if not step < self.far:
                return False
            if step < self.close:
                length: cython.double = self.share * sqrt(ahead * ahead + aside * aside)
                return (step < max(self.flat, length) or self.factor()) and self.take_tangents()
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """The equations at z, with the two axes."""
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        p: cython.Py_ssize_t
        h: cython.int
        k: cython.int
        unit: cython.double
        b: Balance = self.balance
        for i in range(n + 1):
            self.at[i] = self.z[i]
        b.load = self.z[n + 1]
        b.evaluate(self.at)
        self.evaluations += 1
        jacobian: cython.double[:, ::1] = jacobian_of(b) if b.rank else b.jacobian
        for i in range(n):
            unit = 1.0 / self.scale[i]
            for j in range(n + 1):
                self.solver.matrix[i, j] = jacobian[i, j] * (self.scale[j] * unit)
            self.solver.matrix[i, n + 1] = 0.0
        for h in range(b.seen.count):
            k = b.seen.forced[h]
            for p in range(b.ports if k >= 0 else 0):
                i = b.seen.wave_at[p] + b.seen.stride * h
                unit = self.scale[n + 1] / self.scale[i]
                self.solver.matrix[i, n + 1] = -b.seen.X_re[k, p] * unit
                self.solver.matrix[i + 1, n + 1] = -b.seen.X_im[k, p] * unit
        for j in range(n + 2):
            self.solver.matrix[n, j] = self.axes[0, j]
            self.solver.matrix[n + 1, j] = self.axes[1, j]
        return self.solver.factor()

    @cython.cfunc
    @cython.exceptval(-2, check=False)
    def correct(self, ahead: cython.double, aside: cython.double) -> cython.double:
        """Move z by a step of Newton's method; its length."""
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(n):
            self.solver.right[i] = -self.balance.residual[i] / self.scale[i]
        self.solver.right[n], self.solver.right[n + 1] = ahead, aside
        for i in range(n + 2):
            self.solver.right[n] -= self.axes[0, i] * (self.z[i] - self.centre[i]) / self.scale[i]
            self.solver.right[n + 1] -= self.axes[1, i] * (self.z[i] - self.centre[i]) / self.scale[i]
        self.solver.solve()
        for i in range(n + 2):
            self.z[i] += self.scale[i] * self.solver.right[i]
            total += self.solver.right[i] * self.solver.right[i]
        return sqrt(total) if isfinite(total) else 2.0 * self.far

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def take_tangents(self) -> cython.bint:
        """The tangents and the test function, from the equations as they are factored."""
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for k in range(2):
            for i in range(n + 2):
                self.solver.right[i] = 0.0
            self.solver.right[n + k] = 1.0
            self.solver.solve()
            for i in range(n + 2):
                self.tangents[k, i] = self.solver.right[i]
        self.value = (
            self.tangents[0, n] * self.tangents[1, n + 1] - self.tangents[0, n + 1] * self.tangents[1, n]
        )
        return isfinite(self.value)
