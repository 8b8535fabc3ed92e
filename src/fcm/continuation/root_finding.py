"""Where a function along a curve changes its sign, between two points that enclose it.

By the secant through the last two points; halfway between the sides where that leads out of them, or three
looks have not halved their distance. So it is too where the function jumps, if it may: between sides that are
much nearer than they were a smooth function differs by much less.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import fabs

# of the first distance of its sides, at which a function that does not jump
CLOSER = cython.declare(cython.double, 0.25)
LESS = cython.declare(cython.double, 0.5)  # differs by less than this part of what it did
IN_TURN = cython.declare(cython.int, 3)  # looks that are to halve the distance


@cython.cclass
class Secants:
    """The two sides of a change of sign, low and high, which looks at `at` bring nearer to one another.

    width: their distance; secant: where the secant leads.
    """

    def __init__(
        self,
        low: cython.double,
        high: cython.double,
        before: cython.double,
        after: cython.double,
        may_jump: cython.bint = False,
    ) -> None:
        self.low, self.high, self.may_jump = low, high, may_jump
        self.before, self.after = before, after  # the values there
        # the last two points and their values
        self.last, self.last_value, self.now, self.now_value = low, before, high, after
        self.first_width, self.first_difference = high - low, fabs(after - before)
        self.looks, self.width_in_turn = 0, high - low
        self.aim()

    @cython.cfunc
    @cython.exceptval(check=False)
    def aim(self) -> cython.void:
        """The point to be looked at next."""
        self.width, self.secant = self.high - self.low, self.low
        if self.now_value != self.last_value:
            rise: cython.double = self.now_value - self.last_value
            self.secant = self.now - self.now_value * (self.now - self.last) / rise
        slow: cython.bint = self.looks % IN_TURN == IN_TURN - 1 and self.width > 0.5 * self.width_in_turn
        halved: cython.bint = slow or self.jumps() or not self.low < self.secant < self.high
        self.at = 0.5 * (self.low + self.high) if halved else self.secant

    @cython.cfunc
    @cython.exceptval(check=False)
    def jumps(self) -> cython.bint:
        """Whether the function seems to."""
        difference: cython.double = fabs(self.after - self.before)
        near: cython.bint = self.width < CLOSER * self.first_width
        return self.may_jump and near and difference > LESS * self.first_difference

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def known(self, fine: cython.double, after_next: cython.bint = False) -> cython.bint:
        """Whether another look would move by no more than this; or the one after next.

        That is shorter than the next by at least as much as the next is than the last.
        """
        way: cython.double = fabs(self.secant - self.now)
        if way <= fine or self.width <= fine:
            return True
        return after_next and way * way <= fine * fabs(self.now - self.last)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def saw(self, at: cython.double, value: cython.double) -> cython.int:
        """Take the value there for that of one side."""
        if self.looks % IN_TURN == IN_TURN - 1:
            self.width_in_turn = self.width
        self.looks += 1
        self.last, self.last_value, self.now, self.now_value = self.now, self.now_value, at, value
        if (value > 0.0) != (self.before > 0.0):
            self.high, self.after = at, value
        else:
            self.low, self.before = at, value
        self.aim()
        return 0
