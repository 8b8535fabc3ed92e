"""The variables of tracked curves and optima: dimensions, values, meanings and units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.results.padded_arrays import Field
from fcm.results.result import Response
from fcm.results.tracked import Tracking
from fcm.results.variable_meanings import variable_names
from fcm.units import CF_UNIT, in_unit, unit_of_number

KINDS = "smooth, kink of equal peaks, corner of the response, end of a higher peak"
WHAT = "what of the response is tracked"
MEANINGS = {  # of the variables of points of a tracked curve
    "number": "tracked value of {key}",
    "frequency": "excitation frequency of the tracked point",
    "amplitude": "half the peak-to-peak displacement at the tracked point",
    "turn": "1 where the number turns back: a window of several solutions opens or closes",
    "trough": "1 where a tracked peak is a least amplitude, between two peaks",
    "stable": "1 where small disturbances of the motion there die out, 0 where not",
    "corner": "onset at which the response has a corner there, if it has",
}


def tracked_fields(response: Response, tracking: Tracking) -> dict[str, Field]:
    """Variables of the curves on dimensions track, tracked (padded); of the optima on optimum, varied."""
    out: dict[str, Field] = {}
    if tracking.curves:
        out |= _curves(response, tracking)
    if tracking.optima:
        out |= _optima(response, tracking)
    return out


def _curves(response: Response, tracking: Tracking) -> dict[str, Field]:
    unit, curves, dims = response.frequency_unit, tracking.curves, ("track", "tracked")
    values = {name: padded([getattr(curve, name) for curve in curves]) for name in MEANINGS}
    values["frequency"] = in_unit(values["frequency"], unit)
    more = {
        "number": {"key": tracking.key} | _unit_of(tracking.key, response),
        "frequency": {"units": CF_UNIT[unit]},
    }
    what = np.array([curve.what for curve in curves], dtype=str)
    whole = np.array([int(curve.complete) for curve in curves], dtype=np.int8)
    about_whole = {"long_name": "1 where the curve is whole", "units": "1"}
    out = {
        "track_what": Field(("track",), what, {"long_name": WHAT}),
        "track_complete": Field(("track",), whole, about_whole),
    }
    for name, meaning in MEANINGS.items():
        of = (*dims, "dof") if name == "amplitude" else dims
        meaning = meaning.format(key=tracking.key)
        out[f"tracked_{name}"] = Field(of, values[name], {"long_name": meaning, **more.get(name, {})})
    if tracking.what != "optimum":
        out |= _errors(tracking, _unit_of(tracking.key, response))
    for key, name in tracked_names(tracking).items():
        swept = np.array([curve.parameters[key] for curve in curves])
        about = {"long_name": f"{key} of the curve", "key": key} | _unit_of(key, response)
        out[name] = Field(("track",), swept, about)
    return out


def tracked_names(tracking: Tracking | None) -> dict[str, str]:
    """The variable name of each swept value of the tracked curves, by its key in the scene."""
    curves = [] if tracking is None else tracking.curves
    names = variable_names(curves[0].parameters) if curves else {}
    return {key: f"track_{name}" for key, name in names.items()}


def _unit_of(key: str, response: Response) -> dict[str, str]:
    """The attribute of a number's unit, if it is known."""
    unit = unit_of_number(key, *response.units, CF_UNIT[response.frequency_unit])
    return {"units": unit} if unit else {}


def _errors(tracking: Tracking, unit: dict[str, str]) -> dict[str, Field]:
    """Variables of the effect of the harmonics left out, where it was estimated."""
    told = [np.full((3, curve.number.size), np.nan) for curve in tracking.curves]
    for out, curve in zip(told, tracking.curves, strict=True):
        for one in curve.errors:
            out[:, one.point] = one.relative, one.number, float(np.isfinite(one.relative))
    relative, number, known = (padded([one[i] for one in told]) for i in range(3))
    of = "amplitude" if tracking.what == "peaks" else "frequency"
    dims, by = ("track", "tracked"), "by the harmonics left out"
    about_relative = f"estimated relative error of the {of} {by}, at ends, turns, extremes"
    about_number = f"estimated error of {tracking.key} {by}, at turns"
    about_known = "1 where the error was estimated, 0 where that was tried without success"
    return {
        "tracked_error": Field(dims, relative, {"long_name": about_relative, "units": "1"}),
        "tracked_number_error": Field(dims, number, {"long_name": about_number} | unit),
        "tracked_error_told": Field(dims, known, {"long_name": about_known}),
    }


def _optima(response: Response, tracking: Tracking) -> dict[str, Field]:
    optima, unit = tracking.optima, response.frequency_unit
    minimised = " and ".join(optima[0].minimised)
    varied = np.array(list(optima[0].values), dtype=str)
    out = {"varied": Field(("varied",), varied, {"long_name": "number that was chosen"})}

    def add(name: str, dims: tuple[str, ...], values: Any, meaning: str, **attrs: str) -> None:
        out[f"optimum_{name}"] = Field(("optimum", *dims), values, {"long_name": meaning, **attrs})

    numbers = np.array([list(one.values.values()) for one in optima])
    add("number", ("varied",), numbers, "number with which the greatest peak is least")
    if any(one.flat for one in optima):
        none = (np.nan, np.nan)
        flat = np.array([[one.flat.get(key, none) for key in one.values] for one in optima])
        add(
            "flat",
            ("varied", "end"),
            flat,
            "values of the number between which that peak does not depend on it",
        )
    add("peak", (), np.array([one.value for one in optima]), f"the greatest of {minimised} with it")
    if any(one.higher for one in optima):
        higher = np.array([np.nan if one.higher is None else one.higher[1] for one in optima])
        add(
            "higher_peak",
            (),
            higher,
            "of the response there, where it has a higher one that was not followed",
        )
    errors = np.array([one.error for one in optima])
    add("error", (), errors, "estimated relative error of that peak", units="1")
    places = in_unit(padded([np.array([omega for _, omega in one.active]) for one in optima]), unit)
    add("frequency", ("equal",), places, "excitation frequency of that peak, or of those that are equal")
    stable = padded([np.array(one.stable) for one in optima])
    dies = "1 where the motion at that peak, or those, is stable, 0 where not"
    add("stable", ("equal",), stable, dies, units="1")
    residual = padded([np.array(one.residual) for one in optima])
    ranges = "greatest change of that peak by the residual friction of contacts that never slip, relative"
    add("residual_change", ("equal",), residual, ranges, units="1")
    add(
        "kind",
        (),
        np.array([one.kind for one in optima], dtype=str),
        f"{KINDS}, bound, flat, trials, unfinished",
    )
    return out


def padded(values: Sequence[npt.NDArray[Any]]) -> npt.NDArray[Any]:
    """Arrays of different lengths as rows of one, padded with NaN, or with empty text."""
    longest = max(len(one) for one in values)
    text = values[0].dtype.kind == "U"
    kind: Any = np.result_type(*values) if text else np.float64
    out = np.full((len(values), longest, *values[0].shape[1:]), "" if text else np.nan, dtype=kind)
    for row, one in zip(out, values, strict=True):
        row[: len(one)] = one
    return out
