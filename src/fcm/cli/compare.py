"""``fcm respond SCENE --compare``: a scene by every method, error against run time."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.columns import aligned
from fcm.cli.files import wrote
from fcm.cli.guard import NOT_COMPLETED
from fcm.cli.messages import Messages

if TYPE_CHECKING:
    from fcm.model.scene import Scene

OF_NO_USE = {  # options of no use with --compare, and the reasons
    "method": "it runs every method",
    "at": "it compares whole curves",
    "only": "it compares whole curves",
    "periods": "it compares motions that repeat after each period",
    "level": "it compares curves over the range of frequencies",
    "mode": "it compares curves over the range of frequencies",
    "force_levels": "it compares curves over the range of frequencies",
    **dict.fromkeys(("track", "over", "low", "high"), "it compares whole curves"),
    "sensitivity": "it compares heights and frequencies",
    "harmonics": "its balances have one harmonic",
    "accuracy": "its balances have one harmonic",
    "history_csv": "it simulates no schedule",
    "csv": "it has no curves to write; -o FILE.nc holds the errors",
    "jobs": "the methods are timed on one core",
    "cluster": "the methods are timed on one core",
    "peaks_only": "it has no curves to write; -o FILE.nc holds the errors",
    "time_limit": "each of its exact curves has one of its own",
    "resume": "it is not kept in between",
    "keep_all": "it runs every method with and without what is left out",
}


def refuse_other_options() -> None:
    """Raise a usage error if an option was given that is of no use with --compare."""
    context = click.get_current_context()
    for param in context.command.params:
        given = context.get_parameter_source(param.name or "") is click.core.ParameterSource.COMMANDLINE
        if given and param.name in OF_NO_USE:
            raise click.UsageError(f"{param.opts[0]} is of no use with --compare: {OF_NO_USE[param.name]}.")


def write_comparison(
    messages: Messages, scene: Scene, table: str | None, tolerance: float, output: Path | None, to_json: bool
) -> None:
    """Run a comparison, write it and print it."""
    if not scene.has_range:
        raise click.UsageError(f"--compare needs curves; {scene.name} has no [response] frequency.")
    from fcm.compare import IncomparableError, compare
    from fcm.compare.options import COMPARE
    from fcm.compare.output import summary, write_netcdf

    try:
        options = messages.settings.compare or COMPARE
        own = None if table is None else Path(table)
        comparison = compare(scene, own, messages.progress, tolerance, options)
    except IncomparableError as error:
        messages.error(f"error: {error}")
        click.get_current_context().exit(NOT_COMPLETED)
    messages.clear()
    result = summary(comparison)
    try:
        if output is not None:
            write_netcdf(comparison, output)
            messages.info(wrote(output))
    finally:  # a full disk does not take the result away
        click.echo(json.dumps(result, indent=2, allow_nan=False) if to_json else as_text(result))
    _close(messages, result)


def as_text(summary: dict[str, Any]) -> str:
    """Text of the tables of a comparison."""
    from fcm.compare.tables import every, marked

    parts = [aligned(_to_the_left(rows), left=0) for rows in every(summary)]
    return "\n\n".join([*parts, *filter(None, ["\n".join(marked(summary))])])


def _to_the_left(rows: list[list[str]]) -> list[list[str]]:
    """Pad the first column, so that it is aligned to the left among columns aligned to the right."""
    width = max(len(row[0]) for row in rows)
    return [[row[0].ljust(width), *row[1:]] for row in rows]


def _close(messages: Messages, summary: dict[str, Any]) -> None:
    for text in summary["left_out"]:
        messages.info(f"left out: {text}")
    for text in summary["without_exact"]:
        messages.warning(f"no exact reference, compared with the closed form alone: {text}")
    for text in summary["notes"]:
        messages.warning(text)
    own = summary["references"]["exact"]["own_error"]["peak"]
    error = "no exact reference" if own is None else f"the exact peaks are known to {own:.0e}"
    messages.info(f"{len(summary['runs'])} runs in {summary['seconds']:.1f} s; {error}")
    if not summary["complete"]:
        messages.error("error: interrupted; the runs that were finished are reported and written")
        click.get_current_context().exit(NOT_COMPLETED)
