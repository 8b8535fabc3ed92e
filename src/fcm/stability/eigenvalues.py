"""Eigenvalues of real matrices, by LAPACK.

Through numpy, which every run has loaded: scipy's interface for Cython saves ten microseconds a matrix, and
takes longer to be imported than all the matrices of a usual run.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.model.scene import FloatArray


def eigenvalues(matrices: Sequence[FloatArray]) -> list[list[complex] | None]:
    """The eigenvalues of each matrix (n, n), pairs side by side; None where a number is not finite, or they
    are not found.

    LAPACK balances a matrix, so that units of rows and columns do not matter. It is called once for all of
    the same size: around a small matrix numpy's own work takes longer than LAPACK's.

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
        except np.linalg.LinAlgError:  # of one: the others have theirs
            if len(numbers) > 1:
                values = [eigenvalues([one])[0] for one in every]
            else:
                continue
        for k, one in zip(numbers, values, strict=True):
            found[k] = one
    return found
