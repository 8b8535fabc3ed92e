"""Arrays over curves and points that are made in parts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.results.result import Curve


class Padded:
    """Array (curve, row, ...) of values picked from each curve, rows padded with NaN, or '' for text.

    >>> array = Padded([0, 2], lambda count: np.ones((count, 3)), 2)
    >>> array.shape, array.part(1, 2).tolist()
    ((2, 2, 3), [[[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]])
    """

    def __init__(self, curves: Sequence[Any], pick: Callable[[Any], npt.NDArray[Any]], longest: int) -> None:
        self.curves, self.pick = curves, pick
        first = pick(curves[0]) if curves else np.empty(0)
        self.dtype = np.dtype("<U6") if first.dtype.kind == "U" else np.dtype(np.float64)
        self.shape = (len(curves), longest, *first.shape[1:])

    def step(self, chunk: int) -> int:
        """Number of curves whose rows together take about `chunk` bytes."""
        return max(chunk // max(8 * int(np.prod(self.shape[1:])), 1), 1)

    def part(self, begin: int, end: int) -> npt.NDArray[Any]:
        """The rows of curves `begin` to `end` - 1."""
        parts = [self.pick(curve) for curve in self.curves[begin:end]]
        nothing = "" if self.dtype.kind == "U" else np.nan
        out = np.full((len(parts), *self.shape[1:]), nothing, dtype=np.result_type(self.dtype, *parts))
        for row, values in zip(out, parts, strict=True):
            row[: values.shape[0]] = values
        return out

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return self.part(0, len(self.curves))


def by_point(curves: Sequence[Curve], pick: Callable[[Curve], npt.NDArray[Any]]) -> Padded:
    """Padded array of values picked at every point of the curves."""
    return Padded(curves, pick, max((curve.frequency.size for curve in curves), default=0))


def by_fold(curves: Sequence[Curve], pick: Callable[[Curve], npt.NDArray[Any]]) -> Padded:
    """Padded array of values picked from each curve, with a number of rows of its own."""
    return Padded(curves, pick, max((len(pick(curve)) for curve in curves), default=0))


class Field(NamedTuple):
    """One variable of a netCDF file."""

    dims: tuple[str, ...]
    values: npt.NDArray[Any] | Padded
    attrs: dict[str, str]
