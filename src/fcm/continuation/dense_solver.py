"""One dense linear system: factored once, solved for several right-hand sides.

Small systems are eliminated without leaving compiled code; large ones by LAPACK, whose import takes as
long as thousands of these.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

if cython.compiled:
    from cython.cimports.fcm.continuation.elimination import eliminate, substitute
else:
    from fcm.continuation.elimination import eliminate, substitute

LARGE = cython.declare(cython.int, 400 if cython.compiled else 40)  # from here on LAPACK


@cython.cclass
class Solver:
    """matrix x = right: fill `matrix`, `factor`, fill `right`, `solve`: right is then x.

    orientation is the sign of the determinant. Neither array may be replaced.
    """

    def __init__(self, size: cython.int) -> None:
        self.size = size
        self.matrix = np.zeros((size, size))
        self.right = np.zeros(size)
        self.swapped = np.zeros(size, dtype=np.intc)
        self.orientation = 0.0
        self.factors = (np.empty(0), np.empty(0))  # of LAPACK

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """Factor the matrix, in point; false if it is singular or not finite."""
        if self.size < LARGE:
            self.orientation = eliminate(self.matrix, self.swapped)
            return self.orientation != 0.0
        from scipy.linalg import lapack

        matrix = np.asarray(self.matrix)
        if not np.isfinite(matrix).all():
            self.orientation = 0.0
            return False
        lu, pivots, info = lapack.dgetrf(matrix.T, overwrite_a=True)
        self.factors = (lu, pivots)
        swaps = np.count_nonzero(pivots != np.arange(self.size))
        self.orientation = 0.0 if info else float(np.prod(np.sign(lu.diagonal()))) * (-1.0) ** swaps
        return info == 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self) -> cython.int:
        """Replace right by the solution."""
        if self.size < LARGE:
            substitute(self.matrix, self.swapped, self.right)
            return 0
        from scipy.linalg import lapack

        right = np.asarray(self.right)
        right[:] = lapack.dgetrs(*self.factors, right, trans=1)[0]
        return 0

    def inverse(self) -> npt.NDArray[np.float64]:
        """Of the matrix that was factored; right is lost."""
        if self.size >= LARGE:
            from scipy.linalg import lapack

            # all columns at once, which is far faster than one after the other
            return np.asarray(lapack.dgetrs(*self.factors, np.eye(self.size), trans=1)[0])
        made = np.empty((self.size, self.size))
        columns: cython.double[:, ::1] = made
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(self.size):
            self.right[:] = 0.0
            self.right[i] = 1.0
            self.solve()
            for j in range(self.size):
                columns[j, i] = self.right[j]
        return made
