"""What the variables of a response file are: dimensions, values, meanings and units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.results.gist import gist_of
from fcm.results.padded import Padded, by_fold, by_point
from fcm.results.result import Curve, Response
from fcm.results.scatter import PERCENTS, SWEEPS, Scatter, scatter
from fcm.units import in_unit, is_rotation

ORBIT_KINDS = ("cycle_least", "cycle_greatest", "family_least", "family_greatest")
LOOP: tuple[tuple[str, str, dict[str, str]], ...] = (  # of Curve.loop: name, meaning, units
    ("n0_bar", "mu (n_0 + k_v mean v) / (k_u a) of the loop", {"units": "1"}),
    ("b_bar", "mu k_v b / (k_u a) of the loop", {"units": "1"}),
    ("phi", "phase of the normal motion before the tangential, of the loop", {"units": "radian"}),
    ("tangential_amplitude", "amplitude a of the tangential motion across the contact", {}),
    ("spring_force", "k_u a, by which the loop's forces are divided", {}),
)

CYCLE = (  # of Curve.cycle
    ("greatest_normal_force", "greatest normal force of the cycle"),
    ("greatest_friction_force", "greatest friction force of the cycle"),
    ("slip_path", "way of the slider in slip, in a cycle"),
    ("dissipated_energy", "energy that friction takes in a cycle"),
)

EXACT = {  # meanings that differ where the curves are of exact periodic solutions
    "regime": "states of the contact over the exact cycle: E stick, P, N positive and negative slip, "
    "S separation",
    "table_error": "0: no table was used",
    "truncation_error": "0: no harmonic was left out",
    "stable": "1 where small disturbances die out: no Floquet multiplier of a period beyond the unit circle",
}
ORBITS: dict[str, tuple[tuple[str, ...], dict[str, str]]] = {  # variables that only these have
    "closure_error": (
        (),
        {"long_name": "by which a period fails to close, relative to the motion", "units": "1"},
    ),
    "repeats": (
        (),
        {
            "long_name": "periods of the force after which the motion repeats, 0 if it is quasi-periodic or "
            "irregular",
            "units": "1",
        },
    ),
    "cycle_least": (("dof",), {"long_name": "least half the peak-to-peak of a cycle"}),
    "cycle_greatest": (("dof",), {"long_name": "greatest half the peak-to-peak of a cycle"}),
    "family_least": (
        ("dof",),
        {"long_name": "least amplitude over the residual friction of contacts that never slip"},
    ),
    "family_greatest": (
        ("dof",),
        {"long_name": "greatest amplitude over the residual friction of contacts that never slip"},
    ),
    "sweep": ((), {"long_name": "direction of the sweep that visited the point, if one did: up or down"}),
}


def _of_mode(name: str) -> Callable[[Curve], Any]:
    """What picks an array of a nonlinear mode; none of a curve that was lost."""
    return lambda c: c.frequency if c.mode is None else getattr(c.mode, name)


MODE: dict[str, tuple[Callable[[Curve], Any], tuple[str, ...], dict[str, str]]] = {  # of nonlinear modes
    "modal_amplitude": (_of_mode("amplitude"), (), {"long_name": "modal amplitude, of modes of mass 1"}),
    "damping_ratio": (_of_mode("damping"), (), {"long_name": "damping ratio of the mode", "units": "1"}),
    "modal_force": (_of_mode("force"), (), {"long_name": "what the scene's forces do on the mode"}),
    "resonant_level": (
        _of_mode("resonant_level"),
        (),
        {
            "long_name": "level of the scene's forces with which the resonance has the amplitude",
            "units": "1",
        },
    ),
}

LENGTHS = (
    "amplitude", "mean", "fundamental", "peak_amplitude", "tangential_amplitude", "displacement",
    "cycle_amplitude", "cycle_mean", "cycle_greatest", "cycle_least", "family_greatest", "family_least",
    "harmonic_amplitude", "slip_path", "peak_percentile", "tracked_amplitude", "optimum_peak",
)  # fmt: skip
CF_UNIT = {"rad/s": "rad s-1", "Hz": "Hz"}
FORCES = ("spring_force", "greatest_normal_force", "greatest_friction_force")


class Field(NamedTuple):
    """One variable of the file."""

    dims: tuple[str, ...]
    values: npt.NDArray[Any] | Padded
    attrs: dict[str, str]


def fields_of(response: Response) -> dict[str, Field]:
    """Every variable of the file, coordinates first."""
    swept = response.parameters
    out = {
        "dof": Field(("dof",), np.array(response.dofs), {"long_name": "degree of freedom"}),
        "contact": Field(("contact",), np.array(response.contacts, dtype=str), {"long_name": "contact"}),
    }
    for key in swept[0] if swept else ():
        values = np.array([parameters[key] for parameters in swept])
        drawn = {"drawn": "true"} if key in response.drawn else {}
        out[key] = Field(("curve",), values, {"long_name": f"swept value of {key}"} | drawn)
    if response.curves or (response.histories is None and response.tracking is None):
        out |= _gist_fields(response) if response.peaks_only else _point_fields(response)
        out |= _curve_fields(response)
        if any(c.sensitivity is not None for c in response.curves):
            out |= _sensitivity_fields(response)
        if found := scatter(response):
            out |= _scatter_fields(found, response.frequency_unit)
    if response.tracking is not None:
        from fcm.results.tracked_fields import tracked_fields

        out |= {name: Field(*parts) for name, parts in tracked_fields(response, response.tracking).items()}
    if response.histories is not None:
        from fcm.motion import output

        out |= {name: Field(*parts) for name, parts in output.variables(response.histories).items()}
    return _with_units(out, response.units, [dof for dof in response.dofs if is_rotation(dof)])


def _with_units(fields: dict[str, Field], units: tuple[str, str], turning: list[str]) -> dict[str, Field]:
    """The variables with the units of length and force that the scene names, where it does."""
    for names, unit in zip((LENGTHS, FORCES), units, strict=True):
        for name in set(names) & set(fields) if unit else ():
            fields[name].attrs["units"] = unit
            if turning and "dof" in fields[name].dims:
                fields[name].attrs["comment"] = f"rotations such as {turning[0]} are in radians"
    return fields


def _point_fields(response: Response) -> dict[str, Field]:
    """Every variable of the curves."""
    curves, unit = response.curves, response.frequency_unit
    out: dict[str, Field] = {}

    def points(name: str, pick: Callable[[Curve], Any], dims: tuple[str, ...], **attrs: str) -> None:
        out[name] = Field(("curve", "point", *dims), by_point(curves, pick), attrs)

    excitation = "excitation frequency"
    points("frequency", lambda c: in_unit(c.frequency, unit), (), long_name=excitation, units=CF_UNIT[unit])
    if any(c.level is not None for c in curves):
        level = "level of the forces: all amplitudes times this"
        points("level", lambda c: c.frequency if c.level is None else c.level, (), long_name=level, units="1")
    if any(c.mode is not None for c in curves):
        out["frequency"].attrs["long_name"] = "frequency of the nonlinear mode"
        levels = next(c.mode.levels for c in curves if c.mode is not None)
        for name, (picked, tail, about) in MODE.items():
            points(name, picked, tail, **about)
        beside = (
            "frequency of the scene's forces with which they give the amplitude, below and above resonance"
        )
        points(
            "flank_frequency",
            lambda c: np.empty((0, len(levels), 2)) if c.mode is None else in_unit(c.mode.flanks, unit),
            ("force_level", "flank"),
            long_name=beside,
            units=CF_UNIT[unit],
        )
        about_levels = {"long_name": "level of the scene's forces: all amplitudes times this", "units": "1"}
        out["force_level"] = Field(("force_level",), np.array(levels), about_levels)
    points("amplitude", lambda c: c.amplitude, ("dof",), long_name="half the peak-to-peak displacement")
    points("fundamental", lambda c: c.fundamental, ("dof",), long_name="amplitude of the fundamental")
    phase = "phase of the fundamental, as fundamental * sin(omega t + phase)"
    points("phase", lambda c: c.phase, ("dof",), long_name=phase, units="radian")
    points("mean", lambda c: c.mean, ("dof",), long_name="mean displacement")
    states = "states of the contact over a cycle: E stick, P, N positive and negative slip, S separation"
    points("regime", lambda c: c.regime, ("contact",), long_name=states)
    for i, (name, meaning, units) in enumerate(LOOP):
        points(name, partial(_of_loop, column=i), ("contact",), long_name=meaning, **units)
    for i, (name, meaning) in enumerate(CYCLE):
        points(name, partial(_of_cycle, column=i), ("contact",), long_name=meaning)
    shift = (
        "shift of the response when the table is replaced by the closed form, relative (values are corrected)"
    )
    points("table_error", lambda c: c.table_error, (), long_name=shift, units="1")
    points(
        "error", lambda c: c.error, ("dof",), long_name="estimated error of amplitude, relative", units="1"
    )
    left = "estimated shift of the response by the harmonics that were left out, relative"
    points("truncation_error", lambda c: c.truncation_error, (), long_name=left, units="1")
    dies = "1 where small disturbances of the motion die out, 0 where not, missing where that is not known"
    points("stable", lambda c: c.stable, (), long_name=dies, units="1")
    if any(c.harmonic is not None for c in curves):
        out |= _harmonic_fields(curves)
    if response.method == "exact":
        for name, meaning in EXACT.items():
            out[name].attrs["long_name"] = meaning
        for name, (dims, attrs) in ORBITS.items():
            points(name, partial(_of_orbits, name=name), dims, **attrs)
    return out


def _harmonic_fields(curves: Sequence[Curve]) -> dict[str, Field]:
    """Amplitude and phase of each harmonic, by its number; NaN for those that a curve has not."""
    numbers = sorted({h for curve in curves for h in curve.harmonics})
    dims = ("curve", "point", "harmonic", "dof")

    def picked(part: Callable[[Any], FloatArray]) -> Padded:
        return by_point(curves, lambda curve: part(_by_number(curve, numbers)))

    sine = "as harmonic_amplitude * sin(harmonic omega t + harmonic_phase)"
    return {
        "harmonic": Field(("harmonic",), np.array(numbers), {"long_name": "number of the harmonic"}),
        "harmonic_amplitude": Field(dims, picked(np.abs), {"long_name": "amplitude of the harmonic"}),
        "harmonic_phase": Field(dims, picked(np.angle), {"long_name": f"phase, {sine}", "units": "radian"}),
    }


def _by_number(curve: Curve, numbers: Sequence[int]) -> npt.NDArray[np.complex128]:
    """(point, harmonic, dof) of one curve."""
    points, dofs = curve.fundamental.shape
    out = np.full((points, len(numbers), dofs), np.nan, dtype=np.complex128)
    if curve.harmonic is None:
        out[:, numbers.index(1)] = curve.fundamental * np.exp(1j * curve.phase)
    else:
        out[:, [numbers.index(h) for h in curve.harmonics]] = curve.harmonic
    return out


def _of_orbits(curve: Curve, name: str) -> npt.NDArray[Any]:
    if curve.orbits is None:  # lost
        lost: dict[str, npt.NDArray[Any]] = dict.fromkeys(ORBIT_KINDS, curve.amplitude)
        return (lost | {"sweep": np.array([], dtype=str)}).get(name, curve.frequency)
    values: npt.NDArray[Any] = getattr(curve.orbits, name)
    return values


def _of_loop(curve: Curve, column: int) -> FloatArray:
    return curve.loop[..., column]


def _of_cycle(curve: Curve, column: int) -> FloatArray:
    return curve.cycle[..., column]


def _gist_fields(response: Response) -> dict[str, Field]:
    """What is known of all points of each curve, where they are not written."""
    gists = [curve.gist or gist_of(curve) for curve in response.curves]
    of_all = {
        "greatest_table_error": ("largest table_error of the curve", [one.table_error for one in gists]),
        "greatest_truncation_error": (
            "largest truncation_error of the curve",
            [one.truncation_error for one in gists],
        ),
        "points": ("points that were computed", [one.points for one in gists]),
    }
    out = {
        name: Field(("curve",), np.array(values, dtype=np.float64), {"long_name": meaning, "units": "1"})
        for name, (meaning, values) in of_all.items()
    }
    if not response.complete:
        reasons = np.array([curve.reason for curve in response.curves])
        out["reason"] = Field(("curve",), reasons, {"long_name": "why the curve is not complete"})
    return out


def _curve_fields(response: Response) -> dict[str, Field]:
    """One value or row for each curve: peaks, folds, whether it is complete."""
    curves, unit = response.curves, response.frequency_unit
    cf_unit = CF_UNIT[unit]
    peaks = np.array([[c.peaks[d] for d in response.dofs] for c in curves]).reshape(-1, len(response.dofs), 3)
    folds = by_fold(curves, lambda c: in_unit(c.folds, unit))
    complete = np.array([c.complete for c in curves], dtype=np.int8)
    by_dof = ("curve", "dof")
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
        "fold_frequency": Field(
            ("curve", "fold"),
            folds,
            {"long_name": "frequencies of the folds in order along the curve", "units": cf_unit},
        ),
        **_level_folds(curves),
        "complete": Field(
            ("curve",),
            complete,
            {"long_name": "1 where the curve reached the end of its range", "units": "1"},
        ),
    }


def _scatter_fields(found: Sequence[Scatter], unit: str) -> dict[str, Field]:
    """Percentiles over the curves that differ in drawn numbers alone."""
    of_dof, of_sweep = ("scatter", "percent", "dof"), ("scatter", "percent", "sweep_direction")
    peak, frequency, jump = (
        np.stack([getattr(one, x) for one in found]) for x in ("peak", "frequency", "jump")
    )
    at = {"units": CF_UNIT[unit]}
    return {
        "percent": Field(("percent",), np.array(PERCENTS), {"long_name": "percentage of curves below"}),
        "sweep_direction": Field(("sweep_direction",), np.array(SWEEPS), {"long_name": "of a slow sweep"}),
        "peak_percentile": Field(of_dof, peak, {"long_name": "percentile of the greatest amplitude"}),
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
    }


def _sensitivity_fields(response: Response) -> dict[str, Field]:
    """Derivatives of the peaks by the numbers of the scene; NaN where a curve has none."""
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
            ("number",), np.array(numbers), {"long_name": "number of the scene, by its key path"}
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
    """The folds of curves against the level of the forces; nothing for others."""
    if all(curve.level is None for curve in curves):
        return {}
    text = "levels of the forces at the folds in order along the curve"
    levels = by_fold(curves, lambda curve: np.array(curve.level_folds))
    return {"fold_level": Field(("curve", "level_fold"), levels, {"long_name": text, "units": "1"})}
