"""The tolerances of continuation: frozen, and documented field by field.

Lengths refer to the scaled unknowns, in which a curve is about 1 long.
"""

from __future__ import annotations

import dataclasses
from dataclasses import field
from typing import Any

import cython

from fcm.frozen import Frozen

if not cython.compiled:
    from dataclasses import dataclass
else:
    from cython.dataclasses import dataclass  # type: ignore[no-redef]


@cython.cclass
class Options:
    """Base class of options: comparison, hash, display and pickling by their fields."""

    def _values(self) -> tuple[Any, ...]:
        return tuple(getattr(self, one.name) for one in dataclasses.fields(self))  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

    def __repr__(self) -> str:
        names = (one.name for one in dataclasses.fields(self))  # type: ignore[arg-type]
        shown = (f"{name}={value!r}" for name, value in zip(names, self._values(), strict=True))
        return f"{type(self).__name__}({', '.join(shown)})"

    def __reduce__(self) -> tuple[type, tuple[Any, ...]]:
        return type(self), self._values()


class SolverOptions(Frozen):  # a kernel takes them when it is made
    """Options on how a dense system is solved; see `dense_solver`.

    They affect the speed, not the results.

    Attributes
    ----------
    lapack_size : int
        Number of unknowns from which on the factors are computed by LAPACK, and below it by the kernel
        itself.
    blocked_rows : int
        Number of rows from which on the kernel eliminates four of them together.
    """

    lapack_size: int = 400 if cython.compiled else 40
    blocked_rows: int = 40


