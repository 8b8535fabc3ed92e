"""The variables of a response file: those of points here, those of curves in `curve_fields`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.model.scene import Measured
from fcm.results.blades import blade_fields
from fcm.results.contact_motions import motions_across
from fcm.results.curve_fields import condensed_fields, curve_fields, scatter_fields, sensitivity_fields
from fcm.results.fitted import Fitted, frequencies
from fcm.results.padded_arrays import Field, Padded, by_point
from fcm.results.result import Curve, Response
from fcm.results.scatter import scatter
from fcm.results.tracked_fields import padded
from fcm.results.variable_meanings import (
    CYCLE,
    CYCLE_ERROR,
    ENERGIES,
    EXACT,
    FORCES,
    LENGTHS,
    LOOP,
    ORBIT_KINDS,
    ORBITS,
    variable_names,
)
from fcm.rotational_dofs import is_rotation
from fcm.units import CF_UNIT, QUANTITIES, in_unit, unit_of_number


def _of_mode(name: str) -> Callable[[Curve], Any]:
    """Function that picks an array of a nonlinear mode; the frequency for a curve without one."""
    return lambda c: c.frequency if c.mode is None else getattr(c.mode, name)


MODE: dict[str, tuple[Callable[[Curve], Any], tuple[str, ...], dict[str, str]]] = {  # of nonlinear modes
    "modal_amplitude": (_of_mode("amplitude"), (), {"long_name": "modal amplitude, of modes of mass 1"}),
    "damping_ratio": (_of_mode("damping"), (), {"long_name": "damping ratio of the mode", "units": "1"}),
    "modal_force": (_of_mode("force"), (), {"long_name": "what the scene's forces do on the mode"}),
    "resonant_level": (
        _of_mode("resonant_level"),
        (),
        {"long_name": "level of the scene's forces with which the resonance has the amplitude", "units": "1"},
    ),
    "steady_state": (
        lambda c: c.frequency if c.mode is None else c.mode.steady.astype(float),
        (),
        {"long_name": "0 where nothing holds a rigid-body mode, so that there is no steady state"},
    ),
}


def fields_of(response: Response) -> dict[str, Field]:
    """Every variable of the file, coordinates first."""
    swept = response.parameters
    out = {
        "dof": Field(("dof",), np.array(response.dofs), {"long_name": "degree of freedom"}),
        "contact": Field(("contact",), np.array(response.contacts, dtype=str), {"long_name": "contact"}),
    }
    if set(response.contacts) & set(response.positions):
        unknown = np.full(3, np.nan)
        where = np.array([response.positions.get(name, unknown) for name in response.contacts])
        about = "where the contact is, midway between its nodes; missing where that is not known"
        out["axis"] = Field(("axis",), np.array(["x", "y", "z"]), {"long_name": "axis of the mesh"})
        out["contact_position"] = Field(("contact", "axis"), where, {"long_name": about})
    for key, name in swept_names(response).items():
        values = np.array([parameters[key] for parameters in swept])
        drawn = {"drawn": "true"} if key in response.drawn else {}
        unit = unit_of_number(key, *response.units, CF_UNIT[response.frequency_unit])
        attrs = {"long_name": f"swept value of {key}", "key": key} | drawn | ({"units": unit} if unit else {})
        out[name] = Field(("curve",), values, attrs)
    if response.curves or (
        response.histories is None and response.tracking is None and response.fitted is None
    ):
        out |= condensed_fields(response) if response.peaks_only else _point_fields(response)
        out |= curve_fields(response)
        if any(c.sensitivity is not None for c in response.curves):
            out |= sensitivity_fields(response)
        if found := scatter(response):
            out |= scatter_fields(found, response.frequency_unit)
        if response.blades is not None:
            out |= blade_fields(response)
    if response.tracking is not None:
        from fcm.results.tracked_fields import tracked_fields

        out |= tracked_fields(response, response.tracking)
    if response.fitted is not None:
        out |= fitted_fields(response, response.fitted)
    if response.motions is not None:
        from fcm.results.motions import motion_fields

        out |= motion_fields(response.motions, response.frequency_unit)
    if response.histories is not None:
        from fcm.time_domain import history_output

        out |= {name: Field(*parts) for name, parts in history_output.variables(response.histories).items()}
    return _with_units(out, response.units, [dof for dof in response.dofs if is_rotation(dof)])


def swept_names(response: Response) -> dict[str, str]:
    """The variable name of each swept value, by its key in the scene."""
    return variable_names(response.parameters[0] if response.parameters else ())


def _with_units(fields: dict[str, Field], units: tuple[str, str], turning: list[str]) -> dict[str, Field]:
    """Add the scene's units of length, force and energy to the variables, if it names them."""
    work = " ".join(reversed(units)) if all(units) else ""
    for names, unit in zip((LENGTHS, FORCES, ENERGIES), (*units, work), strict=True):
        for name in set(names) & set(fields) if unit else ():
            fields[name].attrs["units"] = unit
            if turning and "dof" in fields[name].dims:
                fields[name].attrs["comment"] = f"rotations such as {turning[0]} are in radians"
    return fields


