r"""Follow a curve by steps along its arc; everything that happens on it is a point of it.

A step is predicted by a parabola and corrected in the plane normal to the tangent. It is accepted if the
curve turned gently and was where it was predicted. An event within an accepted step is the root of a function
along it (`events`): a fold, a peak of an output, or a given value of the parameter.

Where a margin of the problem changes sign the curve may have a corner. It is not approached by shorter and
shorter steps. As the margins are known functions, the step ends just beyond where the prediction crosses one,
and the corner is landed on. The next step follows the tangent of the equations just beyond the corner, with
the orientation that a piecewise smooth curve keeps (Allgower and Georg, "Introduction to Numerical
Continuation Methods").
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import cython
import numpy as np

from fcm.continuation.checkpoint import Checkpoint, restore_stepper, stepper_state
from fcm.continuation.events import NO_EVENTS, End, Events, Landing, first_end
from fcm.continuation.labelled_switching import LabelledSwitching
from fcm.continuation.options import FOLLOW, FollowOptions, StepOptions, SwitchingOptions
from fcm.continuation.path import FloatArray, Mark, Path, PathInterrupted, Status
from fcm.continuation.problem import Point, PointStore, Problem
from fcm.continuation.recorder import NonsmoothPoints, Recorder, step_back
from fcm.continuation.root_corner import is_met, land
from fcm.continuation.step_control import Stepper

if cython.compiled:
    from cython.cimports.fcm.continuation.recorder import before_corner
    from cython.cimports.fcm.continuation.step_control import (
        acceptable,
        changes_sign,
        hidden_reversal,
        hidden_sign_change,
        next_corner,
        next_extrapolated_root,
        next_step,
        parameter_is_even,
        parameter_reversal,
        smooth_step,
        solution_size,
    )
else:
    from fcm.continuation.recorder import before_corner
    from fcm.continuation.step_control import (
        acceptable,
        changes_sign,
        hidden_reversal,
        hidden_sign_change,
        next_corner,
        next_extrapolated_root,
        next_step,
        parameter_is_even,
        parameter_reversal,
        smooth_step,
        solution_size,
    )

__all__ = ["Progress", "Watch", "follow"]

BRANCH = cython.declare(cython.long, int(Mark.BRANCH))
CORNER = cython.declare(cython.long, int(Mark.CORNER))

Progress = Callable[[float], None]  # fraction of the range that has been covered
Watch = Callable[[Checkpoint], None]


@cython.cclass
class Follower:
    """`begin` or `resume`, then `run`: steps, the points that they keep, and where the curve ends."""

    problem: Problem
    options: FollowOptions
    stepper: Stepper
    recorder: Recorder
    ends: Sequence[End]  # functions that end the curve
    landing: Landing  # values of the parameter that no step leads across
    nonsmooth: NonsmoothPoints
    step: cython.double
    size: cython.double  # of the solution at the start
    approach_distance: cython.double  # a corner at most so far away is approached at once
    attempts: int  # to go back from where no step leads on
    labelled: LabelledSwitching | None
    progress: Progress | None

    def __init__(
        self,
        problem: Problem,
        span: tuple[float, float],
        events: Events = NO_EVENTS,
        options: FollowOptions = FOLLOW,
        progress: Progress | None = None,
        stepper: Stepper | None = None,
    ) -> None:
        self.problem, self.options, self.progress = problem, options, progress
        self.stepper = stepper or Stepper(problem, options)
        self.stepper.reset(options)
        self.approach_distance = (
            options.max_step
            if options.user_points_only or problem.costly
            else options.switching.approach_distance
        )
        self.recorder, self.ends = Recorder(self.stepper, span, events), events.ends
        self.landing = Landing(events.within(options.max_step * (span[1] - span[0])))
        self.nonsmooth, self.attempts = NonsmoothPoints(self.recorder, problem.labelled), 0
        self.labelled = LabelledSwitching(self.stepper, self.recorder.store) if problem.labelled else None

    def begin(self, start: FloatArray, forward: bool, direction: FloatArray | None = None) -> bool:
        """Correct the start to the curve; return whether there is a curve."""
        row, n = np.zeros(self.problem.unknowns + 1), self.problem.unknowns
        if direction is not None and start[n] in self.recorder.values:
            forward, direction = bool(direction[n] > 0.0), None
        row[n] = 1.0 if forward else -1.0
        if direction is not None:
            self.problem.evaluate_scale(start)
            row = direction / np.asarray(self.problem.scale)
            row /= np.linalg.norm(row)
        if not self.stepper.begin(np.array(start, dtype=np.float64), row):
            return False
        self.recorder.start(start[n] if direction is None else float(self.stepper.here.z[n]))
        self.size = solution_size(self.stepper)
        self.step = min(self.options.step.initial_step, self.options.max_step)
        return True

    def resume(self, checkpoint: Checkpoint) -> None:
        """Continue from a checkpoint of the curve."""
        restore_stepper(self.stepper, checkpoint)
        self.recorder.restore(checkpoint)
        self.step, self.size = checkpoint.step, checkpoint.size

    def checkpoint(self) -> Checkpoint:
        """The state from which following the curve can resume."""
        return Checkpoint(
            step=self.step, size=self.size, **self.recorder.state(), **stepper_state(self.stepper)
        )

    def run(self, watch: Watch | None) -> Path:
        """Follow the curve step by step to its end, and return its path."""
        count: cython.int
        for count in range(self.options.step.max_steps):
            if watch is not None and self.labelled is not None and self.labelled.departures == 0:
                watch(self.checkpoint())
            status = self.advance()
            if status is None:
                if self.progress is not None and count % 16 == 0:
                    self.progress(self.recorder.covered())
            elif status is not Status.STALLED or not self.retreat():
                return self.path(status)
        return self.path(Status.TOO_LONG)

    def path(self, status: Status) -> Path:
        """The points kept so far, as a `Path` with the given status."""
        return self.recorder.path(status)

    def retreat(self) -> bool:
        """Go back to an earlier point to continue by other steps; return whether that is possible."""
        if self.labelled is not None or self.attempts == len(self.options.step.retreats):
            return False
        self.attempts += 1
        self.step = min(self.options.step.initial_step, self.options.max_step)
        return step_back(self.stepper, self.recorder.store, self.options.step.retreats[self.attempts - 1])

    @cython.cfunc
    def advance(self) -> object:
        """Take one step along the curve; return a status if the curve ends, else None."""
        stepper: Stepper = self.stepper
        control: StepOptions = self.options.step
        switching: SwitchingOptions = self.options.switching
        step: cython.double = self.step
        if self.labelled is not None:
            return self.labelled.advance(self, step)
        step = self.landing.limit_step(stepper, step)
        many: cython.bint = self.problem.unknowns >= switching.many_unknowns
        reached: cython.double = switching.reached_distance
        if self.problem.costly and (
            self.steps_over_corners(step) or self.steps_over_corners(control.retry_fraction * step)
        ):
            return self.accept_step()
        if self.problem.has_root_margins and is_met(stepper):
            return self.leave_corner(stepper.here, 0.0)
        while step > control.min_step:
            known: cython.bint = (
                step <= stepper.known_length
            )  # the last corner and all that is nearer are one
            corner: cython.double = next_corner(stepper, step)
            if corner < step and step > self.approach_distance and many and self.steps_over_corners(step):
                return self.accept_step()
            if corner < min(step, reached):
                stepper.move_short(corner)
                return self.leave_corner(stepper.here, 0.0)
            # a curve bends more and more towards a corner, and may hide a pair of folds there
            if (
                self.approach_distance < corner < step
                and smooth_step(stepper, switching.approach_fraction * corner)
                and self.hidden_event() == 0.0
            ):
                return self.accept_step()
            if stepper.try_step(
                corner * (1.0 + switching.overshoot) + control.min_step if corner < step else step
            ):
                if changes_sign(stepper) and not known:
                    if stepper.known_length > 0.0 and before_corner(stepper) < stepper.known_length:
                        step = stepper.known_length  # on to the value of the parameter, which is nearer
                        continue
                    status = self.reach_corner() if stepper.miss < 1.0 else Status.STALLED
                    if status is not Status.STALLED:
                        return status
                elif corner >= step and acceptable(stepper):
                    hidden: cython.double = self.hidden_event() or self.landing.first_crossed(stepper, step)
                    if hidden == 0.0:
                        return self.accept_step()
                    step = hidden
                    continue
            if self.problem.has_root_margins:
                status = self.pass_straight_corner(step, corner)
                if status is not Status.STALLED:
                    return status
            # the curve may turn back in the corner, so that there is no point beyond it
            if corner < step and smooth_step(stepper, corner * (1.0 - switching.overshoot)):
                return self.accept_step()
            if corner < min(step, switching.turning_distance) and not self.is_at_corner():
                stepper.move_short(corner)  # it turns by more than a right angle: no plane ahead meets it
                return self.leave_corner(stepper.here, 0.0)
            step = 0.25 * min(step, corner)
        return Status.STALLED

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def is_at_corner(self) -> cython.bint:
        """Whether here is the last point kept, and a corner: no point was found beyond it."""
        store: PointStore = self.recorder.store
        return store.ends_at(self.stepper.here) and (store.mark[store.count - 1] & CORNER) != 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def steps_over_corners(self, step: cython.double) -> cython.bint:
        """Whether a step across all margins, taken as if there were none, is acceptable.

        If there are many margins, most corners are slight. The step is refused if a corner may hide a pair of
        folds, unless only values of the parameter matter.
        """
        stepper: Stepper = self.stepper
        if (
            not stepper.try_step(step)
            or not acceptable(stepper)
            or self.landing.first_crossed(stepper, step) > 0.0
        ):
            return False
        if hidden_reversal(stepper, self.recorder.most) != 0.0:
            return False
        return self.options.user_points_only or not changes_sign(stepper) or parameter_is_even(stepper)

    @cython.cfunc
    def pass_straight_corner(self, step: cython.double, corner: cython.double) -> object:
        """Continue from the corner where a margin vanishes, extrapolated from its value and slope here.

        STALLED if no margin approaches zero, or if the prediction meets the corner at the same place.
        """
        stepper: Stepper = self.stepper
        switching: SwitchingOptions = self.options.switching
        at: cython.double = next_extrapolated_root(stepper)
        if self.is_at_corner():
            return Status.STALLED
        if corner < step and corner > switching.root_fraction * at:
            return Status.STALLED
        past: cython.double = switching.crossing_factor * at
        if 0.0 < past < step and stepper.try_step(past) and stepper.miss < 1.0 and changes_sign(stepper):
            status = self.reach_corner()
            if status is not Status.STALLED:
                return status
        if 0.0 < at < switching.reached_distance_root:  # the curve may turn back there
            stepper.move_short(at)
            land(stepper)
            return self.leave_corner(stepper.here, 0.0)
        return Status.STALLED

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def hidden_event(self) -> cython.double:
        """Length at which the step hides a sign change or a reversal, by its two ends; 0 if it hides none."""
        self.stepper.differentiate_margins()
        at: cython.double = hidden_sign_change(self.stepper)
        return at if at > 0.0 else hidden_reversal(self.stepper, self.recorder.most)

    def acceptable(self) -> bool:
        """Whether the curve was where it was predicted, and continued smoothly."""
        return bool(acceptable(self.stepper))

    def fold_pair(self) -> float:
        """Length at which the step hides a pair of folds, by its two ends; 0 if it hides none."""
        return float(parameter_reversal(self.stepper) * self.stepper.step)

    @cython.ccall
    def accept_step(self) -> object:
        """Go to the end of the step and choose the next step; return a status if the curve ends."""
        stepper: Stepper = self.stepper
        count: cython.int = self.recorder.store.count
        if self.ends:
            ended = first_end(stepper, self.ends)
            if ended is not None:
                return self.recorder.stop_at(ended[1], ended[0])
        if self.recorder.keep_events(stepper.step):
            return self.recorder.end_status()
        if not self.recorder.inside():
            self.recorder.store.cut(count)  # beyond an end of the span, which the step did not hit
            self.step = 0.25 * stepper.step
            return Status.STALLED if self.step < self.options.step.step_after_corner else None
        if self.recorder.closed():
            return Status.CLOSED
        turned: cython.bint = stepper.there.orientation != stepper.here.orientation
        self.recorder.add(BRANCH if turned else 0)
        wanted: cython.double = self.step
        self.step = next_step(stepper)
        if (
            self.landing.shortened and self.step >= stepper.step
        ):  # nothing was at the value: return to the longer steps
            self.step = max(self.step, wanted)
        stepper.accept(stepper.there, stepper.step)
        self.recorder.update_greatest()
        return Status.UNBOUNDED if solution_size(stepper) > self.problem.unbounded * self.size else None

    @cython.cfunc
    def reach_corner(self) -> object:
        """Continue from the first corner of the step; STALLED if the curve is not found up to it."""
        stepper: Stepper = self.stepper
        at: cython.double = before_corner(stepper)
        if at < 0.0:
            return Status.STALLED
        # here may be a corner itself, with no event on the way to the next one
        if self.recorder.keep_events(stepper.step):
            return self.recorder.end_status()
        point: Point = stepper.between if stepper.find_between(at, True, True) else stepper.there
        return self.leave_corner(point, at)

    @cython.ccall
    def leave_corner(self, point: Point, at: cython.double, past: cython.double = 0.0) -> object:
        """Leave a corner, a point at a length from here; past: where to look beyond a change of label."""
        if self.nonsmooth.pass_corner(point, at, past or self.options.switching.departure_length):
            return self.recorder.end_status()
        if self.labelled is None and self.recorder.revisits_corner():
            self.recorder.came_around = True
            return self.recorder.end_status()
        resumed: cython.double = (
            self.options.step.resumed_fraction * self.step if self.problem.costly else 0.0
        )
        self.step = max(self.options.step.step_after_corner, resumed)
        return None

    def limit_step(self, step: float, longer: bool) -> None:
        """Make the next step at most (longer: at least) as long as a step."""
        self.step = min(max(self.step, step), self.options.max_step) if longer else min(self.step, step)


def follow(
    problem: Problem,
    start: FloatArray,
    span: tuple[float, float],
    events: Events = NO_EVENTS,
    options: FollowOptions = FOLLOW,
    *,
    forward: bool = True,
    direction: FloatArray | None = None,
    progress: Progress | None = None,
    watch: Watch | None = None,
    checkpoint: Checkpoint | None = None,
    stepper: Stepper | None = None,
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
    events : Events
        Values of the parameter and other points that the curve is to have. Folds, corners, peaks of outputs,
        branch points and the ends of the span are always points of it; see `Mark`.
    options : FollowOptions
        All tolerances, and the longest step.
    forward : bool
        Whether the parameter rises at first.
    direction : (n + 1,), optional
        Approximate direction of the curve at the start, in the units of z. The start is then corrected in the
        plane normal to it, unless the start's parameter is a value or an end at which the curve has a point.
    progress : callable, optional
        Called every 16 steps with the fraction of the span covered.
    watch : callable, optional
        Called with the checkpoint before each step of a labelled problem.
    checkpoint : Checkpoint, optional
        State of an interrupted curve of the same labelled problem, at which following resumes.
    stepper : Stepper, optional
        A stepper of the same problem that has finished another curve.

    Returns
    -------
    Path
        With status STALLED and without points where there is no curve at the start.

    Raises
    ------
    ValueError
        If the start has another shape, or the span ends below where it begins.
    PathInterrupted
        On a `KeyboardInterrupt`, with the points up to there.

    Examples
    --------
    >>> import numpy as np
    >>> from fcm.continuation import Mark, Problem, follow
    >>> class Circle(Problem):
    ...     def evaluate(self, z):
    ...         x, y = z
    ...         self.residual[0] = x * x + y * y - 1.0
    ...         self.jacobian[0, 0], self.jacobian[0, 1] = 2.0 * x, 2.0 * y
    ...         return 0
    >>> path = follow(Circle(1, 0, 0), np.array([1.0, 0.0]), (-2.0, 2.0))
    >>> path.status.name, [round(y, 6) for y in path.parameter[path.where(Mark.FOLD)].tolist()]
    ('CLOSED', [1.0, -1.0])
    """
    if span[0] > span[1]:
        raise ValueError(f"the span is {span[0]:g} to {span[1]:g}; its lower end comes first")
    if checkpoint is None and np.shape(start) != (problem.unknowns + 1,):
        wanted = f"({problem.unknowns + 1},): the unknowns, then the parameter"
        raise ValueError(f"the start has the shape {np.shape(start)}, and should have {wanted}")
    follower = Follower(problem, span, events, options, progress, stepper)
    if checkpoint is not None:
        follower.resume(checkpoint)
    elif not follower.begin(start, forward, direction):
        return follower.path(Status.STALLED)
    try:
        return follower.run(watch)
    except KeyboardInterrupt:
        raise PathInterrupted(follower.path(Status.INTERRUPTED)) from None
