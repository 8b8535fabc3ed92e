"""Error of peaks against the number of kept modes, with and without the flexibility of the others."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np
import numpy.typing as npt

from fcm.cli.messages import Messages, pass_messages
from fcm.response.sweep import trace
from fcm.run import Execution
from fcm.scene import scene_from_dict

from .kept_modes_picture import Kept, draw_kept_modes
from .measured import write_measured
from .plane_blade import blade, blade_scene

COUNTS = (3, 5, 10, 30, 100)
MANY = 300  # modes, with the flexibility of the rest, that errors are measured against
COLUMNS = (
    "modes kept", "height", "its bound", "frequency", "bound", "height without", "frequency without",
)  # fmt: skip


@click.command("kept-modes")
@click.argument("output", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--picture", type=click.Path(dir_okay=False, path_type=Path), required=True, metavar="FILE")
@click.option(
    "--scene", type=click.Path(exists=True, dir_okay=False, path_type=Path), metavar="FILE",
    help="A scene with [structure] of your own.  [default: a blade of plane finite elements]",
)  # fmt: skip
@click.option("--dof", help="Whose peaks are compared, with --scene.")
@pass_messages
def kept_modes(messages: Messages, output: Path, picture: Path, scene: Path | None, dof: str | None) -> None:
    """Write the numbers as JSON to OUTPUT and draw them; print them as a table."""
    if (scene is None) != (dof is None):
        raise click.UsageError("--scene and --dof go together.")
    rows = measured() if scene is None or dof is None else measured_of(scene, dof)
    write_measured(output, rows, picture, draw_kept_modes(rows))
    click.echo("\n".join("  ".join(f"{cell:>20s}" for cell in line) for line in (COLUMNS, *texts(rows))))
    messages.info(f"wrote {output} and {picture}")


def texts(rows: Sequence[Kept]) -> list[tuple[str, ...]]:
    """The cells of a table."""
    return [
        (
            str(one.modes),
            *(f"{x:.1e}" for pair in _columns(one) for x in pair),
            *map("{:.1e}".format, one.without),
        )
        for one in rows
    ]


def _columns(one: Kept) -> zip[tuple[float, float]]:
    """Error and bound of height and frequency."""
    return zip(one.with_flexibility, one.bound, strict=True)


def measured(counts: Sequence[int] = COUNTS) -> list[Kept]:
    """Of the blade of plane elements."""
    made = blade()
    return errors(blade_scene(made), f"{made.middle}y", counts)


def measured_of(path: Path, dof: str, counts: Sequence[int] = COUNTS) -> list[Kept]:
    """Of the scene in a file."""
    return errors(tomllib.loads(path.read_text(encoding="utf-8")), dof, counts, path.parent)


def errors(data: dict[str, Any], dof: str, counts: Sequence[int], folder: Path = Path()) -> list[Kept]:
    """Greatest errors over the curves of a scene, of the peaks of a degree of freedom."""
    exact, _ = _peaks(data, dof, folder, MANY, True)
    rows = []
    for count in counts:
        found, bound = _peaks(data, dof, folder, count, True)
        without, _ = _peaks(data, dof, folder, count, False)
        rows.append(Kept(count, _greatest(found, exact), _greatest(without, exact), bound))
    return rows


def _greatest(found: npt.NDArray[np.float64], exact: npt.NDArray[np.float64]) -> tuple[float, float]:
    height, frequency = np.abs(found / exact - 1.0).max(axis=0).tolist()
    return height, frequency


def _peaks(
    data: dict[str, Any], dof: str, folder: Path, modes: int, flexibility: bool
) -> tuple[npt.NDArray[np.float64], tuple[float, float]]:
    """Height and frequency of the peak of each curve, (curve, 2), and the bounds stated for the two."""
    data = copy.deepcopy(data)
    data["structure"] |= {"modes": modes, "flexibility": flexibility}
    data["response"]["output"] = [dof]
    scene = scene_from_dict(data, "a scene with fewer modes", folder)
    curves = trace(scene, "closed-form", execution=Execution(jobs=1)).curves
    stated = re.search(r"off by at most (\S+), .*resonance by at most (\S+)", " ".join(scene.notes))
    peaks = [(curve.peaks[dof].amplitude, curve.peaks[dof].frequency) for curve in curves]
    return np.array(peaks), (float(stated[2]), float(stated[1])) if stated else (np.nan, np.nan)
