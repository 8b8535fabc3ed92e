"""Where a function along a curve changes its sign: by secants that close in (Illinois), or halves at a jump.

Between ends that are much nearer than they were a smooth function differs by much less; one that jumps does
not, and the secants would leave one end where it is.
"""

from __future__ import annotations

CLOSER = 0.25  # of the first distance of its ends, at which a function that does not jump
LESS = 0.5  # differs by less than this part of what it did


class Secants:
    """The two sides of a change of sign, which looks at `at` bring nearer to one another."""

    def __init__(self, low: float, high: float, before: float, after: float) -> None:
        self.low, self.high = low, high
        self._ends = [before, after]  # the values
        self._weights = [before, after]  # those of the secant
        self._first = (high - low, abs(after - before))
        self._last: int | None = None

    @property
    def width(self) -> float:
        """Distance of the sides."""
        return self.high - self.low

    @property
    def at(self) -> float:
        """The place to be looked at next."""
        before, after = self._weights
        width, difference = self._first
        if self.width < CLOSER * width and abs(self._ends[1] - self._ends[0]) > LESS * difference:
            return 0.5 * (self.low + self.high)
        return (self.low * after - self.high * before) / (after - before)

    def saw(self, at: float, value: float) -> None:
        """Take the value there for that of one side."""
        side = int((value > 0.0) != (self._ends[0] > 0.0))
        if side == self._last:
            self._weights[1 - side] *= 0.5
        self._ends[side] = self._weights[side] = value
        self._last = side
        if side:
            self.high = at
        else:
            self.low = at
