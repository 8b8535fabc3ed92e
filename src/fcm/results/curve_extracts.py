"""Extracts from all points of a curve, and curves of which little more than the extract is kept."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.distinct_values import distinct_values
from fcm.frozen import Frozen
from fcm.harmonic_balance.consecutive_points import runs
from fcm.results.jumps import FrequencySweep
from fcm.results.lower_peaks import lower_peaks, rise_beside
from fcm.results.options import RESULTS
from fcm.stability.unstable_ranges import Stretch, unstable_stretches

if TYPE_CHECKING:
    from fcm.results.result import Curve

NO_ENDS = (np.nan, np.nan)


class CurveExtract(Frozen):
    """Numbers of a curve that need all its points."""

    points: int
    ends: tuple[float, float]  # [rad/s] lowest and highest frequency sought; NaN below two points
    stable: bool | None  # whether the whole curve is stable; None if unknown
    unstable: tuple[Stretch, ...]  # [rad/s] where no stable motion was found, the widest stretch first
    swept: FrequencySweep  # of a slow upward and a slow downward sweep
    table_error: float | None  # the largest known one
    truncation_error: float | None
    truncation_error_at: float  # [rad/s] where it is largest; NaN if unknown
    # [rad/s] low and high end of ranges with large errors, and their greatest error; the widest range first
    inaccurate: tuple[tuple[float, float, float], ...]
    # (dof, 3): amplitude, frequency [rad/s] and error of the greatest stable motion; NaN if there is none
    stable_peaks: FloatArray
    linear: str  # how the response is that of a linear structure; empty if it is not
    # (peak, 6): dof, amplitude, frequency [rad/s], error and stability of peaks that are not the highest, and
    # whether they are on an isolated branch
    lower_peaks: FloatArray
    isolated_branches: tuple[tuple[float, float], ...]  # [rad/s] lowest and highest frequency of each
    highest_on_isolated: npt.NDArray[np.bool_]  # (dof,) whether the highest peak is on one of them

    def at(self, shown: npt.NDArray[np.bool_]) -> CurveExtract:
        """The extract restricted to some degrees of freedom."""
        lower = self.lower_peaks[shown[self.lower_peaks[:, 0].astype(np.intp)]]
        lower[:, 0] = (np.cumsum(shown) - 1)[lower[:, 0].astype(np.intp)]
        return replace(
            self,
            swept=self.swept.at(shown),
            stable_peaks=self.stable_peaks[shown],
            lower_peaks=lower,
            highest_on_isolated=self.highest_on_isolated[shown],
        )


def extract_of(curve: Curve) -> CurveExtract:
    """The extract of a curve that has all its points."""
    known = curve.frequency[np.isfinite(curve.frequency)]
    isolated, on_isolated = _isolated_branches(curve)
    return CurveExtract(
        points=known.size,
        ends=_ends(curve, known),
        stable=_stable(curve),
        unstable=tuple(_unstable(curve)),
        swept=curve.swept(),
        table_error=worst(curve.table_error),
        truncation_error=worst(curve.truncation_error),
        truncation_error_at=_at_worst(curve),
        inaccurate=tuple(_inaccurate_ranges(curve)),
        stable_peaks=_stable_peaks(curve),
        linear=_linear(curve),
        lower_peaks=_lower_peaks(curve, on_isolated),
        isolated_branches=isolated,
        highest_on_isolated=_highest_on_isolated(curve, on_isolated),
    )


def with_extracts(curve: Curve) -> Curve:
    """The curve with its extract, for repeated use."""
    return curve if curve.extract is not None else replace(curve, extract=extract_of(curve))


def without_points(curve: Curve, most: int = 0) -> Curve:
    """The curve with its extract, and at most `most` of its points: those of the greatest displacements."""
    at = np.flatnonzero(np.isfinite(curve.frequency))
    if at.size:
        at = distinct_values(at[curve.amplitude[at].argmax(axis=0)])[:most]
    values = {field.name: getattr(curve, field.name) for field in fields(curve)}
    kept: dict[str, Any] = {name: x[at] for name, x in values.items() if isinstance(x, np.ndarray)}
    return replace(curve, **kept, across=None, extract=extract_of(curve))


def worst(errors: FloatArray) -> float | None:
    """The largest known error; None if none is known."""
    known = errors[np.isfinite(errors)]
    return float(known.max()) if known.size else None


def _at_worst(curve: Curve) -> float:
    """The frequency [rad/s] of the largest truncation error; NaN unless the curve is over the frequency."""
    known = np.isfinite(curve.truncation_error)
    if not known.any() or curve.level is not None or curve.mode is not None:
        return float("nan")
    return float(curve.frequency[np.where(known, curve.truncation_error, -np.inf).argmax()])


def _inaccurate_ranges(curve: Curve) -> list[tuple[float, float, float]]:
    """Ranges of frequency [rad/s] with large errors, and the greatest error in each, the widest range first.

    Empty unless the curve is over the frequency.
    """
    if curve.level is not None or curve.mode is not None:
        return []
    large = np.isfinite(curve.truncation_error) & (curve.truncation_error > RESULTS.point_errors.least_error)
    parts = [(curve.frequency[a:b], curve.truncation_error[a:b]) for a, b in runs(large)]
    ranges = [(float(at.min()), float(at.max()), float(error.max())) for at, error in parts]
    wide = [one for one in ranges if one[1] - one[0] > RESULTS.point_errors.least_width * one[1]]
    return sorted(wide, key=lambda one: one[0] - one[1])


def _ends(curve: Curve, known: FloatArray) -> tuple[float, float]:
    if curve.orbits is not None and curve.orbits.span is not None:
        return curve.orbits.span
    return (float(known.min()), float(known.max())) if known.size and np.ptp(known) > 0.0 else NO_ENDS


def _stable(curve: Curve) -> bool | None:
    stable = curve.stable[np.isfinite(curve.frequency)]
    if (stable == 0.0).any():
        return False
    return True if stable.size and (stable == 1.0).all() else None


def _stable_peaks(curve: Curve) -> FloatArray:
    """The greatest stable amplitude of each degree of freedom, its frequency and error.

    NaN if there is none, or if the curve is not over the frequency."""
    found = np.full((curve.amplitude.shape[1], 3), np.nan)
    rows = np.flatnonzero(np.isfinite(curve.frequency) & (curve.stable == 1.0))
    if rows.size and curve.level is None and curve.mode is None:
        d = np.arange(len(found))
        at = rows[curve.amplitude[rows].argmax(axis=0)]
        found[:] = np.transpose((curve.amplitude[at, d], curve.frequency[at], curve.error[at, d]))
    return found


def _isolated_branches(curve: Curve) -> tuple[tuple[tuple[float, float], ...], npt.NDArray[np.bool_]]:
    """Lowest and highest frequency [rad/s] of each isolated branch, and the points (point,) on these."""
    on_isolated = np.isin(curve.branch, curve.isolated) & np.isfinite(curve.frequency)
    each = [curve.frequency[on_isolated & (curve.branch == k)] for k in curve.isolated]
    return tuple(sorted((float(one.min()), float(one.max())) for one in each)), on_isolated


def _highest_on_isolated(curve: Curve, on_isolated: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Whether the highest point of each degree of freedom is on an isolated branch: (dof,)."""
    if not on_isolated.any():
        return np.zeros(curve.amplitude.shape[1], dtype=bool)
    heights = np.where(np.isnan(curve.amplitude), -np.inf, curve.amplitude)
    found: npt.NDArray[np.bool_] = on_isolated[heights.argmax(axis=0)]
    return found


