"""The segments of a motion: what happens between two transitions; and the arrays of the flows they follow.

`Pool` is the pool of flows of a scene, the arrays of all combinations of contact states that have been met.
"""

from __future__ import annotations

from math import factorial
from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.model.scene import FloatArray
from fcm.time_domain.equations import Matrices
from fcm.time_domain.options import TIME, FlowOptions

ORDER = 19  # of the series of exp(A h): 1 / 20! is below rounding
POWERS = 8  # of exp(A h): 1, 2, 4 ... 128 steps
BLOCK = 8  # steps that are looked at together: a power of two
WATCHED = 3  # g, g' h and g'''' h**4 of each exit
SEPARATED, STICKING, POSITIVE_SLIP, NEGATIVE_SLIP = 0, 1, 2, 3  # states of a contact
SMALL = 256  # components up to which the Taylor coefficients of exp(A h x) are kept
FITS = 1.0 + 1e-12  # radians of the forces that a step lasts at most: one, and rounding
_FITS = cython.declare(cython.double, FITS)
# of (A h)**k in what a force that grows as the j-th power of the time does in a step, for k + j < ORDER
PUSHED = np.array(
    [[1.0 / factorial(k + j + 1) if k + j < ORDER else 0.0 for k in range(ORDER)] for j in range(ORDER)]
)


# arrays of the pool that are no floating-point numbers
KINDS = dict.fromkeys(("states", "halved", "goal"), np.int8) | dict.fromkeys(
    ("exits", "owner", "first", "used", "reached", "watched", "spread", "squared", "spelled"), np.intp
)


def _shapes(n: int, contacts: int, waves: int) -> dict[str, tuple[int, ...]]:
    """What the pool keeps of one flow whose state has n components, and forces at so many harmonics."""
    e = max(2 * contacts, 1)  # exits: of a contact two at most
    wide = (BLOCK + 1) * WATCHED * e
    return {
        "states": (contacts,), "step": (), "halved": (), "exits": (), "owner": (e,), "goal": (e,),
        "first": (e,), "made_for": (), "used": (), "squared": (), "spelled": (), "row": (e, n),
        "power": (POWERS, n, n), "forced": (POWERS, 4 * waves, n), "rotation": (POWERS, 2 * waves),
        "reached": (), "watched": (), "terms": (ORDER + 1 if n <= SMALL else 0, n * n), "sizes": (n, n),
        "sizes_forced": (2 * waves, n), "table": (n, wide), "table_forced": (2 * waves, wide),
        "push": (2, 4 * waves, n), "pushed": (4 * waves, ORDER, n), "kick": (e, 4 * waves, ORDER),
        "spread": (e,), "series": (n, e * (ORDER + 1)), "series_forced": (2 * waves, e * (ORDER + 1)),
    }  # fmt: skip


