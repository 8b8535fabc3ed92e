"""``fcm plot accuracy``: error against run time."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.drawing import draws_file, picture_of, save_picture_of
from fcm.cli.messages import Messages, pass_messages


@click.command()
@draws_file(".png")
@click.option(
    "--of", "quantity", type=click.Choice(["curve", "points", "peak", "peak-frequency", "fold"]),
    default="curve", show_default=True, help="What the error is of.",
)  # fmt: skip
@pass_messages
def accuracy(messages: Messages, file: Path, output: Path | None, quantity: str) -> None:
    """Draw error against run time from FILE, which `fcm respond SCENE --compare -o FILE` has written.

    One line a method, its longest step from long to short. An arrow points down where the error is less
    than the reference can show. The time is that of the processor, which other programs do
    not make longer.
    """
    from fcm.plot.accuracy import draw_accuracy, read_accuracy

    output = picture_of(file, output, ".png")
    read = read_accuracy(file, quantity.replace("-", "_"))
    save_picture_of(lambda: draw_accuracy(read), output)
    messages.info(f"wrote {output}")
