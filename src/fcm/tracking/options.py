"""Tolerances and limits of tracked curves, and of searches for the least peak over numbers of a scene.

`TrackingOptions` has all of the curves. It is a field of `TrackingSetup`, which all curves of one run share.
"""

from __future__ import annotations

from fcm.continuation.options import StepOptions
from fcm.frozen import Frozen
from fcm.stability.options import STABILITY, StabilityOptions

PIECE_STEPS = StepOptions(initial_step=1e-3, min_step=1e-7, max_steps=3000, retreats=())


class PieceOptions(Frozen):
    """Of the smooth pieces of a tracked curve, and how they are joined. Lengths are in the problem's scale.

    Attributes
    ----------
    step : StepOptions
        First, shortest and most of a piece.
    max_points, max_pieces : int
        Of a curve, at most.
    max_correction : float
        A start that is corrected by more is none.
    short_steps : int
        Steps in a row that may be short.
    short_step : float
        A step below which a corner of the response is looked for ahead.
    max_factor : float
        Of a step to the next after short ones, at most.
    reached_distance : float
        Distance to a corner that has been reached, or passed by a step too short to tell.
    corner_distance : float
        A corner further away does not end a piece.
    departure_lengths : tuple of float
        Beyond a corner at which what is tracked is looked for again.
    least_departure : float
        Along the curve; what is less far ahead of a corner is looked at last.
    max_jump : float
        Of what is special; less is no jump at a corner.
    min_cosine_ahead : float
        Cosine of the angle with the direction of what lies ahead.
    max_move : float
        What is found beside a corner is moved by less.
    kink_length : float
        Of the span of the number, by which a kink is passed.
    kink_radii : tuple of float
        Of circles about a kink on which the curve is looked for.
    radius_tolerance : float
        Of such a radius, by which the point found there may be wrong.
    min_radial_cosine : float
        Cosine of the angle of the way on with its radius; other lines cross the circle anyhow.
    """

    step: StepOptions = PIECE_STEPS
    max_points: int = 3000
    max_pieces: int = 300
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
    """The equations of a special point of a response.

    Attributes
    ----------
    min_amplitude : float
        Amplitude; lower ones count as this in a division.
    difference_length : float
        Along the response, of its extent, by which its Jacobian is evaluated for a difference.
    min_difference_fraction : float
        Of that distance, where a corner is near.
    corner_fraction : float
        Of the way to a corner, which the distance is at most, as derivatives change there like a root.
    max_tangent : float
        Times as long as the row; a longer one is nearly across it.
    """

    min_amplitude: float = 1e-150
    difference_length: float = 1e-5
    min_difference_fraction: float = 1e-9
    corner_fraction: float = 0.05
    max_tangent: float = 1e3


class CornerOptions(Frozen):
    """Special points that are corners of a response. Lengths are in the problem's scale.

    Attributes
    ----------
    max_iterations : int
        Of Newton's method, and of the secant, at most.
    tolerance : float
        Length of a step that ends them.
    first_step : float
        Step of the secant.
    max_distance : float
        Along a corner, that what is special of it is sought.
    side_distance : float
        Distance from a corner at which its two sides are evaluated.
    rounding : float
        Distance up to which a point is at a corner.
    """

    max_iterations: int = 20
    tolerance: float = 1e-13
    first_step: float = 1e-6
    max_distance: float = 0.1
    side_distance: float = 1e-13
    rounding: float = 1e-11


class KinkOptions(Frozen):
    """The way on from a kink, on a circle about it.

    Attributes
    ----------
    min_angle, max_angle : float
        [rad] angles from the way back, with which the way on may make a narrow one.
    max_iterations : int
        Of Newton's method to the surface.
    tolerance : float
        Length of a step that ends them.
    angle_tolerance : float
        [rad] to which the change of a sign is found.
    jump_fraction : float
        Part of the greatest value on the circle; what is more on a side of a change is no zero.
    """

    min_angle: float = 1e-3
    max_angle: float = 0.2
    max_iterations: int = 8
    tolerance: float = 1e-12
    angle_tolerance: float = 1e-10
    jump_fraction: float = 1e-3


class OnsetOptions(Frozen):
    """The extremes within a cycle of what a contact does.

    Attributes
    ----------
    samples_per_period : int
        Of a period of the highest harmonic, among which an extreme is sought.
    max_iterations : int
        Of Newton's method from there.
    """

    samples_per_period: int = 24
    max_iterations: int = 4


class CurveOptions(Frozen):
    """All curves over a range of the number.

    Attributes
    ----------
    start_values : int
        Values of the number, evenly spaced, at which ordinary curves are traced.
    value_tolerance : float
        Part of the range, by which values of the number are one.
    frequency_tolerance : float
        Part of it, to which a point is on a curve.
    max_peaks : int
        Curves of peaks along which onsets are looked for.
    min_height : float
        Part of the greatest amplitude of a degree of freedom; lower peaks are not tracked.
    cusp_tolerance : float
        Part of the frequency's rate next to a turn; at a turn where the frequency turns back, too, it is
        less.
    """

    start_values: int = 13
    value_tolerance: float = 1e-9
    frequency_tolerance: float = 1e-3
    max_peaks: int = 3
    min_height: float = 1e-3
    cusp_tolerance: float = 1e-3


