"""Kernel: a contact's periodic motion as trigonometric polynomials: the load and the two slip limits.

The limits of the slider k_u w, as forces relative to the greatest amplitude, are

    lower(theta) = k_u u - mu n,   upper(theta) = k_u u + mu n,   n = n_0 + k_v v where that is positive.

The mean of u is omitted: it matters only for a slider that never moves.

No sign change of a row is missed. Between two nodes, the values and slopes at both and a bound of the fourth
derivative prove that the row has no zero, or that it is monotone (`fcm.cubic`). If they do not, the interval
is halved, until a hidden zero is within the rounding of the row itself (`ZeroCrossings`). Each event holds
the limits of the slider there, and their rates (`CycleEvents`).
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import atan2, ceil, cos, fabs, floor, hypot, sin, sqrt

from fcm.contact.options import PERIODIC, PeriodicOptions

if cython.compiled:
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        UNKNOWN,
        ContactParameters,
        HarmonicMotion,
    )
    from cython.cimports.fcm.cubic import powers, slope_bounds, value_bounds
else:
    from fcm.contact.contact_kernel import CLOSED, MIXED, OPEN, UNKNOWN, ContactParameters, HarmonicMotion
    from fcm.cubic import powers, slope_bounds, value_bounds

# Nodes lie beside the multiples of pi / 2, where symmetric motions have their events.
FIRST_NODE = cython.declare(cython.double, 0.1171)
TWO_PI = cython.declare(cython.double, 6.283185307179586)
PI = cython.declare(cython.double, 3.141592653589793)


def _waves(count: int, harmonics: list[int]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Cosines and sines (node, harmonic) of the harmonics at equally spaced nodes."""
    nodes = 2.0 * np.pi / count * (FIRST_NODE + np.arange(count))
    angle = np.outer(nodes, np.array(harmonics, dtype=np.float64))
    return np.cos(angle), np.sin(angle)


# Rows of coefficients and of samples. The row after each is its derivative.
LOAD = cython.declare(cython.int, 0)
LOAD_RATE = cython.declare(cython.int, 1)
LOWER = cython.declare(cython.int, 3)
LOWER_RATE = cython.declare(cython.int, 4)
UPPER = cython.declare(cython.int, 6)
UPPER_RATE = cython.declare(cython.int, 7)
FORCE = cython.declare(cython.int, 9)  # k_u u
FORCE_RATE = cython.declare(cython.int, 10)
REACH = cython.declare(cython.int, 12)  # mu n; a row of coefficients only
ROWS = cython.declare(cython.int, 13)

POWERS = cython.declare(cython.int, 3)  # number of powers of a harmonic's number, in bounds
EPSILON = cython.declare(cython.double, 2.220446049250313e-16)