class _Points:
    """Variables of the points of curves, collected by `add`."""

    def __init__(self, curves: Sequence[Curve], unit: str) -> None:
        self.curves, self.unit = curves, unit
        self.out: dict[str, Field] = {}

    def add(self, name: str, pick: Callable[[Curve], Any], dims: tuple[str, ...] = (), **attrs: str) -> None:
        self.out[name] = Field(("curve", "point", *dims), by_point(self.curves, pick), attrs)


def _point_fields(response: Response) -> dict[str, Field]:
    """Every variable of the curves."""
    found = _Points(response.curves, response.frequency_unit)
    _add_followed(found)
    if any(c.mode is not None for c in found.curves):
        _add_mode(found)
    _add_motion(found)
    _add_contacts(found)
    if any(c.across is not None for c in found.curves):
        found.out |= motions_across(found.curves)
    _add_trust(found)
    if any(c.harmonics for c in found.curves):
        found.out |= _harmonic_fields(found.curves)
    if response.method == "exact":
        _add_exact(found)
    return found.out


def _add_followed(found: _Points) -> None:
    """Add the variables along which the curves are followed: frequency and force level."""
    unit, excitation = found.unit, "excitation frequency"
    found.add("frequency", lambda c: in_unit(c.frequency, unit), long_name=excitation, units=CF_UNIT[unit])
    if any(c.level is not None for c in found.curves):
        level = "level of the forces: all amplitudes times this"
        found.add("level", lambda c: c.frequency if c.level is None else c.level, long_name=level, units="1")


def _add_mode(found: _Points) -> None:
    """Add the variables of nonlinear modes, and of the scene's forces that give their amplitudes."""
    found.out["frequency"].attrs["long_name"] = "frequency of the nonlinear mode"
    levels = next(c.mode.levels for c in found.curves if c.mode is not None)
    for name, (picked, dims, about) in MODE.items():
        found.add(name, picked, dims, **about)
    found.add(
        "flank_frequency",
        lambda c: np.empty((0, len(levels), 2)) if c.mode is None else in_unit(c.mode.flanks, found.unit),
        ("force_level", "flank"),
        long_name="frequency of the scene's forces with which they give the amplitude, below and above "
        "resonance",
        units=CF_UNIT[found.unit],
    )
    about_levels = {"long_name": "level of the scene's forces: all amplitudes times this", "units": "1"}
    found.out["force_level"] = Field(("force_level",), np.array(levels), about_levels)


def _add_motion(found: _Points) -> None:
    """Add the variables of the displacements."""
    found.add("amplitude", lambda c: c.amplitude, ("dof",), long_name="half the peak-to-peak displacement")
    found.add("fundamental", lambda c: c.fundamental, ("dof",), long_name="amplitude of the fundamental")
    phase = "phase of the fundamental, as fundamental * sin(omega t + phase)"
    found.add("phase", lambda c: c.phase, ("dof",), long_name=phase, units="radian")
    found.add("mean", lambda c: c.mean, ("dof",), long_name="mean displacement")


def _add_contacts(found: _Points) -> None:
    """Add the variables of the contacts: states, loops and loads."""
    states = (
        "states over a cycle: E stick, P and N positive and negative slip (P any slip in planar scenes), "
        "S separation"
    )
    found.add("regime", lambda c: c.regime, ("contact",), long_name=states)
    for i, (name, meaning, units) in enumerate(LOOP):
        found.add(name, _column("loop", i), ("contact",), long_name=meaning, **units)
    for i, (name, meaning) in enumerate(CYCLE):
        found.add(name, _column("cycle", i), ("contact",), long_name=meaning)
        error = CYCLE_ERROR.format(name)
        found.add(f"{name}_error", _column("cycle_error", i), ("contact",), long_name=error, units="1")


def _add_trust(found: _Points) -> None:
    """Add the variables of errors and stability."""
    shift = (
        "shift of the response when the table is replaced by the closed form, relative (values are corrected)"
    )
    found.add("table_error", lambda c: c.table_error, long_name=shift, units="1")
    error = "estimated error of amplitude, relative"
    either = f"{error}: at a peak of its height, elsewhere as error_at_frequency"
    found.add("error", lambda c: c.error, ("dof",), long_name=either, units="1")
    here = f"{error}, at the same frequency: large on steep flanks and where peaks are shifted"
    found.add("error_at_frequency", lambda c: c.same_frequency_error, ("dof",), long_name=here, units="1")
    left = "estimated shift by the harmonics left out, relative to the greatest amplitude there; see error"
    found.add("truncation_error", lambda c: c.truncation_error, long_name=left, units="1")
    dies = "1 where small disturbances of the motion die out, 0 where not, missing where that is not known"
    found.add("stable", lambda c: c.stable, long_name=dies, units="1")


