"""``fcm plot peak``: peaks against what was swept."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.drawing import drawing, draws_file, is_page, picture_of, save_picture_of
from fcm.cli.files import wrote
from fcm.cli.messages import Messages, pass_messages
from fcm.files import replacing


@click.command()
@draws_file("-peak.png", page=True)
@click.option(
    "--dof", metavar="NAME",
    help="The degree of freedom to draw.  [default: the first; of more than 4 that of the greatest peak; "
    "what was tracked]",
)  # fmt: skip
@click.option("--against", metavar="KEY", help="The swept quantity of the axis.  [default: the first]")
@click.option("--folds", is_flag=True, help="The folds, of --track folds: where there are several solutions.")
@pass_messages
def peak(
    messages: Messages, file: Path, output: Path | None, dof: str | None, against: str | None, folds: bool
) -> None:
    """Draw the peaks of FILE, the netCDF file of `fcm respond -o FILE`, against what was swept.

    The least peak is marked: of a sweep of the preload, the best preload. At an end of the sweep that is
    said. Of random draws the median and the scatter are. Of nonlinear modes (--mode) the resonances with the
    scene's forces are drawn, with their damping. Of tracked peaks, as of an [optimum], the curve is drawn; of
    tracked folds their frequencies, the window between them shaded.
    """
    from fcm.plot.peak import draw_peak, read_peaks
    from fcm.plot.tracked import draw_tracked, read_tracked

    output = picture_of(file, output, "-peak.png", page=True)
    tracked = read_tracked(file)
    if is_page(output):
        if folds or (tracked is not None and against is None):
            raise click.UsageError("tracked peaks and folds are drawn to .png, .svg or .pdf, not to a page.")
        from fcm.plot.interactive import peak_page

        with drawing(), replacing(output) as partial:
            peak_page(read_peaks(file), dof, against, partial)
        messages.info(wrote(output))
        return
    if tracked is not None and against is None:
        save_picture_of(lambda: draw_tracked(tracked, dof=dof, folds=folds), output)
    elif folds:
        raise click.UsageError(f"{file} holds no tracked folds; write it with fcm respond --track folds.")
    else:
        peaks = read_peaks(file)
        save_picture_of(lambda: draw_peak(peaks, dof=dof, against=against), output)
    messages.info(wrote(output))