class KnownCurveOptions(Frozen):
    """Whether a curve passes a point that was found otherwise.

    Attributes
    ----------
    point_tolerance : float
        Distance in the problem's scale; points nearer than this are one.
    max_chord_part : float
        Part of a chord; what is further from it is not on its part of the curve, which turns by 90
        degrees.
    nearest_chords : int
        Nearest ones that are looked at.
    """

    point_tolerance: float = 1e-5
    max_chord_part: float = 0.5
    nearest_chords: int = 4


class TurnErrorOptions(Frozen):
    """The error at a turn of the number.

    Attributes
    ----------
    points_before : int
        Before a turn, from which the turn with more harmonics is sought.
    span_factor : float
        Times the way of the number from there to the turn, up to which it is sought.
    before_end : float
        Of the number at which a peak ends: way back, from where the end with more harmonics is sought.
    """

    points_before: int = 3
    span_factor: float = 3.0
    before_end: float = 0.05


class EnvelopeOptions(Frozen):
    """The greatest of several peaks over the number, and its least value.

    Attributes
    ----------
    brackets : int
        Of the lowest points, in which the least value is sought.
    value_tolerance : float
        Part of the range, to which the number is known.
    chord_fraction : float
        Part of the highest by the chords; what is lower is not looked at.
    min_gap : float
        Part of the range, in which no piece is known.
    height_tolerance : float
        Relative; peaks nearer than this are one at a crossing.
    unknown_factor : float
        Times the highest; counts where no peak is known, as differences of infinities are none.
    extreme_tolerance : float
        Relative; extremes of a cycle nearer than this are one.
    flat_slope : float
        Relative change over the whole range by the slope; a peak that changes by less does not depend on the
        number.
    flat_height : float
        Relative; how far above the least such a stretch may be, as the onset of slip lowers peaks a little.
    min_flat : float
        Part of the range over which it has to be so.
    """

    brackets: int = 4
    value_tolerance: float = 1e-9
    chord_fraction: float = 0.7
    min_gap: float = 1e-3
    height_tolerance: float = 1e-7
    unknown_factor: float = 10.0
    extreme_tolerance: float = 1e-12
    flat_slope: float = 1e-8
    flat_height: float = 1e-6
    min_flat: float = 1e-3


class TrackedStabilityOptions(Frozen):
    """Where stability changes along a tracked curve.

    Attributes
    ----------
    corner_side : float
        Part of the response's extent to either side of a corner, where it may turn back.
    halvings : int
        Of a step between points, within which the motion ceases to be stable.
    """

    corner_side: float = 1e-6
    halvings: int = 14


class TrialOptions(Frozen):
    """The least peak by trials.

    Attributes
    ----------
    values : int
        Over the range, both ends among them.
    minima, closer_values : int, int
        About so many of the values that are lower than their neighbours so many further ones are tried.
    min_distance : float
        Part of the range, between two values that are tried.
    same_height : float
        Relative; peaks nearer than this are as high.
    min_flat : float
        Part of the range over which peaks as high are said not to depend on the number.
    """

    values: int = 5
    minima: int = 2
    closer_values: int = 4
    min_distance: float = 1e-4
    same_height: float = 1e-9
    min_flat: float = 0.2


class TrackingOptions(Frozen):
    """All of tracked curves, by what they are for: see the class of each field."""

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
    """Over the range of one number, see `fcm.tracking.lowest_peak`.

    Attributes
    ----------
    max_visits : int
        Of lowest points, and of values about which nothing is followed, at most.
    height_tolerance : float
        A peak that is this much higher, relative, was not followed.
    high_fraction : float
        Of the highest, relative; peaks from there on are followed from where they are met.
    tracking : TrackingOptions
        Of the curves.
    """

    max_visits: int = 12
    height_tolerance: float = 1e-5
    high_fraction: float = 0.9
    tracking: TrackingOptions = TrackingOptions()


class DescentOptions(Frozen):
    """Over two or three numbers, see `fcm.tracking.minimax`.

    Attributes
    ----------
    grid : tuple of float
        Of each range, at which the first responses are traced.
    starts : int
        Of the lowest of them, from which the way leads down.
    max_rounds : int
        Of descending and tracing anew, at most.
    max_halvings : int
        Of a way at whose end other peaks are higher, at most.
    max_iterations : int
        Of one descent, after which the responses are traced anew, as at some kinks it goes to and fro.
    min_change : float
        Change of the greatest height, relative, that ends a descent.
    min_improvement : float
        Less of it along a single number, relative, is worth another way down.
    height_tolerance : float
        What is higher than this, relative, has not been followed.
    out_of_range_height : float
        Relative height of a peak that has left the range of frequencies, so that no step leads there.
    kink_tolerance : float
        Peaks within this, relative, are one kink.
    value_rounding : float
        Of a range of numbers.
    bound_tolerance : float
        Of a range; a number nearer to its end is there.
    search : SearchOptions
        Along a single number.
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


TRACKING = TrackingOptions()  # where nothing else is said
SEARCH = SearchOptions()
DESCENT = DescentOptions()
