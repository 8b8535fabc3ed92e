r"""Follow a curve by steps along its arc; everything that happens on it is a point of it.

A step is predicted by a parabola, corrected in the plane normal to the tangent, and accepted if the curve
turned gently and was where it was predicted. What happens within an accepted step - a fold, a peak of
something reported, a value of the parameter that was asked for - is the root of a function along it
(`events`).

Where a margin of the problem changes sign the curve may have a corner. It is not approached by shorter and
shorter steps: the margins are known functions, so the step ends just beyond where the prediction crosses one,
the corner is landed on, and the curve is left in the direction that the equations have just beyond, with the
orientation that a piecewise smooth curve keeps (Allgower and Georg, "Introduction to Numerical Continuation
Methods").
"""

from __future__ import annotations

from collections.abc import Sequence

from fcm.continuation.follower import Follower, Progress, Watch
from fcm.continuation.front import Front
from fcm.continuation.path import FloatArray, Path, Status
from fcm.continuation.problem import Problem
from fcm.continuation.stage import Stage

__all__ = ["Progress", "Watch", "follow"]


def follow(
    problem: Problem,
    start: FloatArray,
    span: tuple[float, float],
    forward: bool = True,
    max_step: float = 0.05,
    stations: Sequence[float] = (),
    progress: Progress | None = None,
    stage: Stage | None = None,
    watch: Watch | None = None,
    hasty: bool = False,
    front: Front | None = None,
    narrow: Sequence[tuple[float, float]] = (),
) -> Path:
    """Follow the curve through start until the parameter leaves the span, or the curve closes.

    Parameters
    ----------
    problem : Problem
        With n unknowns.
    start : (n + 1,)
        Near a point of the curve, the parameter last; it is corrected with the parameter held.
    span : (low, high)
        Of the parameter; the start may lie within.
    forward : bool
        Whether the parameter rises at first.
    max_step : float
        Longest step, in the problem's scale.
    stations : sequence of float
        Values of the parameter at which the curve has points, marked.
    progress : callable, optional
        Called now and then.
    stage : Stage, optional
        Of the same curve of a soft problem, to which it had come when it was interrupted.
    watch : callable, optional
        Is given the stage before every step of a soft problem.
    hasty : bool
        Whether only the passings of stations matter: corners are gone to, and left, by longer steps.
    front : Front, optional
        Of the same problem, that has followed another curve to its end.
    narrow : sequence of (float, float)
        Values of the parameter, with a width, at which the curve may have a peak that no point away from it
        tells of: steps end there, where the width is less than the longest step.

    Returns
    -------
    Path
        With status STALLED and without points where there is no curve at the start.
    """
    follower = Follower(problem, span, max_step, stations, progress, hasty, front, narrow)
    if stage is not None:
        follower.resume(stage)
    elif not follower.begin(start, forward):
        return follower.path(Status.STALLED)
    return follower.run(watch)