class ProblemOptions(Frozen):  # a kernel takes them when it is made
    """Options of any problem that is followed; see `Problem`.

    Attributes
    ----------
    costly_size : int
        Number of unknowns from which on a problem counts as costly: solving for them is most of the work.
    unbounded : float
        Growth of the solution, relative to its size at the start, beyond which the curve ends as unbounded; a
        problem may set another.
    difference_length : float
        Scaled length of the difference quotients that give the slopes of margins.
    max_angle : float
        [rad] Largest difference of angle between two margins that are taken to be the same.
    """

    costly_size: int = 100
    unbounded: float = 1e9
    difference_length: float = 1e-6
    max_angle: float = 1.0


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class NewtonOptions(Options):
    """Options on when Newton's method has converged, and when it gives up; see `corrector`.

    Attributes
    ----------
    max_iterations : int
        Number of whole Newton steps after which Newton's method gives up.
    max_step : float
        Scaled length of a Newton step from which on the iteration counts as divergent.
    tolerance : float
        Scaled error of a point, estimated from the convergence, below which it counts as on the curve.
    preliminary_tolerance : float
        The tolerance of the points at which steps end, if only values of the parameter matter.
    final_step : float
        Scaled length of a Newton step below which it is the last: the point has converged.
    negligible_step : float
        Scaled length of a Newton step below which it is not worth another evaluation.
    half_steps : int
        Number of halved Newton steps where the equations begin as a root, before whole steps are tried again.
    stalled_rounding : float
        Scaled length below which a Newton step that stalls is taken for rounding: the point is then accepted.
    growing_rounding : float
        Scaled length below which a Newton step longer than the one before is taken for rounding, where the
        problem has labels. A longer one that grows has met a corner.
    chord_step : float
        Scaled length, of a Newton step times its contraction, below which the next steps take the same
        Jacobian, where the problem has labels.
    max_chord_steps, max_cheap_chord_steps : int
        Most Newton steps in a row with the same Jacobian. The second number holds where solving takes far
        less work than factoring.
    chord_contraction, cheap_chord_contraction : float
        Length of such a step, relative to the one before, from which on the Jacobian is computed anew. The
        second holds where `max_cheap_chord_steps` does.
    last_chord_step : float
        Scaled length of a Newton step below which a last one with the same Jacobian is tried.
    max_growth, divergence_ratio : float
        Length of the fourth or a later Newton step, relative to the one before, beyond which the iteration
        diverges; the second where a problem is costly or has labels.
    rounding_ratio : float
        Length of a Newton step, relative to the one before, above which rounding may have made it.
    max_second_ratio : float
        Length of the second Newton step, relative to the first, from which on the iteration has failed, if
        the length of the first step is limited.
    small_second_step : float
        Length of the second Newton step, relative to the limit of the first, below which it never counts as
        failed.
    max_rounding : float
        Scaled length of a Newton step beyond which it is never taken for rounding.
    rounding_multiple : float
        Backward error of an equation, in units of the relative rounding error, up to which it counts as
        solved to rounding.
    """

    max_iterations: cython.int = 8
    max_step: cython.double = 1e30
    tolerance: cython.double = 1e-13
    preliminary_tolerance: cython.double = 1e-9
    final_step: cython.double = 1e-12
    negligible_step: cython.double = 1e-11
    half_steps: cython.int = 8
    stalled_rounding: cython.double = 1e-9
    growing_rounding: cython.double = 1e-10
    chord_step: cython.double = 1e-6
    max_chord_steps: cython.int = 3
    max_cheap_chord_steps: cython.int = 16
    chord_contraction: cython.double = 0.1
    cheap_chord_contraction: cython.double = 0.3
    last_chord_step: cython.double = 1e-5
    max_growth: cython.double = 2.0
    divergence_ratio: cython.double = 0.5
    rounding_ratio: cython.double = 0.25
    max_second_ratio: cython.double = 0.5
    small_second_step: cython.double = 0.02
    max_rounding: cython.double = 1e-6
    rounding_multiple: cython.double = 8.0


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class StepOptions(Options):
    """Options on which steps are accepted, and how long the next step is; see `step_control`.

    Attributes
    ----------
    initial_step, min_step : float
        Scaled lengths of the first and of the shortest step. The curve ends as stalled if the shortest is
        rejected.
    max_steps : int
        Most steps of a curve, after which it ends as too long.
    min_cosine : float
        Cosine of the turn of the curve in a step, below which the step is rejected; 0.94 is 20 degrees.
    min_cubic_cosine : float
        Cosine of the turn in a step, below which no cubic predictor is made from the points of that step.
    any_turn_step : float
        Scaled length up to which a step may turn by any angle below a right angle, as at a corner that no
        margin shows.
    max_branch_distance : float
        Scaled distance up to which two branches are taken to meet, so that a step may change the orientation
        of the curve. Values from 6e-8 to 4e-7 give the same results in the tests; below that, rounding near
        a branch point hides it.
    max_miss : float
        Distance of a point from its prediction, relative to the step, beyond which the step is rejected.
    target_turn : float
        [rad] Turn of the curve in a step for which the step length is chosen.
    target_miss : float
        Distance of a point from its prediction, relative to the step, for which the step length is chosen.
    target_output_error : float
        Change of an output that its slope did not predict, relative to the output, for which the step length
        is chosen.
    max_output_error_ratio : float
        Change of an output that its slope did not predict, relative to `target_output_error`, beyond which a
        step is rejected.
    min_factor, max_factor, max_factor_hasty : float
        Least and greatest length of the next step, relative to the last. The third is the greatest if only
        values of the parameter matter.
    safety : float
        Factor on the step length that meets all targets.
    step_after_corner, resumed_fraction : float
        Scaled length of the first step beyond a corner, and for a costly problem its length relative to the
        step before the corner; the longer of the two is taken.
    retry_fraction : float
        Length of the second attempt to step over all corners, relative to the first, for a costly problem.
    retreats : tuple of int
        Numbers of points by which the curve is taken back if no step leads on, one for each attempt.
    """

    initial_step: cython.double = 1e-3
    min_step: cython.double = 1e-9
    max_steps: cython.int = 20_000
    min_cosine: cython.double = 0.94
    min_cubic_cosine: cython.double = 0.1
    any_turn_step: cython.double = 1e-4
    max_branch_distance: cython.double = 2e-7
    max_miss: cython.double = 0.5
    target_turn: cython.double = 0.2
    target_miss: cython.double = 0.03
    target_output_error: cython.double = 0.15
    max_output_error_ratio: cython.double = 4.0
    min_factor: cython.double = 0.4
    max_factor: cython.double = 2.5
    max_factor_hasty: cython.double = 10.0
    safety: cython.double = 0.9
    step_after_corner: cython.double = 1e-5
    resumed_fraction: cython.double = 0.1
    retry_fraction: cython.double = 0.25
    retreats: tuple[int, ...] = (1, 8, 64)


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class EventOptions(Options):
    """Options on how events are found within a step; see `events` and `extremum_search`.

    Attributes
    ----------
    max_evaluations : int
        Most points of the curve that are computed to find one event.
    tolerance : float
        Length, relative to the step, to which the place of an event is found.
    fold_bracket : float
        Scaled width to which the bracket of a fold shrinks that is not a regular point of the curve.
    min_growth : float
        Slope of an output by scaled length, relative to the output, below which it counts as rounding.
    peak_threshold : float
        Size of an output, relative to the greatest so far, below which its peaks are ignored.
    max_slope_change : float
        Change of the parameter's slope over a step, relative to the lesser slope at its ends, below which the
        step hides no pair of folds.
    doubtful_slope : float
        Slope of the cubic within a step, relative to the lesser slope at its ends, below which the step may
        hide a reversal and is shortened.
    min_reversal : float
        Reversal of an output within a step, relative to the greatest of all outputs so far, below which it is
        ignored. The error of the corrector is a tenth of it.
    rounding_step : float
        Scaled length of a step up to which it is not searched for reversals: its ends would show rounding.
    peak_tolerance, peak_tolerance_of_many : float
        Error of a peak relative to the output, for few outputs and for `many_outputs`. An output smaller
        than the first times the greatest output is rounding and has no peak.
    many_outputs : int
        Number of outputs from which on `peak_tolerance_of_many` holds.
    point_tolerance : float
        Distance of two points, relative to the greatest unknown, below which they are the same.
    far_tolerance : float
        Distance from a corner, relative to the greatest unknown, beyond which the curve has left it; a later
        return is a second visit.
    repeat_tolerance : float
        Distance of two corners, relative to the greatest unknown, below which they are identical.
    around_cosine : float
        Cosine between the directions of two visits to a corner, above which the curve came in the same
        direction: it is closed.
    closing_cosine : float
        Cosine between the directions at the first point, above which the curve closes there; below it the
        curve crosses itself.
    landing_tolerance : float
        Distance from a value of `Events.narrow`, relative to its width, up to which a step may end beside it.
    """

    max_evaluations: cython.int = 40
    tolerance: cython.double = 1e-11
    fold_bracket: cython.double = 1e-4
    min_growth: cython.double = 1e-7
    peak_threshold: cython.double = 0.9
    max_slope_change: cython.double = 0.2
    doubtful_slope: cython.double = 0.25
    min_reversal: cython.double = 1e-10
    rounding_step: cython.double = 1e-4
    peak_tolerance: cython.double = 1e-11
    peak_tolerance_of_many: cython.double = 5e-7
    many_outputs: cython.int = 24
    point_tolerance: cython.double = 1e-6
    far_tolerance: cython.double = 1e-4
    repeat_tolerance: cython.double = 1e-10
    around_cosine: cython.double = 0.9999
    closing_cosine: cython.double = 0.5
    landing_tolerance: cython.double = 0.25


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class SwitchingOptions(Options):
    """Options on how corners, where a margin changes sign, are reached and left; see `NonsmoothPoints`.

    Attributes
    ----------
    max_predictions : int
        Most predictions that are evaluated to find the distance of the next corner.
    distance_tolerance, label_tolerance : float
        Relative error of the distance to the next corner; the second for a change of label.
    overshoot : float
        Length by which a step passes a corner, relative to the distance to it.
    crossing_factor : float
        Length of a step across the extrapolated zero of a margin, relative to the distance to that zero.
    root_fraction : float
        Distance at which the prediction meets a corner, relative to that of the extrapolated zero, above
        which the margin is not a root; for a root it is one half.
    smooth_fraction : float
        Distance of the last smooth point before a corner, relative to the way to the corner.
    reached_distance : float
        Scaled distance up to which a corner counts as reached; less than `departure_length`.
    turning_distance : float
        Scaled distance up to which the curve goes to a corner along the prediction, if no step leads to it or
        across it: the curve turns there by more than a right angle.
    reached_distance_root : float
        Scaled distance up to which a corner counts as reached where the margin is a root, which rounding
        hides.
    root_distance : float
        Scaled distance from its surface within which a root corner is met. The curve is then sought at the
        same distance on the other side; see `root_corner`.
    root_difference : float
        Length of the difference quotients, relative to the scale, for the slopes of the squared margin.
    root_separation : float
        Distance of the nearest of several root corners, relative to the second, below which the nearest is
        left first.
    max_root_margin : float
        Size of a margin above which its point is not at a root corner.
    approach_distance, approach_fraction : float
        Scaled distance of a corner beyond which steps approach it, and the length of each such step relative
        to the remaining distance.
    departure_length : float
        Scaled length past a corner at which the new direction of the curve is computed first.
    departure_tries : int
        Number of lengths past a corner that are tried, each ten times the last; corners within the length are
        passed as one.
    max_pieces : int
        Number of smooth pieces meeting in a corner whose directions are tried at each of these lengths.
    max_deviation : float
        Distance of a point beyond a corner from its prediction, relative to that length, from which on it is
        not accepted.
    many_unknowns : int
        Number of unknowns from which on slight corners are stepped over if the parameter changes evenly.
    """

    max_predictions: cython.int = 50
    distance_tolerance: cython.double = 1e-4
    label_tolerance: cython.double = 2e-3
    overshoot: cython.double = 1e-3
    crossing_factor: cython.double = 1.1
    root_fraction: cython.double = 0.75
    smooth_fraction: cython.double = 1e-6
    reached_distance: cython.double = 1e-8
    turning_distance: cython.double = 1e-6
    reached_distance_root: cython.double = 1e-4
    root_distance: cython.double = 1e-9
    root_difference: cython.double = 1e-6
    root_separation: cython.double = 1e-2
    max_root_margin: cython.double = 1e-2
    approach_distance: cython.double = 1e-4
    approach_fraction: cython.double = 0.9
    departure_length: cython.double = 1e-7
    departure_tries: cython.int = 6
    max_pieces: cython.int = 3
    max_deviation: cython.double = 0.5
    many_unknowns: cython.int = 64


