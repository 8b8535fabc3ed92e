"""Shared parts of the commands that draw: angles on the command line, and writing of pictures."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.files import check_not_read, check_output, output_option
from fcm.cli.limits import SENTENCES
from fcm.cli.messages import Messages
from fcm.files import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ENDINGS = (".png", ".svg", ".pdf")
PAGE = ".html"


def draws_file(ending: str, page: bool = False) -> Callable[[Any], Any]:
    """The argument FILE and the option -o of a command that draws a file of results, as a page too."""
    kinds = ".png, .svg or .pdf, or a page to look into, .html" if page else ".png, .svg or .pdf"
    option = output_option(
        "-o", "--output", endings=(*ENDINGS, PAGE) if page else ENDINGS,
        help=f"The picture to write: {kinds}.  [default: FILE with the ending {ending}]",
    )  # fmt: skip
    kind = click.Path(exists=True, dir_okay=False, readable=True, path_type=Path)
    return lambda command: click.argument("file", type=kind)(option(command))


solution_option = click.option(
    "--solution", type=click.IntRange(min=1), metavar="K",
    help="On a folded curve only the K-th, that of the greatest amplitude being 1.",
)  # fmt: skip


def picture_of(file: Path, output: Path | None, ending: str, *read: Path | None, page: bool = False) -> Path:
    """Path of the picture of a result file, checked not to be one of the files that are read."""
    if output is None and file.suffix == ending:
        raise click.UsageError(
            f"{str(file)!r} is not a netCDF file of results; fcm respond SCENE -o {file.stem}.nc writes one."
        )
    output = output or file.with_name(file.stem + ending)
    check_output(output, (*ENDINGS, PAGE) if page else ENDINGS)
    check_not_read({"-o": output}, [file, *read])
    return output


def is_page(output: Path) -> bool:
    """Whether the output is an interactive page."""
    return output.suffix.lower() == PAGE


def angles(ctx: click.Context, param: click.Parameter, texts: tuple[str, ...]) -> tuple[float, ...]:
    """Callback of an option for angles [rad]; warns of large angles without a unit."""
    from fcm.units import ANGLES  # which takes numpy

    found = tuple(map(angle, texts))
    for text, radians in zip(texts, found, strict=True):
        if abs(radians) >= ANGLES.largest and not text.endswith("deg"):
            ctx.ensure_object(Messages).warning(
                f"{param.opts[0]} {text}: is it right? {text} rad are {abs(radians) / (2.0 * math.pi):.3g} "
                f"turns; if degrees are meant, write {text}deg"
            )
    return found


def angle(text: str) -> float:
    """A number of radians, or of degrees: 0.5, 15deg."""
    try:
        number = float(text.removesuffix("deg"))
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise click.BadParameter(f"{text!r} is no angle: give a number of radians, or degrees as 15deg.")
    return math.radians(number) if text.endswith("deg") else number


def shorten(name: str, most: int) -> str:
    """A name of at most so many characters.

    >>> shorten("a/long/name.nc", 8)
    'a/long/…'
    """
    return name if len(name) <= most else name[: most - 1] + "…"


def save_picture(figure: Figure, output: Path) -> None:
    """Write the picture; the file appears only when complete. Warns of characters that no font has."""
    from fcm.plot.style import lacking, save

    if letters := lacking(figure):
        from fcm.scene.errors import choices  # which takes numpy

        context = click.get_current_context(silent=True)
        messages = (context and context.find_object(Messages)) or Messages()
        messages.warning(f"{output}: the fonts lack {choices(letters)}, which are boxes in the picture")
    with replacing(output) as partial:
        save(figure, partial)


def save_picture_of(drawn: Callable[[], Figure], output: Path) -> None:
    """Draw the picture of a result file, whose numbers are already checked, and write it."""
    with drawing():
        save_picture(drawn(), output)


@contextmanager
def drawing() -> Iterator[None]:
    """Context for drawing data from a file; ignores RuntimeWarning, as numbers may overflow when summed."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        yield


def not_at(wanted: float, there: Sequence[float], unit: str) -> str:
    """Message that the nearest points of a file are drawn instead of the requested place; empty if at it."""
    off = [f"{at:.6g}" for at in there if abs(at - wanted) > SENTENCES.resolution * 1e-3 * abs(wanted)]
    if not off:
        return ""
    told = f" {unit}" if unit not in ("", "level") else ""
    closer = "A smaller --max-step of fcm respond has nearer ones"
    return f"at {wanted:.6g}: drawn is the nearest point of the file, at {', '.join(off)}{told}. {closer}"
