"""Tolerances and limits of tracked curves, and of searches for the least peak over numbers of a scene."""

from __future__ import annotations

from dataclasses import dataclass

from fcm.continuation.options import StepOptions

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
class SearchOptions:
    """Over the range of one number, see `fcm.tracking.lowest_peak`.

    visits: of lowest points, and of values about which nothing is followed, at most. higher: a peak that is
    this much higher, relative, was not followed. high: of the highest, relative; peaks from there on are
    followed from where they are met.
    """

    visits: int = 12
    higher: float = 1e-5
    high: float = 0.9


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


PIECES = PieceOptions()  # where nothing else is said
SEARCH = SearchOptions()
DESCENT = DescentOptions()
