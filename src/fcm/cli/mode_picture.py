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

    Frequency, damping ratio and error against the modal amplitude. Marked are where a mode is damped most,
    and where the forces of each --force-level are in resonance.
    """
    from fcm.plot.mode import draw_modes, read_modes

    output = picture_of(file, output, "-mode.png")
    read = read_modes(file)
    save_picture_of(lambda: draw_modes(read), output)
    messages.info(f"wrote {output}")
