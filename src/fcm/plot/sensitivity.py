"""Sensitivities of a peak to numbers of a scene: bars of relative derivatives, the greatest first."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fcm.frozen import Frozen
from fcm.plot.dof import asked_for, leading_column
from fcm.plot.errors import PlotError
from fcm.plot.labels import staying, with_mode
from fcm.plot.options import READ
from fcm.plot.read import FloatArray, curves_there, floats, opened, swept_units, swept_values
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NEEDED = (
    "sensitivity", "frequency_sensitivity", "number", "number_value", "peak_amplitude", "peak_frequency",
    "peak_stable",
    "peak_kind", "dof",
)  # fmt: skip
_RISE, _FALL = "#2b6a99", "#c03020"
_REMARKS = {"corner": "peak at a corner", "end of range": "peak at an end of the range"}


class DrawnSensitivity(Frozen):
    """Relative derivatives; NaN where they are not known."""

    dofs: tuple[str, ...]
    numbers: tuple[str, ...]
    parameters: tuple[dict[str, float], ...]  # of each curve
    height: FloatArray  # (curve, dof, number) relative change of the peak per relative change of the number
    frequency: FloatArray  # (curve, dof, number) of the peak's frequency likewise
    kind: tuple[tuple[str, ...], ...]  # of each curve and dof
    units: dict[str, str]  # of the swept values
    stable: FloatArray  # (curve, dof) whether the motion at the peak is stable: 1, 0 or NaN
    peak: FloatArray  # (curve, dof) height of the peak
    asked: tuple[str, ...] = ()  # degrees of freedom that the scene asks for; empty where it does not


@apart
def read_sensitivity(path: Path) -> DrawnSensitivity:
    """Read what ``fcm respond --sensitivity -o`` has written; PlotError if the file is something else."""
    with opened(path, "a file with sensitivities (fcm respond --sensitivity)", _NEEDED) as data:
        variables = data.variables
        height, frequency, value, peak, at = (
            floats(variables[name])
            for name in (
                "sensitivity", "frequency_sensitivity", "number_value", "peak_amplitude", "peak_frequency"
            )
        )  # fmt: skip
        swept = swept_values(variables)
        kind = np.atleast_2d(variables["peak_kind"][:])
        with np.errstate(divide="ignore", invalid="ignore"):
            known = [
                slope * (value[:, None, :] / size[:, :, None])
                for slope, size in ((height, peak), (frequency, at))
            ]
        height, frequency = (np.where(np.abs(one) <= READ.max_number, one, np.nan) for one in known)
        dofs = tuple(map(str, np.atleast_1d(variables["dof"][:])))
        return DrawnSensitivity(
            dofs,
            tuple(map(str, np.atleast_1d(variables["number"][:]))),
            tuple({key: float(x[i]) for key, x in swept.items()} for i in range(len(height))),
            height,
            frequency,
            tuple(tuple(map(str, row)) for row in kind),
            swept_units(variables, swept),
            floats(variables["peak_stable"]),
            peak,
            asked_for(getattr(data, "output", ""), dofs),
        )


def draw_sensitivity(drawn: DrawnSensitivity, dof: str | None = None, curve: int = 0) -> Figure:
    """The figure of one peak (by default see `leading_column`): bars of its height, and of its frequency."""
    column = leading_column(drawn.dofs, dof, drawn.peak, drawn.asked)
    if curve >= len(drawn.parameters):
        raise PlotError(f"there is no curve {curve}; the file has {curves_there(len(drawn.parameters))}")
    height, frequency = drawn.height[curve, column], drawn.frequency[curve, column]
    shown = _greatest(height, frequency)
    if shown.size == 0:
        known = f"the sensitivities of {drawn.dofs[column]} on curve {curve} are not known"
        raise PlotError(f"{known}: the run that wrote the file says why, as does its --json")
    names = [with_mode(drawn.numbers[i]) for i in shown]
    with house_style():
        figure = new_figure(LAYOUT.width, 0.9 + 0.24 * len(names))
        left, right = figure.subplots(1, 2, sharey=True)
        _bars(left, height[shown], names, "of the peak")
        _bars(right, frequency[shown], names, "of its frequency")
        figure.suptitle(_title(drawn, curve, column), fontsize=9, parse_math=False)
        figure.supxlabel("Change (%) for 1 % of the number", fontsize=9)
    return figure


def _greatest(height: FloatArray, frequency: FloatArray) -> np.ndarray:
    """Indices of the numbers with the greatest sensitivities, those of the peak's height in falling order."""
    size = np.nan_to_num(np.maximum(np.abs(height), np.abs(frequency)))
    order = np.argsort(-np.nan_to_num(np.abs(height)), kind="stable")
    return np.array(
        [i for i in order if size[i] > LAYOUT.negligible_bar * size.max(initial=0.0)][: LAYOUT.bars],
        dtype=int,
    )


def _bars(axes: Axes, values: FloatArray, names: list[str], title: str) -> None:
    place = np.arange(len(names))
    axes.barh(place, values, height=0.62, color=np.where(values >= 0.0, _RISE, _FALL).tolist())
    axes.set_yticks(place, names, parse_math=False)
    axes.axvline(0.0, color="black", linewidth=0.6)
    axes.set_title(title, fontsize=9)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.tick_params(axis="y", which="both", length=0)
    axes.minorticks_off()
    axes.margins(x=0.08)


def _title(drawn: DrawnSensitivity, curve: int, column: int) -> str:
    parts = [drawn.dofs[column]]
    if drawn.parameters[curve]:
        each = drawn.parameters[curve].items()
        parts.append(", ".join(f"{key} = {value:.4g} {drawn.units[key]}".rstrip() for key, value in each))
    parts.append(_REMARKS.get(drawn.kind[curve][column], ""))
    parts.append(staying(float(drawn.stable[curve, column])).removeprefix(", "))
    return "; ".join(filter(None, parts))
