"""Degrees of freedom that move only by rounding are at rest: they have no peak and no error."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.at_rest import RestOptions, at_rest
from fcm.results.curve_extracts import CurveExtract
from fcm.results.jumps import FrequencySweep
from fcm.results.nonlinear_mode import NonlinearMode
from fcm.results.peak import Peak
from fcm.results.result import Curve

BoolArray = npt.NDArray[np.bool_]


def without_rounding(curve: Curve) -> Curve:
    """The curve with amplitudes of 0 where a degree of freedom moves only by rounding.

    Its peak then has no frequency and no error. Means stay, as a degree of freedom at rest may be displaced.
    """
    rest = _at_rest(curve)
    if not rest.any():
        return curve
    changed: dict[str, Any] = {
        name: _still(getattr(curve, name), rest) for name in ("amplitude", "fundamental", "error")
    }
    if curve.error_at_frequency is not None:
        changed["error_at_frequency"] = _still(curve.error_at_frequency, rest)
    changed["peaks"] = {
        dof: Peak(0.0, np.nan, np.nan, peak.stable, 0.0) if still and np.isfinite(peak.amplitude) else peak
        for (dof, peak), still in zip(curve.peaks.items(), rest.tolist(), strict=True)
    }
    if curve.harmonic is not None:
        changed["harmonic"] = _still(curve.harmonic, rest)
    if (orbits := curve.orbits) is not None:
        names = ("cycle_least", "cycle_greatest", "family_least", "family_greatest")
        arrays: dict[str, Any] = {name: _still(getattr(orbits, name), rest) for name in names}
        arrays["swept"] = None if orbits.swept is None else _swept(orbits.swept, rest)
        changed["orbits"] = replace(orbits, **arrays)
    if curve.mode is not None:
        changed["mode"] = _mode(curve.mode, {dof for dof, one in zip(curve.peaks, rest, strict=True) if one})
    if curve.extract is not None:
        changed["extract"] = _extract(curve.extract, rest)
    return replace(curve, **changed)


def _at_rest(curve: Curve) -> BoolArray:
    """Mask (dof,) of the degrees of freedom that move only by rounding, or not at all."""
    peaks = curve.peaks.values()  # peaks may be higher than points; a nonlinear mode has none
    size = np.fmax.reduce(curve.amplitude, axis=0, initial=np.nan)
    size = np.fmax(size, [peak.amplitude for peak in peaks])
    rounding = np.array([peak.rounding for peak in peaks])
    told = (size == 0.0) | (rounding >= RestOptions().uncertain)
    return np.where(rounding < 0.0, at_rest(size), told)


def _extract(extract: CurveExtract, rest: BoolArray) -> CurveExtract:
    lower = extract.lower_peaks[~rest[extract.lower_peaks[:, 0].astype(np.intp)]]
    return replace(extract, swept=_swept(extract.swept, rest), lower_peaks=lower)


def _mode(mode: NonlinearMode, rest: Collection[str]) -> NonlinearMode:
    resonances = [
        one._replace(amplitude={dof: 0.0 if dof in rest else a for dof, a in one.amplitude.items()})
        for one in mode.resonances
    ]
    return replace(mode, resonances=resonances)


def _swept(swept: FrequencySweep, rest: BoolArray) -> FrequencySweep:
    jumps = [
        replace(one, before=_still(one.before, rest), after=_still(one.after, rest)) for one in swept.jumps
    ]
    return FrequencySweep(jumps, [replace(one, before=_still(one.before, rest)) for one in swept.unknown])


def _still(values: npt.NDArray[Any], rest: BoolArray) -> npt.NDArray[Any]:
    """Values with 0 in the columns (..., dof) at rest; NaN stays."""
    return np.where(np.isnan(values) | ~rest, values, 0.0)
