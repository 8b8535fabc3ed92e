"""``fcm respond SCENE``: the response curves of a scene."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fcm.cli.files import output_option, replacing
from fcm.cli.guard import NOT_COMPLETED
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.report import as_json, as_table, cost_and_error, incomplete

if TYPE_CHECKING:
    from fcm.response import Response
    from fcm.scene.model import Scene


def _a_step(_ctx: click.Context, _param: click.Parameter, value: float | None) -> float | None:
    if value is None:
        return None
    from fcm.scene.rules import FRACTION

    if fault := FRACTION.fault(value):
        raise click.BadParameter(f"{fault}.")
    return value


@click.command()
@click.argument("scene", metavar="SCENE")
@output_option("-o", "--output", endings=(".nc",), help="Write the curves as netCDF.")
@output_option("--csv", endings=(".csv",), help="Write the curves as CSV.")
@click.option("--json", "to_json", is_flag=True, help="Print the summary as JSON instead of a table.")
@click.option(
    "--method", type=click.Choice(["table", "closed-form"]), default="table", show_default=True,
    help="Where the friction coefficients come from.",
)  # fmt: skip
@click.option(
    "--table", type=click.Path(), metavar="FILE", help="A table of your own.  [default: the shipped one]"
)
@click.option(
    "--max-step", type=float, metavar="X", callback=_a_step,
    help="Longest step along a curve, relative to its extent.  [default: the scene's]",
)  # fmt: skip
@pass_messages
def respond(
    messages: Messages,
    scene: str,
    output: Path | None,
    csv: Path | None,
    to_json: bool,
    method: str,
    table: str | None,
    max_step: float | None,
) -> None:
    """Trace the response curves of SCENE, a TOML file or the name of a bundled scene.

    The peaks, folds and errors of every curve are printed; the curves go to files.
    """
    if table is not None and method != "table":
        raise click.UsageError("--table is of no use with --method closed-form.")
    response = _traced(messages, scene, method, table, max_step)
    _write(messages, response, output, csv)
    _print(messages, response, to_json)
    stopped = incomplete(response)
    if stopped:
        messages.error(f"error: {stopped}; what was traced is reported and written")
        click.get_current_context().exit(NOT_COMPLETED)


def _traced(
    messages: Messages, scene: str, method: str, table: str | None, max_step: float | None
) -> Response:
    from fcm.response import trace
    from fcm.scene import load_scene
    from fcm.table import open_table

    loaded = load_scene(scene)
    if max_step is not None:
        loaded = _with_step(loaded, max_step)
    opened = None if table is None else open_table(table)
    response = trace(loaded, method=method, table=opened, progress=messages.progress)
    messages.clear()
    return response


def _with_step(scene: Scene, max_step: float) -> Scene:
    curves = tuple(replace(curve, max_step=max_step) for curve in scene.curves)
    return replace(scene, max_step=max_step, curves=curves)


def _write(messages: Messages, response: Response, output: Path | None, csv: Path | None) -> None:
    from fcm.response.output import write_csv, write_netcdf

    for path, write in ((output, write_netcdf), (csv, write_csv)):
        if path is not None:
            with replacing(path) as partial:
                write(response, partial)
            messages.info(f"wrote {path}")


def _print(messages: Messages, response: Response, to_json: bool) -> None:
    from fcm.response.output import summary

    result = summary(response)
    click.echo(as_json(result) if to_json else as_table(result, response.frequency_unit))
    for name in response.left_out:
        messages.info(f"left out: {name}")
    messages.info(cost_and_error(result))
