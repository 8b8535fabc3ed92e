"""What the variables of a fit are: dimensions, values, meanings and units."""

from __future__ import annotations

from typing import Any

import numpy as np

from fcm.model.scene import FloatArray, Measured
from fcm.results.fitted import Fitted, frequencies
from fcm.results.padded_arrays import Field
from fcm.results.result import Response
from fcm.results.tracked_fields import padded
from fcm.units import CF_UNIT, QUANTITIES


def fitted_fields(response: Response, fitted: Fitted) -> dict[str, Field]:
    """Numbers on the dimension fitted; measured points on data, measured (padded)."""
    out: dict[str, Field] = {}

    def add(name: str, dims: tuple[str, ...], values: Any, meaning: str, **attrs: str) -> None:
        out[name] = Field(dims, np.asarray(values), {"long_name": meaning, **attrs})

    of = ("fitted",)
    add("fitted", of, np.array(fitted.keys, dtype=str), "number that was fitted")
    add("fitted_value", of, fitted.values, "its value")
    add("fitted_error", of, fitted.error, "standard error of the value")
    percent = f"{100.0 * fitted.confidence:g} %"
    add("fitted_interval", (*of, "end"), fitted.interval, f"ends of the interval of {percent} confidence")
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
    off = [np.sqrt((one.residual**2).sum(axis=1)) for one in fitted.data]
    add("data_residual", points, padded(off), "distance to the model, in units of the errors", units="1")
    return out


def _displacements(one: Measured) -> FloatArray:
    """Amplitudes (point,) of the displacements of a response; NaN of a backbone."""
    if one.damping is not None:
        return np.full(one.points, np.nan)
    found: FloatArray = one.amplitude / one.frequency ** QUANTITIES[one.quantity]
    return found
