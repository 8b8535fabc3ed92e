"""Responses and tracked curves as CSV, one row for each point."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.files import replacing
from fcm.results.contact_motions import csv_columns, csv_values
from fcm.results.orbits import Orbits
from fcm.results.result import Curve, Response
from fcm.results.variable_meanings import CYCLE, ORBIT_KINDS
from fcm.rotational_dofs import dof_unit
from fcm.units import headed, in_unit

LAST_COLUMNS = ("stable", "table_error", "truncation_error")
ERRORS = ("error", "error_at_frequency")  # at a peak of its height; everywhere at the same frequency
ORBIT_COLUMNS = ("closure_error", "sweep", "repeats")


def write_csv(response: Response, path: str | Path) -> None:
    """Write the response as CSV, one row for each point; frequencies in the scene's unit.

    The degrees of freedom are those of the scene's output, or all if it has none. Errors that are unknown at
    all points have no column.
    """
    shown = _shown(response)
    columns, unknown = _columns(response, [response.dofs[i] for i in shown]), _unknown_errors(response)
    kept = [i for i, column in enumerate(columns) if column not in unknown]
    planar = [i for i, name in enumerate(response.contacts) if name in response.directions]
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([columns[i] for i in kept])
        for number, curve in enumerate(response.curves):
            for row in _rows(curve, response.frequency_unit, planar, shown):
                whole = [number, *row]
                writer.writerow([whole[i] for i in kept])


def _shown(response: Response) -> list[int]:
    """Indices of the degrees of freedom of the scene's output, or of all if it has none."""
    asked = [i for i, dof in enumerate(response.dofs) if dof in response.output]
    return asked or list(range(len(response.dofs)))


def _unknown_errors(response: Response) -> set[str]:
    """Names of the columns of errors that are unknown at all points of all curves; none without points."""
    names = [
        *(f"{kind} {dof}" for kind in ERRORS for dof in response.dofs),
        *(f"{kind}_error {name}" for name in response.contacts for kind, _ in CYCLE),
        "table_error",
        "truncation_error",
    ]
    known = [_known_errors(curve) for curve in response.curves if np.isfinite(curve.frequency).any()]
    if not known:
        return set()
    return {name for name, told in zip(names, np.any(known, axis=0), strict=True) if not told}


def _known_errors(curve: Curve) -> npt.NDArray[np.bool_]:
    """Mask of the errors that are known at some point of a curve, in the order of `_unknown_errors`."""
    of_contacts = curve.cycle_error.reshape(curve.frequency.size, -1)
    of_point = curve.table_error, curve.truncation_error
    every = np.column_stack((curve.error, curve.same_frequency_error, of_contacts, *of_point))
    return np.logical_not(np.isnan(every).all(axis=0))


def _columns(response: Response, dofs: Sequence[str]) -> list[str]:
    """Names of the columns of `_rows`."""
    exact, unit = response.method == "exact", response.frequency_unit
    kinds = ("amplitude", "phase", "mean", "fundamental", *ERRORS, *(ORBIT_KINDS if exact else ()))
    swept = response.parameters[0] if response.parameters else ()
    heads = [headed(key, *response.units, unit) for key in swept]
    columns = ["curve", "branch", *heads, f"frequency [{unit}]"]
    columns += ["level"] if any(curve.level is not None for curve in response.curves) else []
    if any(curve.mode is not None for curve in response.curves):
        columns += ["modal_amplitude", "damping_ratio"]
    for dof in dofs:
        own = dof_unit(dof, response.units[0])
        units = {kind: f" [{own}]" if own and kind not in ERRORS else "" for kind in kinds}
        units["phase"] = " [rad]"
        columns += [f"{kind} {dof}{units[kind]}" for kind in kinds]
    columns += [f"regime {name}" for name in response.contacts]
    work = " ".join(reversed(response.units)) if all(response.units) else ""
    of_contact = (response.units[1], response.units[1], response.units[0], work)
    for name in response.contacts:
        for (kind, _), own in zip(CYCLE, of_contact, strict=True):
            columns += [f"{kind} {name}{f' [{own}]' if own else ''}", f"{kind}_error {name}"]
    columns += csv_columns(response.contacts, tuple(response.directions), response.units[1])
    return [*columns, *LAST_COLUMNS, *(ORBIT_COLUMNS if exact else ())]


def _rows(c: Curve, unit: str, planar: Sequence[int], shown: Sequence[int]) -> Iterator[list[Any]]:
    """The points of a curve, without its number."""
    orbits, frequency = c.orbits, in_unit(c.frequency, unit)
    own = () if orbits is None else tuple(getattr(orbits, kind) for kind in ORBIT_KINDS)
    parts = (c.amplitude, c.phase, c.mean, c.fundamental, c.error, c.same_frequency_error, *own)
    stacked = np.stack(parts, axis=2)[:, shown]
    values = stacked.reshape(c.frequency.size, stacked.shape[1] * stacked.shape[2])  # of no points, too
    contact_loads = np.stack((c.cycle, c.cycle_error), axis=-1).reshape(
        c.frequency.size, 8 * c.cycle.shape[1]
    )
    for k in np.flatnonzero(np.isfinite(c.frequency)):
        row = [c.branch[k], *c.parameters.values(), repr(float(frequency[k]))]
        row += [] if c.level is None else [repr(float(c.level[k]))]
        row += [] if c.mode is None else [repr(float(x[k])) for x in (c.mode.amplitude, c.mode.damping)]
        row += map(repr, values[k].tolist())
        row += [
            *c.regime[k].tolist(),
            *map(repr, contact_loads[k].tolist()),
            *csv_values(c, int(k), planar),
            f"{c.stable[k]:g}",
        ]
        row += [repr(float(c.table_error[k])), repr(float(c.truncation_error[k]))]
        yield row + ([] if orbits is None else _of_orbit(orbits, int(k)))


def write_tracked_csv(response: Response, path: str | Path) -> None:
    """Write tracked curves as CSV, a row for each point; frequencies in the scene's unit."""
    tracking = response.tracking
    assert tracking is not None
    swept = list(tracking.curves[0].parameters) if tracking.curves else []
    keys = [headed(key, *response.units, response.frequency_unit) for key in (*swept, tracking.key)]
    shown = _shown(response)
    units = {dof: dof_unit(dof, response.units[0]) for dof in (response.dofs[i] for i in shown)}
    amplitudes = [f"amplitude {dof} [{units[dof]}]" if units[dof] else f"amplitude {dof}" for dof in units]
    header = ["track", "what", *keys, f"frequency [{response.frequency_unit}]", *amplitudes]
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([*header, "corner", "turn", "trough"])
        for number, one in enumerate(tracking.curves):
            frequency = in_unit(one.frequency, response.frequency_unit)
            for k in range(one.number.size):
                values = [repr(float(x)) for x in (one.number[k], frequency[k], *one.amplitude[k, shown])]
                marks = [str(one.corner[k]), int(one.turn[k]), int(one.trough[k])]
                writer.writerow([number, one.what, *one.parameters.values(), *values, *marks])


def _of_orbit(orbits: Orbits, point: int) -> list[Any]:
    """The last columns of a row of CSV."""
    return [repr(float(orbits.closure_error[point])), orbits.sweep[point], int(orbits.repeats[point])]