class SignChangeOptions(Frozen):  # a kernel takes them when it is made
    """Options on how the sign change of an event is bracketed; see `events`.

    Attributes
    ----------
    jump_width : float
        Width of the bracket, relative to its first one, below which a jump of the function is recognised.
    jump_difference : float
        Difference of the function across such a narrow bracket, relative to the first bracket, above which it
        jumps.
    halving_interval : int
        Number of evaluations within which the bracket has to halve; otherwise the next one bisects it.
    """

    jump_width: float = 0.25
    jump_difference: float = 0.5
    halving_interval: int = 3


SIGN_CHANGE = SignChangeOptions()


class LabelOptions(Frozen):  # not used by a kernel
    """Options on steps of problems whose margins are labels; see `labelled_switching`.

    Attributes
    ----------
    target_error, max_error_ratio : float
        Scaled distance between point and prediction for which the step length is chosen, and the largest
        accepted distance relative to it.
    max_parameter_miss : float
        Error of the predicted parameter, relative to its change along the step, beyond which the step is
        rejected: it may have skipped two folds.
    min_cosine : float
        Cosine of the turn of the curve in a step, below which the step is rejected.
    max_miss, max_newton_step : float
        Distance of a point from its prediction, and length of the first Newton step, both relative to the
        step, beyond which the step is rejected.
    min_factor, rejection_factors, max_factor, max_factor_after_rejection : float, the second two of them
        Lengths of the next step relative to the last: least after an accepted step; least and greatest after
        a rejected one; greatest after an accepted step; greatest after an accepted step that was shortened.
    straight_cosine : float
        Cosine of the turn above which a change of orientation is a branch point and not a reversal.
    max_length_ratio : float
        Distance between the ends of a short step times the cosine of its turn, relative to the step, beyond
        which it has led to another branch.
    margin_fraction : float
        Distance from a change of label at which a step ends, relative to the way to it.
    reached_distance : float
        Scaled distance up to which a change of label counts as reached if the curve is not found up to it.
    max_departures : int
        Number of lengths beyond a corner that are tried, each ten times the last.
    departure_factor : float
        Least length of the first step beyond a corner, relative to the length at which the direction was
        found.
    reversal_cosine, spike_cosine : float
        Cosine of the turn at a corner, below which the curve would go back on itself; the second if the label
        beyond is new.
    fold_tolerance : float
        Greatest scaled difference of an unknown between two folds that are taken for the same one.
    min_loop_points : int
        Number of points between two such folds from which on the curve is closed.
    departure_lengths : tuple of float
        Scaled lengths beyond a corner at which the curve is sought in all directions, in turn.
    departure_fractions : tuple of float
        Distances relative to these lengths at which the tangent is taken, and by which the guess is moved
        along the incoming direction.
    random_directions : int
        Number of random directions in which other smooth pieces are sought.
    safety : float
        Factor on the step for which the expected error is the target error.
    min_error : float
        Scaled distance of a point from its prediction that replaces any smaller one.
    retreat : float
        Length of a step after a failure, relative to the way to the change of label or to the failed step.
    min_way_cosine : float
        Cosine between the direction beyond a corner and the way there, below which the curve goes back.
    """

    target_error: float = 5e-4
    max_error_ratio: float = 4.0
    max_parameter_miss: float = 0.5
    min_cosine: float = 0.5
    max_miss: float = 0.5
    max_newton_step: float = 0.5
    min_factor: float = 0.3
    rejection_factors: tuple[float, float] = (0.1, 0.5)
    max_factor: float = 3.0
    max_factor_after_rejection: float = 1.0
    straight_cosine: float = 0.999
    max_length_ratio: float = 2.0
    margin_fraction: float = 3e-3
    reached_distance: float = 1e-6
    max_departures: int = 5
    departure_factor: float = 10.0
    reversal_cosine: float = -0.99
    spike_cosine: float = -1.0 + 1e-6
    fold_tolerance: float = 1e-8
    min_loop_points: int = 20
    departure_lengths: tuple[float, ...] = (1e-5, 1e-4, 1e-3, 1e-6)
    departure_fractions: tuple[float, ...] = (1.0, 0.1, 1e-2, 1e-3)
    random_directions: int = 16
    safety: float = 0.9
    min_error: float = 1e-12
    retreat: float = 0.25
    min_way_cosine: float = 0.5


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class FollowOptions(Options):
    """Options on how a curve is followed.

    Attributes
    ----------
    max_step : float
        Scaled length of the longest step.
    user_points_only : bool
        Whether only the points at given values of the parameter matter. Steps to and from corners are then
        longer.
    newton, step, events, switching, labels : NewtonOptions, StepOptions, EventOptions, SwitchingOptions,\
 LabelOptions
        Options of the corrector, of the step control, of events, of corners, and of problems with labels.

    Examples
    --------
    >>> from dataclasses import replace
    >>> replace(FollowOptions(), max_step=0.2).max_step
    0.2
    """

    max_step: cython.double = 0.05
    user_points_only: cython.bint = False
    newton: NewtonOptions = field(default_factory=NewtonOptions)
    step: StepOptions = field(default_factory=StepOptions)
    events: EventOptions = field(default_factory=EventOptions)
    switching: SwitchingOptions = field(default_factory=SwitchingOptions)
    labels: LabelOptions = field(default_factory=LabelOptions)


class PathOptions(Frozen):  # not used by a kernel
    """Options on when a solution lies on a path; see `all_branches` and `segment`.

    Attributes
    ----------
    solution_tolerance : float
        Scaled distance below which two solutions are the same.
    max_distance_ratio : float
        Distance of a solution from a chord of a path, relative to the chord, beyond which it does not lie
        near that chord.
    nearest_chords : int
        Number of nearest chords on which a solution is sought.
    min_cosine : float
        Cosine between the path and the normal of a plane, below which a length along that normal does not
        measure the way along the path.
    """

    solution_tolerance: float = 1e-5
    max_distance_ratio: float = 0.5
    nearest_chords: int = 4
    min_cosine: float = 0.1


SOLVER = SolverOptions()
PROBLEM = ProblemOptions()
NEWTON = NewtonOptions()
FOLLOW = FollowOptions()
PATH = PathOptions()
