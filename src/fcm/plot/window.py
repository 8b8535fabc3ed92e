"""A part of the axis of response curves, cut where they pass its ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.plot.errors import PlotError
from fcm.plot.read import LEVEL, DrawnCurve, DrawnResponse

Window = tuple[float, float]


def within(response: DrawnResponse, window: Window) -> DrawnResponse:
    """The curves and measured points within a window of the axis.

    Raises
    ------
    PlotError
        If there are none.
    """
    low, high = window
    curves = tuple(_cut(curve, low, high) for curve in response.curves)
    if not any(np.isfinite(curve.frequency).any() for curve in curves):
        every = np.concatenate([curve.frequency for curve in response.curves] or [np.full(1, np.nan)])
        there = every[np.isfinite(every)]
        unit = response.frequency_unit  # or "level", which has none
        last = f"{there.max():g}" + ("" if unit == LEVEL else f" {unit}") if there.size else ""
        ends = f"; the curves go from {there.min():g} to {last}" if last else ""
        before, after = there[there < low], there[there > high]
        if before.size and after.size:
            ends = (
                f": no point lies between those at {before.max():.9g} and {after.min():.9g}; take a wider one"
            )
        raise PlotError(f"the window {low:g} to {high:g} shows nothing{ends}")
    measured = tuple(
        replace(
            one,
            frequency=one.frequency[inside],
            amplitude=one.amplitude[inside],
            level=None if one.level is None else one.level[inside],
        )
        for one in response.measured
        if (inside := (one.frequency >= low) & (one.frequency <= high)).any()
    )
    told = response.unfinished
    span = replace(told, span=(max(told.span[0], low), min(told.span[1], high)))
    return replace(response, curves=curves, measured=measured, unfinished=span)


def _cut(curve: DrawnCurve, low: float, high: float) -> DrawnCurve:
    """The curve with NaN beyond the ends; the first point beyond moves to the end that its line crosses."""
    x, y = curve.frequency.copy(), curve.amplitude.copy()
    inside = (curve.frequency >= low) & (curve.frequency <= high)
    x[~inside] = y[~inside] = np.nan
    for step in (1, -1):
        for i in np.flatnonzero(inside).tolist():
            k = i + step
            if not 0 <= k < x.size or inside[k] or not np.isfinite(curve.frequency[k]) or np.isfinite(x[k]):
                continue
            end = low if curve.frequency[k] < low else high
            part = (end - curve.frequency[i]) / (curve.frequency[k] - curve.frequency[i])
            x[k] = end
            y[k] = curve.amplitude[i] + part * (curve.amplitude[k] - curve.amplitude[i])
    return replace(curve, frequency=x, amplitude=y)
