"""Tolerances and limits of tracked curves, and of searches for the least peak over numbers of a scene.

`TrackingOptions` has all of the curves. It is a field of `Way`, which all curves of one run share.
"""

from __future__ import annotations

from dataclasses import dataclass

from fcm.continuation.options import StepOptions
from fcm.stability.options import STABILITY, StabilityOptions

PIECE_STEPS = StepOptions(first=1e-3, shortest=1e-7, most=3000, back=())


@dataclass(frozen=True)
class PieceOptions:
    """Of the smooth pieces of a tracked curve, and how they are joined. Lengths are in the problem's scale.

    step: first, shortest and most of a piece. points, pieces: of a curve, at most. far: a start that is
    corrected by more is none. few: steps in a row that may be short. short: a step below which
    a corner of the response is looked for ahead. growth: of a step to the next after short ones, at most.

    reached: distance to a corner that has been reached, or passed by a step too short to tell. near: a corner
    further away does not end a piece. leaps: beyond a corner at which what is tracked is looked for again.
    continuous: of what is special; less is no jump at a corner. ahead: cosine of the angle with the direction
    of what lies ahead. there: what is found beside a corner is moved by less.

    kink: of the span of the number, by which a kink is passed. radii: of circles about a kink on which the
    curve is looked for. off: of such a radius, by which the point found there may be wrong. across: cosine of
    the angle of the way on with its radius; other lines cross the circle anyhow.
    """

    step: StepOptions = PIECE_STEPS
    points: int = 3000
    pieces: int = 300
    far: float = 0.3
    few: int = 4
    short: float = 1e-3
    growth: float = 2.5
    reached: float = 1e-5
    near: float = 1e-2
    leaps: tuple[float, ...] = (1e-5, 1e-4, 1e-6, 1e-3)
    continuous: float = 1e-4
    ahead: float = 0.5
    there: float = 1e-6
    kink: float = 1e-9
    radii: tuple[float, ...] = (1e-6, 1e-5, 1e-4, 1e-3)
    off: float = 0.1
    across: float = 0.7


@dataclass(frozen=True)
class SpecialPointOptions:
    """The equations of a special point of a response.

    smallest: amplitude; lower ones count as this in a division. distance: along the response, of its extent,
    by which its Jacobian is evaluated for a difference. least: of that distance, where a corner is near.
    part: of the way to a corner, which the distance is at most, as derivatives change there like a root.
    tangent: times as long as the row; a longer one is nearly across it.
    """

    smallest: float = 1e-150
    distance: float = 1e-5
    least: float = 1e-9
    part: float = 0.05
    tangent: float = 1e3


@dataclass(frozen=True)
class CornerOptions:
    """Special points that are corners of a response. Lengths are in the problem's scale.

    steps: of Newton's method, and of the secant, at most. tolerance: length of a step that ends them.
    first: step of the secant. furthest: along a corner, that what is special of it is sought. side: distance
    from a corner at which its two sides are evaluated.
    """

    steps: int = 20
    tolerance: float = 1e-13
    first: float = 1e-6
    furthest: float = 0.1
    side: float = 1e-13


@dataclass(frozen=True)
class KinkOptions:
    """The way on from a kink, on a circle about it.

    closest, widest: [rad] angles from the way back, with which the way on may make a narrow one. steps: of
    Newton's method to the surface. tolerance: length of a step that ends them. angle: [rad] to which the
    change of a sign is found. jump: part of the greatest value on the circle; what is more on a side of a
    change is no zero.
    """

    closest: float = 1e-3
    widest: float = 0.2
    steps: int = 8
    tolerance: float = 1e-12
    angle: float = 1e-10
    jump: float = 1e-3


@dataclass(frozen=True)
class OnsetOptions:
    """The extremes within a cycle of what a contact does.

    samples: of a period of the highest harmonic, among which an extreme is sought. steps: of Newton's method
    from there.
    """

    samples: int = 24
    steps: int = 4


@dataclass(frozen=True)
class CurveOptions:
    """All curves over a range of the number.

    starts: values of the number, evenly spaced, at which ordinary curves are traced. same: part of the range,
    by which values of the number are one. frequency: part of it, to which a point is on a curve. peaks:
    curves of peaks along which onsets are looked for. lowest: part of the greatest amplitude of a degree of
    freedom; lower peaks are not tracked. cusp: part of the frequency's rate next to a turn; at a turn where
    the frequency turns back, too, it is less.
    """

    starts: int = 13
    same: float = 1e-9
    frequency: float = 1e-3
    peaks: int = 3
    lowest: float = 1e-3
    cusp: float = 1e-3


