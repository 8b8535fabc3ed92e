"""Kernel: the steady cycle of a contact in its plane, and the Fourier coefficients of its forces.

A contact that opens forgets everything before it closes again. One that does not open remembers the place of
its slider a period ago. So the steady cycle is a fixed point of the map P of that place over a period, which
is nonexpansive: |P(a) - P(b)| <= |a - b|. Newton's method finds it, with the derivative of P from the slip;
if that does not help, the place after another period is taken.

The integrals along the cycle are the Fourier coefficients of the forces, and their derivatives. Other kernels
call `PlanarContact`.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, hypot

from fcm.contact.plane.options import OPTIONS, PlanarOptions

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN, PI
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        UNSOLVED,
        ContactKernel,
        ContactParameters,
    )
    from cython.cimports.fcm.contact.periodic.motion import CLOSES, EPSILON, FIRST_NODE, OPENS, TWO_PI
    from cython.cimports.fcm.contact.periodic.motion import LOAD as LOAD_ON_A_LINE
    from cython.cimports.fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS
    from cython.cimports.fcm.contact.plane.panel import LOAD, REACH, SCAN, STAGES, PlaneMotion, X, Y
    from cython.cimports.fcm.contact.plane.resting import FAR, Resting
    from cython.cimports.fcm.contact.plane.slider import SEPARATION, SLIP, STICK, Slider
else:
    from fcm.contact.closed_form import NAN, PI
    from fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        UNSOLVED,
        ContactKernel,
        ContactParameters,
    )
    from fcm.contact.periodic.motion import CLOSES, EPSILON, FIRST_NODE, OPENS, TWO_PI
    from fcm.contact.periodic.motion import LOAD as LOAD_ON_A_LINE
    from fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS
    from fcm.contact.plane.panel import LOAD, REACH, SCAN, PlaneMotion, X, Y
    from fcm.contact.plane.radau import STAGES
    from fcm.contact.plane.resting import FAR, Resting
    from fcm.contact.plane.slider import SEPARATION, SLIP, STICK, Slider

from fcm.contact.periodic.motion import ZeroCrossings


@cython.cclass
class PlanarCycle:
    """The steady cycle of a motion; its pieces are those of `slider`, its resting place that of `resting`.

    Attributes
    ----------
    kind
        OPEN, STUCK, MIXED, UNKNOWN, or UNSOLVED if no steady cycle was found.
    periods
        Number of periods that were followed to find it.
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
        """Solves the cycle of the loaded motion; s_x, s_y: start of the slider relative to the means of u."""
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
            self.crossings.search(LOAD_ON_A_LINE, CLOSES, OPENS)
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
        """Solves a cycle without separation: repeats periods until the slider returns to where it began.

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
        # a slider that slips very little, and sticks in between, approaches very slowly the place that the
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
            if i > 0:  # usually the steady one, as the first period forgets nearly everything
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
                # Newton's method: the next change is of the order of the square of this one
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
        """Clears the sums, so that the next period is summed."""
        self.slider.integrals.begin()
        self.slider.integrals.contact(0.0, TWO_PI)
        if gradient:
            self.slider.derivatives.fill(0.0)
        self.slider.gathering, self.slider.varying, self.slider.gradient = True, True, gradient
        self.slider.derivatives.take(0, self.slider.derivatives.unknowns if gradient else 2)

    def bracket(self, w_x: float, w_y: float) -> bool:
        """Whether a period moves two places of the slider towards each other; `place` then lies between.

        If the slider slips nearly all the time, a period moves it from one side of its steady place far to
        the other side, which Newton's method does not see. A period takes all places nearly to a curve. So
        the root is bracketed along the line between two places, by the Illinois rule.
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
            # across the line the place after the period is taken
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
        if not one > 0.0 > two:  # they no longer bracket
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
        """Passes one period from a place of the slider; returns the distance from there to its end."""
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


