"""What random draws make of the results: percentiles of peaks, of their frequencies, and of jumps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.results.gist import gist_of
from fcm.results.result import Curve, Response
from fcm.scene.model import FloatArray
from fcm.units import in_unit

PERCENTS = (5.0, 25.0, 50.0, 75.0, 95.0)
SWEEPS = ("up", "down")  # directions of a slow sweep of the frequency


@dataclass(frozen=True)
class Scatter:
    """Of the curves that differ in drawn numbers alone; incomplete curves do not count.

    Frequencies in rad/s. Of a jump, the first that a slow sweep in the direction meets, over those curves
    that have one: their share, (sweep,).
    """

    parameters: dict[str, float]  # the swept values that are not drawn
    curves: int
    peak: FloatArray  # (percent, dof)
    frequency: FloatArray  # (percent, dof)
    jump: FloatArray  # (percent, sweep); NaN where no curve jumps
    jumping: FloatArray  # (sweep,)


def scatter(response: Response) -> list[Scatter]:
    """One for each combination of the swept values that are not drawn; none where nothing is drawn."""
    if not response.drawn:
        return []
    groups: dict[tuple[float, ...], list[Curve]] = {}
    for curve in response.curves:
        key = tuple(value for name, value in curve.parameters.items() if name not in response.drawn)
        groups.setdefault(key, []).append(curve)
    names = [name for name in response.parameters[0] if name not in response.drawn]
    return [
        _of(dict(zip(names, key, strict=True)), [one for one in curves if one.complete and one.points])
        for key, curves in groups.items()
    ]


def _of(parameters: dict[str, float], curves: Sequence[Curve]) -> Scatter:
    peaks = np.array([[peak[:2] for peak in curve.peaks.values()] for curve in curves])
    heights, frequencies = (peaks[..., i] if curves else np.full((1, 1), np.nan) for i in range(2))
    jumps = [[_first(curve, sweep) for sweep in SWEEPS] for curve in curves] or [[np.nan] * len(SWEEPS)]
    return Scatter(
        parameters, len(curves), _percentiles(heights), _percentiles(frequencies),
        _percentiles(np.array(jumps)), np.isfinite(jumps).mean(axis=0),
    )  # fmt: skip


def _first(curve: Curve, sweep: str) -> float:
    """The first jump in a direction that lands on another part of the curve; NaN if there is none."""
    landing = (
        one
        for one in (curve.gist or gist_of(curve)).swept.jumps
        if one.sweep == sweep and np.isfinite(one.after).any()
    )
    return next((one.frequency for one in landing), np.nan)


def _percentiles(values: npt.NDArray[np.float64]) -> FloatArray:
    """Of each column, (percent, column), without what is NaN."""
    out = np.full((len(PERCENTS), values.shape[1]), np.nan)
    for column, own in enumerate(values.T):
        known = own[np.isfinite(own)]
        if known.size:
            out[:, column] = np.percentile(known, PERCENTS)
    return out


def summary_of(one: Scatter, dofs: Sequence[str], unit: str) -> dict[str, Any]:
    """As `fcm respond --json` prints it, frequencies in unit."""

    def by_percent(values: FloatArray) -> dict[str, float]:
        return {f"{percent:g}": float(value) for percent, value in zip(PERCENTS, values, strict=True)}

    frequency, jump = in_unit(one.frequency, unit), in_unit(one.jump, unit)
    return {
        "parameters": one.parameters,
        "curves": one.curves,
        "peak": {
            dof: {"amplitude": by_percent(one.peak[:, d]), "frequency": by_percent(frequency[:, d])}
            for d, dof in enumerate(dofs)
            if one.curves
        },
        "jumps": {
            sweep: {"share": float(one.jumping[i]), "frequency": by_percent(jump[:, i])}
            for i, sweep in enumerate(SWEEPS)
        },
    }
