"""Results over the sectors of a mistuned ring: the envelope, the worst blade and its amplification."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.frozen import Frozen
from fcm.results.curve_extracts import extract_of
from fcm.results.curve_summary import at_edge
from fcm.results.padded_arrays import Field, by_point
from fcm.results.result import Curve, Response
from fcm.results.scatter import PERCENTS, groups, percentiles, ranges
from fcm.units import CF_UNIT, in_unit


class Worst(Frozen):
    """The greatest peak of a degree of freedom over the sectors; frequencies in rad/s. All (curve, dof)."""

    amplitude: FloatArray
    frequency: FloatArray
    sector: npt.NDArray[np.intp]
    tuned: FloatArray  # peak of the tuned ring; NaN if unknown
    tuned_frequency: FloatArray
    at_end: npt.NDArray[np.bool_]  # whether the amplitude is at an end of the range, and not a peak
    tuned_at_end: npt.NDArray[np.bool_]

    @property
    def amplification(self) -> FloatArray:
        """Amplitude of the worst blade over that of the tuned ring; NaN if the latter is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.tuned > 0.0, self.amplitude / self.tuned, np.nan)


def worst_of(response: Response) -> Worst:
    """The worst blade of each curve of a mistuned ring."""
    blades = response.blades
    assert blades is not None
    columns = blades.columns(response.dofs)
    peaks = np.array([[one[:2] for one in curve.peaks.values()] for curve in response.curves])
    each = peaks.reshape(len(response.curves), len(response.dofs), 2)[:, columns]  # (curve, dof, sector, 2)
    height = np.where(np.isnan(each[..., 0]), -np.inf, each[..., 0])
    sector = height.argmax(axis=2)
    amplitude, frequency = (
        np.take_along_axis(each[..., i], sector[..., None], axis=2)[..., 0] for i in range(2)
    )
    every = [(curve, curve.extract or extract_of(curve)) for curve in response.curves]
    ends = np.array([[at_edge(curve, one, brief) for one in curve.peaks.values()] for curve, brief in every])
    at_end = np.take_along_axis(ends[:, columns], sector[..., None], axis=2)[..., 0]
    return Worst(
        amplitude, frequency, sector, blades.tuned, blades.tuned_frequency, at_end, blades.tuned_at_end
    )


def envelope(curve: Curve, columns: npt.NDArray[np.intp]) -> FloatArray:
    """The greatest amplitude over the sectors, (point, dof), of columns (dof, sector)."""
    found: FloatArray = curve.amplitude[:, columns].max(axis=2)
    return found


def blade_fields(response: Response) -> dict[str, Field]:
    """The variables of a mistuned ring."""
    blades, unit = response.blades, response.frequency_unit
    assert blades is not None
    worst, at, of = worst_of(response), {"units": CF_UNIT[unit]}, ("curve", "sector_dof")
    out = {
        "sector_dof": Field(
            ("sector_dof",), np.array(blades.names), {"long_name": "degree of freedom of a sector"}
        ),
        "sector": Field(("sector",), np.arange(blades.sectors), {"long_name": "sector"}),
        "stiffness_factor": Field(
            ("curve", "sector"),
            blades.factors,
            {"long_name": "factor of the blade's stiffness", "units": "1"},
        ),
        "worst_amplitude": Field(
            of, worst.amplitude, {"long_name": "greatest amplitude over sectors and points"}
        ),
        "worst_frequency": Field(
            of, in_unit(worst.frequency, unit), {"long_name": "its frequency"} | at
        ),
        "worst_sector": Field(of, worst.sector.astype(np.float64), {"long_name": "its sector", "units": "1"}),
        "tuned_amplitude": Field(of, worst.tuned, {"long_name": "greatest amplitude of the tuned ring"}),
        "tuned_frequency": Field(
            of, in_unit(worst.tuned_frequency, unit), {"long_name": "its frequency in the tuned ring"} | at
        ),
        **{
            name: Field(of, ends.astype(np.int8), {"long_name": said, "units": "1"})
            for name, ends, said in (
                ("worst_at_end", worst.at_end, "1 where worst_amplitude is at an end of the range"),
                ("tuned_at_end", worst.tuned_at_end, "1 where tuned_amplitude is at an end of the range"),
            )
        },
        "amplification": Field(
            of, worst.amplification, {"long_name": "worst_amplitude over tuned_amplitude", "units": "1"}
        ),
    }  # fmt: skip
    if not response.peaks_only:
        pick = partial(envelope, columns=blades.columns(response.dofs))
        out["envelope"] = Field(
            ("curve", "point", "sector_dof"),
            by_point(response.curves, pick),
            {"long_name": "greatest amplitude over the sectors"},
        )
    if found := groups(response):
        by = ("scatter", "percent", "sector_dof")
        for name, values in (("worst", worst.amplitude), ("amplification", worst.amplification)):
            rows = np.stack([percentiles(values[_counted(response, places)]) for _, places in found])
            out[f"{name}_percentile"] = Field(by, rows, {"long_name": f"percentile of {name}"})
    return out


def _counted(response: Response, places: Sequence[int]) -> list[int]:
    """The curves that are included in percentiles."""
    return [i for i in places if response.curves[i].complete and response.curves[i].points]


def add_to_summary(response: Response, data: dict[str, Any]) -> None:
    """Add "blades" to each curve and to the percentiles in the output of `fcm respond --json`."""
    blades, worst = response.blades, worst_of(response)
    assert blades is not None
    at, before = (in_unit(one, response.frequency_unit) for one in (worst.frequency, worst.tuned_frequency))
    for i, curve in enumerate(data["curves"]):
        curve["blades"] = {
            name: {
                "sector": int(worst.sector[i, d]),
                "amplitude": float(worst.amplitude[i, d]),
                "frequency": float(at[i, d]),
                "tuned_amplitude": float(worst.tuned[i, d]),
                "tuned_frequency": float(before[i, d]),
                "amplification": float(worst.amplification[i, d]),
                "at_edge": bool(worst.at_end[i, d]),
                "tuned_at_edge": bool(worst.tuned_at_end[i, d]),
            }
            for d, name in enumerate(blades.names)
        }
    for one, (_, places) in zip(data.get("scatter", ()), groups(response), strict=True):
        counted = _counted(response, places)
        both = {"amplitude": worst.amplitude[counted], "amplification": worst.amplification[counted]}
        each = {key: (percentiles(values), ranges(values)) for key, values in both.items()}
        one["blades"] = {
            name: {
                key: {f"{percent:g}": float(x) for percent, x in zip(PERCENTS, rows[:, d], strict=True)}
                for key, (rows, _) in each.items()
            }
            | {f"{key}_range": ends[:, d].tolist() for key, (_, ends) in each.items()}
            for d, name in enumerate(blades.names)
        }
