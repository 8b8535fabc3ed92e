"""``fcm plot surface``, ``error`` and ``normal``: pictures of the coefficients of one contact."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.drawing import ENDINGS, angles, save_picture, shorten
from fcm.cli.files import check_not_read, output_option, wrote
from fcm.cli.limits import REQUESTS
from fcm.cli.messages import Messages, pass_messages

if TYPE_CHECKING:
    from fcm.contact.surface import ParameterPlane

NORMAL_RANGE, NORMAL_POINTS = (-2.0, 2.0), 401  # from open to closed, as figure 12
SPACE_STEPS = (100, 40)  # of a surface in space; finer ones can not be seen


def _range(_ctx: click.Context, _param: click.Parameter, value: tuple[float, float]) -> tuple[float, float]:
    low, high = value
    if not -REQUESTS.farthest <= low < high <= REQUESTS.farthest:
        raise click.BadParameter(f"a lower and a higher number within ±{REQUESTS.farthest:g} are needed.")
    return value


def _positive_range(
    ctx: click.Context, param: click.Parameter, value: tuple[float, float]
) -> tuple[float, float]:
    if value[0] < 0.0:
        raise click.BadParameter("an amplitude is not negative.")
    return _range(ctx, param, value)


def _over_the_plane(output: str, phase: str) -> Callable[[Any], Any]:
    """The options of the pictures over (n0_bar, b_bar)."""
    options = (
        output_option(
            "-o", "--output", endings=ENDINGS, default=output, show_default=True,
            help="The picture to write: .png, .svg or .pdf.",
        ),
        click.option(
            "--coefficient", "coefficients", multiple=True, type=click.Choice(["F_b", "F_s", "F_c"]),
            default=("F_s", "F_c"), show_default=True,
            help="Mean force, stiffness or damping; may be repeated.",
        ),
        click.option(
            "--phi", "phases", multiple=True, default=(phase,), callback=angles,
            show_default=True, metavar="ANGLE",
            help="Phase of the normal motion before the tangential, in radians or as 15deg; may be repeated.",
        ),
        click.option(
            "--n0-bar", "n0_range", type=float, nargs=2, default=(-2.0, 3.0), show_default=True,
            metavar="LOW HIGH", callback=_range, help="Range of the preload mu n_0 / (k_u a).",
        ),
        click.option(
            "--b-bar", "b_range", type=float, nargs=2, default=(0.0, 2.0), show_default=True,
            metavar="LOW HIGH", callback=_positive_range,
            help="Range of the load variation mu k_v b / (k_u a).",
        ),
    )  # fmt: skip

    def add(command: Any) -> Any:
        for option in reversed(options):
            command = option(command)
        return command

    return add


def _panels(
    coefficients: tuple[str, ...],
    phases: tuple[float, ...],
    n0_range: tuple[float, float],
    b_range: tuple[float, float],
) -> list[tuple[str, ParameterPlane]]:
    """Coefficient and plane of each panel: with two phases, these side by side; else by phase."""
    from fcm.contact.surface import ParameterPlane

    coefficients, phases = tuple(dict.fromkeys(coefficients)), tuple(dict.fromkeys(phases))
    if (count := len(coefficients) * len(phases)) > REQUESTS.panels:
        raise click.UsageError(f"{count} panels are too many for a picture: at most {REQUESTS.panels}.")
    planes = [ParameterPlane(phi, n0_range, b_range) for phi in phases]
    if len(phases) == 2:
        return [(name, plane) for name in coefficients for plane in planes]
    return [(name, plane) for plane in planes for name in coefficients]


@click.command()
@_over_the_plane("surface.png", phase="0")
@click.option(
    "--table", type=click.Path(), metavar="FILE", help="Draw what this table has.  [default: the closed form]"
)
@click.option(
    "--contour", is_flag=True, help="Filled contours with the regimes, instead of surfaces in space."
)
@pass_messages
def surface(
    messages: Messages,
    output: Path,
    coefficients: tuple[str, ...],
    phases: tuple[float, ...],
    n0_range: tuple[float, float],
    b_range: tuple[float, float],
    table: str | None,
    contour: bool,
) -> None:
    """Draw the friction coefficients over preload and load variation, as figures 10 and 11.

    The contours show where the contact is open, separates, slips or sticks. Each region names its sequence
    of states: E stick, P and N positive and negative slip, S separation.
    """
    from fcm.contact.surface import STEPS, regions
    from fcm.contact.surface import surface as evaluate
    from fcm.plot.surface import draw_contours, draw_surfaces

    shown = _panels(coefficients, phases, n0_range, b_range)
    check_not_read({"-o": output}, [table])
    law: dict[str, Any] = {} if table is None else {"law": _opened(table)}
    steps = STEPS if contour else SPACE_STEPS
    surfaces = [evaluate(name, plane, steps, **law) for name, plane in shown]
    if contour:
        figure = draw_contours(surfaces, [regions(plane) for _, plane in shown])
    else:
        figure = draw_surfaces(surfaces)
    save_picture(figure, output)
    messages.info(f"{wrote(output)}: from {table or 'the closed form'}")


@click.command()
@_over_the_plane("error.png", phase="30deg")
@click.option(
    "--table", type=click.Path(), metavar="FILE", help="The table to compare.  [default: the shipped one]"
)
@pass_messages
def error(
    messages: Messages,
    output: Path,
    coefficients: tuple[str, ...],
    phases: tuple[float, ...],
    n0_range: tuple[float, float],
    b_range: tuple[float, float],
    table: str | None,
) -> None:
    """Draw the error of a table against the closed form, over preload and load variation.

    The colours mean the same in every such picture. The worst point is marked, named and printed.
    """
    from fcm.plot.table_error import draw_errors
    from fcm.table.error_map import error_map

    shown = _panels(coefficients, phases, n0_range, b_range)
    check_not_read({"-o": output}, [table])
    opened = _opened(table)
    maps = [error_map(name, plane, opened) for name, plane in shown]
    name = "the shipped table" if table is None else Path(table).name
    save_picture(draw_errors(maps, f"Error of {shorten(name, REQUESTS.longest_name)}"), output)
    worst = max(maps, key=lambda one: one.largest)
    n0, b = worst.worst
    messages.info(
        f"{wrote(output)}: greatest error {worst.largest:.1e}, of {worst.coefficient} "
        f"at n0_bar {n0:.4g}, b_bar {b:.4g}, phi {worst.plane.phi:.4g} rad"
    )


@click.command()
@output_option(
    "-o", "--output", endings=ENDINGS, default="normal.png", show_default=True,
    help="The picture to write: .png, .svg or .pdf.",
)  # fmt: skip
@pass_messages
def normal(messages: Messages, output: Path) -> None:
    """Draw the coefficients of the variable normal load against its preload, as figure 12."""
    import numpy as np

    from fcm.contact import normal_coefficients
    from fcm.plot.normal import draw_normal

    n0_star = np.linspace(*NORMAL_RANGE, NORMAL_POINTS)
    save_picture(draw_normal(n0_star, *normal_coefficients(n0_star)), output)
    messages.info(wrote(output))


def _opened(table: str | None) -> Any:
    from fcm.table import open_table

    return open_table(table)
