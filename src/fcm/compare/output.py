"""A comparison as a summary for programs and as a netCDF file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

import fcm
from fcm.compare.comparison import Comparison, contributions
from fcm.compare.errors import MEANINGS, MEASURES, Shown
from fcm.compare.lines import Line
from fcm.compare.methods import CLOSED_FORM, EXACT, Run
from fcm.compare.startup import Startup
from fcm.files import replacing
from fcm.results.curve_extracts import worst
from fcm.results.variable_meanings import variable_names
from fcm.units import UNIT

LAYOUT = "fcm comparison 1"  # changes when a reader of older files would misread
Json = dict[str, Any]


def summary(out: Comparison) -> Json:
    """Output of ``fcm respond --compare --json``; NaN becomes None.

    For an error below `options.margin` times the reference's own, only a limit is given, under `below`.
    """
    return {
        "title": out.scene.title,
        "frequency_unit": out.scene.frequency_unit,
        "max_step": out.scene.each_curve()[0].max_step,
        "curves": out.parameters,
        "references": {name: _reference(out, name) for name in (EXACT, CLOSED_FORM)},
        "without_exact": out.without_exact,
        "notes": out.notes,
        "left_out": out.left_out,
        "runs": [_run(out, number, one) for number, one in enumerate(out.runs)],
        "contributions": {
            what: {"against": against, **_split(_measures(out, against, number))}
            for what, (against, number) in contributions(out).items()
            if number is not None
        },
        "peaks": peaks(out),
        "complete": not out.interrupted,
        "seconds": out.seconds,
    }


def peaks(out: Comparison) -> list[Json]:
    """Exact peak, peak by harmonic balance and its estimated error, for each curve and degree of freedom."""
    unit = UNIT[out.scene.frequency_unit]
    exact, harmonic = (out.references[name].lines for name in (EXACT, CLOSED_FORM))
    rows = []
    for parameters, one, other in zip(out.parameters, exact, harmonic, strict=True):
        for dof in one.peaks if one.complete and other.points else ():
            (true, at), (found, found_at) = one.peaks[dof], other.peaks[dof]
            if true > 0.0 and np.isfinite(found):
                rows.append(
                    {
                        "parameters": parameters,
                        "dof": dof,
                        "exact": _peak(true, at / unit, one, dof),
                        "harmonic": _peak(found, found_at / unit, other, dof),
                        "error": found / true - 1.0,
                        "frequency_error": found_at / at - 1.0,
                        "truncation_error": _number(other.truncation.get(dof, float("nan"))),
                    }
                )
    return rows


def _peak(amplitude: float, frequency: float, line: Line, dof: str) -> Json:
    stable = line.stable.get(dof, float("nan"))
    told = None if np.isnan(stable) else bool(stable)
    return {"amplitude": amplitude, "frequency": frequency, "stable": told}


def _reference(out: Comparison, name: str) -> Json:
    one = out.references[name]
    return {
        "max_step": one.max_step,
        "points": sum(line.points for line in one.lines),
        "folds": [len(line.folds) for line in one.lines],
        "complete": all(line.complete for line in one.lines),
        "own_error": {measure: worst(values) for measure, values in one.own.items()},
    }


def _run(out: Comparison, number: int, one: Run) -> Json:
    start = out.startups.get(one.method)
    shown = {name: _measures(out, name, number) for name in out.references}
    return {
        "method": one.method,
        "corrected": one.corrected,
        "left_out": one.left_out,
        "max_step": one.max_step,
        "points": one.points,
        "folds": [len(line.folds) for line in one.lines],
        "complete": all(line.complete for line in one.lines),
        "seconds": one.seconds,
        "processor_seconds": one.processor_seconds,
        "start_seconds": _number(start.total) if start else None,
        "table_seconds": _number(start.table) if start else None,
        "evaluations": one.evaluations,
        "against": {name: _split(values) for name, values in shown.items()},
    }


def _measures(out: Comparison, against: str, number: int) -> dict[str, Shown]:
    return {measure: out.shown(against, number, measure) for measure in MEASURES}


def _split(shown: dict[str, Shown]) -> Json:
    return {
        "errors": {measure: one.value for measure, one in shown.items()},
        "below": {measure: one.below for measure, one in shown.items() if one.below is not None},
    }


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None


def write_netcdf(out: Comparison, path: str | Path) -> None:
    """Write the comparison as netCDF-4; the file appears only when it is complete."""
    import netCDF4

    references, swept = list(out.references), variable_names(out.parameters[0])
    with replacing(path) as temporary, netCDF4.Dataset(temporary, "w", format="NETCDF4") as file:
        file.title, file.layout = out.scene.title, LAYOUT
        file.source = f"fcm {fcm.__version__}, respond --compare"
        file.frequency_unit = out.scene.frequency_unit
        file.summary = json.dumps(summary(out), allow_nan=False)
        sizes = {"run": len(out.runs), "curve": len(out.parameters)}
        sizes |= {"reference": len(references), "measure": len(MEASURES)}
        for name, size in sizes.items():
            file.createDimension(name, size)

        def put(name: str, dims: tuple[str, ...], values: Any, **attrs: str) -> None:
            array = np.asarray(values)
            kind: Any = str if array.dtype.kind == "U" else array.dtype
            variable = file.createVariable(name, kind, dims)
            variable[...] = array.astype(object) if array.dtype.kind == "U" else array
            of_curves = "curve" in dims and name not in swept.values()
            coordinates = {"coordinates": " ".join(swept.values())} if of_curves and swept else {}
            variable.setncatts(attrs | coordinates)

        put("reference", ("reference",), references, long_name="what the errors are measured against")
        meaning = "; ".join(f"{name}: {text}" for name, text in MEANINGS.items())
        put("measure", ("measure",), list(MEASURES), long_name=f"which error; {meaning}")
        for key, name in swept.items():
            values = [parameters[key] for parameters in out.parameters]
            put(name, ("curve",), values, long_name=f"swept value of {key}", key=key)
        for name, values, attrs in _of_runs(out):
            put(name, ("run",), values, **attrs)
        own = [[out.references[name].own[measure] for measure in MEASURES] for name in references]
        put("own_error", ("reference", "measure", "curve"), own, long_name="error of the reference itself")
        errors = [[[e[measure] for e in out.errors[name]] for measure in MEASURES] for name in references]
        meaning = (
            f"error against the reference; unknown where it is below {out.options.margin:g} times own_error"
        )
        put("error", ("reference", "measure", "run", "curve"), errors, long_name=meaning, units="1")
        folds = [[len(line.folds) for line in one.lines] for one in out.runs]
        put("folds", ("run", "curve"), folds, long_name="number of folds", units="1")


def _of_runs(out: Comparison) -> list[tuple[str, Any, dict[str, str]]]:
    """Variables with one value for each run: name, values, attributes."""
    unknown, seconds = Startup(np.nan, np.nan), {"units": "s"}
    starts = [out.startups.get(run.method, unknown) for run in out.runs]
    to_begin = {"long_name": "time to begin and end a program", **seconds}
    to_open = {"long_name": "of it, to open the table", **seconds}

    def of_runs(name: str, meaning: str, **units: str) -> tuple[str, Any, dict[str, str]]:
        return name, [getattr(run, name) for run in out.runs], {"long_name": meaning, **units}

    def flags(name: str, meaning: str) -> tuple[str, Any, dict[str, str]]:
        values = np.array([getattr(run, name) for run in out.runs], dtype=np.int8)
        return name, values, {"long_name": f"1 where {meaning}"}

    equations = "evaluations of the balanced equations; of exact: periods of the motion"
    return [
        of_runs("method", "method"),
        flags("corrected", "points found with a table are corrected with the closed form"),
        flags("left_out", "what the scene does not need was left out"),
        of_runs("max_step", "longest step, relative to the extent of a curve", units="1"),
        of_runs("points", "points of all curves", units="1"),
        of_runs("seconds", "time to solve all curves", **seconds),
        of_runs("processor_seconds", "processor time to solve all curves", **seconds),
        ("start_seconds", [one.total for one in starts], to_begin),
        ("table_seconds", [one.table for one in starts], to_open),
        of_runs("evaluations", equations, units="1"),
    ]
