"""Tolerances and limits of tracked curves, and of searches for the least peak over numbers of a scene.

`TrackingOptions` has all of the curves. It is a field of `TrackingSetup`, which all curves of one run share.
"""

from __future__ import annotations

from fcm.continuation.options import StepOptions
from fcm.frozen import Frozen
from fcm.stability.options import STABILITY, StabilityOptions

PIECE_STEPS = StepOptions(initial_step=1e-3, min_step=1e-7, max_steps=3000, retreats=())


class PieceOptions(Frozen):
    """Options on the smooth pieces of a tracked curve and their connection; lengths in the problem's scale.

    Attributes
    ----------
    step : StepOptions
        Options of the step control of a piece.
    max_points, max_pieces : int
        Most points, and most pieces, of a curve; with more it ends as too long.
    reach : float
        Length assumed for the step before the first Newton step to a point of the curve, see
        `Newton.correct`.
    max_correction : float
        Length of the correction of a start, from which on the start does not belong to this curve.
    short_steps : int
        Most steps in a row with short length.
    short_step : float
        Length of a step below which a corner of the response is sought ahead.
    max_factor : float
        Length of the first step after short ones, relative to the last of them.
    reached_distance : float
        Distance up to which a corner counts as reached, or as passed by a very short step.
    corner_distance : float
        Distance above which a corner does not end a piece.
    departure_lengths : tuple of float
        Lengths beyond a corner at which the curve is sought again, in turn.
    least_departure : float
        Length along the curve below which a way on is tried last.
    max_jump : float
        Value of the special-point condition on the far side of a corner, above which it jumps there.
    min_cosine_ahead : float
        Cosine between the tangent of the curve and the direction to a corner, above which the corner is
        ahead.
    max_move : float
        Length of the correction of a point beside a corner, from which on the point is not accepted.
    kink_length : float
        Change of the number by which a kink is passed, relative to its span.
    kink_radii : tuple of float
        Radii of the circles about a kink on which the way on is sought, in turn.
    radius_tolerance : float
        Length of the correction of a point on such a circle, relative to the radius, above which the point is
        not accepted.
    min_radial_cosine : float
        Cosine between the tangent of the curve at that point and the radius, below which the point belongs to
        another curve.
    """

    step: StepOptions = PIECE_STEPS
    max_points: int = 3000
    max_pieces: int = 300
    reach: float = 1e-3
    max_correction: float = 0.3
    short_steps: int = 4
    short_step: float = 1e-3
    max_factor: float = 2.5
    reached_distance: float = 1e-5
    corner_distance: float = 1e-2
    departure_lengths: tuple[float, ...] = (1e-5, 1e-4, 1e-6, 1e-3)
    least_departure: float = 1e-7
    max_jump: float = 1e-4
    min_cosine_ahead: float = 0.5
    max_move: float = 1e-6
    kink_length: float = 1e-9
    kink_radii: tuple[float, ...] = (1e-6, 1e-5, 1e-4, 1e-3)
    radius_tolerance: float = 0.1
    min_radial_cosine: float = 0.7


class SpecialPointOptions(Frozen):
    """Options on the equations of a special point of a response.

    Attributes
    ----------
    min_amplitude : float
        Least amplitude in a division.
    difference_length : float
        Step of the difference quotient of the Jacobian along the response, relative to the extent of the
        response.
    min_difference_fraction : float
        Least such step, where a corner is near.
    corner_fraction : float
        Longest such step, relative to the distance to a corner, where derivatives change like a square root.
    max_tangent : float
        Length of the computed tangent, relative to the row that closes the equations, from which on the row
        is nearly normal to it. The tangent is then the singular vector.
    """

    min_amplitude: float = 1e-150
    difference_length: float = 1e-5
    min_difference_fraction: float = 1e-9
    corner_fraction: float = 0.05
    max_tangent: float = 1e3


class CornerOptions(Frozen):
    """Options on special points that are corners of a response; lengths are in the problem's scale.

    Attributes
    ----------
    max_iterations : int
        Most steps of Newton's method, and of the secant method.
    tolerance : float
        Length of a step below which it is the last.
    first_step : float
        Length of the first step of the secant method.
    max_distance : float
        Greatest length along a corner at which its special point is sought.
    side_distance : float
        Distance from a corner at which its two sides are evaluated. It exceeds the rounding error of the
        corner: some 1e-12 in a plane, where slip begins like a square root.
    rounding : float
        Distance up to which a point counts as at a corner.
    """

    max_iterations: int = 20
    tolerance: float = 1e-13
    first_step: float = 1e-6
    max_distance: float = 0.1
    side_distance: float = 1e-10
    rounding: float = 1e-11


