"""``fcm respond SCENE``: the response curves of a scene."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli import balance, exact, nonlinear_mode, of_peaks, schedule
from fcm.cli import cluster as cluster_option
from fcm.cli import track as tracking
from fcm.cli.about_scenes import about_scenes
from fcm.cli.curves import all_lost_to_defects, branches_unsure, cost_and_error, incomplete, short_of_accuracy
from fcm.cli.files import check_different, largest_file_option, output_option
from fcm.cli.guard import DEFECT, NOT_COMPLETED
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.outputs import Outputs
from fcm.cli.time_limit import TimeLimit, seconds

if TYPE_CHECKING:
    from fcm.response import Response
    from fcm.scene.model import Scene

MANY_POINTS = 30_000  # some seconds, and files of 10 MB and more


def _a_step(_ctx: click.Context, _param: click.Parameter, value: float | None) -> float | None:
    if value is None:
        return None
    from fcm.scene.rules import step_fault

    if fault := step_fault(value):
        raise click.BadParameter(f"{fault}.")
    return value


@click.command()
@click.argument("scene", metavar="SCENE")
@output_option("-o", "--output", endings=(".nc",), help="Write the curves, and the motion, as netCDF.")
@output_option("--csv", endings=(".csv",), help="Write the curves as CSV; without any, the motion.")
@output_option("--history-csv", endings=(".csv",), help="Write the motion of the schedule as CSV.")
@click.option("--json", "to_json", is_flag=True, help="Print the summary as JSON instead of a table.")
@click.option(
    "--method", type=click.Choice(["table", "closed-form", "exact"]), default="table", show_default=True,
    help="Harmonic balance with coefficients of a table or in closed form, or exact periodic solutions.",
)  # fmt: skip
@click.option(
    "--harmonics", metavar="H", callback=balance.harmonics,
    help="Harmonics of the balance: up to a number from 1 to 50, or some such as 1,2,3,9.  "
    "[default: the scene's, or as --accuracy]",
)  # fmt: skip
@click.option(
    "--accuracy", type=float, metavar="E", callback=balance.accuracy,
    help="As many harmonics as it takes for peaks and folds that are right to this, relative.  "
    "[default: the scene's, or 0.01]",
)  # fmt: skip
@click.option(
    "--level", metavar="FROM:TO", callback=balance.level,
    help="Follow the level of the forces instead, all amplitudes times this, at the frequency --at; static "
    "loads stay.",
)  # fmt: skip
@click.option(
    "--mode", type=click.IntRange(min=1), metavar="N",
    help="Follow the nonlinear mode N instead: its frequency and damping against its modal amplitude, "
    "over the span --level.",
)  # fmt: skip
@click.option(
    "--force-level", "force_levels", type=click.FloatRange(min=0.0, min_open=True), multiple=True,
    metavar="L",
    help="With --mode: predict the response near the resonance for the scene's forces times this; again for "
    "more.  [default: 1]",
)  # fmt: skip
@click.option(
    "--at", multiple=True, metavar="F", callback=exact.frequencies,
    help="Visit these frequencies by an upward and a downward sweep; a number or FROM:TO:COUNT, again "
    "for more. With --method exact.",
)  # fmt: skip
@tracking.track_options
@click.option(
    "--only", type=click.Choice(["peaks"]),
    help="Peaks, folds and jumps alone, near those of the balance. With --method exact.",
)  # fmt: skip
@click.option(
    "--table", type=click.Path(), metavar="FILE", help="A table of your own.  [default: the shipped one]"
)
@click.option(
    "--max-step", type=float, metavar="X", callback=_a_step,
    help="Longest step along a curve, relative to its extent.  [default: the scene's]",
)  # fmt: skip
@click.option(
    "--jobs", type=click.IntRange(min=0), default=0, metavar="N",
    help="Processes for sweeps of many curves; 0 for one on each core.  [default: 0]",
)  # fmt: skip
@click.option(
    "--cluster", metavar="ADDRESS",
    help="Instead, the workers of the dask.distributed scheduler there, as in tcp://127.0.0.1:8786.",
)  # fmt: skip
@click.option(
    "--time-limit", type=float, metavar="SECONDS", callback=seconds,
    help="Stop after so long, and keep what is finished, as Ctrl-C does; --resume goes on.",
)  # fmt: skip
@click.option("--resume", is_flag=True, help="Continue an interrupted sweep with the same -o FILE.")
@click.option(
    "--leave-out-tolerance", "tolerance", type=click.FloatRange(min=0.0), default=1e-5, show_default=True,
    metavar="X", help="Greatest relative change of the response by what is left out.",
)  # fmt: skip
@click.option(
    "--peaks-only", is_flag=True, help="Write peaks, folds and errors of each curve, not its points."
)
@click.option(
    "--sensitivity", is_flag=True,
    help="Derivatives of every peak, its height and its frequency, by the numbers of the scene.",
)  # fmt: skip
@click.option("--keep-all", is_flag=True, help="Leave nothing out.")
@largest_file_option
@about_scenes
@click.option(
    "--compare",
    is_flag=True,
    help="Run the scene by every method: error against run time, instead of curves.",
)
@pass_messages
def respond(
    messages: Messages,
    scene: str,
    output: Path | None,
    csv: Path | None,
    history_csv: Path | None,
    to_json: bool,
    method: str,
    harmonics: tuple[int, ...] | None,
    accuracy: float | None,
    level: tuple[float, float] | None,
    mode: int | None,
    force_levels: tuple[float, ...],
    at: tuple[float, ...] | None,
    track: str | None,
    over: str | None,
    low: float | None,
    high: float | None,
    only: str | None,
    table: str | None,
    max_step: float | None,
    jobs: int,
    cluster: str | None,
    time_limit: float | None,
    resume: bool,
    tolerance: float,
    peaks_only: bool,
    sensitivity: bool,
    keep_all: bool,
    largest_file: int,
    compare: bool,
) -> None:
    """Trace the response curves of SCENE, a TOML file or the name of a bundled scene.

    By harmonic balance, or with --method exact as periodic solutions of the exact motion. The peaks, folds
    and errors of every curve are printed; the curves go to files. A [[schedule]] of the scene is then
    simulated in time, without a time step; the amplitudes of its phases are printed, the motion goes to the
    same file. With an [optimum] its numbers are chosen, and the response is that with them; with --track,
    points of the response are followed in a number of the scene.
    """
    if compare:
        from fcm.cli.compare import refuse_other_options, write_comparison

        refuse_other_options()
        compared = _loaded(messages, scene, max_step, None, largest_file)
        write_comparison(messages, compared, table, tolerance, output, to_json)
        return
    cluster_option.check_options(cluster, level)
    nonlinear_mode.check_options(mode, level, at, force_levels)
    tracking.check_options(track, over, low, high, method)
    exact.check_options(method, at, only, level)
    balance.check_level(level, at, accuracy, method, mode)
    balance.check_peaks_only(peaks_only, level, csv)
    balance.check_options(harmonics, accuracy, method, table)
    if table is not None and method != "table":
        raise click.UsageError("--table is of no use with --method closed-form.")
    of_peaks.check_options(sensitivity, method, level, mode)
    if resume and output is None and csv is None and history_csv is None:
        raise click.UsageError("--resume needs the -o FILE of the sweep that was interrupted.")
    from fcm.response.around import check_no_ring
    from fcm.response.visible import visible

    check_different({"-o": output, "--csv": csv, "--history-csv": history_csv})
    loaded = _loaded(messages, scene, max_step, history_csv, largest_file)
    if sensitivity:
        check_no_ring(loaded, "sensitivities")
    if loaded.optimum is not None and track is None:
        tracking.check_scene(loaded, method, level is not None)
    announce(
        messages, loaded, method if mode is None else f"nonlinear mode {mode}", at if mode is None else ()
    )
    balanced = {"tolerance": None if keep_all else tolerance, "harmonics": harmonics, "accuracy": accuracy}
    balanced["peaks_only"] = peaks_only
    outputs = Outputs(messages, output, csv, history_csv)
    with outputs.kept(resume) as checkpoint, cluster_option.place_of(cluster) as place:
        options: dict[str, Any] = {"jobs": jobs, "place": place, "keep": checkpoint}
        with TimeLimit(messages, time_limit):
            if track is not None and over is not None and low is not None and high is not None:
                response = tracking.tracked(messages, loaded, track, over, (low, high), harmonics, accuracy)
            elif mode is not None and level is not None:
                chosen = {
                    "harmonics": harmonics,
                    "accuracy": accuracy,
                    "force_levels": force_levels or (1.0,),
                }
                response = nonlinear_mode.traced(loaded, mode, level, chosen)
            elif loaded.optimum is not None:
                kept = {**options, **balanced, "table": _opened(table)}
                response = tracking.optimised(messages, loaded, method, kept)
            elif method == "exact" and (loaded.has_range or at):
                response = exact.traced(
                    messages, loaded, at, {**options, "tolerance": balanced["tolerance"], "only": only}
                )
            elif level is not None and at is not None:
                response = _levels(loaded, at, level, harmonics)
            elif loaded.has_range:
                response = _traced(messages, loaded, method, table, {**options, **balanced})
            else:
                response = _without_curves(loaded)
            if sensitivity:
                of_peaks.added(messages, response, loaded)
            if loaded.schedule and level is None and track is None:
                response.histories = schedule.simulated(messages, loaded, response)
        response = visible(response, loaded)
        response.notes, response.units = list(loaded.notes), loaded.units
        response.drawn = loaded.drawn
        result = outputs.write(response, to_json)
    _close(messages, result, response.defects)


def _levels(
    scene: Scene, at: tuple[float, ...], level: tuple[float, float], harmonics: tuple[int, ...] | None
) -> Response:
    from fcm.response.level import trace_levels

    return trace_levels(scene, at, level, harmonics=harmonics)


def announce(messages: Messages, scene: Scene, method: str, at: tuple[float, ...] | None) -> None:
    """What is going to be computed; without being asked where that is a great deal."""
    from fcm.scene.rules import least_points

    count = len(scene.each_curve())
    messages.detail(f"{scene.title or scene.name}: curves to trace: {count}, method: {method}")
    if at is None and scene.has_range and (points := least_points(scene)) > MANY_POINTS:
        curves = f"{count} curve{'s' * (count > 1)}"
        messages.info(f"at least {points} points: {curves} in steps of {scene.max_step:g} at most")


def _loaded(
    messages: Messages, scene: str, max_step: float | None, history_csv: Path | None, largest_file: int
) -> Scene:
    from fcm.response.visible import check_solvable
    from fcm.scene import load_scene

    loaded = load_scene(scene, largest_file=largest_file).in_use()
    check_solvable(loaded)
    for note in loaded.notes:
        messages.info(note)
    schedule.check_options(loaded, history_csv)
    return loaded if max_step is None else _with_step(loaded, max_step)


def _without_curves(scene: Scene) -> Response:
    from fcm.response import Response

    return Response.without_curves(scene)


def _traced(
    messages: Messages, scene: Scene, method: str, table: str | None, options: dict[str, Any]
) -> Response:
    from fcm.response import trace
    from fcm.run.progress import part

    opened, share = _opened(table), 0.5 if scene.schedule else 1.0
    shown = part(messages.progress, 0.0, share)
    response = trace(scene, method=method, table=opened, progress=shown, **options)
    messages.clear()
    if outside := getattr(opened, "outside", 0):
        messages.info(
            f"{table}: {outside} look-ups outside the part it holds were answered by the closed form"
        )
    return response


def _opened(table: str | None) -> Any:
    if table is None:
        return None
    from fcm.table import open_table

    return open_table(table)


def _with_step(scene: Scene, max_step: float) -> Scene:
    curves = tuple(replace(curve, max_step=max_step) for curve in scene.curves)
    return replace(scene, max_step=max_step, curves=curves)


def _close(messages: Messages, result: dict[str, Any], defects: list[str]) -> None:
    """What the run left out, cost, and how wrong it is; the exit code of one that stopped early."""
    for text in dict.fromkeys(defects):
        messages.detail(text)
    for text in result["left_out"]:
        messages.info(f"left out: {text}")
    if result["curves"]:
        messages.info(cost_and_error(result))
    elif "tracked" in result:
        messages.info(f"{len(result['tracked']['curves'])} tracked curves in {result['seconds']:.2f} s")
    if short := short_of_accuracy(result):
        messages.warning(short)
    if unsure := branches_unsure(result):
        messages.warning(unsure)
    histories = result.get("histories", [])
    if histories:
        messages.info(schedule.cost_and_error(histories))
    if stopped := " and ".join(
        filter(None, (incomplete(result), tracking.incomplete(result), schedule.incomplete(histories)))
    ):
        messages.error(f"error: {stopped}; what was traced is reported and written")
        click.get_current_context().exit(DEFECT if all_lost_to_defects(result) else NOT_COMPLETED)
