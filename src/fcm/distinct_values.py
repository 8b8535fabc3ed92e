"""Distinct values of small arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


def distinct_values(*values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The sorted distinct values of some arrays, as `numpy.unique` of their concatenation.

    `numpy.unique` imports masked arrays, so that its first call takes 8 ms, longer than following a curve.

    >>> distinct_values(np.array([3, 1]), np.array([1, 2])).tolist()
    [1, 2, 3]
    """
    every = np.sort(np.concatenate(values))
    new = np.ones(len(every), dtype=np.bool_)
    new[1:] = every[1:] != every[:-1]
    found: npt.NDArray[Any] = every[new]
    return found
