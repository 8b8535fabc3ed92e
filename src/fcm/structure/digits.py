"""How many digits the entries of a matrix were written with, and what that leaves uncertain of its modes.

A program that writes a matrix as text rounds every entry, and one of single precision does too. The elastic
energy of a rigid-body motion, whose terms cancel, is then no longer zero but some sum of those roundings:
independent of each other, uniform within half a unit of the last digit.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Matrix = Any  # scipy sparse array or matrix

SAMPLE = 1000  # entries that are looked at
FEWEST, MOST = 7, 15  # digits: fewer may be exact, as somebody has typed them, more are all that there are
SINGLE = 7  # digits of a number of single precision


def digits_of(K: Matrix) -> int | None:
    """Decimal digits of the entries; None where they are as many as there can be, or few enough to be exact.

    >>> import scipy.sparse
    >>> rng = np.random.default_rng(0)
    >>> K = np.round(rng.random((9, 9)), 10)
    >>> digits_of(scipy.sparse.csc_array(K)), digits_of(scipy.sparse.csc_array([[1e9 + 1.0, -1e9]]))
    (10, None)
    """
    if K.dtype.kind != "f":
        return None
    entries = np.unique(np.abs(K.data[:: max(1, K.nnz // (10 * SAMPLE))]))
    entries = entries[entries > 0.0][:: max(1, entries.size // SAMPLE)]
    if not entries.size:
        return None
    if (entries.astype(np.float32) == entries).all():
        return SINGLE if _most_need(entries, SINGLE) else None
    for digits in range(FEWEST, MOST + 1):
        if (_rounded(entries, digits) == entries).all():
            return digits if _most_need(entries, digits - 1) else None
    return None


def _most_need(values: FloatArray, digits: int) -> bool:
    """Whether most values have so many digits or more, as 0.9 of those have that are rounded to them."""
    return bool(np.mean(_rounded(values, digits - 1) != values) > 0.5)


def _rounded(values: FloatArray, digits: int) -> FloatArray:
    return np.array([float(f"{value:.{digits - 1}e}") for value in values.tolist()])


def energy_uncertain(K: Matrix, shapes: FloatArray) -> FloatArray:
    """Standard deviation of phi^T K phi of each shape (row, mode) by its digits; 0 if K has them all."""
    digits = digits_of(K)
    if digits is None:
        return np.zeros(shapes.shape[1])
    unit = K.copy()
    size = np.abs(unit.data)
    exponent = np.floor(np.log10(size, out=np.zeros_like(size), where=size > 0.0))
    unit.data = np.where(size > 0.0, 10.0 ** (exponent + 1 - digits), 0.0) ** 2
    square = shapes**2
    # two entries across the diagonal are one number, of variance unit^2 / 12
    deviation: FloatArray = np.sqrt(np.einsum("ij,ij->j", square, unit @ square) / 6.0)
    return deviation
