"""Where a function along a curve changes its sign, between two places that enclose it.

By the secant through the last two places; halfway between the sides where that leads out of them, or three
looks have not halved their distance. So it is too where the function jumps, if it may: between sides that are
much nearer than they were a smooth function differs by much less.
"""

from __future__ import annotations

CLOSER = 0.25  # of the first distance of its sides, at which a function that does not jump
LESS = 0.5  # differs by less than this part of what it did
IN_TURN = 3  # looks that are to halve the distance


class Secants:
    """The two sides of a change of sign, which looks at `at` bring nearer to one another."""

    def __init__(self, low: float, high: float, before: float, after: float, may_jump: bool = False) -> None:
        self.low, self.high, self._may_jump = low, high, may_jump
        self._ends = [before, after]  # the values there
        self._last, self._now = (low, before), (high, after)  # the last two places and their values
        self._first = (high - low, abs(after - before))
        self._looks, self._width = 0, high - low

    @property
    def width(self) -> float:
        """Distance of the sides."""
        return self.high - self.low

    @property
    def secant(self) -> float:
        """Where the secant leads."""
        (last, before), (now, value) = self._last, self._now
        return now - value * (now - last) / (value - before) if value != before else self.low

    def known(self, fine: float, after_next: bool = False) -> bool:
        """Whether another look would move by no more than this; or the one after next.

        That is shorter than the next by at least as much as the next is than the last.
        """
        (last, _), (now, _) = self._last, self._now
        way = abs(self.secant - now)
        return way <= fine or self.width <= fine or (after_next and way * way <= fine * abs(now - last))

    @property
    def at(self) -> float:
        """The place to be looked at next."""
        at = self.secant
        slow = self._looks % IN_TURN == IN_TURN - 1 and self.width > 0.5 * self._width
        return 0.5 * (self.low + self.high) if slow or self._jumps() or not self.low < at < self.high else at

    def _jumps(self) -> bool:
        width, difference = self._first
        return (
            self._may_jump
            and self.width < CLOSER * width
            and abs(self._ends[1] - self._ends[0]) > LESS * difference
        )

    def saw(self, at: float, value: float) -> None:
        """Take the value there for that of one side."""
        if self._looks % IN_TURN == IN_TURN - 1:
            self._width = self.width
        self._looks += 1
        self._last, self._now = self._now, (at, value)
        side = int((value > 0.0) != (self._ends[0] > 0.0))
        self._ends[side] = value
        if side:
            self.high = at
        else:
            self.low = at
