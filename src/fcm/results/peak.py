"""The greatest amplitude of a degree of freedom on a curve, and whether the motion is stable there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.results.options import RESULTS


class Peak(NamedTuple):
    """The greatest amplitude of a degree of freedom on a curve."""

    amplitude: float
    frequency: float  # [rad/s]
    error: float = np.nan  # estimated relative error of the amplitude; NaN if unknown
    stable: float = np.nan  # 1 where small disturbances die out, 0 where not, NaN if unknown
    residual: float = (
        np.nan
    )  # greatest relative change by the residual friction of contacts that always stick; NaN: unknown
    frequency_error: float = np.nan  # estimated relative error of the frequency; NaN if unknown
    rounding: float = -1.0  # relative rounding of the amplitude; -1 if no contact is stiff
    level: float = 1.0  # force level; 1 unless the curve is over the level


def stability_at_top(amplitude: FloatArray, stable: FloatArray) -> FloatArray:
    """Whether the motion is stable at the greatest amplitude of each degree of freedom, (dof,).

    Among points of the same height, as where two branches meet, a stable one counts.

    >>> stability_at_top(np.array([[1.0, 1.0], [2.0, 0.5], [2.0, 2.0]]), np.array([np.nan, 1.0, 0.0]))
    array([1., 0.])
    """
    top = np.fmax.reduce(amplitude, axis=0, initial=np.nan)  # NaN if there is no amplitude
    there = amplitude >= (1.0 - RESULTS.jumps.amplitude_tolerance) * top
    told = (there & (stable == 1.0)[:, None]).any(axis=0)
    if told.all():
        return np.ones(told.size)
    unknown = (there & np.isnan(stable)[:, None]).any(axis=0) | np.isnan(top)
    return np.where(told, 1.0, np.where(unknown, np.nan, 0.0))
