"""``fcm plot WHAT``: pictures of what the other commands have written, and of the coefficients."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.cli.drawing import drawing, draws_file, is_page, picture_of, save_picture_of
from fcm.cli.files import wrote
from fcm.cli.lazy import LazyGroup
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.options import FiniteRange
from fcm.files import MEASURED, replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure


PICTURES = {
    "response": ("fcm.cli.plot:response", "Amplitude against frequency, one line a curve."),
    "modes": ("fcm.cli.modes:modes", "The modes of a scene and what moves them, as a table."),
    "mode": ("fcm.cli.plot:mode", "Frequency and damping of a nonlinear mode against amplitude."),
    "campbell": ("fcm.cli.campbell:campbell", "Frequencies of a ring of sectors by nodal diameter."),
    "history": ("fcm.cli.history:history", "Motion through the phases of a schedule."),
    "peak": ("fcm.cli.peak:peak", "Peak amplitude and frequency against what was swept."),
    "sensitivity": ("fcm.cli.plot:sensitivity", "What each number of the scene does to a peak."),
    "accuracy": ("fcm.cli.plot:accuracy", "Error against run time, one line a method."),
    "loop": ("fcm.cli.loop:loop", "Hysteresis loops of a contact, given or of a response."),
    "contacts": ("fcm.cli.interface:contacts", "Which contacts stick, slip and open, and what they bear."),
    "pairs": ("fcm.cli.pairs:pairs", "Which nodes of two sets are pairs, and how far apart they are."),
    "surface": ("fcm.cli.coefficients:surface", "Friction coefficients over preload and load variation."),
    "error": ("fcm.cli.coefficients:error", "Error of a table over the same plane."),
    "normal": ("fcm.cli.coefficients:normal", "Coefficients of the variable normal load."),
}


@click.group(cls=LazyGroup, lazy=PICTURES)
def plot() -> None:
    """Draw a result, or the coefficients of one contact."""


@click.command()
@draws_file(".png", page=True)
@click.option(
    "--dof", metavar="NAME",
    help="The degree of freedom to draw.  [default: the first; of more than 4 that of the greatest peak]",
)  # fmt: skip
@click.option(
    "--log/--linear", default=None,
    help="Amplitude axis.  [default: logarithmic if the peaks span more than a decade]",
)  # fmt: skip
@click.option("--errors/--no-errors", default=True, show_default=True, help="A panel of the curves' errors.")
@click.option(
    "--points", type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path), metavar="FILE",
    help="To mark over the curves: exact motions, the file of `fcm respond --method exact -o FILE`. Or "
    "measured points with the columns frequency and amplitude (.csv, .mat, .npz, .uff).",
)  # fmt: skip
@click.option(
    "--backbone", type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path), metavar="FILE",
    help="To draw over the curves: nonlinear modes, the file of `fcm respond --mode N -o FILE`.",
)  # fmt: skip
@click.option(
    "--band", type=FiniteRange(0.0, 100.0), nargs=2, metavar="LOW HIGH",
    help="Instead of curves of random draws, these percentiles of the greatest stable amplitude at each "
    "frequency, and the median.",
)  # fmt: skip
@click.option(
    "--window", type=FiniteRange(min=0.0), nargs=2, metavar="FROM TO",
    help="Draw only this part of the axis, as beside a sharp peak.  [default: all]",
)  # fmt: skip
@pass_messages
def response(
    messages: Messages,
    file: Path,
    output: Path | None,
    dof: str | None,
    log: bool | None,
    errors: bool,
    points: Path | None,
    backbone: Path | None,
    band: tuple[float, float] | None,
    window: tuple[float, float] | None,
) -> None:
    """Draw the response curves of FILE, the netCDF file of `fcm respond -o FILE`.

    Unstable parts are dashed. Parts of unknown stability are dotted. A cross is where a curve that is not
    complete ends; above the axes stands why. The errors of the curves are drawn below
    them, where the file has them. Of a mistuned ring the envelope over its sectors is drawn, unless --dof is
    of one, as tip@3. A page (.html) has every degree of freedom, and the numbers of the
    point under the mouse.
    """
    from fcm.plot import draw_response, read_points, read_response
    from fcm.plot.backbone import read_backbone
    from fcm.plot.measured import read_measured_points

    output = picture_of(file, output, ".png", points, backbone, page=True)
    if window is not None and not window[0] < window[1]:
        raise click.UsageError(f"--window {window[0]:g} {window[1]:g}: give the lower end first.")
    if window is not None and (band is not None or is_page(output)):
        raise click.UsageError("--window is of curves in .png, .svg or .pdf, without --band.")
    if is_page(output):
        if band is not None or points is not None or backbone is not None:
            raise click.UsageError(
                "a page has curves alone; write --band, --points and --backbone to .png, .svg or .pdf."
            )
        from fcm.plot.interactive import response_page

        with drawing(), replacing(output) as partial:
            response_page(read_response(file), dof, log, partial)
        messages.info(wrote(output))
        return
    if band is not None:
        if backbone is not None:
            raise click.UsageError("--backbone is drawn over curves; --band draws none.")
        save_picture_of(lambda: _bands(file, dof, log, points, band), output)
        messages.info(wrote(output))
        return
    read = read_response(file)
    marked = None
    if points is not None and points.suffix.lower() in MEASURED:
        own = read_measured_points(points, read.frequency_unit, read.length)
        read = replace(read, measured=(*read.measured, own))
    elif points is not None:
        marked = read_points(points)
    modes = None if backbone is None else read_backbone(backbone)
    save_picture_of(lambda: draw_response(read, dof, log, errors, marked, modes, window), output)
    messages.info(wrote(output))


def _bands(
    file: Path, dof: str | None, log: bool | None, points: Path | None, band: tuple[float, float]
) -> Figure:
    """Figure of the option --band."""
    import numpy as np

    from fcm.plot import read_response
    from fcm.plot.band import banded_column, draw_bands
    from fcm.plot.read import wide
    from fcm.results.bands import bands_of

    if not band[0] < band[1]:
        raise click.UsageError(f"--band {band[0]:g} {band[1]:g}: the percentages must rise, as in 5 95.")
    if points is not None:
        raise click.UsageError("--points are marked over curves; --band draws none.")
    read = read_response(file)
    column = banded_column(read, dof)
    curves = [curve for curve in read.curves if np.isfinite(curve.amplitude[:, column]).any()]
    bands = bands_of(curves, read.drawn, column, band, wide(curves))
    return draw_bands(read, column, bands, band, log)


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
    messages.info(wrote(output))


@click.command()
@draws_file("-sensitivity.png")
@click.option(
    "--dof", metavar="NAME",
    help="The degree of freedom to draw.  [default: the first; of more than 4 that of the greatest peak]",
)  # fmt: skip
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
    messages.info(wrote(output))


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
    messages.info(wrote(output))
