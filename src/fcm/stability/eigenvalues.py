"""Eigenvalues of real matrices, by LAPACK through numpy.

Every run has loaded numpy. Scipy's interface for Cython saves ten microseconds a matrix, but its import takes
longer than all the matrices of a usual run.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.model.scene import FloatArray


def eigenvalues(matrices: Sequence[FloatArray]) -> list[list[complex] | None]:
    """The eigenvalues of each matrix (n, n), or None if it has a number that is not finite, or LAPACK fails.

    Complex pairs are side by side. LAPACK balances a matrix, so that units of rows and columns do not matter.
    It is called once for all matrices of the same size: numpy's own work takes longer than LAPACK's on a
    small matrix.

    >>> eigenvalues([np.array([[2.0, 1.0], [0.0, 3.0]]), np.array([[np.nan]])])
    [[(2+0j), (3+0j)], None]
    """
    found: list[list[complex] | None] = [None] * len(matrices)
    alike: dict[int, list[int]] = {}
    for k, matrix in enumerate(matrices):
        alike.setdefault(len(matrix), []).append(k)
    for numbers in alike.values():
        every = np.array([matrices[k] for k in numbers]) if len(numbers) > 1 else matrices[numbers[0]][None]
        try:
            values = np.linalg.eigvals(every).astype(np.complex128).tolist()
        except np.linalg.LinAlgError:  # one failed: compute the others one by one
            if len(numbers) > 1:
                values = [eigenvalues([one])[0] for one in every]
            else:
                continue
        for k, one in zip(numbers, values, strict=True):
            found[k] = one
    return found
