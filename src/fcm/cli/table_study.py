"""``fcm tabulate --study``: layouts of tables against each other, as a .csv and as a figure."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.cli.interruptible import Interruptible
from fcm.cli.messages import Messages
from fcm.files import replacing

if TYPE_CHECKING:
    from fcm.table.study import Row


def write_study(messages: Messages, path: Path, to_json: bool) -> None:
    from fcm.table.study import Row, study

    began = time.perf_counter()
    with Interruptible(messages, "nothing was written") as progress:
        rows = study(progress)
    lines = [",".join(Row._fields)] + [",".join(map(_cell, row)) for row in rows]
    with replacing(path) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")
    picture = path.with_suffix(".png")
    with replacing(picture) as partial:
        _draw(rows, partial)
    if to_json:
        click.echo(json.dumps([row._asdict() for row in rows], indent=2))
    else:
        columns = list(zip(*(line.split(",") for line in lines), strict=True))
        widths = [max(map(len, column)) + 2 for column in columns]
        for cells in zip(*columns, strict=True):
            click.echo("".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True)))
    best = min((row for row in rows if row.nodes), key=lambda row: row.rms)
    messages.info(
        f"wrote {path} and {picture} in {time.perf_counter() - began:.1f} s; "
        f"least error {best.max:.1e} at most, {best.rms:.1e} rms: {best.layout}, {best.interpolation}"
    )


def _cell(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _draw(rows: list[Row], path: Path) -> None:
    """Error against size, and against the time of a look-up of ten points: a line for each layout."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.2), layout="constrained")
    by_size, by_time = figure.subplots(1, 2, sharey=True)
    for layout, mark in (("rectilinear", "s"), ("regimes", "o")):
        for interpolation, style in (("linear", "--"), ("cubic", "-")):
            some = [row for row in rows if (row.layout, row.interpolation) == (layout, interpolation)]
            label, colour = f"{layout}, {interpolation}", "C0" if layout == "regimes" else "C1"
            for axes, field in ((by_size, "bytes"), (by_time, "us_of_group")):
                at = [getattr(row, field) / (1e6 if field == "bytes" else 1.0) for row in some]
                axes.loglog(at, [row.rms for row in some], style, marker=mark, color=colour, label=label)
                axes.loglog(at, [row.max for row in some], style, marker=mark, color=colour, alpha=0.3)
    by_time.set_xscale("linear")
    by_time.set_xlim(0.0, 1.05 * max(row.us_of_group for row in rows))
    by_time.axvline(rows[-1].us_of_group, color="black", linestyle=":", label="closed form, exact")
    by_size.set(xlabel="size [MB]", ylabel="absolute error: rms (strong), greatest (pale) [-]")
    by_time.set(xlabel="time for ten points [µs]")
    by_time.legend(fontsize="small")
    figure.savefig(path, dpi=150)
