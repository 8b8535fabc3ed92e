"""Kernel: a contact's periodic motion as trigonometric polynomials: its load and its two limits.

With forces instead of displacements, everything divided by the greatest
amplitude, the limits between which the slider k_u w is held are

    lower(theta) = k_u u - mu n,   upper(theta) = k_u u + mu n,   n = n_0 + k_v v where that is positive.

The mean of u is left out: it matters only to a slider that never moves.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, fabs, floor, hypot, isfinite, sin

# Nodes lie beside the multiples of pi / 2, where symmetric motions have their events.
FIRST_NODE = cython.declare(cython.double, 0.1171)
NODES_PER_HARMONIC = cython.declare(cython.int, 4)  # at first: where that proves nothing it is halved
TWO_PI = cython.declare(cython.double, 6.283185307179586)


@cython.cclass
class Nodes:
    """`nodes` angles, first + j * step: few for a fundamental alone, and many for all harmonics.

    node_cos, node_sin (node, harmonic): the harmonics at the few, then at the many; those that are taken
    stand from `before` on.
    """

    def __init__(self, harmonics: list[int]) -> None:
        self.highest = max(harmonics, default=0)
        self.few, self.many = NODES_PER_HARMONIC + 1, NODES_PER_HARMONIC * max(self.highest, 1) + 1
        both = _waves(self.few, harmonics), _waves(self.many, harmonics)
        self.node_cos, self.node_sin = (np.concatenate(waves) for waves in zip(*both, strict=True))
        self.fundamental = harmonics[:1] == [1]
        self.take_nodes(len(harmonics))

    def take_nodes(self, moving: cython.int) -> None:
        """Those of a motion of so many harmonics, the first."""
        self.alone = moving <= 1 and self.fundamental
        self.nodes = self.few if self.alone else self.many
        self.before = 0 if self.alone else self.few
        self.step = TWO_PI / self.nodes
        self.first = FIRST_NODE * self.step


def _waves(count: int, harmonics: list[int]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Cosines and sines (node, harmonic) at so many nodes."""
    nodes = 2.0 * np.pi / count * (FIRST_NODE + np.arange(count))
    angle = np.outer(nodes, np.array(harmonics, dtype=np.float64))
    return np.cos(angle), np.sin(angle)


# Rows of coefficients and of samples. The row after one is its derivative.
LOAD = cython.declare(cython.int, 0)
LOAD_RATE = cython.declare(cython.int, 1)
LOWER = cython.declare(cython.int, 3)
LOWER_RATE = cython.declare(cython.int, 4)
UPPER = cython.declare(cython.int, 6)
UPPER_RATE = cython.declare(cython.int, 7)
FORCE = cython.declare(cython.int, 9)  # k_u u
FORCE_RATE = cython.declare(cython.int, 10)
REACH = cython.declare(cython.int, 12)  # mu n; of coefficients only
ROWS = cython.declare(cython.int, 13)

POWERS = cython.declare(cython.int, 3)  # of a harmonic's number, in bounds
OPEN = cython.declare(cython.int, 0)
CLOSED = cython.declare(cython.int, 1)
MIXED = cython.declare(cython.int, 2)
UNKNOWN = cython.declare(cython.int, 3)

EPSILON = cython.declare(cython.double, 2.220446049250313e-16)
LEAST = cython.declare(cython.double, 1e-290)  # what is smaller counts as nothing
FAINT = cython.declare(
    cython.double, 1e-150
)  # motion that is smaller than its mean by that counts as nothing