@dataclass(frozen=True)
class KnownCurveOptions:
    """Whether a curve passes a point that was found otherwise.

    same: distance in the problem's scale; points nearer than this are one. chord: part of a chord; what is
    further from it is not on its part of the curve, which turns by 90 degrees. chords: nearest ones that are
    looked at.
    """

    same: float = 1e-5
    chord: float = 0.5
    chords: int = 4


@dataclass(frozen=True)
class TurnErrorOptions:
    """The error at a turn of the number.

    points: before a turn, from which the turn with more harmonics is sought. beyond: times the way of the
    number from there to the turn, up to which it is sought.
    """

    points: int = 3
    beyond: float = 3.0


@dataclass(frozen=True)
class EnvelopeOptions:
    """The greatest of several peaks over the number, and its least value.

    brackets: of the lowest points, in which the least value is sought. fine: part of the range, to which the
    number is known. rough: part of the highest by the chords; what is lower is not looked at. gap: part of
    the range, in which no piece is known. equal: relative; peaks nearer than this are one at a crossing.
    unknown: times the highest; counts where no peak is known, as differences of infinities are none.
    overtaken: relative; extremes of a cycle nearer than this are one.
    """

    brackets: int = 4
    fine: float = 1e-9
    rough: float = 0.7
    gap: float = 1e-3
    equal: float = 1e-7
    unknown: float = 10.0
    overtaken: float = 1e-12


@dataclass(frozen=True)
class LimitOptions:
    """Where stability changes along a tracked curve.

    side: part of the response's extent to either side of a corner, where it may turn back. halvings: of a
    step between points, within which the motion ceases to be stable.
    """

    side: float = 1e-6
    halvings: int = 14


@dataclass(frozen=True)
class TrialOptions:
    """The least peak by trials.

    values: over the range, both ends among them. closer: values about the lowest of those. nearest: part of
    the range, between two values that are tried.
    """

    values: int = 5
    closer: int = 4
    nearest: float = 1e-4


@dataclass(frozen=True)
class TrackingOptions:
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
    stability: LimitOptions = LimitOptions()
    trials: TrialOptions = TrialOptions()
    floquet: StabilityOptions = STABILITY


@dataclass(frozen=True)
class SearchOptions:
    """Over the range of one number, see `fcm.tracking.lowest_peak`.

    visits: of lowest points, and of values about which nothing is followed, at most. higher: a peak that is
    this much higher, relative, was not followed. high: of the highest, relative; peaks from there on are
    followed from where they are met. tracking: of the curves.
    """

    visits: int = 12
    higher: float = 1e-5
    high: float = 0.9
    tracking: TrackingOptions = TrackingOptions()


@dataclass(frozen=True)
class DescentOptions:
    """Over two or three numbers, see `fcm.tracking.minimax`.

    levels: of each range, at which the first responses are traced. starts: of the lowest of them, from which
    the way leads down. rounds: of descending and tracing anew, at most. halves: of a way at whose end other
    peaks are higher, at most. iterations: of one descent, after which the responses are traced anew, as at
    some kinks it goes to and fro. smallest: change of the greatest height, relative, that ends a descent.

    further: less of it along a single number, relative, is worth another way down. counts: what is higher
    than this, relative, has not been followed. too_high: relative height of a peak that has left the range of
    frequencies, so that no step leads there. equal: peaks within this, relative, are one kink.

    rounding: of a range of numbers. bound: of a range; a number nearer to its end is there.

    search: along a single number.
    """

    levels: tuple[float, ...] = (0.1, 0.5, 0.9)
    starts: int = 2
    rounds: int = 6
    halves: int = 8
    iterations: int = 20
    smallest: float = 1e-10
    further: float = 1e-5
    counts: float = 1e-6
    too_high: float = 10.0
    equal: float = 1e-5
    rounding: float = 1e-12
    bound: float = 1e-6
    search: SearchOptions = SearchOptions()


TRACKING = TrackingOptions()  # where nothing else is said
SEARCH = SearchOptions()
DESCENT = DescentOptions()
