"""Kernel: the slider of a contact in its plane, followed from an angle on through sticks and slips.

A slider at rest is met by its disc at a root of g = |U - W|^2 - R^2, a trigonometric polynomial. Its values
and slopes at both ends of a step, and a bound of its fourth derivative, prove that there is no root between;
a step that proves nothing is halved. A slip is a chain of panels, each as long as its polynomial resolves; it
ends where lambda falls to zero.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, hypot, sqrt

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.motion import EPSILON, TWO_PI
    from cython.cimports.fcm.contact.plane.integrals import PlanarDerivatives, PlanarIntegrals
    from cython.cimports.fcm.contact.plane.panel import SCAN, STAGES, Panel, PlaneMotion
    from cython.cimports.fcm.cubic import slope_bounds, value_bounds
else:
    from fcm.contact.periodic.motion import EPSILON, TWO_PI
    from fcm.contact.plane.integrals import PlanarDerivatives, PlanarIntegrals
    from fcm.contact.plane.panel import SCAN, Panel, PlaneMotion
    from fcm.contact.plane.radau import STAGES
    from fcm.cubic import slope_bounds, value_bounds

STICK = cython.declare(cython.int, 0)  # states
SLIP = cython.declare(cython.int, 1)
SEPARATION = cython.declare(cython.int, 2)


@cython.cclass
class Slider:
    """The pieces of a cycle in order, `pieces` in number, and the slider at the present angle.

    Attributes
    ----------
    state, begin, rest_x, rest_y
        For each piece: STICK, SLIP or SEPARATION, its first angle, and the place of the slider there.
    theta, sliding, w_x, w_y, e_x, e_y
        The present angle; whether the slider slips; its place if it does not, otherwise its direction.
    gone, gone_x, gone_y
        Path of the slider since it was entered, and displacement along it, as sums over its slips.
        Differences of places would be mere rounding for a slider that hardly moves.
    longest
        Greatest length of a panel [rad], for which Radau's rule integrates the harmonics.
    tolerance
        Greatest last coefficient of a panel, times the radius over its bound, or times the length.
    varying, gathering, gradient
        Whether derivatives are carried along, forces are summed, and their Jacobian is summed.
    record (panel, 5 + s), panels
        For each panel while forces are summed: angle, length, direction at the start, distance to the opening
        if it is graded, or 0, and t at the nodes; see `Panel`.
    failed
        Whether a slip could not be finished, or there are too many pieces.
    """

    def __init__(self, motion: PlaneMotion, outputs: list[int], most_panels: int) -> None:
        given = motion.options
        self.shortest, self.least_step, self.on_edge, self.negligible = (
            given.min_step,
            given.first_step,
            given.edge_tolerance,
            given.negligible_length,
        )
        self.near, self.ends, self.deepest, self.nothing = (
            given.grading_length,
            given.end_factor,
            given.max_grading,
            given.zero_radius,
        )
        self.light, self.shrink, self.grow, self.safety = (
            given.light_load_tolerance,
            given.min_factor,
            given.max_factor,
            given.safety,
        )
        self.varied, self.unturned = given.derivative_fraction, given.impulse_tolerance
        self.motion = motion
        self.panel = Panel(motion)
        self.integrals = PlanarIntegrals(motion, max(outputs, default=0))
        self.derivatives = PlanarDerivatives(self.panel, self.integrals, outputs)
        self.capacity = 64 + 32 * max(motion.highest, 1)
        self.state = np.zeros(self.capacity, dtype=np.intc)
        self.begin, self.rest_x, self.rest_y = np.zeros((3, self.capacity))
        self.record, self.most_panels = np.zeros((most_panels, 5 + STAGES)), most_panels
        self.pieces = self.panels = 0
        self.theta = self.w_x = self.w_y = self.e_x = self.e_y = self.next_length = 0.0
        self.gone_x = self.gone_y = self.gone = 0.0
        self.gap = self.gap_slope = self.noise = self.stalled = 0.0
        self.last_x = self.last_y = self.last_speed = self.falls = 0.0
        self.first_step = self.least_step
        self.tolerance = given.tolerance
        self.longest = given.panel_length / max(self.integrals.highest, 1)
        self.sliding = self.varying = self.gathering = self.gradient = self.failed = False

    def add(self, state: cython.int) -> None:
        """Appends a piece, unless the last one has the same state."""
        i: cython.int = self.pieces
        if i > 0 and self.state[i - 1] == state:
            return
        if i == self.capacity:
            self.failed = True
            return
        self.state[i], self.begin[i] = state, self.theta
        self.rest_x[i], self.rest_y[i] = self.w_x, self.w_y
        self.pieces += 1

    def length(self, p: cython.int) -> float:
        """Length [rad] of piece p."""
        last: cython.bint = p + 1 == self.pieces
        length: float = self.begin[0 if last else p + 1] - self.begin[p]
        while length < 0.0 or (last and length <= 0.0):
            length += TWO_PI
        return length

    def enter(self, theta: float, w_x: float, w_y: float) -> None:
        """Starts at an angle with the slider at a place; a disc that does not contain it moves it at once."""
        self.theta, self.w_x, self.w_y, self.stalled = theta, w_x, w_y, -1e300
        self.gone_x = self.gone_y = self.gone = 0.0
        self.measure(theta)
        d_x: float = self.motion.value[SCAN, 0] - w_x
        d_y: float = self.motion.value[SCAN, 1] - w_y
        d: float = hypot(d_x, d_y)
        r: float = max(self.motion.value[SCAN, 2], 0.0)
        self.sliding = False
        if d < r * (1.0 - 4.0 * EPSILON) or d == 0.0:
            return
        self.e_x, self.e_y = d_x / d, d_y / d
        self.gone, self.gone_x, self.gone_y = d - r, (d - r) * self.e_x, (d - r) * self.e_y
        if self.push() > 0.0 and r > 0.0:
            self.sliding = True
            self.next_length = self.first_length()
            if self.varying:
                self.derivatives.slide(self.e_x, self.e_y)
        else:
            self.w_x = self.motion.value[SCAN, 0] - r * self.e_x
            self.w_y = self.motion.value[SCAN, 1] - r * self.e_y

    def close(self, theta: float) -> None:
        """Closes the contact at an angle: it slips if the motion outruns the disc, otherwise it sticks."""
        self.theta, self.stalled = theta, -1e300
        self.motion.place(SCAN, theta)
        self.w_x, self.w_y = self.motion.value[SCAN, 0], self.motion.value[SCAN, 1]
        x_1: float = self.motion.value[SCAN, 3]
        y_1: float = self.motion.value[SCAN, 4]
        speed: float = hypot(x_1, y_1)
        r_1: float = max(self.motion.value[SCAN, 5], 0.0)
        rounding: float = 8.0 * EPSILON * (self.motion.motion_bound[1] + self.motion.reach_bound[1])
        self.sliding = speed > r_1 + rounding
        if not self.sliding:
            if self.varying:
                self.derivatives.close()
            return
        self.e_x, self.e_y = x_1 / speed, y_1 / speed
        self.motion.bend(SCAN)
        rate: float = self.e_x * self.motion.value[SCAN, 7] - self.e_y * self.motion.value[SCAN, 6]
        rate /= r_1 + speed
        self.next_length = 1.0 / max(self.motion.highest, 1)
        if self.varying:
            self.derivatives.close_sliding(self.e_x, self.e_y, rate)

    def push(self) -> float:
        """lambda at the angle in SCAN, the rate at which the disc pushes the slider."""
        along: float = self.e_x * self.motion.value[SCAN, 3] + self.e_y * self.motion.value[SCAN, 4]
        push: float = along - self.motion.value[SCAN, 5]
        return push

    def first_length(self) -> float:
        """Estimated length of the first panel of a slip, from the angle in SCAN on."""
        x_1: float = self.motion.value[SCAN, 3]
        y_1: float = self.motion.value[SCAN, 4]
        across: float = fabs(self.e_x * y_1 - self.e_y * x_1)
        turning: float = max(across, 0.6 * hypot(x_1, y_1))
        length: float = 1.5 / max(self.motion.highest, 1)
        r: float = max(self.motion.value[SCAN, 2], 1e-12 * self.motion.reach)
        return min(length, 1.5 * r / turning) if turning > 0.0 else length

    def advance(self, end: float, opens: bool) -> None:
        """Follows the slider up to an angle, at which the contact opens or stays closed."""
        while self.theta < end and not self.failed:
            if self.sliding:
                self.slide(end, opens)
            else:
                self.hold(end)
        if self.sliding and not opens:
            self.halt()

    def slide(self, end: float, opens: bool) -> None:
        """Follows a slip until lambda vanishes, or up to the angle `end`."""
        begin: float = self.theta
        length: float
        left: float
        rest: float
        part: float
        before: cython.int = self.pieces
        tries: cython.int
        self.add(SLIP)
        self.panel.exact = self.varying
        if opens:
            self.opening(end)
        self.motion.place(SCAN, begin)
        push: float = self.push()
        r: float = self.motion.value[SCAN, 2]
        rate: float = 0.0
        bend: float = 0.0
        if r > self.nothing * self.motion.reach:
            rate = self.e_x * self.motion.value[SCAN, 4] - self.e_y * self.motion.value[SCAN, 3]
            rate /= r
            self.motion.bend(SCAN)
            bend = self.turning(SCAN, rate)
        near: float = self.near / max(self.motion.highest, 1)
        nothing: float = self.nothing * self.motion.reach
        while self.theta < end and not self.failed:
            if r <= nothing:
                push = self.realign(push)
            left = end - self.theta
            if left < (self.negligible if opens else self.shortest):
                self.theta = end
                return
            graded: cython.bint = opens and r > nothing and left < near
            last: cython.bint = False  # a panel up to the opening, whatever it leaves out
            # at a closing nothing is remembered, and only one initial direction is a solution
            with_turns: cython.bint = self.gathering and self.gradient and r > nothing
            turned: float = self.derivatives.greatest() if with_turns else 0.0
            stray: float = self.stray() if graded else 1.0
            if (
                graded
                and stray * r * left < self.ends * self.tolerance * self.motion.reach
                and (not with_turns or self.left_out(stray, turned * r, left) <= self.unturned)
            ):
                graded, last = False, True
                self.next_length = left
            length = min(self.next_length, left, self.longest)
            if graded:  # the harmonics are those of a square
                part = max(1.0 - self.longest / (3.0 * left), 0.0)
                length = min(length, min(self.deepest, 1.0 - part * part) * left)
            elif length > 0.6 * left and (length < left or (opens and r <= nothing)):
                length = 0.6 * left  # not from closing to opening at once: turns matter only in between
            self.panel.begin(self.theta, self.e_x, self.e_y, rate, bend)
            for tries in range(200):  # noqa: B007
                rest = 1e300
                if self.panel.solve(length, left if graded else 0.0):
                    rest = self.panel.rest()
                    rest *= max(
                        max(r, self.motion.value[STAGES, 2]) / self.motion.reach,
                        min(self.light * length, 1.0),
                    )
                    if with_turns:
                        part = self.varied * max(r, self.motion.value[STAGES, 2])
                        rest = max(rest, part * self.derivatives.rest_of_turns())
                    if rest <= self.tolerance or (last and length == left):
                        break
                part = self.grown(rest) if rest < 1e300 else 0.0
                if length == left and opens:
                    graded, length = True, self.deepest * left
                    continue
                length = self.scaled(length, left, min(max(self.safety * part, self.shrink), 0.7))
            else:
                self.failed = True
                return
            part = min(max(self.safety * self.grown(max(rest, 1e-300)), self.shrink), self.grow)
            self.next_length = self.scaled(length, left - length, part)
            self.panel.push[0] = push
            part = self.panel.end_of_slip()
            if part <= 1.0:
                part, _ = self.panel.gone(part)
                if part > self.shortest:
                    if not self.panel.solve(part, left if graded else 0.0):
                        self.next_length = 0.5 * part
                        continue
                    self.accept(True)
                elif self.theta == begin:
                    self.stalled, self.first_step = begin, 2.0 * self.first_step  # there was no slip
                    self.pieces = before
                self.halt()
                return
            push, r = self.panel.push[STAGES], self.motion.value[STAGES, 2]
            rate = self.panel.rate[STAGES - 1]
            self.accept(not (last and length == left))
            bend = 0.0
            if r > self.nothing * self.motion.reach:
                self.motion.bend(STAGES)
                bend = self.turning(STAGES, rate)

    def turning(self, slot: cython.int, rate: float) -> float:
        """alpha'' at an angle in a slot with second derivatives, from R alpha' = e_perp . U'."""
        bend: float = self.e_x * self.motion.value[slot, 7] - self.e_y * self.motion.value[slot, 6]
        along: float = self.e_x * self.motion.value[slot, 3] + self.e_y * self.motion.value[slot, 4]
        bend -= (along + self.motion.value[slot, 5]) * rate
        bend /= self.motion.value[slot, 2]
        return bend

    def scaled(self, length: float, left: float, by: float) -> float:
        """Panel length times a factor; for a graded panel the change of its root is scaled."""
        part: float
        if self.panel.fade > 0.0:
            part = max(1.0 - by * self.panel.fade, 0.0)
            length = left * (1.0 - part * part)
        else:
            length *= by
        return length

    def grown(self, rest: float) -> float:
        """Factor by which a panel may be longer: its error grows as the 8th power (STAGES) of its length."""
        ratio: float = sqrt(sqrt(sqrt(self.tolerance / rest)))
        return ratio

    def opening(self, end: float) -> None:
        """Sets `last_x`, `last_y`, `last_speed`, `falls`: direction, speed of U', and -R' at the opening."""
        self.motion.place(SCAN, end)
        x_1: float = self.motion.value[SCAN, 3]
        y_1: float = self.motion.value[SCAN, 4]
        self.last_speed, self.falls = hypot(x_1, y_1), -self.motion.value[SCAN, 5]
        by: float = 1.0 / self.last_speed if self.last_speed > 0.0 else 0.0
        self.last_x, self.last_y = by * x_1, by * y_1

    def stray(self) -> float:
        """Distance of the present direction from that at the opening."""
        d_x: float = self.e_x - self.last_x
        d_y: float = self.e_y - self.last_y
        stray: float = sqrt(d_x * d_x + d_y * d_y)
        return stray

    def left_out(self, stray: float, turned: float, left: float) -> float:
        """Bound of the impulse derivatives if the slip direction is not followed up to the opening.

        It sums the derivative of the force by the present direction, the moving opening, and the motion.
        """
        if not self.falls > 0.0:
            return 1e300
        most: float = (turned + stray * self.last_speed / self.falls + self.motion.highest * left) * left
        return most

    def realign(self, push: float) -> float:
        """Turns the direction to that of the motion where the disc vanishes; returns lambda there."""
        self.motion.place(SCAN, self.theta)
        x_1: float = self.motion.value[SCAN, 3]
        y_1: float = self.motion.value[SCAN, 4]
        speed: float = hypot(x_1, y_1)
        if self.e_x * x_1 + self.e_y * y_1 >= 0.5 * speed:
            return push
        self.e_x, self.e_y = x_1 / speed, y_1 / speed
        if self.varying:
            self.derivatives.close_sliding(self.e_x, self.e_y, 0.0)
        return self.push()

    def accept(self, carried: cython.bint) -> None:
        """Goes to the end of the panel; the derivatives follow if `carried`."""
        i: cython.int
        self.theta, self.first_step = self.panel.theta + self.panel.length, self.least_step
        self.e_x, self.e_y = self.panel.e_x[STAGES - 1], self.panel.e_y[STAGES - 1]
        size: float = 1.0 / sqrt(self.e_x * self.e_x + self.e_y * self.e_y)
        self.e_x, self.e_y = self.e_x * size, self.e_y * size
        for i in range(STAGES):
            way: float = self.panel.weight[i] * self.panel.speed[i] * self.panel.push[i + 1]
            self.gone += way
            self.gone_x += way * self.panel.e_x[i]
            self.gone_y += way * self.panel.e_y[i]
        if self.gathering:
            self.integrals.slip(self.panel)
            if self.panels < self.most_panels:
                self.record[self.panels, 0], self.record[self.panels, 1] = self.panel.theta, self.panel.length
                self.record[self.panels, 2], self.record[self.panels, 3] = (
                    self.panel.start_x, self.panel.start_y,
                )  # fmt: skip
                self.record[self.panels, 4] = self.panel.left
                for i in range(STAGES):
                    self.record[self.panels, 5 + i] = self.panel.tangent[i + 1]
            self.panels += 1
        if self.varying and carried:
            self.derivatives.carry(self.gathering and self.gradient)

    def halt(self) -> None:
        """Ends the slip at the present angle."""
        self.motion.place(SCAN, self.theta)
        r: float = max(self.motion.value[SCAN, 2], 0.0)
        self.w_x = self.motion.value[SCAN, 0] - r * self.e_x
        self.w_y = self.motion.value[SCAN, 1] - r * self.e_y
        self.sliding = False
        if self.varying:
            self.derivatives.rest(self.e_x, self.e_y)

    def measure(self, theta: float) -> None:
        """Sets `gap`, `gap_slope`, `noise`: g, its derivative and rounding, at an angle placed in SCAN."""
        self.motion.place(SCAN, theta)
        d_x: float = self.motion.value[SCAN, 0] - self.w_x
        d_y: float = self.motion.value[SCAN, 1] - self.w_y
        r: float = self.motion.value[SCAN, 2]
        size: float = self.motion.size + self.motion.reach + fabs(self.w_x) + fabs(self.w_y)
        self.noise = 8.0 * EPSILON * size * (fabs(r) + EPSILON * size)
        self.gap = d_x * d_x + d_y * d_y - r * r
        self.gap_slope = d_x * self.motion.value[SCAN, 3] + d_y * self.motion.value[SCAN, 4]
        self.gap_slope = 2.0 * (self.gap_slope - r * self.motion.value[SCAN, 5])

    def hold(self, end: float) -> None:
        """Follows a stick until the disc meets the slider, or up to the angle `end`."""
        begin: float = self.theta
        self.add(STICK)
        self.measure(begin)
        self.motion.bend(SCAN)
        r: float = max(self.motion.value[SCAN, 2], 0.0)
        size: float = self.motion.size + hypot(self.w_x, self.w_y)
        noise: float = self.noise
        bend: float = (
            (self.motion.value[SCAN, 0] - self.w_x) * self.motion.value[SCAN, 6]
            + (self.motion.value[SCAN, 1] - self.w_y) * self.motion.value[SCAN, 7]
            + self.motion.value[SCAN, 3] * self.motion.value[SCAN, 3]
            + self.motion.value[SCAN, 4] * self.motion.value[SCAN, 4]
            - self.motion.value[SCAN, 2] * self.motion.value[SCAN, 8]
            - self.motion.value[SCAN, 5] * self.motion.value[SCAN, 5]
        )
        third: float = 2.0 * (
            size * self.motion.motion_bound[3]
            + 3.0 * self.motion.motion_bound[1] * self.motion.motion_bound[2]
            + self.motion.reach * self.motion.reach_bound[3]
            + 3.0 * self.motion.reach_bound[1] * self.motion.reach_bound[2]
        )
        fourth: float = 2.0 * (
            size * self.motion.motion_bound[4]
            + 4.0 * self.motion.motion_bound[1] * self.motion.motion_bound[3]
            + 3.0 * self.motion.motion_bound[2] * self.motion.motion_bound[2]
            + self.motion.reach * self.motion.reach_bound[4]
            + 4.0 * self.motion.reach_bound[1] * self.motion.reach_bound[3]
            + 3.0 * self.motion.reach_bound[2] * self.motion.reach_bound[2]
        )
        longest: float = 0.8 / max(self.motion.highest, 1)
        length: float = 0.5 * longest
        low: float = begin
        g: float = self.gap
        d: float = self.gap_slope
        # on the edge of its disc, from which g falls as bend / 2 times the square
        if g > -noise - self.on_edge * r * r:
            rate: float = 16.0 * EPSILON * size * (self.motion.motion_bound[1] + self.motion.reach_bound[1])
            if (
                d > rate
                and begin != self.stalled
                and (bend >= 0.0 or d * d > -2.0 * bend * (noise + self.on_edge * r * r))
            ):
                self.release(begin, begin)
                return
            length = 3.0 * fabs(bend) / third if bend < 0.0 and third > 0.0 else 0.0
            low = min(begin + min(max(length, self.first_step), longest), end)
            self.measure(low)
            g, d, noise = self.gap, self.gap_slope, self.noise
            if g > self.noise and low < end:
                self.release(begin, low)
                return
            length = max(length, self.first_step)
        while low < end:
            length = min(length, longest)
            high: float = min(low + length, end)
            self.measure(high)
            h: float = high - low
            _, most = value_bounds(h, fourth, g, d, self.gap, self.gap_slope)
            least_slope, most_slope = slope_bounds(h, fourth, g, d, self.gap, self.gap_slope)
            rises: bool = least_slope > 0.0
            if self.gap > self.noise:
                if rises or h < self.shortest or high <= low:
                    self.release(begin, self.meet(low, high))
                    return
            elif rises or most_slope < 0.0 or most <= min(noise, self.noise) or h < self.shortest:
                low, g, d, noise = high, self.gap, self.gap_slope, self.noise
                length *= 2.0
                continue
            length = 0.5 * h
        self.theta = end
        if self.gathering:
            self.integrals.stick(begin, end, self.w_x, self.w_y)
            if self.gradient:
                self.derivatives.stick(begin, end)

    def release(self, begin: float, theta: float) -> None:
        """Ends the stick at an angle, where a slip begins."""
        if self.gathering:
            self.integrals.stick(begin, theta, self.w_x, self.w_y)
            if self.gradient:
                self.derivatives.stick(begin, theta)
        self.theta = theta
        self.motion.place(SCAN, theta)
        d_x: float = self.motion.value[SCAN, 0] - self.w_x
        d_y: float = self.motion.value[SCAN, 1] - self.w_y
        d: float = hypot(d_x, d_y)
        if not (d > 0.0 and self.motion.value[SCAN, 2] > 0.0):
            self.stalled = theta
            return
        self.e_x, self.e_y, self.sliding = d_x / d, d_y / d, True
        self.next_length = self.first_length()
        if self.varying:
            self.derivatives.slide(self.e_x, self.e_y)

    def meet(self, low: float, high: float) -> float:
        """Angle between `low` and `high` at which the disc meets the slider, by bracketed Newton steps."""
        i: cython.int
        x: float = 0.5 * (low + high)
        for i in range(80):  # noqa: B007
            self.measure(x)
            d_x: float = self.motion.value[SCAN, 0] - self.w_x
            d_y: float = self.motion.value[SCAN, 1] - self.w_y
            d: float = sqrt(d_x * d_x + d_y * d_y)
            r: float = max(self.motion.value[SCAN, 2], 0.0)
            if self.gap > 0.0:
                high = x
            else:
                low = x
            step: float = high - low
            if self.gap_slope > 0.0:
                # Newton's step for |U - W| - R, whose derivative is about that of g over |U - W| + R
                step = (r - d) * (d + r) / self.gap_slope
            if not low < x + step < high:
                step = 0.5 * (low + high) - x
            x += step
            if fabs(step) <= 2.0 * EPSILON * fabs(x) or high - low <= 2.0 * EPSILON * fabs(x):
                break
        return x
