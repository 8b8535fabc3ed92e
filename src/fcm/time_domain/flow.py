"""The exact motion in each combination of contact states, from a pool of flows for all frequencies.

The state vector is

    y = (q, q', f, n, 1, sin(h theta), cos(h theta) ...),    d = 2 modes + 2 contacts + 1 + 2 waves numbers,

with the modal displacements and velocities q, q', the friction forces f, the changes n = k_v v of the normal
loads from their preloads, and the phase angle theta = omega t of the forces at each of their harmonics h, of
which the first is 1. Then y' = A y in every combination of states, including forcing and preload. The contact
forces are state components: for a stiff contact, k_u (u - w) from displacements would lose as many digits as
the contact is stiffer than the structure.

Over a step h = 1 / rate the series of exp(A h) is complete to rounding after `ORDER` terms for every A:
defective, singular, or undamped in resonance. Whole steps are powers of exp(A h). A table of the exit
functions' rows times these powers gives the functions on `BLOCK` steps at once. The frequency enters only the
columns of the forces; all other parts of a flow are computed once for a scene (`FlowArrays`). A column is the
response after one step, or 2**j steps, to an initial sin(h theta) = 1 or cos(h theta) = 1 alone, or its
derivative by the frequency; there are four for each harmonic h (`ForcedFlows`). Within a step the motion of
each combination is a power series in the position, which is counted in steps (`FlowSeries`).

The exits of a combination are functions of the state vector; the combination ends where one becomes negative
(`ExitFunctions`). Like the motion, they are computed by columns: on the steps of a block, and as power series
in one step.
"""

from __future__ import annotations

from math import factorial
from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.time_domain.constant_matrices import Matrices
from fcm.time_domain.options import TIME, FlowOptions

ORDER = 19  # of the series of exp(A h): 1 / 20! is below rounding
POWERS = 8  # number of powers of exp(A h): 1, 2, 4 ... 128 steps
BLOCK = 8  # steps that are examined together: a power of two
WATCHED = 3  # for each exit g, g' h and g'''' h**4
SEPARATED, STICKING, POSITIVE_SLIP, NEGATIVE_SLIP = 0, 1, 2, 3  # states of a contact
# factors of (A h)**k in the response over a step to a force that grows as time**j, for k + j < ORDER
PUSHED = np.array(
    [[1.0 / factorial(k + j + 1) if k + j < ORDER else 0.0 for k in range(ORDER)] for j in range(ORDER)]
)


# the same in C, for all kernels
SERIES_ORDER = cython.declare(cython.int, ORDER)
FLOW_POWERS = cython.declare(cython.int, POWERS)
STATE_SEPARATED = cython.declare(cython.int, SEPARATED)
STATE_STICKING = cython.declare(cython.int, STICKING)
STATE_POSITIVE_SLIP = cython.declare(cython.int, POSITIVE_SLIP)
STATE_NEGATIVE_SLIP = cython.declare(cython.int, NEGATIVE_SLIP)


# arrays of the pool that are not of floating-point numbers
KINDS = dict.fromkeys(("states", "halved", "goal"), np.int8) | dict.fromkeys(
    ("exits", "owner", "first", "used", "reached", "watched", "spread", "squared", "spelled"), np.intp
)


def _shapes(n: int, contacts: int, waves: int, taylor_size: int) -> dict[str, tuple[int, ...]]:
    """Shapes of the pool's arrays for one flow: n state components, `waves` force harmonics."""
    e = max(2 * contacts, 1)  # exits: of a contact two at most
    wide = (BLOCK + 1) * WATCHED * e
    return {
        "states": (contacts,), "step": (), "halved": (), "exits": (), "owner": (e,), "goal": (e,),
        "first": (e,), "made_for": (), "used": (), "squared": (), "spelled": (), "row": (e, n),
        "power": (POWERS, n, n), "forced": (POWERS, 4 * waves, n), "rotation": (POWERS, 2 * waves),
        "reached": (), "watched": (), "terms": (ORDER + 1 if n <= taylor_size else 0, n * n), "sizes": (n, n),
        "sizes_forced": (2 * waves, n), "table": (n, wide), "table_forced": (2 * waves, wide),
        "push": (2, 4 * waves, n), "pushed": (4 * waves, ORDER, n), "kick": (e, 4 * waves, ORDER),
        "spread": (e,), "series": (n, e * (ORDER + 1)), "series_forced": (2 * waves, e * (ORDER + 1)),
    }  # fmt: skip


