"""``fcm plot peak``: peaks against what was swept."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.drawing import draws_file, picture_of, save_picture
from fcm.cli.messages import Messages, pass_messages


@click.command()
@draws_file("-peak.png")
@click.option("--dof", metavar="NAME", help="The degree of freedom to draw.  [default: the first]")
@click.option("--against", metavar="KEY", help="The swept quantity of the axis.  [default: the first]")
@pass_messages
def peak(messages: Messages, file: Path, output: Path | None, dof: str | None, against: str | None) -> None:
    """Draw the peaks of FILE, the netCDF file of `fcm respond -o FILE`, against what was swept.

    The least peak is marked: of a sweep of the preload, the best preload.
    """
    from fcm.plot.peak import draw_peak, read_peaks

    output = picture_of(file, output, "-peak.png")
    figure = draw_peak(read_peaks(file), dof=dof, against=against)
    save_picture(figure, output)
    messages.info(f"wrote {output}")
