"""Kernel: Fourier coefficients of a contact's forces over a steady cycle, and their derivatives.

What other kernels call: see `PeriodicContact`.
"""

from __future__ import annotations

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import STUCK, Cycle
    from cython.cimports.fcm.contact.periodic.derivatives import Derivatives
    from cython.cimports.fcm.contact.periodic.integrals import CONTACT, LONG, SIGNED_SLIPS, Integrals
    from cython.cimports.fcm.contact.periodic.motion import FORCE, LOAD, MIXED, REACH, UNKNOWN, Motion
else:
    from fcm.contact.periodic.cycle import STUCK, Cycle
    from fcm.contact.periodic.derivatives import Derivatives
    from fcm.contact.periodic.integrals import CONTACT, LONG, SIGNED_SLIPS, Integrals
    from fcm.contact.periodic.motion import FORCE, LOAD, MIXED, REACH, UNKNOWN, Motion

PI = cython.declare(cython.double, 3.141592653589793)
NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class PeriodicContact:
    """Contacts with given harmonics of their motion and of their forces, one after the other.

    Parameters
    ----------
    harmonics, outputs : list of int, each increasing, from 1 on
        Harmonics of the displacements, and of the forces; the mean is always one.

    Notes
    -----
    Unknowns and forces are real numbers in the order

        mean u, mean v, then for each harmonic h:  Re U_h, Im U_h, Re V_h, Im V_h
        mean f, mean n, then for each harmonic h:  Re F_h, Im F_h, Re N_h, Im N_h

    with x(theta) = Re sum X_h exp(i h theta). Other kernels call `evaluate`, which needs no lock, and read
    `forces` and `jacobian`:

        from cython.cimports.fcm.contact.periodic.forces import PeriodicContact

        contact: PeriodicContact                  # PeriodicContact([1, 2, 3, 9], [1, 2, 3, 9, 10])
        contact.evaluate(x, first, mu, k_u, k_v, n_0, 0.0, True)
        stiffness = contact.jacobian[2, 2]        # d Re F_1 / d Re U_1

    Each thread needs one of its own.
    """

    def __init__(self, harmonics: list[int], outputs: list[int]) -> None:
        self.motion = Motion(harmonics)
        self.cycle = Cycle(self.motion)
        self.integrals = Integrals(self.cycle, max(outputs, default=0))
        self.derivatives = Derivatives(self.integrals, outputs)
        self.output, self.outputs = np.array(outputs, dtype=np.intc), len(outputs)
        self.unknowns, self.equations = 2 + 4 * self.motion.count, 2 + 4 * self.outputs
        self.forces, self.jacobian = np.zeros(self.equations), self.derivatives.jacobian
        self.kind = UNKNOWN

    def at(
        self,
        x: cython.double[::1],
        mu: float,
        k_u: float,
        k_v: float,
        n_0: float,
        start: float = 0.0,
        gradient: bool = True,
    ) -> int:
        """`evaluate`, called from Python."""
        kind: int = self.evaluate(x, 0, mu, k_u, k_v, n_0, start, gradient)
        return kind

    def all(
        self,
        x: cython.double[:, ::1],
        parameters: cython.double[:, ::1],
        forces: cython.double[:, ::1],
        jacobians: cython.double[:, :, ::1],
    ) -> None:
        """`forces` (point, equation) of motions (point, unknown); mu, k_u, k_v, n_0, start of each.

        And `jacobians` (point, equation, unknown), unless there is no room for them.
        """
        gradient: cython.bint = jacobians.shape[0] > 0
        i: cython.Py_ssize_t
        j: cython.int
        k: cython.int
        with cython.nogil:
            for i in range(x.shape[0]):
                self.evaluate(
                    x[i], 0, float(parameters[i, 0]), float(parameters[i, 1]), float(parameters[i, 2]),
                    float(parameters[i, 3]), float(parameters[i, 4]), gradient,
                )  # fmt: skip
                for j in range(self.equations):
                    forces[i, j] = self.forces[j]
                    if gradient:
                        for k in range(self.unknowns):
                            jacobians[i, j, k] = self.jacobian[j, k]

    def evaluate(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        mu: float,
        k_u: float,
        k_v: float,
        n_0: float,
        start: float,
        gradient: bool,
    ) -> cython.int:
        """Forces of the motion x[first:], in `forces`, and if wanted their derivatives, in `jacobian`.

        Parameters
        ----------
        start
            The displacement u at which the contact began unstressed, usually 0. The slider of a contact that
            never slips rests there, unless the limits hold it elsewhere.

        Returns
        -------
        int
            OPEN, STUCK, MIXED; or UNKNOWN where a number is not finite, and then so are the results.
        """
        self.kind = self.cycle.take(x, first, mu, k_u, k_v, n_0, start)
        nothing: float = NAN if self.kind == UNKNOWN else 0.0
        i: cython.int
        for i in range(self.equations):
            self.forces[i] = nothing
        if self.kind == STUCK:
            self.stick()
        elif self.kind == MIXED:
            self.integrals.integrate()
            self.slip()
        if gradient:
            self.derivatives.fill(nothing)
            if self.kind == STUCK:
                self.derivatives.stick()
            elif self.kind == MIXED:
                self.derivatives.slip()
        if self.kind == STUCK or self.kind == MIXED:
            self.rescale(mu, k_u, k_v, gradient)
        return self.kind

    def stick(self) -> None:
        """The slider rests; its place is the start's, or the extreme of the limit that holds it."""
        i: cython.int
        k: cython.int
        row: cython.Py_ssize_t
        self.forces[0] = -self.cycle.rest[0]
        self.forces[1] = self.motion.mean[LOAD]
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    row = 2 + 4 * i
                    self.forces[row] = self.motion.re[FORCE, k]
                    self.forces[row + 1] = self.motion.im[FORCE, k]
                    self.forces[row + 2] = self.motion.re[LOAD, k]
                    self.forces[row + 3] = self.motion.im[LOAD, k]

    def slip(self) -> None:
        """The forces from their integrals; those of short sticks are in the totals already."""
        i: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            self.integrals.product(h, LONG, FORCE)
            self.integrals.product(h, SIGNED_SLIPS, REACH)
            friction_re: float = self.integrals.total_re[h]
            friction_im: float = self.integrals.total_im[h]
            self.integrals.total_re[h] = self.integrals.total_im[h] = 0.0
            self.integrals.product(h, CONTACT, LOAD)
            if i < 0:
                self.forces[0] = 0.5 / PI * friction_re
                self.forces[1] = 0.5 / PI * self.integrals.total_re[h]
            else:
                row = 2 + 4 * i
                self.forces[row], self.forces[row + 1] = friction_re / PI, friction_im / PI
                self.forces[row + 2] = self.integrals.total_re[h] / PI
                self.forces[row + 3] = self.integrals.total_im[h] / PI

    def rescale(self, mu: float, k_u: float, k_v: float, gradient: bool) -> None:
        """From forces divided by the greatest amplitude, and derivatives by forces, to those asked for."""
        i: cython.int
        part: cython.int
        row: cython.int
        step: cython.int
        for i in range(-1, self.outputs):
            row = 2 + 4 * i if i >= 0 else 0
            step = 2 if i >= 0 else 1
            for part in range(step):
                self.forces[row + part] *= self.motion.scale
                self.forces[row + step + part] *= self.motion.load_scale
                if gradient:
                    self.derivatives.rescale(row + part, k_u, mu * k_v)
                    self.derivatives.rescale(row + step + part, 0.0, k_v)
