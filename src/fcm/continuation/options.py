"""The tolerances of continuation: frozen, and documented field by field.

Lengths are those of the scaled unknowns, in which a curve is about 1 long; a part is of the quantity named.
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
    """What the options have in common, written once: they are compared, shown and sent by their fields."""

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


class SolverOptions(Frozen):  # taken by a kernel when it is made
    """How a dense system is solved; see `dense_solver`. They decide how fast, not what comes out.

    Attributes
    ----------
    lapack_size : int
        Unknowns from which on LAPACK is called.
    blocked_rows : int
        Rows from which on four of them are taken together.
    """

    lapack_size: int = 400 if cython.compiled else 40
    blocked_rows: int = 40


class ProblemOptions(Frozen):  # taken by a kernel when it is made
    """What holds for any problem that is followed; see `Problem`.

    Attributes
    ----------
    costly_size : int
        Unknowns from which on most of the work is to solve for them.
    unbounded : float
        Growth of the solution, over its size at the start, where a problem says nothing else.
    difference_length : float
        Length over which margins have their slopes.
    max_angle : float
        [rad] Margins this far from one another are not the same.
    """

    costly_size: int = 100
    unbounded: float = 1e9
    difference_length: float = 1e-6
    max_angle: float = 1.0


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class NewtonOptions(Options):
    """When Newton's method has come to the curve, and when it is given up; see `corrector`.

    Attributes
    ----------
    max_iterations : int
        Steps before a guess is judged too far away.
    max_step : float
        A longer one counts as divergence.
    tolerance : float
        Error that a point may have, estimated from the convergence.
    preliminary_tolerance : float
        The same of a point from which the next is looked for and nothing else.
    final_step : float
        A step after which there is no further one.
    negligible_step : float
        A step that is not worth another evaluation.
    half_steps : int
        Half steps where the equations begin as a root, before whole ones are tried again.
    stalled_rounding : float
        A step that does not shrink, and is taken for rounding though the way was long.
    growing_rounding : float
        A step that grows, and is taken for rounding; longer ones have met a corner.
    chord_step : float
        A step after which the Jacobian from before it will do.
    max_chord_steps, max_cheap_chord_steps : int
        Steps with one Jacobian; and where to solve takes far less than to factor.
    chord_contraction : float
        Part of the step before, that each of those may be.
    last_chord_step : float
        A step after which a last one takes the Jacobian from before it.
    divergence_ratio : float
        Part of the step before, above which the fourth and later steps of a costly problem diverge.
    small_second_step : float
        Part of the greatest first step: a second step this short is no sign of failure.
    max_rounding : float
        A longer step is none that rounding makes.
    rounding_multiple : float
        Equations off by no more than so many relative errors of rounding are solved to rounding.
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
    chord_contraction: cython.double = 0.3
    last_chord_step: cython.double = 1e-5
    divergence_ratio: cython.double = 0.5
    small_second_step: cython.double = 0.02
    max_rounding: cython.double = 1e-6
    rounding_multiple: cython.double = 8.0


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class StepOptions(Options):
    """Which step is accepted, and how long the next one is; see `step_control`.

    Attributes
    ----------
    initial_step, min_step : float
        The first and the shortest step; the curve ends where the shortest is still too long.
    max_steps : int
        Steps of a curve.
    min_cosine : float
        Of the angle by which the curve may turn in a step: 20 degrees.
    min_cubic_cosine : float
        Of the angle by which it turned in a step, beyond which that is no cubic any more.
    any_turn_step : float
        A shorter step may turn by any angle below a right angle: there is a corner that nothing shows.
    max_branch_distance : float
        Branches as near as this meet: there a step may change the orientation of the curve. From 6e-8 to
        4e-7 the tests tell no difference; with less rounding beside a branch point hides it.
    max_miss : float
        Part of its length, by which a step may miss the curve.
    target_turn : float
        [rad] The turn that a step aims at.
    target_miss : float
        Part of its length, by which a step aims to miss the curve.
    target_output_error : float
        Change of an output over its size, that a step aims not to have foreseen;
    max_output_error_ratio : float
        so many times as much it may have.
    min_factor, max_factor, max_factor_hasty : float
        Part of a step that the next is at least, and at most; and at most where nothing but values of the
        parameter is asked for.
    safety : float
        Part of the next step that all aims allow.
    step_after_corner, resumed_fraction : float
        The first step beyond a corner; or this part of that before it, where each point is costly.
    retry_fraction : float
        Part of a step that is tried next where it does not lead over all corners.
    retreats : tuple of int
        Points by which a curve is taken back where no step leads on: one attempt each.
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
    """How events are found within a step; see `events` and `extremum_search`.

    Attributes
    ----------
    max_evaluations : int
        Points of the curve that are computed to find one.
    tolerance : float
        Part of a step, to which an event is known.
    fold_bracket : float
        Distance of two points about a fold that is no regular point of the curve.
    min_growth : float
        Growth of an output over its size, along a unit of length, that is not rounding.
    peak_threshold : float
        Part of the greatest output so far, below which no peak is looked for.
    max_slope_change : float
        Part of the lesser slope at the ends: a parameter whose slope changes by less goes on evenly.
    doubtful_slope : float
        Part of the lesser slope at the ends: a cubic less steep between them may hide a way back.
    min_reversal : float
        Part of the greatest of all outputs so far, by which one goes back within a step: the corrector leaves
        a tenth of that.
    rounding_step : float
        A step this short shows more of rounding than of a way back.
    peak_tolerance, peak_tolerance_of_many : float
        Part of an output, to which a peak is known where points are costly; and where each of many outputs
        has its own, at a point each. A smaller part of the greatest output is rounding, and has no peak.
    many_outputs : int
        So many are many.
    point_tolerance : float
        Part of the greatest unknown: points closer than this are one.
    far_tolerance : float
        The same, beyond which the curve has been elsewhere before it came to a corner again.
    around_cosine : float
        Cosine of the directions at a corner, beyond which the curve comes to it as it did before.
    closing_cosine : float
        Cosine beyond which a curve closes, and does not cross itself.
    landing_tolerance : float
        Part of the width of a value of the parameter that is to be landed on, within which a step ends there.
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
    around_cosine: cython.double = 0.9999
    closing_cosine: cython.double = 0.5
    landing_tolerance: cython.double = 0.25


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class SwitchingOptions(Options):
    """How corners are come to and left where a switching function changes its sign; see `NonsmoothPoints`.

    Attributes
    ----------
    max_predictions : int
        Predictions that are looked at to find how far ahead a corner is.
    distance_tolerance, label_tolerance : float
        Part of the length to there, to which that is found; and where a label changes.
    overshoot : float
        Part of a step that ends at a corner, by which it goes past.
    crossing_factor : float
        Times as long as the way to where a margin vanishes that goes on as it does, is a step across that.
    root_fraction : float
        Part of that way, within which the prediction comes to a margin that is a root: half of it.
    smooth_fraction : float
        Part of the way to a corner: up to here the curve is smooth.
    reached_distance : float
        A corner this near is met: less than `departure_length`.
    turning_distance : float
        A corner this near is gone to along the prediction, if no step leads up to it, nor across.
    reached_distance_root : float
        The same where a margin is the root of the distance, which rounding hides.
    root_distance : float
        A corner where the equations begin as a root is met within this length of its surface, and is left as
        far on the other side; see `root_corner`.
    root_difference : float
        Length over which the square of such a root has its slopes.
    root_separation : float
        Of several such corners the nearest is left first if its distance is less than this part of the next.
    max_root_margin : float
        A root that is larger is not at its corner.
    approach_distance, approach_fraction : float
        A corner further away is gone to by steps, each this part of the way.
    departure_length : float
        Length past a corner at which the curve's new direction is looked for first,
    departure_tries : int
        at so many lengths, each ten times the last: what takes less of the curve is one corner,
    max_pieces : int
        in so many of the smooth pieces that meet in the corner.
    max_deviation : float
        Part of that length: a point this far from its prediction is another.
    many_unknowns : int
        Unknowns from which on slight corners are stepped over where the parameter goes on evenly.
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


class SignChangeOptions(Frozen):  # taken by a kernel when it begins
    """How a change of sign of an event is bracketed; see `events`.

    Attributes
    ----------
    jump_width : float
        Part of the first distance of its sides, at which a function that does not jump
    jump_difference : float
        differs by less than this part of what it did.
    halving_interval : int
        Looks that are to halve the distance.
    """

    jump_width: float = 0.25
    jump_difference: float = 0.5
    halving_interval: int = 3


SIGN_CHANGE = SignChangeOptions()


class LabelOptions(Frozen):  # of no kernel
    """Steps where switching functions are labels, which tell no distance; see `labelled_switching`.

    Attributes
    ----------
    target_error, max_error_ratio : float
        Distance of the curve from where it is predicted that a step aims at, and times as much it may have.
    max_parameter_miss : float
        Part of the parameter's change, by which a step may miss it: more may be the way past two folds.
    min_cosine : float
        Cosine of the turn of a step.
    max_miss, max_newton_step : float
        Parts of its length, by which a step may miss the curve; and by which the first step of Newton's
        method may.
    min_factor, rejection_factors, max_factor, max_factor_after_rejection : float, the second two of them
        Parts of a step that the next is at least; that one in its point is between; that the next is at
        most; and after a shortened one.
    straight_cosine : float
        Cosine beyond which a change of orientation is a branch point and no way back.
    max_length_ratio : float
        Times as long as its turn alone makes it, a short step may be.
    margin_fraction : float
        Part of the way to where a label changes, by which a step ends before it.
    reached_distance : float
        A change of label this near is met where no curve is found up to there.
    max_departures : int
        Points looked for beyond one corner, each ten times as far.
    departure_factor : float
        Times as far from the corner is the next point, at least.
    reversal_cosine, spike_cosine : float
        Cosines below which a curve goes back on the way that it came; the second where its label is new.
    fold_tolerance : float
        Distance of two folds that are one;
    min_loop_points : int
        points that a closed curve has at least.
    departure_lengths : tuple of float
        Lengths beyond a corner at which the curve is looked for,
    departure_fractions : tuple of float
        of these, by which a direction is looked for beyond, and a guess is aside.
    random_directions : int
        Directions into other pieces.
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


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class FollowOptions(Options):
    """How a curve is followed.

    Attributes
    ----------
    max_step : float
        Longest step.
    user_points_only : bool
        Whether only the passings of values of the parameter matter. Corners are then gone to, and left, by
        longer steps.
    newton, step, events, switching, labels : NewtonOptions, StepOptions, EventOptions, SwitchingOptions,\
 LabelOptions
        Of the parts.

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


class PathOptions(Frozen):  # of no kernel
    """When a solution lies on a path that was followed; see `all_branches` and `segment`.

    Attributes
    ----------
    solution_tolerance : float
        In the problem's scale: solutions closer than this are one.
    max_distance_ratio : float
        Part of a chord: what is further from it is not on its part of a path.
    nearest_chords : int
        Nearest ones that are looked at.
    min_cosine : float
        Cosine of a turn, below which a length across the chord is no measure of the way.
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
