"""Runs the calculation of ``fcm respond``: curves, levels, a mode, tracking, an optimum or a motion."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from fcm.cli import exact, fit, schedule, sensitivity, track
from fcm.cli.messages import Messages
from fcm.cli.respond_options import Asked

if TYPE_CHECKING:
    from fcm.model.scene import Scene
    from fcm.response import Response
    from fcm.response.options import ResponseOptions
    from fcm.run import Execution


def calculated(messages: Messages, scene: Scene, asked: Asked, place: Any, keep: Any) -> Response:
    """Calculate the requested response, with its sensitivities and the motion of its schedule.

    Sweeps of curves run at `place`, and `keep` holds their finished curves.
    """
    from fcm.run import Execution

    execution = Execution(asked.jobs, place, keep, progress=messages.progress)
    response = _response(messages, scene, asked, execution)
    if asked.sensitivity:
        sensitivity.added(messages, response, scene, asked.to_json or asked.output is not None)
    if scene.schedule and asked.level is None and asked.track is None:
        response.histories = schedule.simulated(messages, scene, response, keep)
    return response


def _response(messages: Messages, scene: Scene, asked: Asked, execution: Execution) -> Response:
    if asked.track is not None:
        return _tracked(messages, scene, asked, execution)
    if asked.mode is not None:
        return _mode(messages, scene, asked, execution)
    if scene.optimum is not None:
        method = _method(asked)
        response = track.optimised(messages, scene, method, execution, _balanced(messages, asked))
        _say_outside(messages, asked.table, method)
        return response
    if scene.fit is not None:
        return fit.fitted(messages, scene, asked.method, execution, _balanced(messages, asked))
    if asked.method == "exact" and (scene.has_range or asked.at):
        chosen = {"only": asked.only, "periods": asked.periods, "options": _options(messages, asked)}
        return exact.traced(messages, scene, asked.at, _before_schedule(scene, execution), chosen)
    if asked.level is not None:
        return _levels(messages, scene, asked, execution)
    if scene.has_range:
        return _traced(messages, scene, asked, _before_schedule(scene, execution))
    from fcm.response import Response

    return Response.without_curves(scene)


def _before_schedule(scene: Scene, execution: Execution) -> Execution:
    """The execution of curves: half of the progress if a schedule is simulated after them."""
    return execution.stage(0.0, 0.5) if scene.schedule else execution


def _options(messages: Messages, asked: Asked) -> ResponseOptions:
    """Tolerances and limits, with those given by options of the command."""
    from fcm.response.options import RESPONSE, leaving_out

    options = messages.settings.response or RESPONSE
    options = leaving_out(None if asked.keep_all else asked.tolerance, options)
    if asked.time_limit is not None and asked.method == "exact":  # that of the run is enough
        options = replace(options, exact=replace(options.exact, max_seconds=math.inf))
    return replace(options, sweep=replace(options.sweep, peaks_only=asked.peaks_only))


def _balanced(messages: Messages, asked: Asked) -> dict[str, Any]:
    """Options of a calculation by harmonic balance."""
    return {"harmonics": asked.harmonics, "accuracy": asked.accuracy, "options": _options(messages, asked)}


def _tracked(messages: Messages, scene: Scene, asked: Asked, execution: Execution) -> Response:
    assert asked.track is not None and asked.over is not None  # --track needs the others
    assert asked.low is not None and asked.high is not None
    from fcm.response.track import TrackRequest

    curves = TrackRequest(asked.track, asked.over, (asked.low, asked.high))
    return track.tracked(messages, scene, curves, execution, _balanced(messages, asked))


def _mode(messages: Messages, scene: Scene, asked: Asked, execution: Execution) -> Response:
    from fcm.response.mode import ModeRequest, trace_modes

    assert asked.mode is not None and asked.level is not None  # --mode needs --level
    exported = asked.export is not None or asked.contact_forces is not None or asked.modal_amplitudes
    motion_at = asked.motion_at if exported else None
    mode = ModeRequest(asked.mode, asked.level, asked.force_levels or (1.0,), motion_at)
    response = trace_modes(scene, mode, execution, **_balanced(messages, asked))
    messages.clear()
    return response


def _levels(messages: Messages, scene: Scene, asked: Asked, execution: Execution) -> Response:
    from fcm.response.level import LevelRequest, trace_levels

    assert asked.level is not None and asked.at is not None  # --level needs --at
    levels = LevelRequest(asked.at, asked.level)
    response = trace_levels(scene, levels, execution, **_balanced(messages, asked))
    messages.clear()
    return response


def _traced(messages: Messages, scene: Scene, asked: Asked, execution: Execution) -> Response:
    from fcm.response import trace

    method = _method(asked)
    response = trace(scene, method, execution, **_balanced(messages, asked))
    messages.clear()
    _say_outside(messages, asked.table, method)
    return response


def _method(asked: Asked) -> Any:
    """The method, or the table that is given for it."""
    if asked.table is None:
        return asked.method
    from fcm.table import open_table

    return open_table(asked.table)


def _say_outside(messages: Messages, path: str | None, table: Any) -> None:
    """Report how often a table was asked for points that it does not hold."""
    if outside := getattr(table, "outside", 0):
        messages.info(
            f"{path}: {outside} look-ups outside the part it holds were answered by the closed form"
        )
