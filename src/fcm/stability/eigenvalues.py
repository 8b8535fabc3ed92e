"""Eigenvalues of real matrices, by LAPACK.

Through numpy, which every run has loaded: scipy's interface for Cython saves ten microseconds a matrix, and
takes longer to be imported than all the matrices of a usual run.
"""

from __future__ import annotations

import numpy as np

from fcm.model.scene import FloatArray


def eigenvalues(matrix: FloatArray) -> list[complex] | None:
    """Of a matrix (n, n), pairs side by side; None where a number is not finite, or they are not found.

    LAPACK balances the matrix, so that units of rows and columns do not matter.

    >>> eigenvalues(np.array([[2.0, 1.0], [0.0, 3.0]]))
    [(2+0j), (3+0j)]
    """
    try:
        found: list[complex] = np.linalg.eigvals(matrix).astype(np.complex128).tolist()
    except np.linalg.LinAlgError:
        return None
    return found
