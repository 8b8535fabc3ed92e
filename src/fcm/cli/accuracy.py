"""``fcm plot accuracy``: error against run time."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.drawing import save_picture
from fcm.cli.files import check_output, output_option
from fcm.cli.messages import Messages, pass_messages

ENDINGS = (".png", ".svg", ".pdf")


@click.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path))
@output_option(
    "-o", "--output", endings=ENDINGS,
    help="The picture to write: .png, .svg or .pdf.  [default: FILE with the ending .png]",
)  # fmt: skip
@click.option(
    "--of", "quantity", type=click.Choice(["curve", "points", "peak", "peak-frequency", "fold"]),
    default="curve", show_default=True, help="What the error is of.",
)  # fmt: skip
@pass_messages
def accuracy(messages: Messages, file: Path, output: Path | None, quantity: str) -> None:
    """Draw error against run time from FILE, which `fcm respond SCENE --compare -o FILE` has written.

    One line a method, its longest step from long to short; an arrow down where the error is less than
    can be shown, for want of a better reference. The time is that of the processor, which other programs do
    not make longer.
    """
    from fcm.plot.accuracy import draw_accuracy, read_accuracy

    output = output or file.with_suffix(".png")
    check_output(output, ENDINGS)
    save_picture(draw_accuracy(read_accuracy(file, quantity.replace("-", "_"))), output)
    messages.info(f"wrote {output}")