@cython.cclass
class FlowArrays:
    """Pool of the flows of a scene; if it is full, the least recently used flow is replaced.

    Many flows are followed only for short segments, and without derivatives. So the powers for more than one
    step, and the Taylor coefficients, are computed when they are needed.
    """

    def __init__(self, matrices: Matrices, options: FlowOptions = TIME.flows) -> None:
        modal, ports, law, springs, harmonics = matrices
        self.stiffness, self.damping, self.hold, self.constant, self.square = (
            np.ascontiguousarray(x, dtype=np.float64) for x in modal
        )
        self.drive, self.slope = np.array(self.constant), np.zeros_like(self.constant)
        self.tangential, self.normal, self.push_u, self.push_v = (
            np.ascontiguousarray(x, dtype=np.float64) for x in ports
        )
        self.stretch, self.pull = (np.ascontiguousarray(x, dtype=np.float64) for x in springs)
        self.springs = self.stretch.shape[0]
        self.mu, self.k_u, self.k_v, self.n_0 = (np.ascontiguousarray(x, dtype=np.float64) for x in law[:4])
        self.rough = np.ascontiguousarray(law[4], dtype=np.int8)
        self.modes, self.contacts = self.stiffness.shape[0], self.mu.shape[0]
        self.linear = 2 * self.modes + 2 * self.contacts + 1
        self.harmonic = np.ascontiguousarray(harmonics, dtype=np.float64)
        self.waves, self.highest = self.harmonic.shape[0], float(np.max(harmonics))
        self.size = self.linear + 2 * self.waves
        self.omega = 0.0
        self.count, self.clock = 0, 0
        self.take_options(options)
        self._pool: dict[str, Any] = {}
        self._make_room(4)

    def at(self, omega: float) -> None:
        """Sets the excitation frequency [rad/s]."""
        i: cython.Py_ssize_t
        b: cython.Py_ssize_t
        if omega == self.omega:
            return
        self.omega = omega
        for b in range(2 * self.waves):
            for i in range(self.modes):
                self.drive[b, i] = self.constant[b, i] + self.omega * self.omega * self.square[b, i]
                self.slope[b, i] = 2.0 * self.omega * self.square[b, i]

    def bytes(self) -> int:
        """Memory of the pool [bytes]."""
        return sum(made.nbytes for made in self._pool.values())

    def add(self, flow: Any) -> int:
        """Puts a `fcm.time_domain.contact_states.Flow` into the pool; returns its place."""
        k, exits, made = self._place(), len(flow.owner), self._pool
        rows, table, series, pushes = flow.rows, flow.table, flow.series, flow.pushes
        made["states"][k], made["step"][k], made["halved"][k] = flow.states, flow.step, flow.halved
        made["exits"][k], made["made_for"][k] = exits, -1.0
        made["owner"][k, :exits], made["goal"][k, :exits], made["row"][k, :exits] = (
            flow.owner,
            flow.goal,
            rows,
        )
        made["first"][k, :exits] = (rows != 0.0).argmax(axis=1) if exits else 0
        made["power"][k, 0], made["sizes"][k], made["used"][k] = flow.power, flow.sizes, self.clock
        made["squared"][k] = made["spelled"][k] = 0
        if made["terms"].shape[1]:
            made["terms"][k, 0], made["terms"][k, 1] = np.eye(self.linear).ravel(), flow.change.ravel()
        made["table"][k, :, : table.shape[1]], made["series"][k, :, : series.shape[1]] = table, series
        made["push"][k], made["kick"][k, :exits] = pushes[:2], np.einsum("ei,kci->eck", rows, pushes)
        made["pushed"][k] = np.tensordot(PUSHED, pushes, 1).swapaxes(0, 1)
        return k

    def spell(self, slot: int) -> None:
        """Computes the Taylor coefficients (A h)**j / j! of a flow for j >= 2."""
        terms = self._pool["terms"][slot].reshape(ORDER + 1, self.linear, self.linear)
        for j in range(2, ORDER + 1):
            np.matmul(terms[j - 1], terms[1], out=terms[j])
            terms[j] /= j
        self._pool["spelled"][slot] = 1

    def next_power(self, slot: int) -> None:
        """Computes the power of a flow over twice as many steps as its last power."""
        power, j = self._pool["power"][slot], int(self._pool["squared"][slot])
        np.matmul(power[j], power[j], out=power[j + 1])
        self._pool["squared"][slot] = j + 1

    def take_options(self, options: FlowOptions) -> None:
        """Copies the options to typed attributes for the kernels."""
        self.min_count, self.max_bytes = options.min_count, options.max_bytes
        self.dense_size, self.taylor_size = options.dense_size, options.taylor_size
        self.few_rows, of = options.few_rows, options.transitions
        self.rounding, self.depth, self.grazing = of.rounding, of.depth, of.grazing
        self.max_passes, self.max_steps, self.max_blocks = of.max_passes, of.max_steps, of.max_blocks
        self.max_halvings, self.first_doublings, self.max_order = (
            of.max_halvings,
            of.first_doublings,
            of.max_order,
        )
        self.negligible_power, self.max_step_angle = of.negligible_power, options.max_step_angle

    def _place(self) -> int:
        """Place of a new flow: a free place, or that of the least recently used flow."""
        capacity = self.step.shape[0]
        most = max(int(self.max_bytes / (self.bytes() / capacity)), self.min_count)
        if self.count == capacity < most:
            capacity = min(16 * capacity, most)  # unused room takes no memory
            self._make_room(capacity)
        if self.count == capacity:
            return int(np.argmin(np.asarray(self.used)))
        self.count += 1
        return int(self.count - 1)

    def _make_room(self, capacity: int) -> None:
        """Enlarges the arrays to `capacity` flows, keeps the present ones, and renews the typed views."""
        old, made = self._pool, {}
        for name, shape in _shapes(self.linear, self.contacts, self.waves, self.taylor_size).items():
            made[name] = np.zeros((capacity, *shape), KINDS.get(name, np.float64))
            if self.count:
                made[name][: self.count] = old[name][: self.count]
        self.states, self.step, self.exits = made["states"], made["step"], made["exits"]
        self.halved = made["halved"]
        self.owner, self.goal = made["owner"], made["goal"]
        self.row, self.first = made["row"], made["first"]
        self.made_for, self.power, self.forced = made["made_for"], made["power"], made["forced"]
        self.terms, self.squared, self.spelled = made["terms"], made["squared"], made["spelled"]
        self.rotation, self.table, self.table_forced = made["rotation"], made["table"], made["table_forced"]
        self.reached, self.watched, self.spread = made["reached"], made["watched"], made["spread"]
        self.push, self.pushed, self.kick = made["push"], made["pushed"], made["kick"]
        self.sizes, self.sizes_forced, self.used = made["sizes"], made["sizes_forced"], made["used"]
        self.series, self.series_forced = made["series"], made["series_forced"]
        self._pool = made

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def find(self, states: cython.schar[:, ::1], k: cython.Py_ssize_t) -> cython.Py_ssize_t:
        """Place of the flow for the states in row k, with steps valid at the frequency; -1 if there is none.

        The steps do not depend on which flows exist, as segment lengths are counted in steps.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        angle: cython.double
        for i in range(self.count):
            angle = self.highest * self.omega * self.step[i]
            if angle > self.max_step_angle or (self.halved[i] and 2.0 * angle <= self.max_step_angle):
                continue
            j = 0
            while j < self.contacts and self.states[i, j] == states[k, j]:
                j += 1
            if j == self.contacts:
                return i
        return -1


@cython.cclass
class FlowSeries(FlowArrays):
    """Flows as power series of y' = A y, a whole series per call."""

    def __init__(self, matrices: Matrices, options: FlowOptions = TIME.flows) -> None:
        FlowArrays.__init__(self, matrices, options)
        self._own = np.zeros((ORDER + 1, self.size))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def derive(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        a: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        b: cython.Py_ssize_t,
    ) -> cython.void:
        """Sets row b of z to A y, where y is row a."""
        i: cython.Py_ssize_t
        for i in range(self.size):
            self._own[0, i] = y[a, i]
        self.extend(slot, self._own, 1, 1.0, self._own, False)
        for i in range(self.size):
            z[b, i] = self._own[1, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def extend(
        self,
        slot: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        last: cython.Py_ssize_t,
        step: cython.double,
        y: cython.double[:, ::1],
        graded: cython.bint,
    ) -> cython.void:
        """Fills Taylor coefficients by the position in a step of a given length [s], from row 0 of z on.

        If graded, z is the derivative by the frequency of the motion with the coefficients y:
        z[a + 1] = step / (a + 1) (A z[a] + dA / d omega y[a]).
        """
        a: cython.Py_ssize_t
        j: cython.Py_ssize_t
        factor: cython.double
        for a in range(last):
            factor = step / (a + 1)
            structure(self, z, a, factor)
            for j in range(self.springs):
                spring(self, j, z, a, factor)
            for j in range(self.contacts):
                contact(self, j, self.states[slot, j], z, a, factor)
            if graded:
                grade(self, z, a, y, factor)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def structure(
    series: FlowSeries, z: cython.double[:, ::1], a: cython.Py_ssize_t, factor: cython.double
) -> cython.void:
    """Sets row a + 1 of z to the factor times the effect of modes and forces on row a."""
    m: cython.Py_ssize_t = series.modes
    end: cython.Py_ssize_t = series.linear
    i: cython.Py_ssize_t
    b: cython.Py_ssize_t = a + 1
    h: cython.Py_ssize_t
    one: cython.double = z[a, end - 1]
    sine: cython.double = z[a, end]
    cosine: cython.double = z[a, end + 1]
    z[b, end - 1] = 0.0
    for h in range(series.waves):
        z[b, end + 2 * h] = factor * series.omega * series.harmonic[h] * z[a, end + 2 * h + 1]
        z[b, end + 2 * h + 1] = -factor * series.omega * series.harmonic[h] * z[a, end + 2 * h]
    for i in range(m):
        z[b, i] = factor * z[a, m + i]
        z[b, m + i] = factor * (
            series.drive[0, i] * sine + series.drive[1, i] * cosine + series.hold[i] * one
            - series.stiffness[i] * z[a, i] - series.damping[i] * z[a, m + i]
        )  # fmt: skip
    for h in range(2, 2 * series.waves, 2):  # most scenes have only one harmonic
        sine, cosine = factor * z[a, end + h], factor * z[a, end + h + 1]
        for i in range(m):
            z[b, m + i] += series.drive[h, i] * sine + series.drive[h + 1, i] * cosine


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def spring(
    series: FlowSeries,
    j: cython.Py_ssize_t,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    factor: cython.double,
) -> cython.void:
    """Subtracts the force of spring j."""
    m: cython.Py_ssize_t = series.modes
    i: cython.Py_ssize_t
    u: cython.double = 0.0
    for i in range(m):
        u += series.stretch[j, i] * z[a, i]
    u *= factor
    for i in range(m):
        z[a + 1, m + i] -= series.pull[j, i] * u


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def contact(
    series: FlowSeries,
    j: cython.Py_ssize_t,
    state: cython.int,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    factor: cython.double,
) -> cython.void:
    """Adds the forces of contact j in a state, and sets the rates of its forces."""
    m: cython.Py_ssize_t = series.modes
    v: cython.double = factor * series.k_v[j] * velocity(series.normal, j, z, a)
    u: cython.double = 0.0
    f: cython.double = z[a, 2 * m + j]
    n: cython.double = z[a, 2 * m + series.contacts + j]
    if state == STATE_SEPARATED:  # the preload is missing
        f, n = 0.0, -max(series.n_0[j], 0.0) * z[a, series.linear - 1]
    else:  # a gap does not press
        n += min(series.n_0[j], 0.0) * z[a, series.linear - 1]
        if state != STATE_STICKING:
            u = series.mu[j] * v if state == STATE_POSITIVE_SLIP else -series.mu[j] * v
        elif series.rough[j]:
            u = factor * series.k_u[j] * velocity(series.tangential, j, z, a)
    push(series.push_u, j, f * factor, z, a + 1)
    push(series.push_v, j, n * factor, z, a + 1)
    z[a + 1, 2 * m + j] = u
    z[a + 1, 2 * m + series.contacts + j] = v


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def grade(
    series: FlowSeries,
    z: cython.double[:, ::1],
    a: cython.Py_ssize_t,
    y: cython.double[:, ::1],
    factor: cython.double,
) -> cython.void:
    """Adds the derivative of A by the frequency times the forces' phases in row a of y."""
    i: cython.Py_ssize_t
    h: cython.Py_ssize_t
    b: cython.Py_ssize_t = a + 1
    n: cython.Py_ssize_t = series.linear
    sine: cython.double
    cosine: cython.double
    for h in range(series.waves):
        sine, cosine = factor * y[a, n + 2 * h], factor * y[a, n + 2 * h + 1]
        z[b, n + 2 * h] += series.harmonic[h] * cosine
        z[b, n + 2 * h + 1] -= series.harmonic[h] * sine
        for i in range(series.modes):
            z[b, series.modes + i] += series.slope[2 * h, i] * sine + series.slope[2 * h + 1, i] * cosine


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def velocity(
    shape: cython.double[:, ::1], j: cython.Py_ssize_t, z: cython.double[:, ::1], a: cython.Py_ssize_t
) -> cython.double:
    """Velocity of contact j along its shape, from row a of z."""
    m: cython.Py_ssize_t = shape.shape[1]
    half: cython.Py_ssize_t = m // 2
    i: cython.Py_ssize_t
    one: cython.double = 0.0
    other: cython.double = 0.0  # two sums, as a single one would wait for each addition
    for i in range(half):
        one += shape[j, i] * z[a, m + i]
        other += shape[j, half + i] * z[a, m + half + i]
    if m % 2:
        other += shape[j, m - 1] * z[a, m + m - 1]
    return one + other


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def push(
    shape: cython.double[:, ::1],
    j: cython.Py_ssize_t,
    force: cython.double,
    z: cython.double[:, ::1],
    b: cython.Py_ssize_t,
) -> cython.void:
    """Subtracts contact j's force, times its shape over the masses, from the accelerations in row b of z."""
    m: cython.Py_ssize_t = shape.shape[1]
    i: cython.Py_ssize_t
    if force != 0.0:
        for i in range(m):
            z[b, m + i] -= shape[j, i] * force


@cython.cclass
class ForcedFlows(FlowSeries):
    """Force columns of flows; `refresh` computes those of a flow for `omega` [rad/s] and one step.

    `fill_columns` computes those for more steps when they are needed.
    """

    def __init__(self, matrices: Matrices, options: FlowOptions = TIME.flows) -> None:
        FlowSeries.__init__(self, matrices, options)
        self.whole = np.zeros(self.linear)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def refresh(self, slot: cython.Py_ssize_t) -> cython.int:
        """Computes the columns of the forces for the present frequency, unless they are computed."""
        self.clock += 1
        self.used[slot] = self.clock
        if self.made_for[slot] == self.omega:
            return 0
        self._one_step(slot)
        self._sized(slot)
        self.reached[slot] = 0
        self.fill_columns(slot, 0)
        self.made_for[slot] = self.omega
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _one_step(self, slot: cython.Py_ssize_t) -> cython.void:
        """Response over one step to sin(h theta) = 1 or cos(h theta) = 1 alone, and its derivative by omega.

        The j-th time derivative of the forces grows as (h omega)**j; its effect is stored with the flow.
        """
        h: cython.Py_ssize_t
        self.forced[slot, 0, :, :] = 0.0
        for h in range(self.waves):
            self._sum_terms(slot, h)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sum_terms(self, slot: cython.Py_ssize_t, h: cython.Py_ssize_t) -> cython.void:
        """Adds the one-step response to one harmonic, up to negligible terms."""
        j: cython.int
        step: cython.double = self.harmonic[h] * self.step[slot]
        x: cython.double = self.omega * step
        size: cython.double = 1.0
        power: cython.double = 1.0
        before: cython.double = 0.0
        for j in range(SERIES_ORDER):
            self._add_term(slot, h, j, power, j * before * step)
            size *= x / (j + 1)
            if size < self.negligible_power * x:
                return
            before = power
            power *= -x if j % 2 else x
            if j % 2:
                before = -before

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _add_term(
        self,
        slot: cython.Py_ssize_t,
        h: cython.Py_ssize_t,
        j: cython.int,
        power: cython.double,
        slope: cython.double,
    ) -> cython.void:
        """Adds `power` times the effect of the forces' j-th derivative, and its derivative by omega.

        `slope` is the derivative of `power` by omega.
        """
        i: cython.Py_ssize_t
        b: cython.Py_ssize_t = 4 * h
        square: cython.double = self.omega * self.omega
        rate: cython.double = 2.0 * self.omega * power
        first: cython.double
        other: cython.double
        grade: cython.double
        new: cython.double[:, ::1] = self.forced[slot, 0]
        for i in range(self.linear):
            first = self.pushed[slot, b, j, i] + square * self.pushed[slot, b + 2, j, i]
            other = self.pushed[slot, b + 1, j, i] + square * self.pushed[slot, b + 3, j, i]
            grade = slope * first + rate * self.pushed[slot, b + 2, j, i]
            new[b + j % 2, i] += power * first
            new[b + 2 + j % 2, i] += grade
            grade = slope * other + rate * self.pushed[slot, b + 3, j, i]
            if j % 2:
                new[b, i] -= power * other
                new[b + 2, i] -= grade
            else:
                new[b + 1, i] += power * other
                new[b + 3, i] += grade

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sized(self, slot: cython.Py_ssize_t) -> cython.void:
        """Sets the sizes of the first two terms of the one-step response."""
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        x: cython.double
        square: cython.double = self.omega * self.omega
        sine: cython.double
        cosine: cython.double
        for h in range(self.waves):
            b, x = 4 * h, self.harmonic[h] * self.omega * self.step[slot]
            for i in range(self.linear):
                sine = self.push[slot, 0, b, i] + square * self.push[slot, 0, b + 2, i]
                cosine = self.push[slot, 0, b + 1, i] + square * self.push[slot, 0, b + 3, i]
                self.sizes_forced[slot, 2 * h, i] = fabs(sine) + 0.5 * fabs(
                    self.push[slot, 1, b, i] + square * self.push[slot, 1, b + 2, i] - x * cosine
                )
                self.sizes_forced[slot, 2 * h + 1, i] = fabs(cosine) + 0.5 * fabs(
                    self.push[slot, 1, b + 1, i] + square * self.push[slot, 1, b + 3, i] + x * sine
                )

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def fill_columns(self, slot: cython.Py_ssize_t, last: cython.Py_ssize_t) -> cython.int:
        """Computes the missing columns of the forces over 1, 2, 4 ... 2**last steps."""
        t: cython.double
        h: cython.Py_ssize_t
        while self.reached[slot] <= last:
            if self.reached[slot] > 0:
                self._double(slot, self.reached[slot] - 1)
            if self.squared[slot] < self.reached[slot]:
                with cython.gil:
                    self.next_power(slot)
            for h in range(self.waves):
                t = self.harmonic[h] * self.omega * self.step[slot] * (1 << self.reached[slot])
                self.rotation[slot, self.reached[slot], 2 * h] = cos(t)
                self.rotation[slot, self.reached[slot], 2 * h + 1] = sin(t)
            self.reached[slot] += 1
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _double(self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.void:
        """Columns over twice as many steps: C(2 t) = E C + C R, with the rotation R of the forces."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        t: cython.double
        c: cython.double
        s: cython.double
        old: cython.double[:, ::1] = self.forced[slot, j]
        new: cython.double[:, ::1] = self.forced[slot, j + 1]
        for h in range(self.waves):
            b, t = 4 * h, self.harmonic[h] * self.step[slot] * (1 << j)
            c, s = self.rotation[slot, j, 2 * h], self.rotation[slot, j, 2 * h + 1]
            for i in range(n):
                new[b, i] = c * old[b, i] - s * old[b + 1, i]
                new[b + 1, i] = s * old[b, i] + c * old[b + 1, i]
                new[b + 2, i] = c * old[b + 2, i] - s * old[b + 3, i] - t * new[b + 1, i]
                new[b + 3, i] = s * old[b + 2, i] + c * old[b + 3, i] + t * new[b, i]
        for b in range(4 * self.waves):
            for i in range(n):
                self.whole[i] = new[b, i]
            self.free(slot, j, old, b)
            for i in range(n):
                new[b, i] = self.whole[i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def free(
        self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.void:
        """Adds to `whole` the result of 2**j steps without forces from row k of y."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t = 0
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        while p + 4 <= n:  # four together, to pass through the sums less often
            a, b, c, d = y[k, p], y[k, p + 1], y[k, p + 2], y[k, p + 3]
            for i in range(n):
                self.whole[i] = (
                    ((self.whole[i] + self.power[slot, j, p, i] * a) + self.power[slot, j, p + 1, i] * b)
                    + self.power[slot, j, p + 2, i] * c
                ) + self.power[slot, j, p + 3, i] * d
            p += 4
        while p < n:
            a = y[k, p]
            for i in range(n):
                self.whole[i] += self.power[slot, j, p, i] * a
            p += 1


@cython.cclass
class ExitFunctions(ForcedFlows):
    """Exits of flows; `watch` evaluates them on the steps of a block, `leave` their series in a step.

    `make_columns` and `expand` compute the columns for a new frequency when they are needed.
    """

    def __init__(self, matrices: Matrices, options: FlowOptions = TIME.flows) -> None:
        ForcedFlows.__init__(self, matrices, options)
        self._rotated = np.zeros((self.waves, ORDER))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def refresh(self, slot: cython.Py_ssize_t) -> cython.int:
        """Computes the columns of the forces for the frequency, and the leading terms of the exits."""
        e: cython.Py_ssize_t
        exits: cython.Py_ssize_t = self.exits[slot]
        b: cython.int
        w: cython.Py_ssize_t
        made: cython.bint = self.made_for[slot] == self.omega
        ForcedFlows.refresh(self, slot)
        if made:
            return 0
        self._angles(slot)
        for e in range(exits):
            w = e * (SERIES_ORDER + 1)
            self.spread[slot, e] = 0
            self._of_exit(slot, e, 1)
            self._of_exit(slot, e, 2)
            self._of_exit(slot, e, 4)
            for b in range(2 * self.waves):
                self.series_forced[slot, b, w] = self.table_forced[slot, b, e] = 0.0
                self.table_forced[slot, b, exits + e] = self.series_forced[slot, b, w + 1]
                self.table_forced[slot, b, 2 * exits + e] = 24.0 * self.series_forced[slot, b, w + 4]
        self.watched[slot] = 0
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _angles(self, slot: cython.Py_ssize_t) -> cython.void:
        """Computes powers of each harmonic's angle of a step, signed as the derivatives of sin at 0."""
        h: cython.Py_ssize_t
        j: cython.int
        power: cython.double
        x: cython.double
        for h in range(self.waves):
            power, x = 1.0, self.harmonic[h] * self.omega * self.step[slot]
            for j in range(SERIES_ORDER):
                self._rotated[h, j] = power
                power *= -x if j % 2 else x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _of_exit(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t, a: cython.int) -> cython.void:
        """Computes Taylor coefficient a > 0 of an exit in a step, the part by the forces."""
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        k: cython.int
        j: cython.int
        square: cython.double = self.omega * self.omega
        first: cython.double
        other: cython.double
        sine: cython.double
        cosine: cython.double
        total: cython.double = 1.0
        for k in range(a):
            total *= k + 1
        for h in range(self.waves):
            b, sine, cosine = 4 * h, 0.0, 0.0
            for k in range(a):
                j = a - 1 - k
                first = self.kick[slot, e, b, k] + square * self.kick[slot, e, b + 2, k]
                other = self.kick[slot, e, b + 1, k] + square * self.kick[slot, e, b + 3, k]
                first, other = self._rotated[h, j] * first, self._rotated[h, j] * other
                if j % 2:
                    sine, cosine = sine - other, cosine + first
                else:
                    sine, cosine = sine + first, cosine + other
            self.series_forced[slot, 2 * h, e * (SERIES_ORDER + 1) + a] = sine / total
            self.series_forced[slot, 2 * h + 1, e * (SERIES_ORDER + 1) + a] = cosine / total

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def expand(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t) -> cython.void:
        """Computes all Taylor coefficients of an exit by the forces, unless they are computed already."""
        a: cython.int
        if self.spread[slot, e]:
            return
        self._angles(slot)
        for a in range(1, SERIES_ORDER + 1):
            self._of_exit(slot, e, a)
        self.spread[slot, e] = 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def make_columns(self, slot: cython.Py_ssize_t, steps: cython.Py_ssize_t) -> cython.void:
        """Computes the missing columns of the table of exits up to a number of steps.

        The table T satisfies T[k + 1] = T[k] exp(A h).
        """
        g: cython.Py_ssize_t = 3 * self.exits[slot]
        begin: cython.Py_ssize_t = self.watched[slot] * g
        end: cython.Py_ssize_t = steps * g
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        b: cython.Py_ssize_t
        x: cython.double
        c: cython.double
        s: cython.double
        if begin >= end:
            return
        for b in range(2 * self.waves):
            for w in range(begin + g, end + g):
                self.table_forced[slot, b, w] = 0.0
            for i in range(self.linear):
                x = self.forced[slot, 0, b + b // 2 * 2, i]  # the first two of the four rows of a harmonic
                for w in range(begin, end):
                    self.table_forced[slot, b, w + g] += self.table[slot, i, w] * x
        for b in range(0, 2 * self.waves, 2):
            c, s = self.rotation[slot, 0, b], self.rotation[slot, 0, b + 1]
            for w in range(begin, end):
                self.table_forced[slot, b, w + g] += (
                    c * self.table_forced[slot, b, w] - s * self.table_forced[slot, b + 1, w]
                )
                self.table_forced[slot, b + 1, w + g] += (
                    s * self.table_forced[slot, b, w] + c * self.table_forced[slot, b + 1, w]
                )
        self.watched[slot] = steps

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def watch(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        steps: cython.Py_ssize_t,
        seen: cython.double[::1],
    ) -> cython.void:
        """Evaluates g, g' h and g'''' h**4 of the exits at 0 to `steps` <= BLOCK steps from row k of y."""
        wide: cython.Py_ssize_t = (steps + 1) * 3 * self.exits[slot]
        n: cython.Py_ssize_t = self.linear
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t = 0
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        h: cython.Py_ssize_t
        self.make_columns(slot, steps)
        for w in range(wide):
            seen[w] = 0.0
        for h in range(0, 2 * self.waves, 2):
            a, b = y[k, n + h], y[k, n + h + 1]
            for w in range(wide):
                seen[w] += self.table_forced[slot, h, w] * a + self.table_forced[slot, h + 1, w] * b
        while i + 4 <= n:
            a, b, c, d = y[k, i], y[k, i + 1], y[k, i + 2], y[k, i + 3]
            for w in range(wide):
                seen[w] = (
                    ((seen[w] + self.table[slot, i, w] * a) + self.table[slot, i + 1, w] * b)
                    + self.table[slot, i + 2, w] * c
                ) + self.table[slot, i + 3, w] * d
            i += 4
        while i < n:
            a = y[k, i]
            for w in range(wide):
                seen[w] += self.table[slot, i, w] * a
            i += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def leave(
        self,
        slot: cython.Py_ssize_t,
        e: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        powers: cython.double[:, ::1],
    ) -> cython.void:
        """Computes Taylor coefficients of exit e in the step from row k of y, into row e of powers."""
        n: cython.Py_ssize_t = self.linear
        w: cython.Py_ssize_t = e * (SERIES_ORDER + 1)
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        j: cython.int
        x: cython.double
        other: cython.double
        self.expand(slot, e)
        for j in range(SERIES_ORDER + 1):
            powers[e, j] = 0.0
        for h in range(0, 2 * self.waves, 2):
            x, other = y[k, n + h], y[k, n + h + 1]
            for j in range(SERIES_ORDER + 1):
                powers[e, j] += (
                    self.series_forced[slot, h, w + j] * x + self.series_forced[slot, h + 1, w + j] * other
                )
        for i in range(n):
            x = y[k, i]
            if x != 0.0:
                for j in range(SERIES_ORDER + 1):
                    powers[e, j] += self.series[slot, i, w + j] * x


_SERIES_END = cython.declare(cython.double, 4e-19)  # 1 / 20!; so many terms make a step complete


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def value(powers: cython.double[::1], order: cython.int, x: cython.double) -> cython.double:
    """Value of a polynomial or of one of its first three derivatives at x."""
    j: cython.int
    factor: cython.double
    total: cython.double = 0.0
    for j in range(SERIES_ORDER, order - 1, -1):
        factor = (
            1.0 if order == 0 else j if order == 1 else j * (j - 1) if order == 2 else j * (j - 1) * (j - 2)
        )
        total = total * x + factor * powers[j]
    return total


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def root(
    powers: cython.double[::1], order: cython.int, low: cython.double, high: cython.double
) -> cython.double:
    """Root of a derivative with different signs at low and high, by bracketed Newton steps."""
    sense: cython.double = value(powers, order, low)
    x: cython.double = 0.5 * (low + high)
    height: cython.double
    slope: cython.double
    new: cython.double
    for _ in range(60):
        height, slope = value(powers, order, x), value(powers, order + 1, x)
        if height == 0.0:
            return x
        if height * sense > 0.0:
            low = x
        else:
            high = x
        new = x - height / slope if slope != 0.0 else low
        if not low < new < high:
            new = 0.5 * (low + high)
        if fabs(new - x) <= 1e-15:
            return new
        x = new
    return x


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def needed(x: cython.double) -> cython.int:
    """Number of terms after the first that a fraction x of a step needs, to rounding."""
    j: cython.int = 0
    size: cython.double = 1.0
    while size > _SERIES_END and j < SERIES_ORDER:
        j += 1
        size *= x / j
    return j


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def summed(
    terms: cython.double[:, ::1], x: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
) -> cython.void:
    """Sets row k of y to the sum of terms[j] x**j."""
    i: cython.Py_ssize_t
    j: cython.int
    n: cython.Py_ssize_t = terms.shape[1]
    for i in range(n):
        y[k, i] = terms[SERIES_ORDER, i]
    for j in range(SERIES_ORDER - 1, -1, -1):
        for i in range(n):
            y[k, i] = y[k, i] * x + terms[j, i]


@cython.cclass
class Flows(ExitFunctions):
    """The flows of a scene with their force columns at the frequency `omega` [rad/s]; see `FlowArrays`."""

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def advance(
        self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.int:
        """Advances row k of y by 2**j steps."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        sine: cython.double
        cosine: cython.double
        c: cython.double
        s: cython.double
        self.fill_columns(slot, j)
        for i in range(n):
            self.whole[i] = 0.0
        for h in range(self.waves):
            b, sine, cosine = 4 * h, y[k, n + 2 * h], y[k, n + 2 * h + 1]
            for i in range(n):
                self.whole[i] += self.forced[slot, j, b, i] * sine + self.forced[slot, j, b + 1, i] * cosine
        self.free(slot, j, y, k)
        for i in range(n):
            y[k, i] = self.whole[i]
        for b in range(0, 2 * self.waves, 2):
            sine, cosine = y[k, n + b], y[k, n + b + 1]
            c, s = self.rotation[slot, j, b], self.rotation[slot, j, b + 1]
            y[k, n + b], y[k, n + b + 1] = c * sine + s * cosine, c * cosine - s * sine
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def carry(
        self, slot: cython.Py_ssize_t, position: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.int:
        """Advances row k of y by any number of steps."""
        whole: cython.longlong = cython.cast(cython.longlong, position)
        x: cython.double = position - whole
        j: cython.int
        while whole >> FLOW_POWERS:
            self.advance(slot, FLOW_POWERS - 1, y, k)
            whole -= 1 << (FLOW_POWERS - 1)
        for j in range(FLOW_POWERS):
            if whole >> j & 1:
                self.advance(slot, j, y, k)
        self.part(slot, x, y, k, k + 1)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def bound(
        self, slot: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t, out: cython.double[::1]
    ) -> cython.void:
        """Computes the sizes of the terms that add up to each component of row k of y over a step."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        b: cython.Py_ssize_t
        x: cython.double
        other: cython.double
        for i in range(n):
            out[i] = 0.0
        for b in range(0, 2 * self.waves, 2):
            x, other = fabs(y[k, n + b]), fabs(y[k, n + b + 1])
            for i in range(n):
                out[i] += self.sizes_forced[slot, b, i] * x + self.sizes_forced[slot, b + 1, i] * other
            out[n + b] = out[n + b + 1] = 2.5  # 1 + x + x**2 / 2, with x <= 1 the angle of a step
        for p in range(n):
            x = fabs(y[k, p])
            for i in range(n):
                out[i] += self.sizes[slot, p, i] * x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def taylor(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        terms: cython.double[:, ::1],
    ) -> cython.void:
        """Computes Taylor coefficients (ORDER + 1, d) of the motion in the step from row k of y."""
        i: cython.Py_ssize_t
        for i in range(self.size):
            terms[0, i] = y[k, i]
        self.extend(slot, terms, SERIES_ORDER, self.step[slot], terms, False)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def part(
        self,
        slot: cython.Py_ssize_t,
        x: cython.double,
        y: cython.double[:, ::1],
        first: cython.Py_ssize_t,
        last: cython.Py_ssize_t,
    ) -> cython.void:
        """Advances rows first to last - 1 of y by a fraction x of a step."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        orders: cython.Py_ssize_t = needed(x)
        for k in range(first, last):
            for i in range(self.size):
                self._own[0, i] = y[k, i]
            self.extend(slot, self._own, orders, x * self.step[slot], self._own, False)
            for j in range(orders - 1, -1, -1):
                for i in range(self.size):
                    self._own[j, i] += self._own[j + 1, i]
            for i in range(self.size):
                y[k, i] = self._own[0, i]
