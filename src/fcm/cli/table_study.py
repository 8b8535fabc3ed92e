"""``fcm tabulate --study``: layouts of tables against each other, as a .csv and as a figure."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.cli.columns import aligned
from fcm.cli.interruptible import Interruptible
from fcm.cli.messages import Messages
from fcm.files import replacing

if TYPE_CHECKING:
    from fcm.table.options import StudyOptions


def write_study(messages: Messages, path: Path, to_json: bool, options: StudyOptions | None = None) -> None:
    from fcm.plot.study import write_study_figure
    from fcm.table.options import STUDY_OPTIONS
    from fcm.table.study import Row, study

    began = time.perf_counter()
    with Interruptible(messages, "nothing was written") as progress:
        rows = study(progress, options or STUDY_OPTIONS)
    lines = [",".join(Row._fields)] + [",".join(map(_cell, row)) for row in rows]
    with replacing(path) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")
    picture = path.with_suffix(".png")
    with replacing(picture) as partial:
        write_study_figure(rows, partial)
    if to_json:
        click.echo(json.dumps([row._asdict() for row in rows], indent=2))
    else:
        click.echo(aligned([line.split(",") for line in lines], left=0))
    best = min((row for row in rows if row.nodes), key=lambda row: row.rms)
    messages.info(
        f"wrote {path} and {picture} in {time.perf_counter() - began:.1f} s; "
        f"least error {best.max:.1e} at most, {best.rms:.1e} rms: {best.layout}, {best.interpolation}"
    )


def _cell(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
