"""Kernel: the steady cycle of a contact in its plane, with sums for its forces.

A contact that opens has forgotten everything when it closes again. One that does not open remembers where its
slider was a period ago. So the steady cycle is a fixed point of the map P of that place over a period, which
is nonexpansive: |P(a) - P(b)| <= |a - b|. Newton's method finds it, with the derivative of P that comes with
the slip; where that does not help, a period more is taken as it is.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, hypot

if cython.compiled:
    from cython.cimports.fcm.contact.contact_kernel import CLOSED, MIXED, OPEN, STUCK, UNKNOWN, UNSOLVED
    from cython.cimports.fcm.contact.periodic.motion import CLOSES, EPSILON, FIRST_NODE, LOAD, OPENS, TWO_PI
    from cython.cimports.fcm.contact.plane.panel import SCAN, PlaneMotion
    from cython.cimports.fcm.contact.plane.resting import FAR, Resting
    from cython.cimports.fcm.contact.plane.slider import SEPARATION, SLIP, STICK, Slider
else:
    from fcm.contact.contact_kernel import CLOSED, MIXED, OPEN, STUCK, UNKNOWN, UNSOLVED
    from fcm.contact.periodic.motion import CLOSES, EPSILON, FIRST_NODE, LOAD, OPENS, TWO_PI
    from fcm.contact.plane.panel import SCAN, PlaneMotion
    from fcm.contact.plane.resting import FAR, Resting
    from fcm.contact.plane.slider import SEPARATION, SLIP, STICK, Slider

from fcm.contact.periodic.motion import ZeroCrossings


@cython.cclass
class PlanarCycle:
    """The steady cycle of a motion; its pieces are those of `slider`, its resting place that of `resting`.

    Attributes
    ----------
    kind
        OPEN, STUCK, MIXED, UNKNOWN, or UNSOLVED where no steady cycle was found.
    periods
        How many were gone through for it.
    """

    def __init__(self, motion: PlaneMotion, outputs: list[int], most_panels: int) -> None:
        given = motion.options
        self.most_periods, self.double_point, self.slight, self.hardly = (
            given.max_periods,
            given.double_point_tolerance,
            given.slight_miss,
            given.min_way,
        )
        self.inside, self.fine, self.next_change = given.min_depth, given.place_tolerance, given.next_change
        self.contraction, self.determinant = given.max_contraction, given.min_determinant
        self.motion = motion
        self.slider = Slider(motion, outputs, most_panels)
        self.resting = Resting(motion)
        self.crossings = ZeroCrossings(motion.normal)
        self.kind = self.behaviour = UNKNOWN
        self.periods = 0
        self.moved_x = self.moved_y = self.place_x = self.place_y = 0.0
        self.side = np.zeros((2, 4))  # places of the slider, and how far a period moves it from there
        self.sides, self.replaced = 0, -1

    def solve(self, behaviour: cython.int, s_x: float, s_y: float, gradient: bool) -> cython.int:
        """Solves the cycle of the loaded motion, for a slider that began at a place from the means of u."""
        self.periods = self.slider.pieces = self.slider.panels = 0
        self.slider.failed = False
        self.behaviour = self.kind = behaviour
        self.slider.theta = self.slider.w_x = self.slider.w_y = 0.0
        if behaviour == UNKNOWN:
            return UNKNOWN
        self.slider.integrals.begin()
        if behaviour == MIXED:
            self.motion.normal.sample()
            self.crossings.begin()
            self.crossings.search(LOAD, CLOSES, OPENS)
            if self.crossings.count < 2:
                behaviour = CLOSED if self.crossings.sign > 0 else OPEN
        self.behaviour = behaviour
        if behaviour == OPEN:
            self.slider.add(SEPARATION)
            self.kind = OPEN
            return OPEN
        if behaviour == CLOSED:
            self.slider.integrals.contact(0.0, TWO_PI)
            if not self.motion.rubs():
                self.slider.derivatives.take(0, self.slider.derivatives.unknowns)
                self.slider.add(SLIP)
                self.kind = MIXED
            elif self.resting.stays(s_x, s_y):
                self.slider.w_x, self.slider.w_y = self.resting.w_x, self.resting.w_y
                self.slider.add(STICK)
                self.kind = STUCK
            else:
                self.kind = self.closed(gradient)
            return self.kind
        self.crossings.sort()
        self.kind = self.opening(gradient)
        return self.kind

    def opening(self, gradient: bool) -> cython.int:
        """Solves a cycle with separations, from the first closing to the last opening."""
        i: cython.int
        at: cython.int
        turn: float = 0.0
        count: cython.int = self.crossings.count
        first: cython.int = 0
        while self.crossings.kind[self.crossings.order[first]] != CLOSES:
            first += 1
        self.slider.gathering, self.slider.varying, self.slider.gradient = True, gradient, gradient
        self.slider.derivatives.take(2, self.slider.derivatives.unknowns)
        at = first
        for i in range(count // 2):  # noqa: B007
            begin: float = self.crossings.angle[self.crossings.order[at]] + turn
            at += 1
            if at == count:
                at, turn = 0, TWO_PI
            end: float = self.crossings.angle[self.crossings.order[at]] + turn
            at += 1
            if at == count:
                at, turn = 0, TWO_PI
            self.slider.integrals.contact(begin, end)
            if self.motion.rubs():
                self.slider.close(begin)
                self.slider.advance(end, True)
            else:
                self.slider.theta = begin
                self.slider.add(SLIP)
            self.slider.theta = end
            self.slider.add(SEPARATION)
        return UNSOLVED if self.slider.failed else MIXED

    def closed(self, gradient: bool) -> cython.int:
        """Solves a cycle without separation: repeats periods until the slider returns to its start.

        A period begins at the angle at which the slip disc is smallest.
        """
        i: cython.int
        j: cython.int
        begin: float = 0.0
        least: float = FAR
        self.resting.sample()
        for j in range(self.resting.nodes):
            if self.resting.at[2, j] < least:
                least = self.resting.at[2, j]
                begin = self.resting.step * (FIRST_NODE + j)
        self.motion.place(SCAN, begin)
        speed: float = hypot(self.motion.value[SCAN, 3], self.motion.value[SCAN, 4])
        r: float = max(self.motion.value[SCAN, 2], 0.0)
        r = r / speed if speed > 0.0 else 0.0
        w_x: float = self.motion.value[SCAN, 0] - r * self.motion.value[SCAN, 3]
        w_y: float = self.motion.value[SCAN, 1] - r * self.motion.value[SCAN, 4]
        # a slider that slips hardly at all, and sticks between, is drawn ever so slowly to the place that the
        # discs miss least
        if self.resting.overlap < self.slight * self.motion.reach:
            self.resting.encloses(True)
            self.resting.farthest(self.resting.w_x, self.resting.w_y)
            least = -self.inside * self.motion.reach
            for j in range(self.resting.nodes):
                if self.resting.gap[j] < least:
                    least = self.resting.gap[j]
                    begin = self.resting.step * (FIRST_NODE + j)
                    w_x, w_y = self.resting.w_x, self.resting.w_y
        change: float
        before: float = FAR
        nearest: float = FAR
        nearest_x: float = w_x
        nearest_y: float = w_y
        fine: float = self.fine * min(self.motion.reach, self.motion.size)
        rounding: float = 4.0 * EPSILON * self.motion.size
        self.slider.gathering, self.slider.varying, self.slider.gradient = False, True, False
        self.slider.derivatives.take(0, 2)
        self.sides = 0
        for i in range(self.most_periods):
            self.periods = i + 1
            if i > 0:  # most often it is the steady one, as nearly all is forgotten in the first
                self.gather(gradient)
            change = self.period(begin, w_x, w_y)
            if self.slider.failed:
                return UNSOLVED
            if change < nearest:
                nearest, nearest_x, nearest_y = change, w_x, w_y
            x: float = self.moved_x
            y: float = self.moved_y
            a: float = 1.0 - self.slider.derivatives.w_x[0]
            b: float = -self.slider.derivatives.w_x[1]
            c: float = -self.slider.derivatives.w_y[0]
            d: float = 1.0 - self.slider.derivatives.w_y[1]
            by: float = a * d - b * c
            known: cython.bint = fabs(by) > self.determinant
            hardly: cython.bint = known and self.slider.gone < self.hardly * self.motion.reach
            if change <= fine + rounding and not (
                hardly and hypot(d * x - b * y, a * y - c * x) > (fine + rounding) * fabs(by)
            ):
                if i > 0:
                    return MIXED
                w_x, w_y = w_x + x, w_y + y
                break
            bounded: cython.bint = self.bracket(w_x, w_y)
            if change < self.contraction * before and known:
                before = change
                w_x, w_y = w_x + (d * x - b * y) / by, w_y + (a * y - c * x) / by
                # the next change is of the square of this one
                if change * change < self.next_change * fine * self.motion.reach * by * by:
                    break
                if bounded and not self.between(w_x, w_y):
                    w_x, w_y = self.place_x, self.place_y
            else:
                before = 2.0 * change if change < before else FAR
                w_x, w_y = (self.place_x, self.place_y) if bounded else (w_x + x, w_y + y)
        else:
            if nearest > self.double_point * self.motion.reach:
                return UNSOLVED
            w_x, w_y = nearest_x, nearest_y
        self.gather(gradient)
        self.period(begin, w_x, w_y)
        return UNSOLVED if self.slider.failed else MIXED

    def gather(self, gradient: bool) -> None:
        """Clears the sums and lets the next period be summed."""
        self.slider.integrals.begin()
        self.slider.integrals.contact(0.0, TWO_PI)
        if gradient:
            self.slider.derivatives.fill(0.0)
        self.slider.gathering, self.slider.varying, self.slider.gradient = True, True, gradient
        self.slider.derivatives.take(0, self.slider.derivatives.unknowns if gradient else 2)

    def bracket(self, w_x: float, w_y: float) -> bool:
        """Whether a period moves two places of the slider towards each other; `place` then lies between them.

        Where the slider slips hardly less than all the time, a period moves it from one side of its steady
        place far to the other side, which Newton's method does not see. A period takes all places to a curve,
        nearly: along the line between two of them the way is bounded, by the Illinois rule.
        """
        i: cython.int
        x: float = self.moved_x
        y: float = self.moved_y
        i = 0
        if self.sides == 2:
            d_x: float = self.side[1, 0] - self.side[0, 0]
            d_y: float = self.side[1, 1] - self.side[0, 1]
            along: float = (x * d_x + y * d_y) / (d_x * d_x + d_y * d_y)
            i = 0 if along > 0.0 else 1
            self.side[1 - i, 2] *= 0.5 if i == self.replaced else 1.0
            self.side[1 - i, 3] *= 0.5 if i == self.replaced else 1.0
            self.replaced = i
            # across the line the way of a period is taken
            w_x, w_y = w_x + x - along * d_x, w_y + y - along * d_y
        elif self.sides == 1 and x * self.side[0, 2] + y * self.side[0, 3] < 0.0:
            i, self.sides, self.replaced = 1, 2, -1
        else:
            self.sides = 1
        self.side[i, 0], self.side[i, 1], self.side[i, 2], self.side[i, 3] = w_x, w_y, x, y
        if self.sides < 2:
            return False
        x, y = self.side[1, 0] - self.side[0, 0], self.side[1, 1] - self.side[0, 1]
        one: float = self.side[0, 2] * x + self.side[0, 3] * y
        two: float = self.side[1, 2] * x + self.side[1, 3] * y
        if not one > 0.0 > two:  # they no longer are
            self.sides = 0
            return False
        part: float = one / (one - two)
        self.place_x, self.place_y = self.side[0, 0] + part * x, self.side[0, 1] + part * y
        return True

    def between(self, w_x: float, w_y: float) -> bool:
        """Whether a place lies between the two bracketing places, along their line."""
        d_x: float = self.side[1, 0] - self.side[0, 0]
        d_y: float = self.side[1, 1] - self.side[0, 1]
        along: float = (w_x - self.side[0, 0]) * d_x + (w_y - self.side[0, 1]) * d_y
        return 0.0 <= along <= d_x * d_x + d_y * d_y

    def period(self, begin: float, w_x: float, w_y: float) -> float:
        """Passes one period from a place of the slider; returns its distance from there at the end."""
        self.slider.pieces = self.slider.panels = 0
        if self.slider.varying:
            self.slider.derivatives.start()
        self.slider.enter(begin, w_x, w_y)
        self.slider.advance(begin + TWO_PI, False)
        if self.slider.gone < self.hardly * self.motion.reach:
            self.moved_x, self.moved_y = self.slider.gone_x, self.slider.gone_y
        else:
            self.moved_x, self.moved_y = self.slider.w_x - w_x, self.slider.w_y - w_y
        moved: float = hypot(self.moved_x, self.moved_y)
        return moved
