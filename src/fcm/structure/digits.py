"""Number of digits with which the entries of a matrix were written, and the resulting uncertainty of modes.

A program that writes a matrix as text or in single precision rounds every entry. The terms of the elastic
energy of a rigid-body motion cancel; with rounded entries their sum is that of the rounding errors instead of
0. These are uniform within half a unit of the last digit, and independent except for equal entries.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.structure.options import RIGID_BODY

FloatArray = npt.NDArray[np.float64]
Matrix = Any  # scipy sparse array or matrix

SINGLE = 7  # digits of a number of single precision


def digits_of(K: Matrix) -> int | None:
    """Decimal digits of the entries; None for full precision, or if they are few enough to be exact.

    >>> import scipy.sparse
    >>> rng = np.random.default_rng(0)
    >>> K = np.round(rng.random((9, 9)), 10)
    >>> digits_of(scipy.sparse.csc_array(K)), digits_of(scipy.sparse.csc_array([[1e9 + 1.0, -1e9]]))
    (10, None)
    """
    if K.dtype.kind != "f":
        return None
    entries = _some(K)
    if not entries.size:
        return None
    if _single(entries):
        return SINGLE if _most_need(entries, SINGLE) else None
    for digits in range(
        RIGID_BODY.min_digits if entries.size >= RIGID_BODY.min_distinct_entries else RIGID_BODY.typed_digits,
        RIGID_BODY.max_digits + 1,
    ):
        if (_rounded(entries, digits) == entries).all():
            return digits if _most_need(entries, digits - 1) else None
    return None


def _some(K: Matrix) -> FloatArray:
    """Magnitudes of a sample of the nonzero entries, each once."""
    entries: FloatArray = np.unique(np.abs(K.data[:: max(1, K.nnz // (10 * RIGID_BODY.sampled_entries))]))
    entries = entries[entries > 0.0]
    return entries[:: max(1, entries.size // RIGID_BODY.sampled_entries)]


def _single(values: FloatArray) -> bool:
    """Whether all values are representable in single precision."""
    with np.errstate(over="ignore"):
        return bool((values.astype(np.float32) == values).all())


def _most_need(values: FloatArray, digits: int) -> bool:
    """Whether most values need at least a number of digits.

    Of values rounded to a number of digits, 90 percent need all of them.
    """
    return bool(np.mean(_rounded(values, digits - 1) != values) > 0.5)


def _rounded(values: FloatArray, digits: int) -> FloatArray:
    return np.array([float(f"{value:.{digits - 1}e}") for value in values.tolist()])


def energy_uncertain(K: Matrix, shapes: FloatArray) -> FloatArray:
    """Standard deviation of phi^T K phi of each shape (row, mode) by the digits of K; 0 for full digits."""
    digits = digits_of(K)
    if digits is None:
        return np.zeros(shapes.shape[1])
    entries = K.tocoo()
    size, number = np.unique(np.abs(entries.data), return_inverse=True)
    unit, sign = _unit(size, digits), np.sign(entries.data)
    found = np.zeros(shapes.shape[1])
    for mode, shape in enumerate(shapes.T):
        # equal entries are rounded alike, so they add up: both sides of the diagonal, and equal elements
        alike = np.bincount(number, sign * shape[entries.row] * shape[entries.col])
        found[mode] = np.sqrt((unit**2 * alike**2).sum() / 12.0)
    return found


def _unit(size: FloatArray, digits: int) -> FloatArray:
    """Unit in the last digit of numbers with that many digits; 0 for a zero, which is exact."""
    unit: FloatArray
    if digits == SINGLE and _single(size):
        unit = np.spacing(size.astype(np.float32)).astype(np.float64)
    else:
        exponent = np.floor(np.log10(size, out=np.zeros_like(size), where=size > 0.0))
        unit = 10.0 ** (exponent + 1 - digits)
    return np.where(size > 0.0, unit, 0.0)