@cython.cclass
class LineMotion(HarmonicMotion):
    """Motion u and n_0 + k_v v with given harmonics; `load` takes one contact, `sample` fills the nodes.

    Attributes
    ----------
    nodes, first, step
        The number of nodes, at the angles first + j step [rad]: `few` if only the fundamental moves, `many`
        for all harmonics.
    at (row, node)
        The rows at the nodes.
    node_cos, node_sin (node, harmonic)
        The harmonics at the few nodes, then at the many; the rows in use begin at `before`.
    taken
        Whether a cycle has solved the motion that is loaded; see `LineCycle.take`.
    sampled
        Whether `at` is filled for that motion.
    """

    def __init__(self, harmonics: list[int], options: PeriodicOptions = PERIODIC) -> None:
        HarmonicMotion.__init__(self, harmonics, 2, ROWS)
        self.few = options.nodes_per_harmonic + 1
        self.many = options.nodes_per_harmonic * max(self.highest, 1) + 1
        both = _waves(self.few, harmonics), _waves(self.many, harmonics)
        self.node_cos, self.node_sin = (np.concatenate(waves) for waves in zip(*both, strict=True))
        self.fundamental = harmonics[:1] == [1]
        self.take_nodes(len(harmonics))
        self.taken = self.sampled = False
        self.load_bound, self.limit_bound = np.zeros(POWERS), np.zeros(POWERS)
        self.at = np.zeros((REACH, self.many))

    def take_nodes(self, moving: cython.int) -> None:
        """Chooses the nodes for a motion whose harmonics after the first `moving` ones are zero."""
        self.alone = moving <= 1 and self.fundamental
        self.nodes = self.few if self.alone else self.many
        self.before = 0 if self.alone else self.few
        self.step = TWO_PI / self.nodes
        self.first = FIRST_NODE * self.step

    def load(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> cython.int:
        """Takes a motion x[first:]; returns OPEN, CLOSED or MIXED, or UNKNOWN if a number is not finite."""
        self.taken = self.sampled = False
        if not self.measure(x, first, contact):
            return UNKNOWN
        self.fill(x, first + 2, contact)
        self.take_nodes(self.moving)
        self.mean[LOAD] = self.preload / self.load_scale
        self.mean[REACH] = self.ratio * self.mean[LOAD]
        self.mean[LOWER] = -self.mean[REACH]
        self.mean[UPPER] = self.mean[REACH]
        self.bound()
        return self.behaviour()

    def fill(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> None:
        """Fills the coefficients of all rows."""
        k_u: float = contact.k_u
        k_v: float = contact.k_v
        k: cython.int
        i: cython.Py_ssize_t = first
        row: cython.int
        order: float
        for k in range(self.count):
            order = self.order[k]
            self.re[FORCE, k] = k_u * x[i] / self.scale
            self.im[FORCE, k] = k_u * x[i + 1] / self.scale
            self.re[LOAD, k] = k_v * x[i + 2] / self.load_scale
            self.im[LOAD, k] = k_v * x[i + 3] / self.load_scale
            self.re[REACH, k] = self.ratio * self.re[LOAD, k]
            self.im[REACH, k] = self.ratio * self.im[LOAD, k]
            self.re[LOWER, k] = self.re[FORCE, k] - self.re[REACH, k]
            self.im[LOWER, k] = self.im[FORCE, k] - self.im[REACH, k]
            self.re[UPPER, k] = self.re[FORCE, k] + self.re[REACH, k]
            self.im[UPPER, k] = self.im[FORCE, k] + self.im[REACH, k]
            for row in range(LOAD, REACH, 3):
                self.re[row + 1, k] = -order * self.im[row, k]
                self.im[row + 1, k] = order * self.re[row, k]
            i += 4

    def behaviour(self) -> cython.int:
        """OPEN, CLOSED or MIXED, from the mean load and the sum of its harmonics' amplitudes."""
        k: cython.int
        total: float = 0.0
        for k in range(self.count):
            total += hypot(self.re[LOAD, k], self.im[LOAD, k])
        if self.mean[LOAD] <= -total:
            return OPEN
        return CLOSED if self.mean[LOAD] >= total else MIXED

    def bound(self) -> None:
        """Fills `load_bound` and `limit_bound`, bounds of the derivatives of each order.

        They are sums of order**power times the amplitude. For a limit the amplitudes of motion and load are
        added, so that the sums also bound the rounding.
        """
        k: cython.int
        p: cython.int
        load: float
        limit: float
        for p in range(POWERS):
            self.load_bound[p] = self.limit_bound[p] = 0.0
        for k in range(self.count):
            load = fabs(self.re[LOAD, k]) + fabs(self.im[LOAD, k])
            limit = fabs(self.re[FORCE, k]) + fabs(self.im[FORCE, k]) + self.ratio * load
            for p in range(POWERS):
                self.load_bound[p] += load
                self.limit_bound[p] += limit
                load *= self.order[k]
                limit *= self.order[k]

    def sample(self) -> None:
        """Fills the load and limits with their derivatives at all nodes."""
        if self.sampled:
            return
        self.sampled = True
        j: cython.int
        k: cython.int
        c: float
        s: float
        order: float
        real: float
        imag: float
        for j in range(self.nodes):
            u: float = 0.0
            u_1: float = 0.0
            u_2: float = 0.0
            y: float = 0.0
            y_1: float = 0.0
            y_2: float = 0.0
            for k in range(self.moving):
                order, c, s = (
                    self.order[k],
                    self.node_cos[self.before + j, k],
                    self.node_sin[self.before + j, k],
                )
                real = self.re[FORCE, k] * c - self.im[FORCE, k] * s
                imag = self.re[FORCE, k] * s + self.im[FORCE, k] * c
                u += real
                u_1 -= order * imag
                u_2 -= order * order * real
                real = self.re[LOAD, k] * c - self.im[LOAD, k] * s
                imag = self.re[LOAD, k] * s + self.im[LOAD, k] * c
                y += real
                y_1 -= order * imag
                y_2 -= order * order * real
            y += self.mean[LOAD]
            self.at[LOAD, j], self.at[LOAD + 1, j], self.at[LOAD + 2, j] = y, y_1, y_2
            y, y_1, y_2 = self.ratio * y, self.ratio * y_1, self.ratio * y_2
            self.at[LOWER, j], self.at[LOWER + 1, j], self.at[LOWER + 2, j] = u - y, u_1 - y_1, u_2 - y_2
            self.at[UPPER, j], self.at[UPPER + 1, j], self.at[UPPER + 2, j] = u + y, u_1 + y_1, u_2 + y_2
            self.at[FORCE, j], self.at[FORCE + 1, j], self.at[FORCE + 2, j] = u, u_1, u_2

    def evaluate(self, row: cython.int, theta: float) -> tuple[float, float]:
        """Value and slope of a row at an angle."""
        slope: float
        value: float
        _, slope, value = self.derivatives(row, row, cos(theta), sin(theta))
        return value, slope

    def derivatives(
        self, row: cython.int, other: cython.int, c_1: float, s_1: float
    ) -> tuple[float, float, float]:
        """Second derivative and slope of a row, and value of another row, at an angle.

        c_1 and s_1 are the cosine and sine of the angle.
        """
        c: float = c_1
        s: float = s_1
        turned: float
        order: float
        bend: float = 0.0
        slope: float = 0.0
        value: float = self.mean[other]
        h: cython.int = 1
        k: cython.int
        for k in range(self.moving):
            while h < self.number[k]:
                turned = c * c_1 - s * s_1
                s = s * c_1 + c * s_1
                c = turned
                h += 1
            order = self.order[k]
            bend -= order * order * (self.re[row, k] * c - self.im[row, k] * s)
            slope -= order * (self.re[row, k] * s + self.im[row, k] * c)
            value += self.re[other, k] * c - self.im[other, k] * s
        return bend, slope, value

    def node_before(self, theta: float) -> cython.int:
        """Number of the last node at or before an angle, not reduced to one turn."""
        return cython.cast(cython.int, floor((theta - self.first) / self.step))


@cython.cclass
class ZeroCrossings:
    """Angles where rows of a motion change sign: `angle`, the first `count`, in the order of the searches.

    `order`: their numbers by rising angle, after `sort`.
    """

    def __init__(self, motion: LineMotion, options: PeriodicOptions = PERIODIC) -> None:
        self.motion = motion
        self.max_halvings, self.min_interval = options.max_halvings, options.min_interval
        self.capacity = 4 * motion.highest + 4  # two zeros for each harmonic, and as many extremes
        self.angle = np.empty(self.capacity)
        self.kind, self.order = np.empty((2, self.capacity), dtype=np.intc)
        self.open = np.zeros(motion.at.shape[1], dtype=np.intc)
        self.stack = np.empty((self.max_halvings + 2, 3))
        self.count = self.row = self.rising = self.falling = self.sign = 0
        self.curvature = self.fourth = self.noise = 0.0
        self.last = self.last_value = self.last_slope = 0.0

    def begin(self) -> None:
        """Forgets the crossings found so far."""
        j: cython.int
        self.count = 0
        for j in range(self.motion.nodes):
            self.open[j] = 0

    def search(self, row: cython.int, rising: cython.int, falling: cython.int) -> None:
        """Appends the sign changes of LOAD or of a rate, as kinds `rising` and `falling`; -1 omits a kind.

        The search of LOAD has to come first: it finds the intervals in which the contact is open, which the
        other searches skip.
        """
        j: cython.int
        self.row, self.rising, self.falling = row, rising, falling
        self.bounds()
        self.sign = 0
        start: cython.int = self.definite_node()
        if self.motion.alone and row != LOAD:
            _of_one(self, self.motion, self.motion.first + start * self.motion.step)
            return
        for j in range(start, start + self.motion.nodes):
            self.interval(j)

    def sort(self) -> None:
        """Fills `order`."""
        i: cython.int
        j: cython.int
        for i in range(self.count):
            j = i
            while j > 0 and self.angle[self.order[j - 1]] > self.angle[i]:
                self.order[j] = self.order[j - 1]
                j -= 1
            self.order[j] = i

    def bounds(self) -> None:
        """Sets bounds of the row's second and fourth derivatives, and of the rounding error of its value."""
        k: cython.int
        amplitude: float
        order: cython.int = 0 if self.row == LOAD else 1
        if self.row <= LOAD_RATE:
            self.noise = self.motion.load_bound[order] + self.motion.load_bound[order + 1]
        else:
            self.noise = self.motion.limit_bound[order] + self.motion.limit_bound[order + 1]
        self.noise = EPSILON * (4.0 * self.noise + 2.0 * fabs(self.motion.mean[self.row]))
        self.curvature = self.fourth = 0.0
        for k in range(self.motion.moving):
            amplitude = fabs(self.motion.re[self.row, k]) + fabs(self.motion.im[self.row, k])
            amplitude *= self.motion.order[k] * self.motion.order[k]
            self.curvature += amplitude
            self.fourth += amplitude * self.motion.order[k] * self.motion.order[k]

    def definite_node(self) -> cython.int:
        """Number (-nodes to 0) of the last node with a certain sign, before the turn of nodes."""
        j: cython.int
        for j in range(self.motion.nodes):
            if fabs(self.motion.at[self.row, self.motion.nodes - 1 - j]) > self.noise:
                return -1 - j
        return 0

    def interval(self, j: cython.int) -> None:
        """Goes from node j to the next, halving the interval until a crossing is excluded or isolated."""
        left: cython.int = j if j >= 0 else j + self.motion.nodes
        right: cython.int = left + 1 if left + 1 < self.motion.nodes else 0
        row: cython.int = self.row
        if row != LOAD and self.open[left]:
            self.sign = 0
            return
        begin: float = self.motion.first + j * self.motion.step
        g: float = self.motion.at[row, left]
        d: float = self.motion.at[row + 1, left]
        if self.sign == 0:
            self.note(begin, g, d)
        if row == LOAD and self.proved(
            self.motion.step, g, d, self.motion.at[row, right], self.motion.at[row + 1, right]
        ):
            self.open[left] = g < -self.noise and self.motion.at[row, right] < -self.noise
        depth: cython.int = 0
        self.stack[0, 0], self.stack[0, 1] = begin + self.motion.step, self.motion.at[row, right]
        self.stack[0, 2] = self.motion.at[row + 1, right]
        while depth >= 0:
            end: float = self.stack[depth, 0]
            length: float = end - begin
            if (
                depth == self.max_halvings
                or length < self.min_interval
                or self.proved(length, g, d, self.stack[depth, 1], self.stack[depth, 2])
            ):
                begin, g, d = end, self.stack[depth, 1], self.stack[depth, 2]
                self.note(begin, g, d)
                depth -= 1
            else:
                depth += 1
                middle: float = begin + 0.5 * length
                value, slope = self.motion.evaluate(row, middle)
                self.stack[depth, 0], self.stack[depth, 1], self.stack[depth, 2] = middle, value, slope

    def proved(self, length: float, g_0: float, d_0: float, g_1: float, d_1: float) -> bool:
        """Whether the row provably has no zero inside, is monotone, or is within rounding."""
        low, high = value_bounds(length, self.fourth, g_0, d_0, g_1, d_1)
        if low > 0.0 or high < 0.0 or (low >= -self.noise and high <= self.noise):
            return True
        low, high = slope_bounds(length, self.fourth, g_0, d_0, g_1, d_1)
        return bool(low > 0.0 or high < 0.0)

    def note(self, theta: float, value: float, slope: float) -> None:
        """Takes the next point of the walk, and appends a crossing if the certain sign has changed."""
        if fabs(value) <= self.noise:
            return
        sign: cython.int = 1 if value > 0.0 else -1
        kind: cython.int = self.rising if sign > 0 else self.falling
        if sign == -self.sign and kind >= 0 and self.count < self.capacity:  # every zero changes the sign
            self.angle[self.count] = self.root(self.row, 0.0, theta, value, slope)
            self.kind[self.count] = kind
            self.count += 1
        self.sign = sign
        self.begin_at(theta, value, slope)

    def begin_at(self, theta: float, value: float, slope: float) -> None:
        """Makes a point the last point of the walk."""
        self.last, self.last_value, self.last_slope = theta, value, slope

    def root(self, row: cython.int, level: float, high: float, g_high: float, d_high: float) -> float:
        """Angle at which a row takes a value, beyond the last point: Halley's method, bracketed.

        g_high, d_high: row minus level, not zero, and its slope at the upper end. `last_value` and
        `last_slope` are those at the last point; the value there may be zero if the row turns in between.
        """
        low: float = self.last
        g_low: float = self.last_value
        d_low: float = self.last_slope
        up: bool = g_high > 0.0
        length: float = high - low
        # near a zero end where the row turns, its sign is due to rounding
        rounding: float = 4.0 * EPSILON * (self.motion.limit_bound[0] + self.motion.limit_bound[1])
        floor: float = rounding if g_low == 0.0 else 0.0
        x: float = low + length * _cubic(g_low, length * d_low, g_high, length * d_high)
        third: float = 2.0 * self.motion.highest  # twice a bound of the third derivative over the second
        for _ in range(100):
            c, s = cos(x), sin(x)
            bend, slope, value = self.motion.derivatives(row, row, c, s)
            value -= level
            if value == 0.0:
                return x
            if (value > 0.0) == up and fabs(value) > floor:
                high = x
            else:
                low = x
            step: float = high - low
            if (slope > 0.0) == up and slope != 0.0:
                step = -value / slope
                part: float = 0.5 * step * bend / slope
                step /= 1.0 + part if fabs(part) < 0.5 else 1.0
            rest: float = (3.0 * self.curvature + third * fabs(slope)) * fabs(step) * step * step
            if not low < x + step < high:
                step = 0.5 * (low + high) - x
            elif self.curvature * rest <= 6.0 * EPSILON * slope * slope:
                return x + step
            x += step
            if high - low <= EPSILON * fabs(x):
                return x
        return x


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _of_one(found: ZeroCrossings, motion: LineMotion, begin: float) -> cython.void:
    """Appends the crossings of a rate a cos(theta) - b sin(theta) within one turn; see `search`."""
    i: cython.int
    a: float = motion.re[found.row, 0]
    b: float = motion.im[found.row, 0]
    angle: float = atan2(a, b)
    angle += PI * ceil((begin - angle) / PI)
    falls: cython.int = a * sin(angle) + b * cos(angle) > 0.0
    for i in range(2 if hypot(a, b) > found.noise else 0):  # noqa: B007
        kind: cython.int = found.falling if falls else found.rising
        if kind >= 0 and not found.open[(motion.node_before(angle) + 2 * motion.nodes) % motion.nodes]:
            found.angle[found.count], found.kind[found.count] = angle, kind
            found.count += 1
        angle, falls = angle + PI, 1 - falls


def _cubic(g_0: float, d_0: float, g_1: float, d_1: float) -> float:
    """Approximate root in (0, 1] of a cubic with given values and slopes at the ends."""
    c_2, c_3 = powers(g_1 - g_0, d_0, d_1)
    if g_0 == 0.0:
        return _last_root(d_0, c_2, c_3)
    t: float = g_0 / (g_0 - g_1) if (g_0 > 0.0) != (g_1 > 0.0) else 0.5
    i: cython.int
    for i in range(3):  # noqa: B007
        value: float = g_0 + t * (d_0 + t * (c_2 + t * c_3))
        slope: float = d_0 + t * (2.0 * c_2 + t * 3.0 * c_3)
        if slope == 0.0 or not 0.0 < t - value / slope < 1.0:
            return t
        t -= value / slope
    return t


def _last_root(c_0: float, c_1: float, c_2: float) -> float:
    """The greatest root of a quadratic in [0.01, 1]; 0.5 if there is none."""
    root: float = c_1 * c_1 - 4.0 * c_0 * c_2
    if root < 0.0:
        return 0.5
    root = -0.5 * (c_1 + sqrt(root) if c_1 >= 0.0 else c_1 - sqrt(root))
    one: float = c_0 / root if root != 0.0 else 0.0
    other: float = root / c_2 if c_2 != 0.0 else 0.0
    one = one if one <= 1.0 else 0.0
    other = other if other <= 1.0 else 0.0
    return max(one, other) if max(one, other) >= 0.01 else 0.5


CLOSES = cython.declare(cython.int, 0)  # kinds of cuts
OPENS = cython.declare(cython.int, 1)
TOP = cython.declare(cython.int, 2)
BOTTOM = cython.declare(cython.int, 3)
MEETS = cython.declare(cython.int, 4)  # where a limit meets the slider: an event, but not a cut


@cython.cclass
class CycleEvents:
    """Events of a cycle, the first `events`, in any order, with the limits of the motion there.

    Attributes
    ----------
    event_kind, event_angle, event_cos, event_sin
        The kind, the angle [rad], its cosine and sine.
    lower, upper, moved
        Both limits and k_u u, divided by the scale of the motion.
    lower_rate, upper_rate, load_rate, motion_rate
        Their derivatives by the angle; that of the load is relative to its own scale.
    margin
        For a TOP or BOTTOM, how far the limit passes the slider: it slips if that is positive. For OPENS, the
        way of the slider to its place there. Relative to the scale.
    """

    def __init__(self, motion: LineMotion, size: int) -> None:
        self.motion = motion
        self.events = 0
        self.event_kind, self.event_angle = np.zeros(size, dtype=np.intc), np.zeros(size)
        self.event_cos, self.event_sin, self.margin = np.zeros((3, size))
        self.lower, self.upper, self.moved = np.zeros((3, size))
        self.lower_rate, self.upper_rate, self.load_rate, self.motion_rate = np.zeros((4, size))

    def place(self, theta: float, kind: cython.int) -> cython.int:
        """Adds an event at an angle, with its limits and their rates, and returns its number."""
        c_1: float = cos(theta)
        s_1: float = sin(theta)
        c: float = c_1
        s: float = s_1
        turned: float
        u: float = 0.0
        u_1: float = 0.0
        y: float = 0.0
        y_1: float = 0.0
        h: cython.int = 1
        k: cython.int
        e: cython.int = self.events
        for k in range(self.motion.moving):
            while h < self.motion.number[k]:
                turned = c * c_1 - s * s_1
                s = s * c_1 + c * s_1
                c = turned
                h += 1
            u += self.motion.re[FORCE, k] * c - self.motion.im[FORCE, k] * s
            y += self.motion.re[REACH, k] * c - self.motion.im[REACH, k] * s
            u_1 -= self.motion.order[k] * (self.motion.re[FORCE, k] * s + self.motion.im[FORCE, k] * c)
            y_1 -= self.motion.order[k] * (self.motion.re[LOAD, k] * s + self.motion.im[LOAD, k] * c)
        y = max(y + self.motion.mean[REACH], 0.0)
        self.event_kind[e], self.margin[e] = kind, 0.0
        self.event_angle[e], self.event_cos[e], self.event_sin[e] = theta, c_1, s_1
        self.moved[e], self.lower[e], self.upper[e] = u, u - y, u + y
        self.motion_rate[e], self.load_rate[e] = u_1, y_1
        self.lower_rate[e] = u_1 - self.motion.ratio * y_1
        self.upper_rate[e] = u_1 + self.motion.ratio * y_1
        self.events += 1
        return e