class KinkOptions(Frozen):
    """Options on the search for the way on from a kink, on a circle about it.

    Attributes
    ----------
    min_angle, max_angle : float
        [rad] Least and greatest angle from the way back that are sampled closely: the way on may make a
        narrow angle with the way back.
    max_iterations : int
        Most Newton steps to the surface of solutions.
    tolerance : float
        Length of a Newton step below which it is the last.
    angle_tolerance : float
        [rad] Error of the angle at which the special-point condition changes its sign.
    jump_fraction : float
        Value of the condition beside a sign change, relative to the greatest on the circle, above which it
        jumps there and has no zero.
    """

    min_angle: float = 1e-3
    max_angle: float = 0.2
    max_iterations: int = 8
    tolerance: float = 1e-12
    angle_tolerance: float = 1e-10
    jump_fraction: float = 1e-3


class OnsetOptions(Frozen):
    """Options on the extremes within a cycle that decide the state of a contact.

    Attributes
    ----------
    samples_per_period : int
        Number of samples for each period of the highest harmonic, among which an extreme is sought.
    max_iterations : int
        Number of Newton steps from the extreme sample.
    """

    samples_per_period: int = 24
    max_iterations: int = 4


class CurveOptions(Frozen):
    """Options on the search for all tracked curves over a range of the number.

    Attributes
    ----------
    start_values : int
        Number of values, evenly spaced, at which responses are traced for starts.
    value_tolerance : float
        Difference of two values of the number, relative to its range, below which they are the same.
    frequency_tolerance : float
        Relative difference of frequencies below which a point is on a curve.
    max_peaks : int
        Most curves of peaks along which onsets are sought.
    min_height : float
        Height of a peak, relative to the greatest amplitude of its degree of freedom, up to which it is not
        tracked.
    min_prominence : float
        Prominence of a peak lower than others of its branch, relative to its height, up to which no tracked
        curve begins there. Folds where a contact begins to slip have many smaller peaks.
    cusp_tolerance : float
        Rate of the frequency at a turn of the number, relative to that at the points beside it, below which
        the turn is a cusp: the frequency also turns back.
    """

    start_values: int = 13
    value_tolerance: float = 1e-9
    frequency_tolerance: float = 1e-3
    max_peaks: int = 3
    min_height: float = 1e-3
    min_prominence: float = 1e-3
    cusp_tolerance: float = 1e-3


class KnownCurveOptions(Frozen):
    """Options on the test whether a known curve passes a point.

    Attributes
    ----------
    point_tolerance : float
        Distance in the problem's scale below which two points are the same.
    max_chord_part : float
        Distance of a point from a chord, relative to the chord, from which on it is not on that part of the
        curve: the curve would have to turn by 90 degrees.
    nearest_chords : int
        Number of nearest chords at which the curve is computed.
    """

    point_tolerance: float = 1e-5
    max_chord_part: float = 0.5
    nearest_chords: int = 4


class TurnErrorOptions(Frozen):
    """Options on the error at a turn of the number.

    Attributes
    ----------
    points_before : int
        Number of points before a turn at which the search for the turn with more harmonics begins.
    span_factor : float
        Range of the number of this search, relative to the distance from its start to the turn.
    before_end : float
        Distance from the value at which a peak ends, relative to that value, at which the search for the end
        with more harmonics begins.
    """

    points_before: int = 3
    span_factor: float = 3.0
    before_end: float = 0.05


class EnvelopeOptions(Frozen):
    """Options on the envelope of several peaks over the number, and on its least value.

    Attributes
    ----------
    brackets : int
        Number of the lowest points about which the least value is sought.
    value_tolerance : float
        Error of the number at the least value, relative to its range, or to the number itself if that is
        less.
    search_tolerance : float
        Error of the number, relative to the range, up to which the search uses only heights.
    bracket : float
        Distance from the value found, relative to the range, at which the slopes on both sides decide on the
        kind of the minimum.
    smooth_slope : float
        Slope of a peak at the least value, relative to the lesser one of those on both sides, below which the
        minimum is smooth and no corner.
    chord_fraction : float
        Height of a peak by the chords, relative to the highest, below which it is not computed.
    min_gap : float
        Width of a gap without pieces, relative to the whole range, above which the gap is examined.
    height_tolerance : float
        Relative difference of two peaks up to which they are equal, as at a crossing.
    unknown_factor : float
        Finite height that replaces an unknown one, relative to the highest.
    extreme_tolerance : float
        Relative difference of two extremes of a cycle up to which they are equal.
    flat_slope : float
        Relative change of a peak over the whole range, by its slope, up to which it does not depend on the
        number.
    flat_height : float
        Height of such a flat stretch above the least value, relative to the latter, up to which the stretch
        counts as the least: the onset of slip lowers peaks slightly.
    min_flat : float
        Least width of a flat stretch, relative to the range.
    wide_flat : float
        Width of a flat stretch, relative to the range, from which on the rest of the range is searched
        separately, since all other lengths are relative to the range.
    """

    brackets: int = 4
    value_tolerance: float = 1e-9
    search_tolerance: float = 1e-5
    bracket: float = 1e-4
    smooth_slope: float = 1e-3
    chord_fraction: float = 0.7
    min_gap: float = 1e-3
    height_tolerance: float = 1e-7
    unknown_factor: float = 10.0
    extreme_tolerance: float = 1e-12
    flat_slope: float = 1e-8
    flat_height: float = 1e-6
    min_flat: float = 1e-3
    wide_flat: float = 0.9