@cython.cclass
class Motion(Nodes):
    """u and n_0 + k_v v with given harmonics; `load` takes one contact, `sample` fills the nodes.

    moving: the harmonics after so many are nothing, as where few are looked at among more.
    taken: whether a cycle remembers the motion that is loaded; see `Cycle.take`. sampled: whether the nodes
    are those of that motion.
    """

    def __init__(self, harmonics: list[int]) -> None:
        Nodes.__init__(self, harmonics)
        numbers, self.count = np.array(harmonics, dtype=np.intc), len(harmonics)
        self.number, self.order = numbers, numbers.astype(np.float64)
        self.re = np.zeros((ROWS, max(self.count, 1)))
        self.im = np.zeros((ROWS, max(self.count, 1)))
        self.mean = np.zeros(ROWS)
        self.scale = self.load_scale = self.ratio = self.preload = 0.0
        self.taken = self.sampled = False
        self.load_bound, self.limit_bound = np.zeros(POWERS), np.zeros(POWERS)
        self.at = np.zeros((REACH, self.many))

    def load(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        mu: float,
        k_u: float,
        k_v: float,
        n_0: float,
    ) -> cython.int:
        """Take a contact; OPEN, CLOSED or MIXED over the cycle, UNKNOWN where a number is not finite."""
        self.taken = self.sampled = False
        self.moving = 0
        k: cython.int
        i: cython.Py_ssize_t = first + 2
        motion: float = 0.0
        variation: float = 0.0
        for k in range(self.count):
            motion = max(motion, fabs(x[i]), fabs(x[i + 1]))
            variation = max(variation, fabs(x[i + 2]), fabs(x[i + 3]))
            if not x[i] == x[i + 1] == x[i + 2] == x[i + 3] == 0.0:
                self.moving = k + 1
            # max passes over what is not a number
            if not (isfinite(x[i]) and isfinite(x[i + 1]) and isfinite(x[i + 2]) and isfinite(x[i + 3])):
                return UNKNOWN
            i += 4
        if not (isfinite(x[first]) and isfinite(x[first + 1]) and isfinite(n_0) and isfinite(mu)):
            return UNKNOWN
        self.preload = n_0 + k_v * float(x[first + 1])
        self.load_scale = max(k_v * variation, FAINT * fabs(self.preload), LEAST)
        self.scale = max(k_u * motion, mu * self.load_scale, FAINT * k_u * fabs(x[first]), LEAST)
        if not (isfinite(self.scale) and isfinite(self.preload) and isfinite(k_u) and isfinite(k_v)):
            return UNKNOWN
        self.ratio = mu * (self.load_scale / self.scale) if mu > 0.0 else 0.0
        self.fill(x, first + 2, k_u, k_v)
        self.take_nodes(self.moving)
        self.mean[LOAD] = self.preload / self.load_scale
        self.mean[REACH] = self.ratio * self.mean[LOAD]
        self.mean[LOWER] = -self.mean[REACH]
        self.mean[UPPER] = self.mean[REACH]
        self.bound()
        return self.behaviour()

    def fill(self, x: cython.double[::1], first: cython.Py_ssize_t, k_u: float, k_v: float) -> None:
        """The coefficients of all rows."""
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
        """What the mean load and the sum of the amplitudes of its variation say."""
        k: cython.int
        total: float = 0.0
        for k in range(self.count):
            total += hypot(self.re[LOAD, k], self.im[LOAD, k])
        if self.mean[LOAD] <= -total:
            return OPEN
        return CLOSED if self.mean[LOAD] >= total else MIXED

    def bound(self) -> None:
        """`load_bound` and `limit_bound`: no value of the derivative of an order is greater.

        They are sums of order**power times the amplitude; of a limit those of the motion and the load, so
        that they also bound their rounding.
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
        """Load and limits with their derivatives at all nodes."""
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
        slope, value = self.rate_and_value(row, row, cos(theta), sin(theta))
        return value, slope

    def rate_and_value(
        self, row: cython.int, other: cython.int, c_1: float, s_1: float
    ) -> tuple[float, float]:
        """Slope of a row and value of another at an angle, of which the cosine and the sine are given."""
        c: float = c_1
        s: float = s_1
        turned: float
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
            slope -= self.order[k] * (self.re[row, k] * s + self.im[row, k] * c)
            value += self.re[other, k] * c - self.im[other, k] * s
        return slope, value

    def bend(self, row: cython.int, c_1: float, s_1: float) -> float:
        """Second derivative of a row at an angle, of which the cosine and the sine are given."""
        c: float = c_1
        s: float = s_1
        turned: float
        bend: float = 0.0
        h: cython.int = 1
        k: cython.int
        for k in range(self.moving):
            while h < self.number[k]:
                turned = c * c_1 - s * s_1
                s = s * c_1 + c * s_1
                c = turned
                h += 1
            bend -= self.order[k] * self.order[k] * (self.re[row, k] * c - self.im[row, k] * s)
        return bend

    def node_before(self, theta: float) -> cython.int:
        """Number of the last node at or before an angle; not reduced to one turn."""
        return cython.cast(cython.int, floor((theta - self.first) / self.step))