@cython.cclass
class Pool:
    """The flows of a scene; where there is no room for more, the one that was used longest ago goes.

    Of many flows only short pieces are followed, and never their derivatives: the powers of more than a step,
    and the Taylor coefficients, are made where they are needed.
    """

    def __init__(self, matrices: Matrices) -> None:
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
        self.limit(TIME.flows)
        self._pool: dict[str, Any] = {}
        self._make_room(4)

    def at(self, omega: float) -> None:
        """Set the frequency [rad/s]."""
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
        """Memory of the pool."""
        return sum(made.nbytes for made in self._pool.values())

    def add(self, flow: Any) -> int:
        """Put a `fcm.time_domain.contact_states.Flow` into the pool; returns its place."""
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
        """Make the Taylor coefficients (A h)**j / j! of a flow, of which those to j = 1 are there."""
        terms = self._pool["terms"][slot].reshape(ORDER + 1, self.linear, self.linear)
        for j in range(2, ORDER + 1):
            np.matmul(terms[j - 1], terms[1], out=terms[j])
            terms[j] /= j
        self._pool["spelled"][slot] = 1

    def next_power(self, slot: int) -> None:
        """Make the power of a flow over twice as many steps as the last."""
        power, j = self._pool["power"][slot], int(self._pool["squared"][slot])
        np.matmul(power[j], power[j], out=power[j + 1])
        self._pool["squared"][slot] = j + 1

    def limit(self, options: FlowOptions) -> None:
        """Keep so many flows from now on."""
        self.min_count, self.max_bytes = options.min_count, options.max_bytes

    def _place(self) -> int:
        """A place for one more."""
        capacity = self.step.shape[0]
        most = max(int(self.max_bytes / (self.bytes() / capacity)), self.min_count)
        if self.count == capacity < most:
            capacity = min(16 * capacity, most)  # what is not used of it takes no memory
            self._make_room(capacity)
        if self.count == capacity:
            return int(np.argmin(np.asarray(self.used)))
        self.count += 1
        return int(self.count - 1)

    def _make_room(self, capacity: int) -> None:
        """Arrays for so many flows, with those that are there; typed views of them for the kernels."""
        old, made = self._pool, {}
        for name, shape in _shapes(self.linear, self.contacts, self.waves).items():
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
        """The flow of the states in row k, in the steps that they have at the frequency; -1 if there is none.

        Whichever flows there are, these steps are the same: the lengths of segments are counted in them.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        angle: cython.double
        for i in range(self.count):
            angle = self.highest * self.omega * self.step[i]
            if angle > _FITS or (self.halved[i] and 2.0 * angle <= _FITS):
                continue
            j = 0
            while j < self.contacts and self.states[i, j] == states[k, j]:
                j += 1
            if j == self.contacts:
                return i
        return -1


TINY = cython.declare(cython.double, 1e-300)  # instead of a division by zero where nothing moves


@cython.cclass
class Segments:
    """Arrays over segments, of which the first `count` are there.

    A segment begins at the time `start` [s] with the state vector `y` (d,), lasts for `length` steps of the
    flow of its `states` (contact,), and is `ended` by that exit of it, or (-1) by the end of the motion.
    While it lasts, the exits of each contact are no less than `slack` (contact,).
    """

    def __init__(self, size: int, contacts: int, capacity: int = 16) -> None:
        self.count = 0
        self._numbers = np.empty((capacity, size + contacts + 3))
        self.states = np.empty((capacity, contacts), np.int8)
        self._part(size)

    @cython.cfunc
    def _part(self, size: cython.Py_ssize_t) -> cython.void:
        """Name the columns of the numbers, which are one array so that it is soon made."""
        wide: cython.Py_ssize_t = self._numbers.shape[1]
        self.y, self.slack = self._numbers[:, :size], self._numbers[:, size : wide - 3]
        self.start, self.length = self._numbers[:, wide - 3], self._numbers[:, wide - 2]
        self.ended = self._numbers[:, wide - 1]

    def __len__(self) -> int:
        return self.count

    def largest(self) -> FloatArray:
        """The greatest magnitude of each component at the ends of segments: (d,)."""
        greatest = np.zeros(self.y.shape[1])
        out: cython.double[::1] = greatest
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        for k in range(self.count):
            for i in range(self.y.shape[1]):
                out[i] = max(out[i], fabs(self.y[k, i]))
        return greatest

    def scale(
        self,
        per_unit: cython.double[::1],
        flows: Pool,
    ) -> FloatArray:
        """The size of the displacements, velocities and friction forces: (2 modes + contacts,).

        A mode's is the greatest displacement by the one that its shape gives, a contact's the greatest of its
        force and of the smaller of its limit and of the force of that displacement.
        """
        m: cython.Py_ssize_t = flows.modes
        c: cython.Py_ssize_t = flows.contacts
        omega: cython.double = flows.omega
        y: cython.double[::1] = self.largest()
        whole = np.empty(2 * m + c)
        out: cython.double[::1] = whole
        length: cython.double = TINY
        limit: cython.double
        i: cython.Py_ssize_t
        for i in range(m):
            length = max(length, per_unit[i] * max(y[i], y[m + i] / omega))
        for i in range(m):
            out[i] = length / per_unit[i]
            out[m + i] = out[i] * omega
        for i in range(c):
            limit = flows.mu[i] * (fabs(flows.n_0[i]) + y[2 * m + c + i])
            out[2 * m + i] = max(max(y[2 * m + i], min(limit, flows.k_u[i] * length)), TINY)
        return whole

    def length_by(self, rates: cython.double[::1]) -> float:
        """The greatest displacement of any mode, or velocity over the mode's own rate (mode,) [1/s]."""
        m: cython.Py_ssize_t = rates.shape[0]
        y: cython.double[::1] = self.largest()
        length: cython.double = TINY
        i: cython.Py_ssize_t
        for i in range(m):
            length = max(length, max(y[i], y[m + i] / rates[i]))
        return float(length)

    def lasting(self, duration: cython.double, least: cython.double) -> bytes:
        """The states in the segments that last longer than the least [s], of all those of a duration."""
        codes = []
        k: cython.Py_ssize_t
        j: cython.Py_ssize_t
        end: cython.double
        for k in range(self.count):
            end = self.start[k + 1] if k + 1 < self.count else duration
            if end - self.start[k] > least:
                for j in range(self.states.shape[1]):
                    codes.append(int(self.states[k, j]))
        return bytes(codes)

    def held(self, j: int) -> float:
        """A lower bound of the exits of contact j over all segments."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t = j
        least: cython.double = self.slack[0, i]
        for k in range(1, self.count):
            least = min(least, self.slack[k, i])
        return float(least)

    def seen(self) -> list[int]:
        """For each contact the sum of 2**code of the states that it has been in."""
        found: list[int] = []
        seen: cython.int
        k: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for j in range(self.states.shape[1]):
            seen = 0
            for k in range(self.count):
                seen |= 1 << self.states[k, j]
            found.append(seen)
        return found

    def trim(self) -> Segments:
        """These segments without room for more."""
        self._numbers, self.states = self._numbers[: self.count], self.states[: self.count]
        self._part(self.y.shape[1])
        return self

    def room(self, capacity: int) -> Segments:
        """The same segments with room for more."""
        made = Segments(self.y.shape[1], self.states.shape[1], capacity)
        k = made.count = self.count
        np.asarray(made._numbers)[:k], np.asarray(made.states)[:k] = (
            np.asarray(self._numbers)[:k],
            np.asarray(self.states)[:k],
        )
        return made
