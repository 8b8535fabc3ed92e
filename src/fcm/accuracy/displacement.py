"""From points of a curve to the partner's curve, which has more harmonics: Newton in the normal planes."""

from __future__ import annotations

import cython

from fcm.harmonic_balance.normal_plane_prolongation import Lifted

NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class Displacement:
    """`find` displaces points to the curve of the partner's balance, that of lifted."""

    def __init__(self, lifted: Lifted) -> None:
        self.lifted, self.missed = lifted, 0.0

    def find(
        self,
        points: cython.Py_ssize_t[::1],
        z: cython.double[:, ::1],
        direction: cython.double[:, ::1],
        amplitude: cython.double[:, ::1],
        unit: cython.double[:, ::1],
        change: cython.double[:, ::1],
        theirs: cython.double[:, ::1],
        known: cython.uchar[::1],
        most: cython.double,
    ) -> None:
        """Displacements (point, 1 + dof) of some points that are not known; then they are.

        z, direction (point, unknown + 1); the first displacement is that of the frequency, relative,
        the others
        are those of amplitude (point, dof) in their unit (point, dof). theirs (point, partner's unknown + 1)
        is the partner there. NaN where Newton's method finds no point of the partner near, and where more
        than the most evaluations were spent on such points.
        """
        n: cython.Py_ssize_t = z.shape[1] - 1
        p: cython.Py_ssize_t
        d: cython.Py_ssize_t
        for p in range(points.shape[0]):
            i: cython.Py_ssize_t = points[p]
            if known[i]:
                continue
            known[i] = 1
            before: cython.double = self.lifted.newton.evaluations
            self.led(i, z, theirs, known)
            if self.missed > most or not self.lifted.beside(z[i], direction[i], True):
                self.missed += self.lifted.newton.evaluations - before
                change[i, :] = NAN
                theirs[i, :] = NAN
                continue
            theirs[i, :] = self.lifted.newton.z
            change[i, 0] = (self.lifted.found[0] - z[i, n]) / z[i, n]
            for d in range(amplitude.shape[1]):
                change[i, 1 + d] = (self.lifted.found[1 + d] - amplitude[i, d]) / unit[i, d]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def led(
        self,
        i: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        theirs: cython.double[:, ::1],
        known: cython.uchar[::1],
    ) -> cython.int:
        """Begin at the displacement of the nearest point of which that is known."""
        off: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for off in range(1, known.shape[0]):
            for j in (i - off, i + off):
                if 0 <= j < known.shape[0] and known[j] and theirs[j, 0] == theirs[j, 0]:
                    return self.lifted.lead(z[j], theirs[j])
        return 0
