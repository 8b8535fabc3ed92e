"""``fcm plot peak``: peaks against what was swept."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.files import check_output, output_option
from fcm.cli.messages import Messages, pass_messages
from fcm.files import replacing

ENDINGS = (".png", ".svg", ".pdf")


@click.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path))
@output_option(
    "-o", "--output", endings=ENDINGS,
    help="The picture to write: .png, .svg or .pdf.  [default: FILE with the ending -peak.png]",
)  # fmt: skip
@click.option("--dof", metavar="NAME", help="The degree of freedom to draw.  [default: the first]")
@click.option("--against", metavar="KEY", help="The swept quantity of the axis.  [default: the first]")
@pass_messages
def peak(messages: Messages, file: Path, output: Path | None, dof: str | None, against: str | None) -> None:
    """Draw the peaks of FILE, the netCDF file of `fcm respond -o FILE`, against what was swept.

    The least peak is marked: of a sweep of the preload, the best preload.
    """
    from fcm.plot.peak import draw_peak, read_peaks
    from fcm.plot.style import save

    output = output or file.with_name(f"{file.stem}-peak.png")
    check_output(output, ENDINGS)
    figure = draw_peak(read_peaks(file), dof=dof, against=against)
    with replacing(output) as partial:
        save(figure, partial)
    messages.info(f"wrote {output}")
