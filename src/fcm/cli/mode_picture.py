"""``fcm plot mode``: frequency and damping of a mode against its amplitude."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.drawing import draws_file, picture_of, save_picture_of
from fcm.cli.messages import Messages, pass_messages


@click.command()
@draws_file("-mode.png")
@pass_messages
def mode(messages: Messages, file: Path, output: Path | None) -> None:
    """Draw the nonlinear modes of FILE, the netCDF file of `fcm respond --mode N --level FROM:TO -o FILE`.

    Frequency and damping ratio against the modal amplitude; where a mode is damped most is marked.
    """
    from fcm.plot.mode import draw_modes, read_modes

    output = picture_of(file, output, "-mode.png")
    read = read_modes(file)
    save_picture_of(lambda: draw_modes(read), output)
    messages.info(f"wrote {output}")
