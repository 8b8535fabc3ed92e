"""The motion of each combination as a power series by the position, which is counted in steps."""

from __future__ import annotations

import cython
import numpy as np

from fcm.motion.pool import ORDER
from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.equations import Equations
else:
    from fcm.motion.equations import Equations

_ORDER = cython.declare(cython.int, 19)
_SERIES_END = cython.declare(cython.double, 4e-19)  # 1 / 20!, as many terms as make a step complete


@cython.cclass
class Series(Equations):
    """Flows as power series."""

    def __init__(
        self,
        modal: tuple[FloatArray, ...],
        ports: tuple[FloatArray, ...],
        law: FloatArray,
        springs: tuple[FloatArray, ...],
    ) -> None:
        Equations.__init__(self, modal, ports, law, springs)
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
    def taylor(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        terms: cython.double[:, ::1],
    ) -> cython.void:
        """Taylor coefficients of the motion from row k of y, by the position in a step: (ORDER + 1, d)."""
        i: cython.Py_ssize_t
        for i in range(self.size):
            terms[0, i] = y[k, i]
        self.extend(slot, terms, _ORDER, self.step[slot], terms, False)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def part(
        self,
        slot: cython.Py_ssize_t,
        x: cython.double,
        y: cython.double[:, ::1],
        first: cython.Py_ssize_t,
        last: cython.Py_ssize_t,
    ) -> cython.void:
        """Move the rows from the first to before the last of y by a part x of a step."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        orders: cython.Py_ssize_t = needed(x)
        for k in range(first, last):
            for i in range(self.size):
                self._own[0, i] = y[k, i]
            self.extend(slot, self._own, orders, x * self.step[slot], self._own, False)
            for j in range(orders - 1, -1, -1):
                for i in range(self.size):
                    self._own[j, i] += self._own[j + 1, i]
            for i in range(self.size):
                y[k, i] = self._own[0, i]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def needed(x: cython.double) -> cython.int:
    """The terms beyond the first that a part x of a step takes, to rounding."""
    j: cython.int = 0
    size: cython.double = 1.0
    while size > _SERIES_END and j < _ORDER:
        j += 1
        size *= x / j
    return j


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def summed(
    terms: cython.double[:, ::1], x: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
) -> cython.void:
    """Row k of y becomes the sum of terms[j] x**j."""
    i: cython.Py_ssize_t
    j: cython.int
    n: cython.Py_ssize_t = terms.shape[1]
    for i in range(n):
        y[k, i] = terms[_ORDER, i]
    for j in range(_ORDER - 1, -1, -1):
        for i in range(n):
            y[k, i] = y[k, i] * x + terms[j, i]
