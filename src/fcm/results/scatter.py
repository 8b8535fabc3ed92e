"""Scatter of results by random draws: percentiles of peaks, their frequencies, and jumps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.results.curve_extracts import extract_of
from fcm.results.options import RESULTS
from fcm.results.peak import Peak
from fcm.results.quantile_interval import draws_needed, intervals
from fcm.results.result import Curve, Response
from fcm.units import in_unit

PERCENTS = (5.0, 25.0, 50.0, 75.0, 95.0)
OUTER = (PERCENTS[0], PERCENTS[-1])
SWEEPS = ("up", "down")  # directions of a slow sweep of the frequency
NONE = np.inf  # the frequency of a jump that does not occur


class Scatter(Frozen):
    """Percentiles over the complete curves that differ only in drawn numbers.

    Frequencies are in rad/s. A jump is the first one of a slow sweep in a direction, over the curves that
    have one; `jumping` (sweep,) is their share. If the sweep may have jumped before, as stability is unknown,
    the jump is unknown; `unknown` is the share of such curves. A percentile of fewer curves than
    `draws_beyond` is NaN, as it would be an extreme. The interval of a percentile of peaks holds for all
    possible draws, see `fcm.results.quantile_interval`.
    """

    parameters: dict[str, float]  # the swept values that are not drawn
    curves: int
    left_out: int  # number of draws without a complete curve
    peak: FloatArray  # (percent, dof)
    interval: FloatArray  # (percent, dof, end) of the peak; NaN for an unknown end
    greatest_error: FloatArray  # (dof,) greatest relative error of the curves' peaks; NaN if none is known
    error_unknown: npt.NDArray[np.intp]  # (dof,) number of curves whose peak has an unknown error
    frequency: FloatArray  # (percent, dof)
    jump: FloatArray  # (percent, sweep); NaN if no curve jumps
    peak_range: FloatArray  # (end, dof): the least and the greatest
    frequency_range: FloatArray  # (end, dof)
    jump_range: FloatArray  # (end, sweep)
    jumping: FloatArray  # (sweep,)
    unknown: FloatArray  # (sweep,)
    peak_unstable: FloatArray  # (dof,) share of the curves whose peak is not stable
    peak_unknown: FloatArray  # (dof,) share of the curves whose peak has unknown stability


def scatter(response: Response) -> list[Scatter]:
    """Scatter for each combination of the swept values that are not drawn; empty if nothing is drawn."""
    curves = response.curves
    return [
        _of(
            parameters,
            [curves[i] for i in places if curves[i].complete and curves[i].points],
            len(places),
            len(curves[0].peaks),
        )
        for parameters, places in groups(response)
    ]


def groups(response: Response) -> list[tuple[dict[str, float], list[int]]]:
    """Swept values that are not drawn, and the numbers of their curves; empty if nothing is drawn."""
    if not response.drawn:
        return []
    found: dict[tuple[float, ...], list[int]] = {}
    for place, curve in enumerate(response.curves):
        key = tuple(value for name, value in curve.parameters.items() if name not in response.drawn)
        found.setdefault(key, []).append(place)
    names = [name for name in response.parameters[0] if name not in response.drawn]
    return [(dict(zip(names, key, strict=True)), places) for key, places in found.items()]


def _of(parameters: dict[str, float], curves: Sequence[Curve], draws: int, dofs: int) -> Scatter:
    peaks = np.array([[peak[:3] for peak in curve.peaks.values()] for curve in curves])
    heights, frequencies, errors = (peaks[..., i] if curves else np.full((1, dofs), np.nan) for i in range(3))
    moving = np.isfinite(heights) & (heights != 0.0)
    confidence = RESULTS.draws.confidence
    left_out = draws - len(curves)
    bounds = [intervals(*of, PERCENTS, confidence, left_out) for of in zip(heights.T, errors.T, strict=True)]
    stable = np.array([[_stays(peak) for peak in curve.peaks.values()] for curve in curves] or [[1.0] * dofs])
    each = [[_first(curve, sweep) for sweep in SWEEPS] for curve in curves]
    jumps = np.array(each or [[NONE] * len(SWEEPS)])
    return Scatter(
        parameters, len(curves), left_out, percentiles(heights),
        np.stack(bounds, axis=1), np.fmax.reduce(np.where(moving, errors, np.nan), axis=0),
        (moving & np.isnan(errors)).sum(axis=0), percentiles(frequencies),
        percentiles(jumps), ranges(heights), ranges(frequencies), ranges(jumps),
        np.isfinite(jumps).mean(axis=0), np.isnan(jumps).mean(axis=0),
        (stable == 0.0).mean(axis=0), np.isnan(stable).mean(axis=0),
    )  # fmt: skip


def _stays(peak: Peak) -> float:
    """Stability of the motion at a peak; a degree of freedom that does not move counts as stable."""
    return 1.0 if peak.amplitude == 0.0 else peak.stable


def _first(curve: Curve, sweep: str, near: float = RESULTS.draws.frequency_tolerance) -> float:
    """Frequency of the first jump in a direction; NONE if there is none, NaN if it may be an earlier one.

    If no motion is stable where the sweep begins, that is not a jump.
    """
    extract, ahead = curve.extract or extract_of(curve), 1.0 if sweep == "up" else -1.0
    met, begin = extract.swept, extract.ends[0 if sweep == "up" else 1]
    jumps = [ahead * one.frequency for one in met.jumps if one.sweep == sweep and one.frequency != begin]
    unknown = [ahead * one.start for one in met.unknown if one.sweep == sweep]
    first = min(jumps, default=NONE)
    if first == NONE:
        return np.nan if unknown else NONE
    known = first - min(unknown, default=first) <= near * abs(first)
    return ahead * first if known else np.nan


def draws_beyond(percent: float) -> int:
    """Least number of draws of which one lies beyond a percentile; with fewer it would be an extreme.

    >>> [draws_beyond(percent) for percent in PERCENTS]
    [20, 4, 2, 4, 20]
    """
    return math.ceil(100.0 / min(percent, 100.0 - percent))


def percentiles(values: npt.NDArray[np.float64]) -> FloatArray:
    """Percentiles (percent, column) of each column, ignoring NaN; NaN if there are too few values.

    >>> percentiles(np.arange(5.0)[:, None]).T.tolist()
    [[nan, 1.0, 2.0, 3.0, nan]]
    """
    out = np.full((len(PERCENTS), values.shape[1]), np.nan)
    for column, own in enumerate(values.T):
        known = own[np.isfinite(own)]
        enough = [known.size >= draws_beyond(percent) for percent in PERCENTS]
        if any(enough):
            out[enough, column] = np.percentile(known, np.array(PERCENTS)[enough])
    return out


def ranges(values: npt.NDArray[np.float64]) -> FloatArray:
    """The least and the greatest (2, column) of each column, ignoring NaN and infinity."""
    known = np.where(np.isfinite(values), values, np.nan)
    return np.stack((np.fmin.reduce(known, axis=0), np.fmax.reduce(known, axis=0)))


def summary_of(one: Scatter, dofs: Sequence[str], unit: str) -> dict[str, Any]:
    """Entries for `fcm respond --json`, with frequencies in `unit`."""

    def by_percent(values: FloatArray) -> dict[str, float]:
        return {f"{percent:g}": float(value) for percent, value in zip(PERCENTS, values, strict=True)}

    def ends(values: FloatArray) -> dict[str, list[float]]:
        return {f"{percent:g}": pair.tolist() for percent, pair in zip(PERCENTS, values, strict=True)}

    frequency, jump = in_unit(one.frequency, unit), in_unit(one.jump, unit)
    reach, jumped = in_unit(one.frequency_range, unit), in_unit(one.jump_range, unit)
    return {
        "parameters": one.parameters,
        "curves": one.curves,
        "left_out": one.left_out,
        "confidence": RESULTS.draws.confidence,
        "curves_beyond": {f"{percent:g}": draws_beyond(percent) for percent in PERCENTS},
        "curves_needed": {f"{percent:g}": draws_needed(percent) for percent in PERCENTS},
        "peak": {
            dof: {
                "amplitude": by_percent(one.peak[:, d]),
                "amplitude_range": one.peak_range[:, d].tolist(),
                "interval": ends(one.interval[:, d]),
                "greatest_error": float(one.greatest_error[d]),
                "error_unknown": int(one.error_unknown[d]),
                "frequency": by_percent(frequency[:, d]),
                "frequency_range": reach[:, d].tolist(),
                "unstable": float(one.peak_unstable[d]),
                "untold": float(one.peak_unknown[d]),
            }
            for d, dof in enumerate(dofs)
            if one.curves
        },
        "jumps": {
            sweep: {
                "share": float(one.jumping[i]),
                "untold": float(one.unknown[i]),
                "frequency": by_percent(jump[:, i]),
                "frequency_range": jumped[:, i].tolist(),
            }
            for i, sweep in enumerate(SWEEPS)
        },
    }
