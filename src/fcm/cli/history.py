"""``fcm plot history``: the motion through a schedule."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.cli.drawing import save_picture
from fcm.cli.files import check_output, output_option
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.plot import ENDINGS

if TYPE_CHECKING:
    from fcm.plot.history_file import DrawnMotion


@click.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path))
@output_option(
    "-o", "--output", endings=ENDINGS,
    help="The picture to write: .png, .svg or .pdf.  [default: FILE with the ending -history.png]",
)  # fmt: skip
@click.option("--dof", metavar="NAME", help="The degree of freedom to draw.  [default: the first]")
@click.option(
    "--against", type=click.Choice(["cycles", "time"]), default="cycles", show_default=True,
    help="The axis: cycles of the force, or time in s.",
)  # fmt: skip
@click.option(
    "--window",
    type=float,
    nargs=2,
    metavar="FROM TO",
    help="Draw only this part of the axis.  [default: all]",
)
@click.option(
    "--curve", "curves", type=click.IntRange(min=0), multiple=True, metavar="N",
    help="Number of the curve in the file, from 0; may be repeated.  [default: all]",
)  # fmt: skip
@pass_messages
def history(
    messages: Messages,
    file: Path,
    output: Path | None,
    dof: str | None,
    against: str,
    window: tuple[float, float] | None,
    curves: tuple[int, ...],
) -> None:
    """Draw the motion in FILE, the netCDF file of `fcm respond -o FILE` for a scene with a [[schedule]].

    Up to 60 cycles are drawn as they move; of more, the exact extent and the mean of each cycle.
    """
    from fcm.plot.history import draw_history
    from fcm.plot.history_file import read_history

    output = output or file.with_name(f"{file.stem}-history.png")
    check_output(output, ENDINGS)
    read = read_history(file, dof, against)
    if curves:
        read = replace(read, motions=_chosen(read.motions, curves))
    save_picture(draw_history(read, window), output)
    messages.info(f"wrote {output}")


def _chosen(motions: tuple[DrawnMotion, ...], curves: tuple[int, ...]) -> tuple[DrawnMotion, ...]:
    """The motions of some curves."""
    if max(curves) >= len(motions):
        raise click.BadParameter(f"--curve {max(curves)}: the file has the curves 0 to {len(motions) - 1}.")
    return tuple(motions[i] for i in dict.fromkeys(curves))
