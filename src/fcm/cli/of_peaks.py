"""``fcm respond --sensitivity`` and ``fcm plot sensitivity``: what the numbers of a scene do to its peaks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.cli.drawing import draws_file, picture_of, save_picture
from fcm.cli.messages import Messages, pass_messages

if TYPE_CHECKING:
    from fcm.response import Response
    from fcm.scene.model import Scene


def check_options(wanted: bool, method: str, level: object, mode: int | None) -> None:
    """A usage error if --sensitivity is given with what has no peaks of a balance."""
    if wanted and method == "exact":
        raise click.UsageError(
            "--sensitivity is of no use with --method exact: it is of the balance's peaks."
        )
    if wanted and (level is not None or mode is not None):
        option = "--level" if mode is None else "--mode"
        raise click.UsageError(f"--sensitivity is of no use with {option}: such a curve has no peaks.")


def added(messages: Messages, response: Response, scene: Scene) -> None:
    """Give the curves of a response the sensitivities of their peaks."""
    from fcm.response.sensitivity import add_sensitivities, remarks

    add_sensitivities(response, scene, messages.progress)
    messages.clear()
    for remark in remarks(response):
        messages.info(remark)


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
    save_picture(draw_sensitivity(read_sensitivity(file), dof=dof, curve=curve), output)
    messages.info(f"wrote {output}")
