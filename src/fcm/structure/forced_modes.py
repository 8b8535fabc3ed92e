"""How far a structure of few modes moves under harmonic forces on its ports, beside given amplitudes."""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import sqrt

LEAST_DAMPING = cython.declare(cython.double, 1e-9)  # as of a `Receptance`


@cython.cclass
class ForcedModes:
    """Modes of mass 1 with shapes on the ports (mode, port) and on the degrees of freedom (mode, dof)."""

    def __init__(
        self,
        natural: npt.NDArray[np.float64],
        damping: npt.NDArray[np.float64],
        ports: npt.NDArray[np.float64],
        dofs: npt.NDArray[np.float64],
    ) -> None:
        self.natural, self.rate = np.array(natural), 2.0 * np.asarray(damping) * natural
        self.ports, self.dofs = np.ascontiguousarray(ports), np.ascontiguousarray(dofs)
        self.q_re, self.q_im = np.zeros((2, len(natural)))

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shares(
        self,
        harmonics: cython.Py_ssize_t[::1],
        omega: cython.double,
        force: cython.double[:, :, ::1],
        size: cython.double[::1],
        out: cython.double[::1],
    ) -> cython.int:
        """Greatest amplitude over the size of a degree of freedom, of some harmonics: (harmonic,).

        force (harmonic, port, 2): real and imaginary parts; size (dof,), where 0 does not count; harmonic 1
        is the first of both.
        """
        k: cython.Py_ssize_t
        for k in range(harmonics.shape[0]):
            h: cython.Py_ssize_t = harmonics[k]
            self.move(h * omega, force[h - 1])
            out[h - 1] = self.greatest(size)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def move(self, w: cython.double, force: cython.double[:, ::1]) -> cython.void:
        """The modes under the forces on the ports (port, 2) of a frequency."""
        m: cython.Py_ssize_t
        p: cython.Py_ssize_t
        for m in range(self.natural.shape[0]):
            f_re: cython.double = 0.0
            f_im: cython.double = 0.0
            for p in range(self.ports.shape[1]):
                f_re += self.ports[m, p] * force[p, 0]
                f_im += self.ports[m, p] * force[p, 1]
            re: cython.double = (self.natural[m] - w) * (self.natural[m] + w)
            im: cython.double = self.rate[m] * w
            if re == 0.0 and im == 0.0:
                re = LEAST_DAMPING * w * w
            square: cython.double = re * re + im * im
            self.q_re[m] = (f_re * re + f_im * im) / square
            self.q_im[m] = (f_im * re - f_re * im) / square

    @cython.cfunc
    @cython.exceptval(check=False)
    def greatest(self, size: cython.double[::1]) -> cython.double:
        """Of the amplitudes over sizes (dof,)."""
        m: cython.Py_ssize_t
        d: cython.Py_ssize_t
        most: cython.double = 0.0
        for d in range(self.dofs.shape[1]):
            if size[d] > 0.0:
                re: cython.double = 0.0
                im: cython.double = 0.0
                for m in range(self.natural.shape[0]):
                    re += self.dofs[m, d] * self.q_re[m]
                    im += self.dofs[m, d] * self.q_im[m]
                re, im = re / size[d], im / size[d]
                most = max(most, re * re + im * im)
        return sqrt(most)
