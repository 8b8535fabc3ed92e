"""What ``fcm respond`` is asked to calculate: curves, levels, a mode, tracked points, an optimum, motion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from fcm.cli import exact, fit, nonlinear_mode, schedule, sensitivity, track
from fcm.cli.messages import Messages
from fcm.cli.respond_options import Asked

if TYPE_CHECKING:
    from fcm.model.scene import Scene
    from fcm.response import Response


def calculated(messages: Messages, scene: Scene, asked: Asked, place: Any, keep: Any) -> Response:
    """The response that is asked for, with its sensitivities and the motion of its schedule.

    Sweeps of curves run at a place, and what of them is finished is kept.
    """
    response = _response(messages, scene, asked, {"jobs": asked.jobs, "place": place, "keep": keep})
    if asked.sensitivity:
        sensitivity.added(messages, response, scene, asked.to_json or asked.output is not None)
    if scene.schedule and asked.level is None and asked.track is None:
        response.histories = schedule.simulated(messages, scene, response, keep)
    return response


def _response(messages: Messages, scene: Scene, asked: Asked, run: dict[str, Any]) -> Response:
    balanced = {**_balanced(asked), "options": messages.settings.response}
    if asked.track is not None:
        return _tracked(messages, scene, asked, run)
    if asked.mode is not None:
        return _mode(messages, scene, asked, run["keep"])
    if scene.optimum is not None:
        table = _opened(asked.table)
        response = track.optimised(messages, scene, asked.method, {**run, **balanced, "table": table})
        _say_outside(messages, asked.table, table)
        return response
    if scene.fit is not None:
        balanced |= {key: run[key] for key in ("jobs", "place", "keep")}
        return fit.fitted(messages, scene, asked.method, balanced)
    if asked.method == "exact" and (scene.has_range or asked.at):
        options = {**run, "tolerance": _tolerance(asked), "only": asked.only}
        options["periods"] = asked.periods
        options["limit"] = None if asked.time_limit is None else math.inf  # that of the run is enough
        return exact.traced(messages, scene, asked.at, options)
    if asked.level is not None:
        return _levels(messages, scene, asked, run["keep"])
    if scene.has_range:
        return _traced(messages, scene, asked, {**run, **balanced})
    from fcm.response import Response

    return Response.without_curves(scene)


def _tolerance(asked: Asked) -> float | None:
    return None if asked.keep_all else asked.tolerance


def _balanced(asked: Asked) -> dict[str, Any]:
    """What a balance is to do."""
    return {
        "tolerance": _tolerance(asked),
        "harmonics": asked.harmonics,
        "accuracy": asked.accuracy,
        "peaks_only": asked.peaks_only,
    }


def _tracked(messages: Messages, scene: Scene, asked: Asked, run: dict[str, Any]) -> Response:
    assert asked.track is not None and asked.over is not None  # --track needs the others
    assert asked.low is not None and asked.high is not None
    options = {**run, "harmonics": asked.harmonics, "accuracy": asked.accuracy}
    options["options"] = messages.settings.response
    return track.tracked(messages, scene, asked.track, asked.over, (asked.low, asked.high), options)


def _mode(messages: Messages, scene: Scene, asked: Asked, keep: Any) -> Response:
    assert asked.mode is not None and asked.level is not None  # --mode needs --level
    chosen = {
        "harmonics": asked.harmonics,
        "accuracy": asked.accuracy,
        "force_levels": asked.force_levels or (1.0,),
        "progress": messages.progress,
        "keep": keep,
        "options": messages.settings.response,
    }
    response = nonlinear_mode.traced(scene, asked.mode, asked.level, chosen)
    messages.clear()
    return response


def _levels(messages: Messages, scene: Scene, asked: Asked, keep: Any) -> Response:
    from fcm.response.level import trace_levels

    assert asked.level is not None and asked.at is not None  # --level needs --at
    chosen: dict[str, Any] = {"harmonics": asked.harmonics, "accuracy": asked.accuracy, "keep": keep}
    chosen["options"] = messages.settings.response
    response = trace_levels(scene, asked.at, asked.level, progress=messages.progress, **chosen)
    messages.clear()
    return response


def _traced(messages: Messages, scene: Scene, asked: Asked, options: dict[str, Any]) -> Response:
    from fcm.response import trace
    from fcm.run.progress import part

    table, share = _opened(asked.table), 0.5 if scene.schedule else 1.0
    shown = part(messages.progress, 0.0, share)
    response = trace(scene, method=asked.method, table=table, progress=shown, **options)
    messages.clear()
    _say_outside(messages, asked.table, table)
    return response


def _say_outside(messages: Messages, path: str | None, table: Any) -> None:
    """How often a table was asked for what it does not hold."""
    if outside := getattr(table, "outside", 0):
        messages.info(
            f"{path}: {outside} look-ups outside the part it holds were answered by the closed form"
        )


def _opened(table: str | None) -> Any:
    if table is None:
        return None
    from fcm.table import open_table

    return open_table(table)
