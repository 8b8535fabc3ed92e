"""``fcm respond SCENE``: the response curves of a scene."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from fcm.cli import balance, exact, export, fit, nonlinear_mode, schedule, sensitivity, track
from fcm.cli.calculation import calculated
from fcm.cli.files import alone, check_different, check_not_read
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.options import scene_argument
from fcm.cli.outputs import Outputs
from fcm.cli.remarks import announce, close
from fcm.cli.resources_needed import check_room
from fcm.cli.respond_options import Asked, respond_options
from fcm.cli.time_limit import TimeLimit

if TYPE_CHECKING:
    from pathlib import Path

    from fcm.model.scene import Scene
    from fcm.run import Factory
    from fcm.run.options import RunOptions


@click.command()
@scene_argument
@respond_options
@pass_messages
def respond(messages: Messages, /, scene: str, **options: Any) -> None:
    """Trace the response curves of SCENE, a TOML file or the name of a bundled scene.

    By harmonic balance, or with --method exact as periodic solutions of the exact motion. The peaks, folds
    and errors of every curve are printed. The curves go to files.

    A [[schedule]] of the scene is then simulated in time, without a time step. A [fit] fits numbers to
    measured data, an [optimum] chooses them. The response is that with these numbers. With --track, points of
    the response are followed in a number of the scene.
    """
    asked = Asked(**options)
    if asked.compare:
        _compare(messages, scene, asked)
        return
    _check_options(asked)
    from fcm.response.visible_dofs import visible

    loaded, exporting = _loaded(messages, scene, asked)
    check_not_read(_files(asked), [*loaded.files, asked.table, asked.mesh])
    _check_scene(loaded, asked)
    announced = announce(messages, loaded, asked)
    if not asked.resume:
        messages.expect(len(loaded.each_curve()))
    exported = [] if exporting is None else exporting.files
    outputs = Outputs(messages, asked.output, asked.csv, asked.history_csv, exported)
    with outputs.kept(asked.resume) as keep, _place_of(asked.cluster, messages.settings.run) as place:
        with TimeLimit(messages, asked.time_limit):
            response = calculated(messages, loaded, asked, place or messages.settings.place, keep)
            if exporting is not None:
                exporting.take(response, loaded)
        response = visible(response, loaded)
        result = outputs.write(response, asked.to_json)
    close(messages, result, response.defects, outputs.written, announced, _wants_table(asked))


def _compare(messages: Messages, scene: str, asked: Asked) -> None:
    from fcm.cli.compare import refuse_other_options, write_comparison

    refuse_other_options()
    loaded, _ = _loaded(messages, scene, asked)
    check_not_read({"-o": asked.output}, [*loaded.files, asked.table])
    with alone([asked.output]):
        write_comparison(messages, loaded, asked.table, asked.tolerance, asked.output, asked.to_json)


def _check_options(asked: Asked) -> None:
    """Raise a usage error if options exclude or need one another, whatever the scene."""
    level, mode, method = asked.level, asked.mode, asked.method
    _check_cluster(asked.cluster, level)
    _check_left_out(asked)
    nonlinear_mode.check_options(mode, level, asked.at, asked.force_levels)
    track.check_options(asked.track, asked.over, asked.low, asked.high, method)
    exact.check_options(method, asked.at, asked.only, asked.periods, level)
    balance.check_level(level, asked.at, method, mode)
    balance.check_peaks_only(asked.peaks_only, level, asked.csv)
    balance.check_options(asked.harmonics, asked.accuracy, method, asked.table)
    if asked.table is not None and method != "table":
        raise click.UsageError("--table is of no use with --method closed-form.")
    sensitivity.check_options(asked.sensitivity, method, level, mode, asked.peaks_only)
    export.check_options(asked)
    files = _files(asked)
    if asked.resume and not any(files.values()):
        raise click.UsageError("--resume needs the -o FILE of the sweep that was interrupted.")
    check_different(files)


def _files(asked: Asked) -> dict[str, Path | None]:
    """The files to write, by their options."""
    return {
        "-o": asked.output,
        "--csv": asked.csv,
        "--history-csv": asked.history_csv,
        "--export": asked.export,
        "--contact-forces": asked.contact_forces,
    }


def _wants_table(asked: Asked) -> bool:
    """Whether the command line asks for a table."""
    given = click.get_current_context().get_parameter_source("method")
    return asked.table is not None or (asked.method == "table" and given is ParameterSource.COMMANDLINE)


def _check_left_out(asked: Asked) -> None:
    given = click.get_current_context().get_parameter_source("tolerance")
    if asked.keep_all and given is ParameterSource.COMMANDLINE:
        raise click.UsageError("--leave-out-tolerance is of no use with --keep-all: nothing is left out.")


def _loaded(messages: Messages, name: str, asked: Asked) -> tuple[Scene, export.Exporting | None]:
    """The scene at the degrees of freedom in use, and its export, if any."""
    from fcm.response.visible_dofs import check_solvable
    from fcm.scene import load_scene
    from fcm.scene.options import MESSAGES
    from fcm.scene.size_notices import SizeNotices

    def before(scene: Scene, count: int) -> None:
        if not asked.compare:
            check_room(messages, _with_step(scene.in_use(), asked), count, asked)

    settings = messages.settings
    notices = SizeNotices(messages.info, before, settings.memory, settings.reading or MESSAGES)
    every_row = asked.export is not None
    whole = load_scene(name, largest_file=asked.largest_file, every_row=every_row, notices=notices)
    exporting = export.exporting(messages, whole, asked)
    scene = whole.in_use()
    check_solvable(scene)
    for note in scene.notes:
        messages.note(note)
    schedule.check_options(scene, asked.history_csv)
    return _with_step(scene, asked), exporting


def _check_cluster(address: str | None, level: object) -> None:
    """Raise a usage error if options are of no use with a cluster."""
    if address is None:
        return
    if level is not None:
        raise click.UsageError(
            "--cluster is of no use with --level, whose curves are followed in this process."
        )
    given = click.get_current_context().get_parameter_source("jobs")
    if given is ParameterSource.COMMANDLINE:
        raise click.UsageError("--jobs is of no use with --cluster, whose workers are as many as it has.")


def _place_of(address: str | None, options: RunOptions | None) -> AbstractContextManager[Factory | None]:
    """Context with the place to compute: a cluster, while it is open; None for this machine."""
    if address is None:
        return nullcontext()
    from fcm.run.cluster import connected

    return connected(address) if options is None else connected(address, options)


def _with_step(scene: Scene, asked: Asked) -> Scene:
    """The scene with the requested longest step."""
    return scene if asked.max_step is None else scene.with_step(asked.max_step)


def _check_scene(scene: Scene, asked: Asked) -> None:
    """Raise a usage error if options are of no use with this scene."""
    if scene.fit is not None:
        fit.check_scene(scene, asked)
    if asked.sensitivity:
        from fcm.response.ring_limits import check_no_ring

        check_no_ring(scene, "sensitivities")
    if scene.optimum is not None and asked.track is None:
        track.check_scene(scene, asked.method, asked.level is not None)
