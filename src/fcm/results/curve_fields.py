"""Variables with one value or row for each curve: peaks, folds, derivatives of peaks, percentiles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fcm.results.contact_maxima import Greatest
from fcm.results.curve_extracts import CurveExtract, extract_of
from fcm.results.curve_summary import at_edge
from fcm.results.options import RESULTS
from fcm.results.padded_arrays import Field, by_fold
from fcm.results.peak import Peak
from fcm.results.result import Curve, Response
from fcm.results.scatter import PERCENTS, SWEEPS, Scatter
from fcm.results.variable_meanings import CYCLE
from fcm.units import CF_UNIT, in_unit


def condensed_fields(response: Response) -> dict[str, Field]:
    """Variables that summarise all points of each curve, for files without points."""
    extracts = [curve.extract or extract_of(curve) for curve in response.curves]
    of_all = {
        "greatest_table_error": (
            "largest table_error of the curve",
            [one.table_error for one in extracts],
        ),
        "greatest_truncation_error": (
            "largest truncation_error of the curve",
            [one.truncation_error for one in extracts],
        ),
        "points": ("points that were computed", [one.points for one in extracts]),
    }
    out = {
        name: Field(("curve",), np.array(values, dtype=np.float64), {"long_name": meaning, "units": "1"})
        for name, (meaning, values) in of_all.items()
    }
    out |= _caveats(response, extracts)
    if not response.complete:
        reasons = np.array([curve.reason for curve in response.curves])
        out["reason"] = Field(("curve",), reasons, {"long_name": "why the curve is not complete"})
    return out


def _caveats(response: Response, extracts: Sequence[CurveExtract]) -> dict[str, Field]:
    """Variables on what curves may lack.

    Files with all points have this in their summary.
    """
    curves, unit, out = response.curves, response.frequency_unit, dict[str, Field]()
    in_file = {"units": CF_UNIT[unit]}
    if any(curve.undetermined for curve in curves):
        meaning = "points at which the motion is one of many, by the residual friction of stuck contacts"
        undetermined = np.array([curve.undetermined for curve in curves], dtype=np.float64)
        out["points_maybe_not_unique"] = Field(("curve",), undetermined, {"long_name": meaning, "units": "1"})
    if any(curve.not_confirmed for curve in curves):
        meaning = (
            "points of unknown stability, as more harmonics were not tried at all points of many contacts"
        )
        points = np.array([curve.not_confirmed for curve in curves], dtype=np.float64)
        out["points_not_confirmed"] = Field(("curve",), points, {"long_name": meaning, "units": "1"})
    if any(curve.uncertain_at for curve in curves):
        meaning = "frequencies at which solutions were not looked for to the end: branches may be missing"
        uncertain_at = by_fold(curves, lambda curve: in_unit(np.array(curve.uncertain_at), unit))
        out["branches_unsure_at"] = Field(("curve", "unsure"), uncertain_at, {"long_name": meaning} | in_file)
    if any(curve.folds_uncertain_at for curve in curves):
        meaning = "frequencies from where folds of the force level were lost: branches may be missing"
        uncertain_at = by_fold(curves, lambda curve: in_unit(np.array(curve.folds_uncertain_at), unit))
        out["folds_unsure_at"] = Field(("curve", "lost_fold"), uncertain_at, {"long_name": meaning} | in_file)
    if any(curve.symmetry_lost for curve in curves):
        meaning = "frequencies at which symmetry is lost by harmonics that are not balanced"
        lost = by_fold(curves, lambda curve: in_unit(np.array(curve.symmetry_lost), unit))
        out["symmetry_lost_at"] = Field(("curve", "symmetry_lost"), lost, {"long_name": meaning} | in_file)
    if any(extract.unstable for extract in extracts):
        meaning = "from and to which frequency no stable motion was found"
        most = max(len(extract.unstable) for extract in extracts)
        ends = np.full((len(extracts), most, 2), np.nan)
        for row, extract in zip(ends, extracts, strict=True):
            row[: len(extract.unstable)] = np.array(sorted(extract.unstable)).reshape(-1, 2)
        of = ("curve", "stretch", "end")
        out["no_stable_motion"] = Field(of, in_unit(ends, unit), {"long_name": meaning} | in_file)
    if any(curve.short_of for curve in curves):
        short = np.array([curve.short_of for curve in curves])
        out["short_of_accuracy"] = Field(("curve",), short, {"long_name": "what keeps it from the accuracy"})
    return out


def curve_fields(response: Response) -> dict[str, Field]:
    """Variables with one value or row for each curve: peaks, folds, whether it is complete."""
    curves, unit = response.curves, response.frequency_unit
    cf_unit = CF_UNIT[unit]
    shape = (-1, len(response.dofs), len(Peak._fields))
    peaks = np.array([[c.peaks[d] for d in response.dofs] for c in curves]).reshape(shape)
    folds = by_fold(curves, lambda c: in_unit(c.folds, unit))
    complete = np.array([c.complete for c in curves], dtype=np.int8)
    by_dof, at_end = ("curve", "dof"), _peaks_at_end(curves)
    return {
        "peak_amplitude": Field(by_dof, peaks[..., 0], {"long_name": "greatest amplitude of the curve"}),
        "peak_frequency": Field(
            by_dof,
            in_unit(peaks[..., 1], unit),
            {"long_name": "frequency of the greatest amplitude", "units": cf_unit},
        ),
        "peak_error": Field(
            by_dof,
            peaks[..., 2],
            {"long_name": "estimated error of the greatest amplitude, relative", "units": "1"},
        ),
        "peak_frequency_error": Field(
            by_dof, peaks[..., 5], {"long_name": "estimated error of peak_frequency, relative", "units": "1"}
        ),
        "peak_stable": Field(
            by_dof, peaks[..., 3], {"long_name": "stable of the greatest amplitude", "units": "1"}
        ),
        "peak_residual_change": Field(
            by_dof,
            peaks[..., 4],
            {
                "long_name": "greatest change of peak_amplitude by the residual friction of contacts that "
                "never slip, relative, estimated",
                "units": "1",
            },
        ),
        **({"peak_at_end": Field(by_dof, at_end, _AT_END)} if at_end.any() else {}),
        "fold_frequency": Field(
            ("curve", "fold"),
            folds,
            {"long_name": "frequencies of the folds in order along the curve", "units": cf_unit},
        ),
        **_greatest_of_contacts(response),
        **_level_folds(curves),
        "complete": Field(
            ("curve",),
            complete,
            {"long_name": "1 where the curve reached the end of its range", "units": "1"},
        ),
    }


_AT_END = {
    "long_name": "1 where the greatest amplitude is at an end of the range, beyond which it may rise",
    "units": "1",
}


def _peaks_at_end(curves: Sequence[Curve]) -> NDArray[np.int8]:
    """Flags (curve, dof): 1 if the greatest amplitude is at an end of the range, and not a peak."""
    every = [(curve, curve.extract or extract_of(curve)) for curve in curves]
    rows = [[at_edge(curve, one, extract) for one in curve.peaks.values()] for curve, extract in every]
    return np.array(rows, dtype=np.int8)


def _greatest_of_contacts(response: Response) -> dict[str, Field]:
    """Variables of each contact's greatest loads along each curve, their frequencies and errors."""
    dims, out, unit = ("curve", "contact"), dict[str, Field](), response.frequency_unit
    found = [one.greatest or Greatest.none(len(response.contacts)) for one in response.curves]
    value, omega, error, stable = (
        np.array([getattr(one, name) for one in found]).reshape(len(found), len(response.contacts), 4)
        for name in ("value", "frequency", "error", "stable")
    )
    for i, (name, _) in enumerate(CYCLE):
        of, at = f"greatest {name} of the curve", {"units": CF_UNIT[unit]}
        out[f"peak_{name}"] = Field(dims, value[..., i], {"long_name": of})
        where = {"long_name": f"frequency of the {of}"} | at
        out[f"peak_{name}_frequency"] = Field(dims, in_unit(omega[..., i], unit), where)
        wrong = {"long_name": f"estimated error of the {of}, relative", "units": "1"}
        out[f"peak_{name}_error"] = Field(dims, error[..., i], wrong)
        dies = {"long_name": f"stable of the {of}", "units": "1"}
        out[f"peak_{name}_stable"] = Field(dims, stable[..., i], dies)
    return out


