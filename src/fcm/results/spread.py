"""Median and scatter of results over random draws, for each combination of values that are not drawn."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.results.scatter import OUTER, draws_beyond


class Spread(Frozen):
    """The median of some draws, and their scatter."""

    count: int
    low: float
    median: float
    high: float
    percents: bool  # whether the ends are the outer of `PERCENTS`; otherwise they are the extremes


def spread_of(values: FloatArray) -> Spread:
    """The spread of values (draw,), ignoring NaN: between percentiles, or for few draws between extremes.

    >>> spread_of(np.arange(3.0))
    Spread(count=3, low=0.0, median=1.0, high=2.0, percents=False)
    """
    known = values[np.isfinite(values)]
    enough = known.size >= max(map(draws_beyond, OUTER))
    low, high = OUTER if enough else (0.0, 100.0)
    ends = np.percentile(known, (low, 50.0, high)) if known.size else np.full(3, np.nan)
    return Spread(known.size, float(ends[0]), float(ends[1]), float(ends[2]), enough)


class DrawnSpread(Frozen):
    """Spreads of some quantities over the curves that differ only in drawn numbers."""

    parameters: dict[str, float]  # the swept values that are not drawn
    spreads: tuple[Spread, ...]  # (quantity,)


def spreads_of(
    parameters: Mapping[str, FloatArray],
    drawn: Collection[str],
    quantities: Sequence[FloatArray],
    counted: npt.NDArray[np.bool_],
) -> list[DrawnSpread]:
    """Spreads for each combination of the swept values that are not drawn, in their order.

    Parameters
    ----------
    parameters : mapping
        The values (curve,) of each swept key.
    drawn : collection of str
        The keys whose values are random draws.
    quantities : sequence of (curve,) array
        Quantities of which the spreads are computed.
    counted : (curve,) array
        Mask of the curves that are included.

    >>> swept = {"mu": np.array([0.1, 0.1, 0.2]), "n_0": np.array([9.0, 11.0, 10.0])}
    >>> found = spreads_of(swept, ("n_0",), [np.array([3.0, 5.0, 7.0])], np.ones(3, dtype=bool))
    >>> [(one.parameters, one.spreads[0].median) for one in found]
    [({'mu': 0.1}, 4.0), ({'mu': 0.2}, 7.0)]
    """
    given = {key: values for key, values in parameters.items() if key not in drawn}
    groups: dict[tuple[float, ...], list[int]] = {}
    for curve in np.flatnonzero(counted).tolist():
        groups.setdefault(tuple(float(values[curve]) for values in given.values()), []).append(curve)
    return [
        DrawnSpread(
            dict(zip(given, values, strict=True)), tuple(spread_of(each[curves]) for each in quantities)
        )
        for values, curves in groups.items()
    ]
