r"""The receptance of one sector of a ring in which a wave travels: one structure for each harmonic.

Harmonic h of the motion of sector k is X_h exp(i h k phi), so it meets the modes of one nodal diameter, with
complex shapes P on the ports, in which the next sector counts exp(i h phi) times:

    G(h omega) = sum_i P_i P_i^H c_i = A + B + i (D - D^T),    P = a + i b

with the blocks A = sum a a^T c, B = sum b b^T c and D = sum b a^T c of a receptance with real shapes on twice
as many ports, (a, b).
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

from fcm.structure.receptance import Receptance


@cython.cclass
class TravellingReceptance(Receptance):
    """`waves` (harmonic,): of each harmonic the receptance on (a, b), of that harmonic alone."""

    def __init__(
        self,
        waves: list[Receptance],
        static: npt.NDArray[np.float64],
        harmonics: npt.NDArray[np.float64],
        contacts: cython.int,
        driven: tuple[int, ...],
    ) -> None:
        shapes, none = np.zeros((0, len(static))), np.zeros(0)
        push = np.zeros((len(driven), 0), dtype=np.complex128)
        Receptance.__init__(self, shapes, none, none, push, static, harmonics, True, contacts, driven)
        self.waves = waves

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def at(self, omega: cython.double) -> cython.int:
        """Fill the arrays for a frequency."""
        j: cython.int
        if omega == self.omega:
            return 0
        self.omega = omega
        for j in range(self.count):
            wave: Receptance = self.waves[j]
            wave.at(omega)
            self.from_real(j, wave)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def from_real(self, j: cython.int, wave: Receptance) -> cython.void:
        """One harmonic from its real blocks."""
        n: cython.Py_ssize_t = self.ports
        k: cython.int = self.forced[j]
        p: cython.Py_ssize_t
        q: cython.Py_ssize_t
        for p in range(n):
            for q in range(n):
                self.G_re[j, p, q] = (
                    wave.G_re[0, p, q] + wave.G_re[0, n + p, n + q]
                    - wave.G_im[0, n + p, q] + wave.G_im[0, p, n + q]
                )  # fmt: skip
                self.G_im[j, p, q] = (
                    wave.G_im[0, p, q] + wave.G_im[0, n + p, n + q]
                    + wave.G_re[0, n + p, q] - wave.G_re[0, p, n + q]
                )  # fmt: skip
                self.dG_re[j, p, q] = (
                    wave.dG_re[0, p, q] + wave.dG_re[0, n + p, n + q]
                    - wave.dG_im[0, n + p, q] + wave.dG_im[0, p, n + q]
                )  # fmt: skip
                self.dG_im[j, p, q] = (
                    wave.dG_im[0, p, q] + wave.dG_im[0, n + p, n + q]
                    + wave.dG_re[0, n + p, q] - wave.dG_re[0, p, n + q]
                )  # fmt: skip
            if k >= 0:
                self.X_re[k, p] = wave.X_re[0, p] - wave.X_im[0, n + p]
                self.X_im[k, p] = wave.X_im[0, p] + wave.X_re[0, n + p]
                self.dX_re[k, p] = wave.dX_re[0, p] - wave.dX_im[0, n + p]
                self.dX_im[k, p] = wave.dX_im[0, p] + wave.dX_re[0, n + p]
