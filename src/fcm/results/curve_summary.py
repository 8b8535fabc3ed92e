"""A curve in the summary of a response: its peaks, folds and jumps as JSON entries."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.results.cause import Cause
from fcm.results.contact_maxima import Greatest
from fcm.results.curve_extracts import CurveExtract, extract_of, worst
from fcm.results.jumps import Jump, UnknownStability
from fcm.results.orbits import Orbits, Stuck
from fcm.results.peak import Peak
from fcm.results.variable_meanings import CYCLE
from fcm.stability.unstable_ranges import without_frequencies
from fcm.units import in_unit

if TYPE_CHECKING:
    from fcm.results.result import Curve
    from fcm.sensitivity.peaks import Sensitivities


_ON_ISOLATED = "on_isolated_branch"  # key of a peak on an isolated branch


def curve_summary(curve: Curve, unit: str, contacts: Sequence[str] = ()) -> dict[str, Any]:
    """The curve as `fcm respond --json` prints it, frequencies in unit; missing entries are omitted."""
    extract = curve.extract or extract_of(curve)
    swept, dofs = extract.swept, tuple(curve.peaks)
    out: dict[str, Any] = {
        "parameters": curve.parameters,
        "points": extract.points,
        "complete": curve.complete,
    }
    if not curve.complete:
        out["reason"], out["cause"] = curve.reason, curve.cause.name.lower()
    if curve.harmonics:
        out["harmonics"] = list(curve.harmonics)
    if curve.short_of:
        out["short_of_accuracy"] = curve.short_of
    if curve.uncertain_at:
        out["branches_unsure_at"] = in_unit(curve.uncertain_at, unit).tolist()
    if curve.folds_uncertain_at:
        out["folds_unsure_at"] = in_unit(curve.folds_uncertain_at, unit).tolist()
    if curve.symmetry_lost:
        out["symmetry_lost_at"] = in_unit(curve.symmetry_lost, unit).tolist()
    if extract.unstable:
        out["no_stable_motion"] = in_unit(sorted(extract.unstable), unit).tolist()
    missing = [] if curve.levels is None else without_frequencies(extract.unstable, curve.levels)
    if missing:
        out["no_stable_motion_not_looked_at"] = in_unit(sorted(missing), unit).tolist()
    if curve.folds_between is not None:
        out["levels_looked_at"] = list(curve.folds_between)
    if curve.not_confirmed:
        out["stability_not_confirmed"] = curve.not_confirmed
    if curve.mirrored:
        out["mirrored_branches"] = curve.mirrored
    if extract.linear:
        out[extract.linear] = True
    if np.isfinite(curve.shakedown_at):
        out["shakedown_at"] = float(in_unit(curve.shakedown_at, unit))
    if curve.may_wedge:
        out["may_wedge"] = True
    if curve.undetermined:
        out["may_not_be_unique"] = curve.undetermined
    out["peak"] = {
        dof: _peak(curve, peak, extract, unit)
        | _error_there(curve, d)
        | _stable_peak(peak, stays, unit)
        | ({_ON_ISOLATED: True} if extract.highest_on_isolated[d] else {})
        for d, ((dof, peak), stays) in enumerate(
            zip(curve.peaks.items(), extract.stable_peaks.tolist(), strict=True)
        )
    }
    if extract.isolated_branches:
        out["isolated_branches"] = in_unit(np.array(extract.isolated_branches), unit).tolist()
    if peaks := _every_peak(out["peak"], extract, unit):
        out["peaks"] = peaks
    if curve.greatest is not None and contacts:
        out["contacts"] = _contacts(curve.greatest, contacts, unit)
    out["folds"] = in_unit(curve.folds, unit).tolist()
    if curve.bifurcations:
        out["bifurcations"] = [
            {"kind": kind, "frequency": float(in_unit(at, unit))} for kind, at in curve.bifurcations
        ]
    if curve.sensitivity is not None:
        out["sensitivity"] = _sensitivity(curve, curve.sensitivity, unit)
    if curve.level is not None:
        out["level_folds"] = curve.level_folds
        out["at_level_1"] = _motions_at_level_1(curve, dofs)
    out["jumps"] = [_jump(jump, dofs, unit) for jump in swept.jumps]
    if swept.unknown and not _unjudged(curve):
        out["stability_untold"] = [_unknown(one, dofs, unit) for one in swept.unknown]
    out |= {name: getattr(extract, name) for name in ("stable", "table_error", "truncation_error")}
    if np.isfinite(extract.truncation_error_at):
        out["truncation_error_at"] = float(in_unit(extract.truncation_error_at, unit))
    if extract.inaccurate:
        out["large_errors"] = [
            {"from": float(in_unit(low, unit)), "to": float(in_unit(high, unit)), "error": error}
            for low, high, error in extract.inaccurate
        ]
    if curve.orbits is not None:
        out |= _of_orbits(curve, curve.orbits, unit)
    if curve.mode is not None:
        out["mode"] = curve.mode.summary(
            curve.frequency, unit, dict(zip(curve.peaks, curve.amplitude.T, strict=True))
        )
        known = curve.mode.amplitude[np.isfinite(curve.truncation_error)]
        out["mode"]["error_known"] = {"points": known.size, "modal_amplitude": max(known, default=None)}
    return out | {"seconds": curve.seconds}


def _motions_at_level_1(curve: Curve, dofs: Sequence[str]) -> list[dict[str, Any]]:
    """Motions of the curve at the force level 1, the smallest first."""
    found = [
        {
            "amplitude": dict(zip(dofs, curve.amplitude[i].tolist(), strict=True)),
            "error": {
                dof: error if np.isfinite(error) else None
                for dof, error in zip(dofs, curve.error[i].tolist(), strict=True)
            },
            "stable": None if np.isnan(curve.stable[i]) else bool(curve.stable[i]),
        }
        for i in np.flatnonzero(np.asarray(curve.level) == 1.0)
    ]
    return sorted(found, key=lambda one: max(one["amplitude"].values()))


def _unjudged(curve: Curve) -> bool:
    """Whether an interruption came before the stability of any point was examined."""
    cut_off = not curve.complete and curve.cause is Cause.INTERRUPTED
    return cut_off and bool(np.isnan(curve.stable).all())


def _jump(jump: Jump, dofs: tuple[str, ...], unit: str) -> dict[str, Any]:
    return {
        "sweep": jump.sweep,
        "frequency": float(in_unit(jump.frequency, unit)),
        "before": dict(zip(dofs, jump.before.tolist(), strict=True)),
        "after": dict(zip(dofs, jump.after.tolist(), strict=True)),
        "after_stable": True if jump.known and np.isfinite(jump.after).any() else None,
        "periods": list(jump.periods),
    }


def _unknown(one: UnknownStability, dofs: tuple[str, ...], unit: str) -> dict[str, Any]:
    return {
        "sweep": one.sweep,
        "from": float(in_unit(one.start, unit)),
        "to": float(in_unit(one.end, unit)),
        "before": dict(zip(dofs, one.before.tolist(), strict=True)),
    }


def _peak(curve: Curve, peak: Peak, extract: CurveExtract, unit: str) -> dict[str, Any]:
    """Entries of a peak, including whether it is at an end of the range."""
    return {
        "amplitude": peak.amplitude,
        "frequency": float(in_unit(peak.frequency, unit)),
        "error": peak.error,
        "frequency_error": peak.frequency_error,
        "stable": None if np.isnan(peak.stable) else bool(peak.stable),
        "at_edge": at_edge(curve, peak, extract),
        "residual_change": peak.residual,
        **({} if curve.level is None else {"level": peak.level}),
    }


def at_edge(curve: Curve, peak: Peak, extract: CurveExtract) -> bool:
    """Whether a peak is at an end of the range of frequencies or levels, and so is not a true maximum."""
    if not (peak.amplitude > 0.0 and curve.complete):
        return False
    if curve.level is None:
        return peak.frequency in extract.ends
    return peak.level in (np.nanmin(curve.level), np.nanmax(curve.level))


def _error_there(curve: Curve, d: int) -> dict[str, float]:
    """The error of the motion at the frequency of a peak, if it is known while that of the peak is not.

    With more harmonics the peak may be elsewhere, or higher.
    """
    column, peak = curve.amplitude[:, d], list(curve.peaks.values())[d]
    visited = curve.orbits is not None and curve.orbits.visited
    if visited or not np.isnan(peak.error) or np.isnan(peak.amplitude) or not np.isfinite(column).any():
        return {}
    error = float(curve.error[int(np.nanargmax(column)), d])
    return {"error_at_frequency": error} if np.isfinite(error) and curve.level is None else {}


def _every_peak(
    highest: dict[str, dict[str, Any]], extract: CurveExtract, unit: str
) -> dict[str, list[dict[str, Any]]]:
    """All peaks in order of frequency, for the degrees of freedom with more than one."""
    keys = ("amplitude", "frequency", "error", "stable", "at_edge")
    found: dict[str, list[dict[str, Any]]] = {}
    dofs = list(highest)
    for d, amplitude, omega, error, stable, isolated in extract.lower_peaks.tolist():
        dof = dofs[int(d)]
        top = {key: highest[dof][key] for key in (*keys, _ON_ISOLATED) if key in highest[dof]}
        every = found.setdefault(dof, [top])
        told = None if np.isnan(stable) else bool(stable)
        values = (amplitude, float(in_unit(omega, unit)), error, told, False)
        every.append(dict(zip(keys, values, strict=True)) | ({_ON_ISOLATED: True} if isolated else {}))
    return {dof: sorted(every, key=lambda one: one["frequency"]) for dof, every in found.items()}


def _stable_peak(peak: Peak, stays: Sequence[float], unit: str) -> dict[str, Any]:
    """The greatest stable motion (amplitude, frequency, error), if the peak is not known to be stable."""
    amplitude, frequency, error = stays
    if peak.stable == 1.0 or np.isnan(amplitude):
        return {}
    at = float(in_unit(frequency, unit))
    return {"greatest_stable": {"amplitude": amplitude, "frequency": at, "error": error}}


def _contacts(found: Greatest, contacts: Sequence[str], unit: str) -> dict[str, Any]:
    """The greatest forces, slip and energy of each contact."""
    at = in_unit(found.frequency, unit)
    return {
        contact: {
            name: {
                "greatest": float(found.value[i, k]),
                "frequency": float(at[i, k]),
                "error": float(found.error[i, k]),
                "stable": None if np.isnan(found.stable[i, k]) else bool(found.stable[i, k]),
            }
            for k, (name, _) in enumerate(CYCLE)
        }
        for i, contact in enumerate(contacts)
    }


def _sensitivity(curve: Curve, found: Sensitivities, unit: str) -> dict[str, Any]:
    """Derivatives of each peak by each number; relative: for relative changes of peak and number."""
    out: dict[str, Any] = {}
    for dof, kind, why, height, frequency in zip(
        curve.peaks, found.kind, found.why, found.height, in_unit(found.frequency, unit), strict=True
    ):
        top = curve.peaks[dof].amplitude
        numbers = zip(found.numbers, found.values, height, frequency, strict=True)
        out[dof] = {
            "peak": kind.value,
            **({"unknown_because": why.value} if why.value else {}),
            "stable": None if np.isnan(curve.peaks[dof].stable) else bool(curve.peaks[dof].stable),
            "numbers": {
                key: {
                    "value": float(value),
                    "amplitude": float(by),
                    "frequency": float(by_frequency),
                    "relative": float(by * value / top) if top > 0.0 else np.nan,
                }
                for key, value, by, by_frequency in numbers
            },
        }
    return out


def _of_orbits(curve: Curve, orbits: Orbits, unit: str) -> dict[str, Any]:
    """Summary entries that only curves of exact motions have."""
    here = np.isfinite(curve.frequency)
    frequencies = np.unique(curve.frequency[here]).size
    known = np.isfinite(orbits.family_greatest).any(axis=1)
    families = {
        dof: [float(orbits.family_least[k, i]), float(orbits.family_greatest[k, i])]
        for i, (dof, peak) in enumerate(curve.peaks.items())
        for k in np.flatnonzero(known & (curve.frequency == peak.frequency))[:1]
    }
    return {
        "closure_error": worst(orbits.closure_error),
        "repeats": sorted({int(x) for x in orbits.repeats[here]}),
        **({"period_doubles": in_unit(np.array(orbits.doubles), unit).tolist()} if orbits.doubles else {}),
        "not_unique": int(known.sum()),
        **({"visited": frequencies} if orbits.visited else {}),
        **({"unreached": _unreached(curve, orbits, unit)} if orbits.unreached else {}),
        **({} if orbits.span is None else {"only": "peaks"}),
        **({"peak_range": families} if families else {}),
        **(
            {"stuck_beside": [_stuck(one, tuple(curve.peaks), unit) for one in orbits.stuck]}
            if orbits.stuck
            else {}
        ),
    }


def _unreached(curve: Curve, orbits: Orbits, unit: str) -> list[dict[str, Any]]:
    """Motions at visited frequencies that neither sweep reached, also those without a period (repeats 0)."""
    frequency = in_unit(curve.frequency, unit)
    return [
        {
            "frequency": float(frequency[k]),
            "repeats": int(orbits.repeats[k]),
            "regime": curve.regime[k].tolist(),
            "amplitude": dict(zip(curve.peaks, curve.amplitude[k].tolist(), strict=True)),
        }
        for k in orbits.unreached
    ]


def _stuck(one: Stuck, dofs: tuple[str, ...], unit: str) -> dict[str, Any]:
    return {
        "frequency": float(in_unit(one.frequency, unit)),
        "regime": list(one.states),
        "start_friction": one.friction.tolist(),
        "amplitude": {dof: [float(one.least[i]), float(one.greatest[i])] for i, dof in enumerate(dofs)},
    }