def _add_exact(found: _Points) -> None:
    """Add the variables of exact motions, and adapt the meanings of others."""
    for name, meaning in EXACT.items():
        found.out[name].attrs["long_name"] = meaning
    for name, (dims, attrs) in ORBITS.items():
        found.add(name, partial(_of_orbits, name=name), dims, **attrs)


def _harmonic_fields(curves: Sequence[Curve]) -> dict[str, Field]:
    """Amplitude and phase of each harmonic, by its number; NaN for harmonics that a curve does not have."""
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
    """Harmonics (point, harmonic, dof) of one curve, with a place for every number."""
    points, dofs = curve.fundamental.shape
    out = np.full((points, len(numbers), dofs), np.nan, dtype=np.complex128)
    if curve.harmonic is None:
        out[:, numbers.index(1)] = curve.fundamental * np.exp(1j * curve.phase)
    else:
        out[:, [numbers.index(h) for h in curve.harmonics]] = curve.harmonic
    return out


def _of_orbits(curve: Curve, name: str) -> npt.NDArray[Any]:
    if curve.orbits is None:  # a lost curve
        lost: dict[str, npt.NDArray[Any]] = dict.fromkeys(ORBIT_KINDS, curve.amplitude)
        return (lost | {"sweep": np.array([], dtype=str)}).get(name, curve.frequency)
    values: npt.NDArray[Any] = getattr(curve.orbits, name)
    return values


def _column(name: str, column: int) -> Callable[[Curve], FloatArray]:
    return lambda curve: getattr(curve, name)[..., column]


def fitted_fields(response: Response, fitted: Fitted) -> dict[str, Field]:
    """Variables of a fit: numbers on the dimension fitted; measured points on data, measured (padded)."""
    out: dict[str, Field] = {}

    def add(name: str, dims: tuple[str, ...], values: Any, meaning: str, **attrs: str) -> None:
        out[name] = Field(dims, np.asarray(values), {"long_name": meaning, **attrs})

    of = ("fitted",)
    add("fitted", of, np.array(fitted.keys, dtype=str), "number that was fitted")
    add("fitted_value", of, fitted.values, "its value")
    add("fitted_error", of, fitted.error, "standard error of the value")
    percent = f"{100.0 * fitted.confidence:g} %"
    add(
        "fitted_interval",
        (*of, "end"),
        fitted.interval,
        f"ends of the interval of {percent} confidence; none beyond bounds",
    )
    add("fitted_start", of, fitted.begin, "its value in the scene")
    add(
        "fitted_correlation",
        (*of, "fitted_other"),
        fitted.correlation,
        "correlation of the errors",
        units="1",
    )
    data = [one.measured for one in fitted.data]
    unit = response.frequency_unit
    add(
        "data_file", ("data",), np.array([one.file for one in data], dtype=str), "file of the measured points"
    )
    add(
        "data_dof",
        ("data",),
        np.array([one.dof for one in data], dtype=str),
        "degree of freedom; empty: modal",
    )
    kinds = ["backbone" if one.damping is not None else one.quantity for one in data]
    add("data_quantity", ("data",), np.array(kinds, dtype=str), "what was measured")
    points = ("data", "measured")
    add("data_frequency", points, padded([frequencies(one, unit) for one in data]),
        "measured frequency", units=CF_UNIT[unit])  # fmt: skip
    add(
        "data_amplitude",
        points,
        padded([one.amplitude for one in data]),
        "measured amplitude of the quantity",
    )
    add(
        "data_displacement",
        points,
        padded([_displacements(one) for one in data]),
        "displacement that this is",
    )
    add("data_level", points, padded([one.level for one in data]), "level of the forces there", units="1")
    nothing = [np.full(one.points, np.nan) for one in data]
    phase = [n if one.phase is None else one.phase for n, one in zip(nothing, data, strict=True)]
    add("data_phase", points, padded(phase), "measured phase", units="rad")
    damping = [n if one.damping is None else one.damping for n, one in zip(nothing, data, strict=True)]
    add("data_damping", points, padded(damping), "measured damping ratio", units="1")
    modal = [
        n if one.modal_amplitude is None else one.modal_amplitude
        for n, one in zip(nothing, fitted.data, strict=True)
    ]
    add("data_modal_amplitude", points, padded(modal), "modal amplitude on the mode of the model")
    off = [np.sqrt((one.residual**2).sum(axis=1)) for one in fitted.data]
    add("data_residual", points, padded(off), "distance to the model, in units of the errors", units="1")
    return out


def _displacements(one: Measured) -> FloatArray:
    """Amplitudes (point,) of the displacements of a response; NaN for a backbone."""
    if one.damping is not None:
        return np.full(one.points, np.nan)
    found: FloatArray = one.amplitude / one.frequency ** QUANTITIES[one.quantity]
    return found
