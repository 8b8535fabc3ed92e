"""``fcm tabulate``: build a table of the Fourier coefficients, or check one against the closed form."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.files import alone, output_option, wrote
from fcm.cli.guard import NOT_COMPLETED
from fcm.cli.interruptible import Interruptible
from fcm.cli.limits import REQUESTS, SENTENCES
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.options import complete_scene
from fcm.cli.table_study import write_study
from fcm.cli.terminal import plain

if TYPE_CHECKING:
    from collections.abc import Callable

    from fcm.table import Table
    from fcm.table.tabulated import Resolution

DEFAULT_OUTPUT = "table.nc"


@click.command()
@output_option(
    "-o", "--output", endings=(".nc",), default=DEFAULT_OUTPUT, show_default=True, help="The file to write."
)
@click.option(
    "--preset", type=click.Choice(["default", "fast"]), default="default", show_default=True,
    help="As the shipped tables: error below 2e-4 in 11 MB, or 2e-3 in 1 MB.",
)  # fmt: skip
@click.option(
    "--nodes", type=int, nargs=4, metavar="U U X Z", callback=lambda _ctx, _param, value: _resolution(value),
    help="Nodes of your own: along n0_bar in separation and in slip, b_bar, phi.  [default: the preset's]",
)  # fmt: skip
@click.option(
    "--for", "scene", metavar="SCENE", shell_complete=complete_scene,
    help="Only the part of the table that the response of this scene looks up.",
)  # fmt: skip
@click.option(
    "--points", type=click.IntRange(10_000, 100_000_000), default=1_000_000, show_default=True,
    help="At how many points the error is measured.",
)  # fmt: skip
@click.option(
    "--verify", type=click.Path(path_type=Path), metavar="FILE",
    help="Build nothing: measure the error of FILE anew and compare it with the one FILE records.",
)  # fmt: skip
@output_option(
    "--study",
    endings=(".csv",),
    help="Build nothing: measure error against size and time for tables of several layouts. They are "
    "written to this .csv, and drawn in a .png beside it.",
)
@click.option("--json", "to_json", is_flag=True, help="Print the error as JSON instead of a table.")
@click.pass_context
@pass_messages
def tabulate(
    messages: Messages,
    ctx: click.Context,
    output: Path,
    preset: str,
    nodes: Resolution | None,
    scene: str | None,
    points: int,
    verify: Path | None,
    study: Path | None,
    to_json: bool,
) -> None:
    """Build a table of the Fourier coefficients of friction from their closed form.

    The table covers every preload, gap, load variation and phase. Its error is measured against the
    closed form in all regimes and corners, recorded in the file and printed.
    """
    if verify is not None:
        _alone(ctx, "verify")
        _verify(messages, verify, to_json)
    elif study is not None:
        _alone(ctx, "study")
        with alone([study]):
            write_study(messages, study, to_json)
    else:
        from fcm.table.nodes import PRESETS

        if scene is not None and ctx.get_parameter_source("points") is click.core.ParameterSource.DEFAULT:
            points = REQUESTS.points_of_part
        with alone([output]):
            _build(messages, output, nodes or PRESETS[preset], scene, points, to_json)


def _resolution(value: tuple[int, int, int, int] | None) -> tuple[int, int, int, int] | None:
    if value is None:
        return None
    from fcm.table.nodes import problem

    if reason := problem(value):
        raise click.BadParameter(f"{reason}.")
    return value


def _alone(ctx: click.Context, option: str) -> None:
    """Raise a usage error if an option that builds no table is combined with others of this command."""
    for name in {"output", "preset", "nodes", "scene", "points", "verify", "study"} - {option}:
        if ctx.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
            raise click.UsageError(f"--{'for' if name == 'scene' else name} is of no use with --{option}.")


def _build(
    messages: Messages, output: Path, resolution: Resolution, scene: str | None, points: int, to_json: bool
) -> None:
    from fcm.cli.partial_table import reached, saving
    from fcm.run.progress import part as share
    from fcm.table import build_table

    began = time.perf_counter()
    with Interruptible(messages, f"nothing was written, {output} is as it was") as progress:
        made_by = f"fcm tabulate --nodes {' '.join(map(str, resolution))} --points {points}"
        part, begin = None, 0.0
        if scene is not None:
            part, begin = (
                reached(messages, scene, output, resolution, share(progress, 0.0, SENTENCES.response_share)),
                SENTENCES.response_share,
            )
        made_by += "" if scene is None else f" --for {plain(scene)}"
        table = build_table(output, resolution, points, share(progress, begin, 1.0), made_by, part)
    seconds = time.perf_counter() - began
    size = output.stat().st_size
    result = {
        "file": str(output),
        "bytes": size,
        "resolution": list(resolution),
        "seconds": seconds,
        "error": table.error,
    }
    if part is not None:
        result["part"], sentence = saving(output, part)
        messages.info(sentence)
    click.echo(json.dumps(result, indent=2, allow_nan=False) if to_json else _as_table(table.error))
    messages.info(f"{wrote(output)}: {size / 1e6:.1f} MB in {seconds:.1f} s; {_error_line(table.error)}")


def _verify(messages: Messages, path: Path, to_json: bool) -> None:
    from fcm.table import open_table
    from fcm.table.error import disagreement

    table = open_table(path)
    began = time.perf_counter()
    recorded = table.error
    if "points" not in recorded:
        raise click.UsageError(f"{path} records no error that could be verified.")
    with Interruptible(messages, "the table was not verified") as progress:
        again = _measured(table, 0, lambda share: progress(share / 2, "same points"))
        fresh = _measured(table, 1, lambda share: progress((1 + share) / 2, "new points"))
    found = disagreement(recorded, again, fresh)
    result = {
        "file": str(path),
        "true": not found,
        "seconds": time.perf_counter() - began,
        "recorded": recorded,
        "measured": again,
        "measured_at_new_points": fresh,
    }
    click.echo(json.dumps(result, indent=2, allow_nan=False) if to_json else _as_table(fresh))
    if found:
        messages.error(f"error: {path}: the recorded error is not true: {found}")
        click.get_current_context().exit(NOT_COMPLETED)
    messages.info(f"{path}: as recorded, in {result['seconds']:.1f} s; {_error_line(fresh)}")


def _measured(table: Table, later: int, progress: Callable[[float], None]) -> dict[str, Any]:
    """The error of a table at its recorded number of points; `later` shifts the seed that draws them."""
    from fcm.table.error import error_of, sample

    recorded, drawn = table.error, sample if table.part.whole else table.part.sample
    return error_of(table, recorded["points"], recorded["seed"] + later, progress, drawn)


def _as_table(error: dict[str, Any]) -> str:
    """Error by regime and coefficient, with the point of the greatest."""
    lines = [f"{'regime':<11}{'':<5}{'max':>8}{'99.9 %':>9}{'rms':>9}  worst at (n0_bar, b_bar, phi)"]
    for regime, parts in error["regimes"].items():
        for name in ("F_b", "F_s", "F_c"):
            part = parts[name]
            point = ", ".join(f"{value:.6g}" for value in part["worst"])
            numbers = f"{part['max']:8.1e} {part['p999']:8.1e} {part['rms']:8.1e}"
            lines.append(f"{regime:<11}{name:<5}{numbers}  ({point})")
    return "\n".join(lines)


def _error_line(error: dict[str, Any]) -> str:
    return f"error at {error['points']} points {error['max']:.1e} at most, {error['rms']:.1e} rms"