@cython.cclass
class PlanarContact(ContactKernel):
    """Kernel of contacts in a plane.

    Parameters
    ----------
    harmonics, outputs : list of int, each increasing, from 1 on
        Harmonics of the displacements, and of the forces; the mean is always one.
    most_panels : int
        Number of panels of slip that are recorded, for a loop.
    options : PlanarOptions, optional
        Tolerances with which the motion is followed.

    Notes
    -----
    Unknowns and forces are real numbers in the order

        mean u_x, u_y, v, then for each harmonic h:  Re and Im of U_x, then of U_y, then of V
        mean f_x, f_y, n, then for each harmonic h:  Re and Im of F_x, then of F_y, then of N
    """

    def __init__(
        self, harmonics: list[int], outputs: list[int], most_panels: int = 0, options: PlanarOptions = OPTIONS
    ) -> None:
        self.cycle = PlanarCycle(PlaneMotion(harmonics, STAGES, options), outputs, most_panels)
        self.integrals, self.derivatives = self.cycle.slider.integrals, self.cycle.slider.derivatives
        ContactKernel.__init__(self, self.derivatives)

    def evaluate(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters, gradient: bool
    ) -> cython.int:
        load: cython.int = self.cycle.motion.load(x, first, contact)
        if load != UNKNOWN and gradient:
            self.motion.moving = self.motion.count
        s_x: float = NAN
        s_y: float = NAN
        if load != UNKNOWN:
            s_x = contact.k_u * contact.start_x / self.motion.scale - self.cycle.motion.mean_x
            s_y = contact.k_u * contact.start_y / self.motion.scale - self.cycle.motion.mean_y
        if not s_x - s_x == s_y - s_y == 0.0:
            load = UNKNOWN
        if gradient:
            self.derivatives.fill(0.0)
        self.kind = self.cycle.solve(load, s_x, s_y, gradient)
        self.behaviour = self.cycle.behaviour
        nothing: float = NAN if self.kind == UNKNOWN or self.kind == UNSOLVED else 0.0
        self.clear(nothing)
        if self.kind == STUCK:
            self.stick()
            if gradient:
                self.stick_gradient(s_x, s_y)
        elif self.kind == MIXED:
            self.integrals.total()
            self.slip()
            if gradient:
                self.derivatives.settle(self.behaviour == CLOSED)
                self.derivatives.direct()
        if self.kind == STUCK or self.kind == MIXED:
            self.rescale()
            if gradient:
                self.derivatives.rescale(contact)
        elif gradient:
            self.derivatives.fill(nothing)
        return self.kind

    def resist(self, contact: ContactParameters, resistance: cython.double[:, ::1]) -> None:
        """Tangential: k_u in stick, and mu k_v by the normal displacement in slip; normal: k_v in contact."""
        rubs: cython.bint = contact.mu * contact.k_u > 0.0
        stick: float = 0.0
        closed: float = 0.0
        x: float = 0.0
        y: float = 0.0
        if self.kind == STUCK:
            stick = closed = 1.0
        elif self.kind == MIXED:
            closed = self.integrals.cos_sum[CONTACT, 0] / TWO_PI
            if rubs:
                stick = self.integrals.cos_sum[STICKS, 0] / TWO_PI
                x = self.integrals.cos_sum[SLIPS_X, 0] / TWO_PI
                y = self.integrals.cos_sum[SLIPS_Y, 0] / TWO_PI
        resistance[0, 0] = resistance[1, 1] = stick * contact.k_u if rubs else 0.0
        resistance[0, 2], resistance[1, 2] = x * contact.mu * contact.k_v, y * contact.mu * contact.k_v
        resistance[2, 2] = closed * contact.k_v

    def stick(self) -> None:
        """Sets the forces of a contact whose slider rests."""
        self.forces[0], self.forces[1] = -self.cycle.slider.w_x, -self.cycle.slider.w_y
        self.take_waves(0, X)
        self.take_waves(1, Y)
        self.press(LOAD)

    def slip(self) -> None:
        """Sets the forces from their integrals."""
        i: cython.int
        h: cython.int
        row: cython.int
        step: cython.int
        factor: float
        x_re: float
        x_im: float
        y_re: float
        y_im: float
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            row = 3 + 6 * i if i >= 0 else 0
            step = 2 if i >= 0 else 1
            factor = 1.0 / PI if i >= 0 else 0.5 / PI
            self.integrals.product(h, STICKS, X)
            x_re, x_im = (
                self.integrals.re - self.integrals.held_x_re[h],
                self.integrals.im - self.integrals.held_x_im[h],
            )
            self.integrals.product(h, STICKS, Y)
            y_re, y_im = (
                self.integrals.re - self.integrals.held_y_re[h],
                self.integrals.im - self.integrals.held_y_im[h],
            )
            self.integrals.product(h, SLIPS_X, REACH)
            x_re, x_im = x_re + self.integrals.re, x_im + self.integrals.im
            self.integrals.product(h, SLIPS_Y, REACH)
            y_re, y_im = y_re + self.integrals.re, y_im + self.integrals.im
            self.forces[row], self.forces[row + step] = factor * x_re, factor * y_re
            if i >= 0:
                self.forces[row + 1], self.forces[row + 3] = factor * x_im, factor * y_im
            if self.behaviour == CLOSED:
                continue
            self.integrals.product(h, CONTACT, LOAD)
            self.forces[row + 2 * step] = factor * self.integrals.re
            if i >= 0:
                self.forces[row + 5] = factor * self.integrals.im
        if self.behaviour == CLOSED:
            self.press(LOAD)

    def stick_gradient(self, s_x: float, s_y: float) -> None:
        """Sets the derivatives of a contact that never slips."""
        self.derivatives.take(0, self.unknowns)  # an earlier search for a cycle may have left fewer
        self.jacobian[2, 2] = 1.0
        self.derivatives.stick_waves()
        if self.cycle.resting.held == 0:
            self.jacobian[0, 0] = self.jacobian[1, 1] = 1.0
        elif self.cycle.resting.held == 1:
            self.held_by_one(s_x, s_y)
        else:
            self.held_by_two()

    def held_by_one(self, s_x: float, s_y: float) -> None:
        """Derivatives if one disc holds the slider, at W = s + (|U - s| - R) e nearest to its start."""
        j: cython.int
        self.cycle.motion.place(SCAN, self.cycle.resting.basis[0, 3])
        self.cycle.motion.bend(SCAN)
        d_x: float = self.cycle.motion.value[SCAN, 0] - s_x
        d_y: float = self.cycle.motion.value[SCAN, 1] - s_y
        d: float = hypot(d_x, d_y)
        e_x: float = d_x / d
        e_y: float = d_y / d
        beyond: float = d - self.cycle.motion.value[SCAN, 2]
        across: float = e_x * self.cycle.motion.value[SCAN, 4] - e_y * self.cycle.motion.value[SCAN, 3]
        bend: float = e_x * self.cycle.motion.value[SCAN, 6] + e_y * self.cycle.motion.value[SCAN, 7]
        bend += across * across / d - self.cycle.motion.value[SCAN, 8]
        later: float = -1.0 / bend if bend < 0.0 else 0.0
        self.derivatives.moved()
        for j in range(self.unknowns):
            u_x: float = self.derivatives.u_x[j]
            u_y: float = self.derivatives.u_y[j]
            r: float = self.derivatives.r[j]
            if j < 2:  # the mean of u: the start moves the other way
                u_x, u_y = (1.0, 0.0) if j == 0 else (0.0, 1.0)
            x_1: float = 0.0
            y_1: float = 0.0
            r_1: float = 0.0
            if j >= 3:
                k: cython.int = (j - 3) // 6
                p: cython.int = (j - 3) % 6
                # the derivative of cos is -h sin, that of -sin is -h cos
                rate: float = -self.motion.order[k] * (
                    self.cycle.motion.sin[SCAN, k] if p % 2 == 0 else self.cycle.motion.cos[SCAN, k]
                )
                if p < 2:
                    x_1 = rate
                elif p < 4:
                    y_1 = rate
                else:
                    r_1 = rate
            turn: float = (e_x * u_y - e_y * u_x) / d
            shift: float = later * (e_x * x_1 + e_y * y_1 - r_1 + turn * across)
            gap: float = e_x * u_x + e_y * u_y - r
            turn += shift * across / d
            w_x: float = gap * e_x - beyond * turn * e_y
            w_y: float = gap * e_y + beyond * turn * e_x
            if j == 0:
                w_x -= 1.0
            elif j == 1:
                w_y -= 1.0
            self.jacobian[0, j], self.jacobian[1, j] = -w_x, -w_y

    def held_by_two(self) -> None:
        """Derivatives if the slider rests where two circles meet: e . (d U - d W) = d R for both."""
        i: cython.int
        j: cython.int
        x: float
        e_x: float
        e_y: float
        det: float = 0.0
        a: float = 0.0
        b: float = 0.0
        for i in range(2):
            self.cycle.motion.place(SCAN, self.cycle.resting.basis[i, 3])
            e_x = self.cycle.motion.value[SCAN, 0] - self.cycle.slider.w_x
            e_y = self.cycle.motion.value[SCAN, 1] - self.cycle.slider.w_y
            x = hypot(e_x, e_y)
            e_x, e_y = e_x / x, e_y / x
            self.derivatives.moved()
            if i == 0:
                a, b = e_x, e_y
                for j in range(2, self.unknowns):
                    self.derivatives.turn[j] = (
                        e_x * self.derivatives.u_x[j] + e_y * self.derivatives.u_y[j] - self.derivatives.r[j]
                    )
                continue
            det = a * e_y - b * e_x
            det = 1.0 / det if det != 0.0 else 0.0
            for j in range(2, self.unknowns):
                x = e_x * self.derivatives.u_x[j] + e_y * self.derivatives.u_y[j] - self.derivatives.r[j]
                self.jacobian[0, j] = det * (b * x - e_y * self.derivatives.turn[j])
                self.jacobian[1, j] = det * (e_x * self.derivatives.turn[j] - a * x)
