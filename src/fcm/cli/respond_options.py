"""The options of ``fcm respond``, and their values."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import wrap
from typing import Any

import click

from fcm.cli import balance, exact
from fcm.cli.export import export_options
from fcm.cli.files import largest_file_option, output_option
from fcm.cli.limits import SENTENCES
from fcm.cli.options import FiniteRange
from fcm.cli.time_limit import seconds
from fcm.cli.track import track_options
from fcm.frozen import Frozen


def _printed(text: str) -> None:
    click.echo(text)
    click.get_current_context().exit()


def _keys(_ctx: click.Context, _param: click.Parameter, wanted: bool) -> None:
    if wanted:
        from fcm.scene.keys import as_lines

        _printed("\n".join(map(_of_key, as_lines())))


def _of_key(line: tuple[str, str, str, str]) -> str:
    """A key with its meaning, and below it the kind of value and the default.

    >>> print(_of_key(("force[].phase", "number", "0", "of the force")))
    force[].phase: of the force
        number; without it: 0
    """
    key, kind, default, meaning = line
    needed = f"; {default}" if default.startswith(("required", "needed")) else f"; without it: {default}"
    width = SENTENCES.width - 20
    said = wrap(f"{key}: {meaning}", width, subsequent_indent="    ", break_long_words=False)
    may_be = wrap(
        kind + needed, width, initial_indent="    ", subsequent_indent="    ", break_long_words=False
    )
    return "\n".join([*said, *may_be])


def _template(_ctx: click.Context, _param: click.Parameter, wanted: bool) -> None:
    if wanted:
        _printed((Path(__file__).parents[1] / "scene" / "template.toml").read_text("utf-8").rstrip("\n"))


def about_scenes(command: Any) -> Any:
    """The options --keys and --template."""
    keys = click.option(
        "--keys", is_flag=True, is_eager=True, expose_value=False, callback=_keys,
        help="Print every key of a scene and end.",
    )  # fmt: skip
    template = click.option(
        "--template", is_flag=True, is_eager=True, expose_value=False, callback=_template,
        help="Print a commented scene with every key and end.",
    )  # fmt: skip
    return keys(template(command))


def _a_step(_ctx: click.Context, _param: click.Parameter, value: float | None) -> float | None:
    if value is None:
        return None
    from fcm.scene.rules import step_fault

    if fault := step_fault(value):
        raise click.BadParameter(f"{fault}.")
    return value


OPTIONS: list[Callable[[Any], Any]] = [  # in the order of the help
    output_option("-o", "--output", endings=(".nc",), help="Write the curves, and the motion, as netCDF."),
    output_option("--csv", endings=(".csv",),
        help="Write the curves as CSV, of response.output where there is one; without any, the motion."),
    output_option("--history-csv", endings=(".csv",), help="Write the motion of the schedule as CSV."),
    export_options,
    click.option("--json", "to_json", is_flag=True, help="Print the summary as JSON instead of a table."),
    click.option(
        "--method", type=click.Choice(["table", "closed-form", "exact"]), default="table", show_default=True,
        help=(
            "table and closed-form: harmonic balance, with or without the error of a table of its "
            "coefficients. exact: exact periodic solutions."
        ),
    ),
    click.option(
        "--harmonics", metavar="H", callback=balance.harmonics,
        help="Harmonics that are balanced: up to a number from 1 to 50, or as 1,2,3,9 or 1-3,9.  "
        "[default: the scene's, or as --accuracy]",
    ),
    click.option(
        "--accuracy", metavar="E", callback=balance.accuracy,
        help="Relative error that the greatest peaks and folds may have: as many harmonics as that takes.  "
        "[default: the scene's, or 0.01]",
    ),
    click.option(
        "--level", metavar="FROM:TO", callback=balance.level,
        help="Follow the level of the forces instead, all amplitudes times this, at the frequency --at; "
        "static loads stay.",
    ),
    click.option(
        "--mode", type=click.IntRange(min=1), metavar="N",
        help="Follow the nonlinear mode N instead: its frequency and damping against its modal amplitude, "
        "over the span --level. Counted from 1 with the contacts as at rest, without rigid-body modes. The "
        "table says what a modal amplitude of 1 is at the degrees of freedom.",
    ),
    click.option(
        "--force-level", "force_levels", type=FiniteRange(min=0.0, min_open=True), multiple=True,
        metavar="L",
        help="With --mode: predict the response near the resonance for the scene's forces times this; again "
        "for more.  [default: 1]",
    ),
    click.option(
        "--at", multiple=True, metavar="F", callback=exact.frequencies,
        help="With --method exact: visit these frequencies by an upward and a downward sweep; a number or "
        "FROM:TO:COUNT, again for more. With --level: follow the levels at these. They may lie beyond "
        "the scene's range.",
    ),
    track_options,
    click.option(
        "--only", type=click.Choice(["peaks"]),
        help="Peaks, folds and jumps alone, near those of harmonic balance. With --method exact.",
    ),
    click.option(
        "--periods", type=click.Choice([1, 2, 4, 8]), default=1, show_default=True,
        help="Follow also motions that repeat only after so many periods of the force, from where the period "
        "doubles. With --method exact.",
    ),
    click.option(
        "--table", type=click.Path(), metavar="FILE", help="A table of your own.  [default: the shipped one]"
    ),
    click.option(
        "--max-step", type=float, metavar="X", callback=_a_step,
        help="Longest step along a curve, relative to its extent.  [default: the scene's]",
    ),
    click.option(
        "--jobs", type=click.IntRange(min=0), default=0, metavar="N",
        help="Processes for sweeps of many curves; 0 for one on each core.  [default: 0]",
    ),
    click.option(
        "--cluster", metavar="ADDRESS",
        help=(
            "Instead of processes, the workers of the dask.distributed scheduler there, as in "
            "tcp://127.0.0.1:8786."
        ),
    ),
    click.option(
        "--time-limit", type=float, metavar="SECONDS", callback=seconds,
        help="Stop after this time, and keep what is finished, as Ctrl-C does; see --resume.",
    ),
    click.option(
        "--resume", is_flag=True,
        help="Continue an interrupted run with the same -o FILE. Finished curves of a sweep are not "
        "traced again; one that was begun is, from its start. With --method exact it goes on from its last "
        "point.",
    ),
    click.option(
        "--leave-out-tolerance", "tolerance", type=FiniteRange(min=0.0), default=1e-5, show_default=True,
        metavar="X",
        help="What is left out, as modes far above the range, may change the response by this, relative.",
    ),
    click.option(
        "--peaks-only", is_flag=True, help="Write peaks, folds and errors of each curve, not its points."
    ),
    click.option(
        "--sensitivity", is_flag=True,
        help="Derivatives of every peak, its height and its frequency, by the numbers of the scene.",
    ),
    click.option("--keep-all", is_flag=True, help="Leave nothing out, as modes far above the range."),
    largest_file_option,
    about_scenes,
    click.option(
        "--compare",
        is_flag=True,
        help="Run the scene by every method: error against run time, instead of curves.",
    ),
]  # fmt: skip


def respond_options(command: Any) -> Any:
    """Decorator that adds all options of the command."""
    for option in reversed(OPTIONS):
        command = option(command)
    return command


class Asked(Frozen):
    """Values of the command line options, by their names."""

    output: Path | None
    csv: Path | None
    history_csv: Path | None
    export: Path | None
    mesh: Path | None
    contact_forces: Path | None
    modal_amplitudes: bool
    motion_at: tuple[float, ...]
    to_json: bool
    method: str
    harmonics: tuple[int, ...] | None
    accuracy: float | None
    level: tuple[float, float] | None
    mode: int | None
    force_levels: tuple[float, ...]
    at: tuple[float, ...] | None
    track: str | None
    over: str | None
    low: float | None
    high: float | None
    only: str | None
    periods: int
    table: str | None
    max_step: float | None
    jobs: int
    cluster: str | None
    time_limit: float | None
    resume: bool
    tolerance: float
    peaks_only: bool
    sensitivity: bool
    keep_all: bool
    largest_file: int
    compare: bool
