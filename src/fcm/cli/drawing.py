"""What the commands that draw share: angles on the command line, and the picture written whole."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.files import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def angles(_ctx: click.Context, _param: click.Parameter, texts: tuple[str, ...]) -> tuple[float, ...]:
    """Callback of an option for angles [rad]."""
    return tuple(map(_angle, texts))


def _angle(text: str) -> float:
    """A number of radians, or of degrees: 0.5, 15deg."""
    try:
        number = float(text.removesuffix("deg"))
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise click.BadParameter(f"{text!r} is no angle; it is a number of radians, or of degrees as 15deg.")
    return math.radians(number) if text.endswith("deg") else number


def shorten(name: str, most: int) -> str:
    """A name of at most so many characters.

    >>> shorten("a/long/name.nc", 8)
    'a/long/…'
    """
    return name if len(name) <= most else name[: most - 1] + "…"


def save_picture(figure: Figure, output: Path) -> None:
    """Write the picture; the file appears only when it is whole."""
    from fcm.plot.style import save

    with replacing(output) as partial:
        save(figure, partial)
