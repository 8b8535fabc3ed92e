"""``fcm plot sensitivity``: what the numbers of a scene do to a peak."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.drawing import draws_file, picture_of, save_picture_of
from fcm.cli.messages import Messages, pass_messages


@click.command()
@draws_file("-sensitivity.png")
@click.option("--dof", metavar="NAME", help="The degree of freedom to draw.  [default: the first]")
@click.option("--curve", type=click.IntRange(min=0), default=0, metavar="I", help="Of a sweep.  [default: 0]")
@pass_messages
def sensitivity(messages: Messages, file: Path, output: Path | None, dof: str | None, curve: int) -> None:
    """Draw what each number does to a peak of FILE, the netCDF file of `fcm respond --sensitivity -o FILE`.

    Relative: by how many percent the peak rises, and its frequency, for each percent of the number. The
    numbers that do most come first.
    """
    from fcm.plot.sensitivity import draw_sensitivity, read_sensitivity

    output = picture_of(file, output, "-sensitivity.png")
    read = read_sensitivity(file)
    save_picture_of(lambda: draw_sensitivity(read, dof=dof, curve=curve), output)
    messages.info(f"wrote {output}")