class TrackedStabilityOptions(Frozen):
    """Options on changes of stability along a tracked curve.

    Attributes
    ----------
    corner_side : float
        Distance to either side of a corner at which the sign of the determinant is computed, in the scale:
        the response may turn back at the corner.
    halvings : int
        Number of bisections of a step in which stability changes.
    """

    corner_side: float = 1e-6
    halvings: int = 14


class TrialOptions(Frozen):
    """Options on the search for the least peak by trials.

    Attributes
    ----------
    values : int
        Number of values over the range that are tried first, including both ends.
    minima, refinements, closer_values : int, int, int
        Number of local minima of these values that are refined; most refinements, the further ones at the
        least value known then; and most further values for each.
    min_distance : float
        Distance of two values, relative to the range, at which a refinement ends.
    same_height, close_height : float
        Relative difference of two peaks up to which they are equally high; and up to which the least is not
        refined further.
    min_flat : float
        Width of a stretch of equally high peaks, relative to the range, from which on they do not depend on
        the number.
    """

    values: int = 5
    minima: int = 2
    refinements: int = 5
    closer_values: int = 4
    min_distance: float = 1e-4
    same_height: float = 1e-9
    close_height: float = 0.01
    min_flat: float = 0.2


class TrackingOptions(Frozen):
    """All options of tracked curves, grouped by purpose; see the class of each field."""

    pieces: PieceOptions = PieceOptions()
    special: SpecialPointOptions = SpecialPointOptions()
    corner: CornerOptions = CornerOptions()
    kink: KinkOptions = KinkOptions()
    onset: OnsetOptions = OnsetOptions()
    curves: CurveOptions = CurveOptions()
    known: KnownCurveOptions = KnownCurveOptions()
    error: TurnErrorOptions = TurnErrorOptions()
    envelope: EnvelopeOptions = EnvelopeOptions()
    stability: TrackedStabilityOptions = TrackedStabilityOptions()
    trials: TrialOptions = TrialOptions()
    floquet: StabilityOptions = STABILITY


class SearchOptions(Frozen):
    """Options on the search for the least peak over one number; see `fcm.tracking.lowest_peak`.

    Attributes
    ----------
    max_visits : int
        Most values of the number at which a response is traced.
    height_tolerance : float
        Relative height above the expected least peak, above which a traced peak has not been followed.
    high_fraction : float
        Height, relative to the highest peak, from which on peaks of a traced response are followed.
    tracking : TrackingOptions
        Options of the tracked curves.
    """

    max_visits: int = 12
    height_tolerance: float = 1e-5
    high_fraction: float = 0.9
    tracking: TrackingOptions = TrackingOptions()


class DescentOptions(Frozen):
    """Options on the search for the least peak over two or three numbers; see `fcm.tracking.minimax`.

    Attributes
    ----------
    grid : tuple of float
        Positions in each number's range, relative to it, at which the first responses are traced.
    starts : int
        Number of the lowest of these responses from which a descent starts.
    max_rounds : int
        Most rounds of descending and of tracing anew.
    max_halvings : int
        Most halvings of a step at whose end other peaks are higher.
    max_iterations : int
        Most iterations of one descent; then the responses are traced anew, as the descent may alternate at a
        kink.
    min_change : float
        Relative change of the greatest height in an iteration below which a descent ends.
    min_improvement : float
        Relative improvement along a single number above which a further descent begins.
    height_tolerance : float
        Relative height above the expected one, above which another peak has not been followed.
    out_of_range_height : float
        Relative height that replaces that of a peak which has left the frequency range, so that no step leads
        there.
    kink_tolerance : float
        Relative difference of two peaks up to which they meet in one kink.
    value_rounding : float
        Distance of a number from an end of its range, relative to the range, below which it is set to that
        end.
    bound_tolerance : float
        Distance from an end of a number's range, relative to the range, below which the optimum lies at that
        end.
    search : SearchOptions
        Options of the search along a single number.
    """

    grid: tuple[float, ...] = (0.1, 0.5, 0.9)
    starts: int = 2
    max_rounds: int = 6
    max_halvings: int = 8
    max_iterations: int = 20
    min_change: float = 1e-10
    min_improvement: float = 1e-5
    height_tolerance: float = 1e-6
    out_of_range_height: float = 10.0
    kink_tolerance: float = 1e-5
    value_rounding: float = 1e-12
    bound_tolerance: float = 1e-6
    search: SearchOptions = SearchOptions()


TRACKING = TrackingOptions()  # the default
SEARCH = SearchOptions()
DESCENT = DescentOptions()