def scatter_fields(found: Sequence[Scatter], unit: str) -> dict[str, Field]:
    """Percentiles over the curves that differ only in drawn numbers."""
    of_dof, of_sweep = ("scatter", "percent", "dof"), ("scatter", "percent", "sweep_direction")
    peak, interval, frequency, jump = (
        np.stack([getattr(one, x) for one in found]) for x in ("peak", "interval", "frequency", "jump")
    )
    sure = (
        f"of all possible draws, with {100.0 * RESULTS.draws.confidence:g} % confidence and errors of peaks"
    )
    at = {"units": CF_UNIT[unit]}
    return {
        "percent": Field(("percent",), np.array(PERCENTS), {"long_name": "percentage of curves below"}),
        "sweep_direction": Field(("sweep_direction",), np.array(SWEEPS), {"long_name": "of a slow sweep"}),
        "peak_percentile": Field(
            of_dof, peak, {"long_name": "percentile of the greatest amplitude over the draws"}
        ),
        "peak_percentile_low": Field(of_dof, interval[..., 0], {"long_name": f"least it may be, {sure}"}),
        "peak_percentile_high": Field(of_dof, interval[..., 1], {"long_name": f"most it may be, {sure}"}),
        "peak_frequency_percentile": Field(
            of_dof, in_unit(frequency, unit), {"long_name": "percentile of its frequency"} | at
        ),
        "jump_percentile": Field(
            of_sweep, in_unit(jump, unit), {"long_name": "percentile of the first jump's frequency"} | at
        ),
        "jump_share": Field(
            ("scatter", "sweep_direction"),
            np.stack([one.jumping for one in found]),
            {"long_name": "share of curves that jump", "units": "1"},
        ),
        "jump_untold_share": Field(
            ("scatter", "sweep_direction"),
            np.stack([one.unknown for one in found]),
            {"long_name": "share of curves that may jump, as stability is unknown", "units": "1"},
        ),
        "peak_unstable_share": Field(
            ("scatter", "dof"),
            np.stack([one.peak_unstable for one in found]),
            {"long_name": "share of curves that are not stable at the greatest amplitude", "units": "1"},
        ),
        "peak_untold_share": Field(
            ("scatter", "dof"),
            np.stack([one.peak_unknown for one in found]),
            {"long_name": "share of curves of which that is unknown", "units": "1"},
        ),
    }


