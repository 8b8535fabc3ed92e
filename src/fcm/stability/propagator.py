r"""Disturbances of many modes carried through a state of the contacts, by the eigenvalues of that state.

In time, not in angle, the equations of a state do not depend on the frequency:

    q' = v,    v' = -K q - D v + B w

So they are decomposed once for each state that comes up again, for all that is followed of a curve.
"""

from __future__ import annotations

from collections.abc import Callable

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, expm1, sin

from fcm.model.scene import FloatArray

MOST = cython.declare(cython.int, 256)  # states that are remembered
WORST = 1e6  # condition of the eigenvectors, beyond which they are not used

ComplexArray = npt.NDArray[np.complex128]


@cython.cclass
class Parts:
    """A disturbance as the sum of those that grow by exp(value time), one value of each pair.

    values (value,); real and imaginary parts side by side of share (2 values, 2 modes) of (q, v), and of
    driven (2 values, contact) of the places, None where no contact sticks; back (2 modes, 2 values).
    """

    def __init__(
        self, values: ComplexArray, share: FloatArray, driven: FloatArray | None, back: FloatArray
    ) -> None:
        self.re, self.im = np.array(values.real), np.array(values.imag)
        self.share, self.driven, self.back = share, driven, back
        self.modes, self.count = len(back) // 2, len(values)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def carry(self, time: cython.double, omega: cython.double, X: FloatArray) -> cython.int:
        """Replace the rows (q, dq / dangle) of X, above those of w, by what they are after a time."""
        rows: cython.double[:, :] = X
        m: cython.Py_ssize_t = self.modes
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for i in range(m, 2 * m):
            for k in range(rows.shape[1]):
                rows[i, k] *= omega
        moving = X[: 2 * m]
        parts = np.matmul(self.share, moving)
        self.grow(time, parts, None if self.driven is None else np.matmul(self.driven, X[2 * m :]))
        np.matmul(self.back, parts, out=moving)
        for i in range(m, 2 * m):
            for k in range(rows.shape[1]):
                rows[i, k] /= omega
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def grow(
        self, time: cython.double, part: cython.double[:, ::1], drive: cython.double[:, ::1]
    ) -> cython.void:
        """The parts (2 values, column), of which the places drive some, or None, after a time.

        What is driven grows by (exp(value time) - 1) / value, of no value by the time.
        """
        i: cython.Py_ssize_t
        re: cython.double
        im: cython.double
        for i in range(self.count):
            less: cython.double = expm1(self.re[i] * time)
            half: cython.double = sin(0.5 * self.im[i] * time)
            re = less * cos(self.im[i] * time) - 2.0 * half * half
            im = (1.0 + less) * sin(self.im[i] * time)
            turn(part[2 * i], part[2 * i + 1], part[2 * i], part[2 * i + 1], re, im)
            if drive is not None:
                still: cython.bint = self.re[i] == 0.0 and self.im[i] == 0.0
                re = time if still else re
                turn(part[2 * i], part[2 * i + 1], drive[2 * i], drive[2 * i + 1], re, im)


class Propagator:
    """States by their keys, each seen once before it is decomposed."""

    def __init__(self) -> None:
        self.known: dict[bytes, Parts | None] = {}
        self.seen: set[bytes] = set()

    def through(
        self,
        key: bytes,
        angle: float,
        omega: float,
        system: Callable[[], tuple[FloatArray, FloatArray, FloatArray]],
        X: FloatArray,
    ) -> bool:
        """Carry the rows (q, dq / dangle) of X, above those of w, through an angle; false if it cannot yet.

        system makes K, D (mode,) and B of derivatives by the angle.
        """
        parts = self._parts(key, omega, system)
        if parts is None:
            return False
        parts.carry(angle / omega, omega, X)
        return True

    def _parts(
        self, key: bytes, omega: float, system: Callable[[], tuple[FloatArray, FloatArray, FloatArray]]
    ) -> Parts | None:
        if key in self.known:
            return self.known[key]
        if key not in self.seen or len(self.known) >= MOST:
            self.seen.add(key)
            return None
        K, D, B = system()
        m = len(D)
        A = np.zeros((2 * m, 2 * m))
        A[:m, m:] = np.eye(m)
        A[m:, :m], A[m:, m:] = -omega * omega * K, -np.diag(omega * D)
        self.known[key] = _decomposed(A, np.vstack((np.zeros_like(B), omega * omega * B)))
        return self.known[key]


def _decomposed(A: FloatArray, B: FloatArray) -> Parts | None:
    """None where the eigenvectors are nearly dependent."""
    try:
        values, vectors = np.linalg.eig(A)
        unit = np.repeat([1.0, np.abs(values).max()], len(A) // 2)[:, None]  # of places and velocities
        if not np.linalg.cond(vectors / unit) < WORST:
            return None
        inverse = np.linalg.inv(vectors / unit) / unit.T
    except np.linalg.LinAlgError:
        return None
    one = values.imag >= 0.0
    values, vectors, inverse = values[one].astype(np.complex128), vectors[:, one], inverse[one]
    pair = np.where(values.imag > 0.0, 2.0, 1.0)
    driven = _real((inverse @ B) / np.where(values == 0.0, 1.0, values)[:, None]) if B.any() else None
    return Parts(values, _real(inverse), driven, _real(np.conj(vectors * pair).T).T.copy())


def _real(rows: ComplexArray) -> FloatArray:
    """(value, n) as (2 values, n): real and imaginary parts side by side."""
    return np.stack((rows.real, rows.imag), axis=1).reshape(2 * len(rows), -1)


@cython.cfunc
@cython.exceptval(check=False)
def turn(
    re: cython.double[::1],
    im: cython.double[::1],
    by_re: cython.double[::1],
    by_im: cython.double[::1],
    times: cython.double,
    times_im: cython.double,
) -> cython.void:
    """Add (times + i times_im) (by_re + i by_im) to re + i im, which it may be."""
    k: cython.Py_ssize_t
    one: cython.double
    other: cython.double
    for k in range(re.shape[0]):
        one, other = by_re[k], by_im[k]
        re[k] += times * one - times_im * other
        im[k] += times * other + times_im * one
