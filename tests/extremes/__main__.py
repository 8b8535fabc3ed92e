"""``python -m tests.extremes``: the stiff and extreme cases as a table; fails if one that passed does not."""

from __future__ import annotations

import json
import time
from pathlib import Path

import click

from fcm.cli.files import output_option
from fcm.cli.messages import Messages
from fcm.files import replacing

LOST = 1  # a defect of fcm


@click.command()
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option(
    "--known", type=click.Path(exists=True, dir_okay=False, path_type=Path), metavar="FILE",
    help="Names of the scenes that are known to pass, one a line.",
)  # fmt: skip
@output_option("-o", "--output", endings=(".json",), help="Write the rows as JSON as well.")
@click.pass_context
def main(ctx: click.Context, names: tuple[str, ...], known: Path | None, output: Path | None) -> None:
    """Measure the scenes of the catalogue, all of them by default, and print them as a table."""
    from fcm.scene.errors import choices, suggestion

    from .known import changes, read_known
    from .row import catalogue, measured
    from .show import as_data, as_text

    everything = catalogue()
    for name in names:
        if name not in everything:
            hint = suggestion(name, everything) or f"; there are {choices(everything)}"
            raise click.BadParameter(f"{name}: no such scene{hint}.", param_hint="NAME")
    messages, begin, rows = Messages(), time.perf_counter(), []
    for count, name in enumerate(names or everything):
        messages.progress(count / len(names or everything), name)
        rows.append(measured(name))
    messages.clear()
    click.echo(as_text(rows))
    if output is not None:
        with replacing(output) as partial:
            partial.write_text(json.dumps(as_data(rows), indent=2, allow_nan=False), encoding="utf-8")
    messages.info(f"{len(rows)} scenes in {time.perf_counter() - begin:.1f} s")
    lost, new = changes(rows, read_known(known)) if known is not None else ([], [])
    if new:
        messages.info(f"pass and are not in {known}: {', '.join(new)}")
    if lost:
        messages.error(f"error: passed before and do not pass now: {', '.join(lost)}")
        ctx.exit(LOST)


if __name__ == "__main__":
    main(prog_name="python -m tests.extremes")
