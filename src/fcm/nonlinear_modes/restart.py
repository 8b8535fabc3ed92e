"""Follow a curve past places where its steps make no progress, such as corners of two contacts at once.

The curve is restarted a little further on, from a solution near where it stopped.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fcm.continuation import FollowOptions, Path, Problem, Status, follow
from fcm.continuation.corrector import Newton
from fcm.continuation.follow import Progress
from fcm.model.scene import FloatArray
from fcm.nonlinear_modes.options import NONLINEAR_MODE, RestartOptions


class _StuckError(Exception):
    """Raised when the steps make no progress."""


def follow_past_corners(
    new_problem: Callable[[], Problem],
    start: FloatArray,
    span: tuple[float, float],
    options: FollowOptions,
    restart: RestartOptions = NONLINEAR_MODE.restart,
    progress: Progress | None = None,
) -> Path:
    """Follow the curve through start upwards from the lower end of the span, see `follow`."""
    whole, low = None, span[0]

    def report(share: float) -> None:
        if progress is not None:
            progress((low - span[0] + share * (span[1] - low)) / (span[1] - span[0]))

    for _ in range(restart.max_restarts):
        path, ended = _first_piece(new_problem, start, (low, span[1]), options, restart, report)
        if not path.z.shape[0]:
            return path if whole is None else whole
        if low > span[0] and path.status is Status.RETURNED:  # to where it was restarted
            path = replace(path, status=Status.STALLED)
        whole = path if whole is None else whole.then(path)
        if ended:
            return whole
        beyond = _restart_point(new_problem(), path.z[-1], options, restart)
        if beyond is None or beyond[-1] >= span[1]:
            return whole
        start, low = beyond, float(beyond[-1])
    assert whole is not None
    return whole


def _first_piece(
    new_problem: Callable[[], Problem],
    start: FloatArray,
    span: tuple[float, float],
    options: FollowOptions,
    restart: RestartOptions,
    report: Progress,
) -> tuple[Path, bool]:
    """The curve as far as its steps make progress, and whether that is its end."""
    last, same = -1.0, 0

    def watch(share: float) -> None:
        nonlocal last, same
        report(share)
        same = same + 1 if abs(share - last) < restart.min_progress else 0
        last = share
        if same > restart.max_reports:
            raise _StuckError

    try:
        path = follow(new_problem(), start, span, options=options, progress=watch)
        return path, path.status is not Status.STALLED
    except _StuckError:
        reach = span[0] + last * (span[1] - span[0]) * (1.0 - restart.end_fraction)
        if not reach > span[0]:
            return follow(new_problem(), start, span, options=options), True
        path = follow(new_problem(), start, (span[0], reach), options=options)
        return replace(path, status=Status.STALLED), path.status is not Status.COMPLETE


def _restart_point(
    problem: Problem, z: FloatArray, options: FollowOptions, restart: RestartOptions
) -> FloatArray | None:
    """The first solution found at growing distances beyond z; None if there is none near."""
    newton = Newton(problem, options.newton)
    newton.row[-1] = 1.0
    problem.evaluate_scale(np.ascontiguousarray(z))
    for step in restart.restart_lengths:
        guess = np.array(z)
        guess[-1] += step * problem.scale[z.size - 1]
        newton.scale[:], newton.z[:] = problem.scale, guess
        if newton.correct(step) and newton.moved < restart.max_distance_ratio * step:
            return np.array(newton.z)
    return None
