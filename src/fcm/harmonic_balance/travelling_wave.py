"""Displacements of one sector of a ring in which a wave travels."""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.displacement import Displacements
from fcm.structure.linear import Linear
from fcm.structure.receptance import Receptance
from fcm.structure.travelling import TravellingReceptance


@cython.cclass
class TravellingDisplacements(Displacements):
    """As `Displacements`, each harmonic by the shapes (mode, dof) of the modes that it meets."""

    def __init__(
        self, seen: TravellingReceptance, linear: Linear, shapes: list[npt.NDArray[np.complex128]]
    ) -> None:
        Displacements.__init__(self, seen, linear)
        self.waves = seen.waves
        most = max((len(one) for one in shapes), default=0)
        self.wave_re, self.wave_im = np.zeros((2, len(shapes), most, self.dofs))
        for j, one in enumerate(shapes):
            np.asarray(self.wave_re)[j, : len(one)] = one.real
            np.asarray(self.wave_im)[j, : len(one)] = one.imag

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def harmonic(
        self,
        j: cython.int,
        load: cython.double,
        force: cython.double[::1],
        d_force: cython.double[::1],
        d_omega: cython.double,
    ) -> cython.int:
        """Amplitudes of one harmonic, mode by mode."""
        wave: Receptance = self.waves[j]
        n: cython.Py_ssize_t = self.seen.ports
        i: cython.Py_ssize_t
        d: cython.Py_ssize_t
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        driven: cython.double = load if self.seen.forced[j] >= 0 else 0.0
        self.clear(j)
        for i in range(wave.modes):
            f_re: cython.double = driven * wave.force_re[0, i]
            f_im: cython.double = driven * wave.force_im[0, i]
            g_re: cython.double = driven * d_omega * wave.slope_re[0, i]
            g_im: cython.double = driven * d_omega * wave.slope_im[0, i]
            for p in range(n):
                k = self.seen.wave_at[p] + self.seen.stride * j
                a: cython.double = wave.shapes[i, p]
                b: cython.double = wave.shapes[i, n + p]
                f_re -= a * force[k] + b * force[k + 1]
                f_im -= a * force[k + 1] - b * force[k]
                g_re -= a * d_force[k] + b * d_force[k + 1]
                g_im -= a * d_force[k + 1] - b * d_force[k]
            self.move(wave, 0, i, f_re, f_im, g_re, g_im, d_omega)
            for d in range(self.dofs):
                a = self.wave_re[j, i, d]
                b = self.wave_im[j, i, d]
                self.re[j, d] += a * self.q_re - b * self.q_im
                self.im[j, d] += a * self.q_im + b * self.q_re
                self.d_re[j, d] += a * self.r_re - b * self.r_im
                self.d_im[j, d] += a * self.r_im + b * self.r_re
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def clear(self, j: cython.int) -> cython.void:
        """No amplitudes of a harmonic."""
        d: cython.Py_ssize_t
        for d in range(self.dofs):
            self.re[j, d] = self.im[j, d] = self.d_re[j, d] = self.d_im[j, d] = 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def sum_modes(self) -> cython.int:
        """Done for each harmonic."""
        return 0
