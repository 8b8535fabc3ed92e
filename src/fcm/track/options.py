"""Tolerances and limits of searches for the least peak over numbers of a scene."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SearchOptions:
    """Over the range of one number, see `fcm.track.lowest`.

    visits: of lowest points, and of values about which nothing is followed, at most. higher: a peak that is
    this much higher, relative, was not followed. high: of the highest, relative; peaks from there on are
    followed from where they are met.
    """

    visits: int = 12
    higher: float = 1e-5
    high: float = 0.9


@dataclass(frozen=True)
class DescentOptions:
    """Over two or three numbers, see `fcm.track.descent`.

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


SEARCH = SearchOptions()  # where nothing else is said
DESCENT = DescentOptions()