def _lower_peaks(curve: Curve, on_isolated: npt.NDArray[np.bool_]) -> FloatArray:
    """Peaks other than the highest, of a curve over the whole range of frequency.

    Errors are those of the points, or the possible rise between points if that is greater."""
    if curve.level is not None or curve.mode is not None or _is_partial(curve):
        return np.empty((0, 6))
    d, k = lower_peaks(curve.amplitude).T
    height = curve.amplitude[k, d]
    beside = [
        rise_beside(curve.frequency, curve.amplitude[:, dof], at)
        for dof, at in zip(d, k.tolist(), strict=True)
    ]
    error = np.maximum(curve.error[k, d], beside)
    columns = (d, height, curve.frequency[k], error, curve.stable[k], on_isolated[k])
    return np.transpose(columns).astype(np.float64)


def _is_partial(curve: Curve) -> bool:
    """Whether exact motions were computed only at some frequencies, or only at peaks and folds."""
    orbits = curve.orbits
    return orbits is not None and (orbits.swept is not None or orbits.span is not None)


def _linear(curve: Curve) -> str:
    """Code for contacts that keep their states along a curve: all_stick, all_open or all_stick_or_open.

    '' if a state changes or a contact slips."""
    states = curve.regime[np.isfinite(curve.frequency)]
    if not states.size or not np.isin(states, ("E", "S")).all() or (states != states[0]).any():
        return ""
    found = {str(one) for one in states[0]}
    return {"E": "all_stick", "S": "all_open"}[found.pop()] if len(found) == 1 else "all_stick_or_open"


def _unstable(curve: Curve) -> list[Stretch]:
    """Stretches of frequency in which no stable motion was found, for a complete curve over the frequency."""
    if not curve.complete or _is_partial(curve) or curve.level is not None or curve.mode is not None:
        return []
    there = np.isfinite(curve.frequency)
    span = _ends(curve, curve.frequency[there])
    between = np.where(there, curve.stable, 0.0)  # there is nothing between two branches
    return unstable_stretches([(curve.frequency, between)], span)
