"""``fcm plot history``: the motion through a schedule."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.cli.drawing import draws_file, picture_of, save_picture_of
from fcm.cli.files import wrote
from fcm.cli.messages import Messages, pass_messages

if TYPE_CHECKING:
    from fcm.plot.history_file import DrawnMotion


@click.command()
@draws_file("-history.png")
@click.option(
    "--dof",
    metavar="NAME",
    help="The degree of freedom to draw.  [default: the first of the scene's output, or of all]",
)
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

    output = picture_of(file, output, "-history.png")
    read = read_history(file, dof, against)
    if curves:
        read = replace(read, motions=_chosen(read.motions, curves))
    save_picture_of(lambda: draw_history(read, window), output)
    messages.info(wrote(output))


def _chosen(motions: tuple[DrawnMotion, ...], curves: tuple[int, ...]) -> tuple[DrawnMotion, ...]:
    """The motions of the chosen curves."""
    if max(curves) >= len(motions):
        from fcm.plot.read import curves_there

        raise click.BadParameter(f"--curve {max(curves)}: the file has {curves_there(len(motions))}.")
    return tuple(motions[i] for i in dict.fromkeys(curves))