def sensitivity_fields(response: Response) -> dict[str, Field]:
    """Derivatives of the peaks by numbers of the scene; NaN for curves without them."""
    curves, dofs = response.curves, len(response.dofs)
    numbers = next(c.sensitivity.numbers for c in curves if c.sensitivity is not None)
    height, frequency = (np.full((len(curves), dofs, len(numbers)), np.nan) for _ in range(2))
    values, kind = (
        np.full((len(curves), len(numbers)), np.nan),
        np.full((len(curves), dofs), "", dtype="<U16"),
    )
    for i, curve in enumerate(curves):
        if curve.sensitivity is not None:
            height[i], values[i] = curve.sensitivity.height, curve.sensitivity.values
            frequency[i] = in_unit(curve.sensitivity.frequency, response.frequency_unit)
            kind[i] = [one.value for one in curve.sensitivity.kind]
    by = ("curve", "dof", "number")
    return {
        "number": Field(
            ("number",),
            np.array(numbers),
            {"long_name": "number of the scene, by its path; modal.damping.0 is that of mode 1"},
        ),
        "number_value": Field(("curve", "number"), values, {"long_name": "value of the number"}),
        "sensitivity": Field(by, height, {"long_name": "derivative of the greatest amplitude by the number"}),
        "frequency_sensitivity": Field(
            by, frequency, {"long_name": "derivative of its frequency by the number"}
        ),
        "peak_kind": Field(
            ("curve", "dof"),
            kind,
            {"long_name": "what the greatest amplitude is: smooth, corner, end of range, or unknown"},
        ),
    }


def _level_folds(curves: Sequence[Curve]) -> dict[str, Field]:
    """The folds of curves over the force level; empty if there are no such curves."""
    if all(curve.level is None for curve in curves):
        return {}
    text = "levels of the forces at the folds in order along the curve"
    levels = by_fold(curves, lambda curve: np.array(curve.level_folds))
    return {"fold_level": Field(("curve", "level_fold"), levels, {"long_name": text, "units": "1"})}
