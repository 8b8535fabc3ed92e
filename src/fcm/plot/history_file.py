"""The motion of a schedule in a response file, read for drawing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

import numpy as np

from fcm.frozen import Frozen
from fcm.plot.dof import asked_for, column_of
from fcm.plot.errors import PlotError
from fcm.plot.read import FloatArray, floats, opened, swept_units, swept_values
from fcm.plot.reader_process import apart

_CYCLES = ("cycle_start", "cycle_elapsed", "cycle_part", "cycle_greatest", "cycle_least", "cycle_mean")
_PHASES = ("schedule_frequency", "schedule_cycles", "schedule_start")
_NEEDED = ("displacement", "time", "cycles", "dof", *_CYCLES, *_PHASES)


class DrawnMotion(Frozen):
    """The motion of one curve in one degree of freedom, as far as it was simulated."""

    parameters: dict[str, float]
    edges: FloatArray  # (cycle + 1,) where the cycles begin and the last one ends
    greatest: FloatArray  # (cycle,)
    least: FloatArray  # (cycle,)
    mean: FloatArray  # (cycle,)
    position: FloatArray  # (instant,)
    displacement: FloatArray  # (instant,)


class DrawnHistory(Frozen):
    """The motion of each curve through a schedule; positions are in cycles, or times in s."""

    axis: str
    dof: str
    unit: str  # of the frequencies
    frequency: FloatArray  # (phase,)
    boundaries: FloatArray  # (phase + 1,) where the phases begin and the last one ends
    motions: tuple[DrawnMotion, ...]
    units: Mapping[str, str] = field(default_factory=dict)  # of swept keys, if the file says them
    length: str = ""  # unit of displacements, if the file says it


@apart
def read_history(path: Path, dof: str | None = None, axis: str = "cycles") -> DrawnHistory:
    """Read the motion that ``fcm respond -o`` has written; PlotError if the file has none.

    The default degree of freedom is the first of the scene's output, or else the first of the file.
    """
    with opened(path, "the file of a scene with a schedule", _NEEDED) as data:
        dofs = [str(name) for name in np.atleast_1d(data["dof"][:])]
        asked = asked_for(getattr(data, "output", ""), dofs)
        column = column_of(dofs, dof or next(iter(asked), None))
        boundaries, edges = _edges(data, axis)
        swept = swept_values(data.variables)
        motions = tuple(
            _motion(data, {name: float(values[i]) for name, values in swept.items()}, edges, axis, i, column)
            for i in range(data["displacement"].shape[0])
        )
        unit = str(getattr(data, "frequency_unit", "rad/s"))
        frequency = floats(data["schedule_frequency"])
        units = swept_units(data.variables, swept)
        length = str(getattr(data["displacement"], "units", ""))
    if not any(motion.least.size for motion in motions):
        raise PlotError(f"{path}: holds no cycle of the schedule")
    return DrawnHistory(axis, dofs[column], unit, frequency, boundaries, motions, units, length)


def _edges(data: Any, axis: str) -> tuple[FloatArray, FloatArray]:
    """Starts of the phases and of the cycles, each followed by the end: in time, or in cycles passed."""
    end = floats(data[axis])[-1:]
    if axis == "time":
        phases, cycles = floats(data["schedule_start"]), floats(data["cycle_start"])
    else:
        passed = np.cumsum(floats(data["schedule_cycles"]))
        phases, cycles = np.concatenate(([0.0], passed[:-1])), floats(data["cycle_elapsed"])
    for what, begun in (("phases", phases), ("cycles", cycles)):
        if not (np.diff(begun, append=end) > 0.0).all():
            raise ValueError(f"the times of its {what} do not rise")
    return np.concatenate((phases, end)), np.concatenate((cycles, end))


def _motion(
    data: Any, parameters: dict[str, float], edges: FloatArray, axis: str, curve: int, column: int
) -> DrawnMotion:
    greatest, least, mean = (
        floats(data[name][curve, :, column]) for name in ("cycle_greatest", "cycle_least", "cycle_mean")
    )
    displacement = floats(data["displacement"][curve, :, column])
    mean[floats(data["cycle_part"]) < 1.0] = np.nan  # the mean over part of a cycle says nothing
    done, reached = int(np.isfinite(least).sum()), int(np.isfinite(displacement).sum())
    return DrawnMotion(
        parameters, edges[: done + 1], greatest[:done], least[:done], mean[:done],
        floats(data[axis])[:reached], displacement[:reached],
    )  # fmt: skip
