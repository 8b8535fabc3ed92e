"""The exact motion in each combination of contact states, as a pool of flows that serves all frequencies.

The state vector is

    y = (q, q', f, n, 1, sin(theta), cos(theta)),    d = 2 modes + 2 contacts + 3 numbers,

with the modal displacements and velocities q, q', the friction forces f, the changes n = k_v v of the normal
loads from their preloads, and the phase angle theta = omega t of the forces. Then y' = A y in every
combination of states, forcing and preload included. The forces of the contacts are states of their own:
k_u (u - w) of a stiff contact, computed from displacements, would lose as many digits as it is stiffer than
the structure.

Over a step h = 1 / rate the series of exp(A h) is complete to rounding after `ORDER` terms, whatever A is:
defective, singular, resonant without damping. Whole steps are powers of exp(A h). The functions that end a
combination are known on `BLOCK` steps at once from a table of their rows times those powers. The frequency
enters only the two columns of the forces: everything else of a flow is made once for a scene.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.scene.model import FloatArray

ORDER = 19  # 1 / 20! is below rounding
POWERS = 8  # of exp(A h): 1, 2, 4 ... 128 steps
BLOCK = 16  # steps that are looked at together: a power of two
LEADING = 8  # derivatives of an exit that may tell which combination follows
WATCHED = 3  # g, g' h and g'''' h**4 of each exit
OPEN, STICK, POSITIVE, NEGATIVE = 0, 1, 2, 3
_ORDER = cython.declare(cython.int, 19)
_POWERS = cython.declare(cython.int, 8)
_BLOCK = cython.declare(cython.int, 16)
_LEADING = cython.declare(cython.int, 8)
_OPEN = cython.declare(cython.int, 0)
_STICK = cython.declare(cython.int, 1)
_POSITIVE = cython.declare(cython.int, 2)
_NEGATIVE = cython.declare(cython.int, 3)


@cython.cclass
class Flows:
    """The flows of a scene, and their forced columns at the frequency `omega` [rad/s].

    Parameters
    ----------
    modal : tuple of arrays
        Squares of the modes' frequencies, 2 zeta omega_0, and the forces of sin and cos by mass (2, mode).
    ports : tuple of arrays (contact, mode)
        Shapes of u and of v, and the same divided by the modal masses.
    law : array (5, contact)
        mu, k_u, k_v, n_0, and whether the contact can exert friction at all.
    """

    def __init__(self, modal: tuple[FloatArray, ...], ports: tuple[FloatArray, ...], law: FloatArray) -> None:
        self.stiffness, self.damping, self.drive = (np.ascontiguousarray(x, dtype=np.float64) for x in modal)
        self.tangential, self.normal, self.push_u, self.push_v = (
            np.ascontiguousarray(x, dtype=np.float64) for x in ports
        )
        self.mu, self.k_u, self.k_v, self.n_0 = (np.ascontiguousarray(x, dtype=np.float64) for x in law[:4])
        self.rough = np.ascontiguousarray(law[4], dtype=np.int8)
        self.modes, self.contacts = self.stiffness.shape[0], self.mu.shape[0]
        self.linear = 2 * self.modes + 2 * self.contacts + 1
        self.size = self.linear + 2
        self.omega = 0.0
        self._terms, self._rates = np.zeros((ORDER + 1, self.size)), np.zeros((2, self.size))
        self._grades, self._exits = np.zeros((2, self.size)), np.zeros((ORDER + 1, 2 * self.contacts + 1))
        self._whole = np.zeros(self.size)
        self._pool: dict[str, Any] = {}
        self.clear()

    def clear(self) -> None:
        """Forget all flows."""
        self.count = 0
        self._grow(4)

    def bytes(self) -> int:
        """Memory of the pool."""
        return sum(made.nbytes for made in self._pool.values())

    def at(self, omega: float) -> None:
        """Set the frequency [rad/s]."""
        self.omega = omega

    def slot(self, states: Any) -> int:
        """The place of a combination of states, -1 if it is not made yet."""
        return int(self.find(np.ascontiguousarray(states, dtype=np.int8).reshape(1, -1), 0))

    def add(
        self,
        states: Any,
        step: float,
        rows: FloatArray,
        owner: list[int],
        goal: list[int],
        powers: FloatArray,
        rounding: FloatArray,
        sizes: FloatArray,
        table: FloatArray,
    ) -> int:
        """Put a flow into the pool: see `fcm.motion.combination`; returns its place."""
        if self.count == self.capacity:
            self._grow(2 * self.capacity)
        k, exits = self.count, len(owner)
        np.asarray(self.states)[k], self.step[k], self.exits[k] = states, step, exits
        self.made_for[k] = -1.0
        np.asarray(self.owner)[k, :exits], np.asarray(self.goal)[k, :exits] = owner, goal
        np.asarray(self.row)[k, :exits], np.asarray(self.power)[k] = rows, powers
        np.asarray(self.rounding)[k, :, :exits], np.asarray(self.sizes)[k] = rounding, sizes
        np.asarray(self.table)[k, :, : table.shape[1]] = table
        self.count += 1
        return k

    def _grow(self, capacity: int) -> None:
        """Room for more flows."""
        n, c, e = self.linear, self.contacts, max(2 * self.contacts, 1)
        wide = (BLOCK + 1) * WATCHED * e
        shapes = {
            "states": (c,), "step": (), "exits": (), "owner": (e,), "goal": (e,), "made_for": (),
            "row": (e, n),
            "power": (POWERS, n, n), "forced": (POWERS, 4, n), "turn": (POWERS, 2),
            "table": (n, wide), "table_forced": (2, wide), "sizes": (n, n), "sizes_forced": (2, n),
            "rounding": (LEADING, e, n), "rounding_forced": (LEADING, e, 2),
        }  # fmt: skip
        kinds = {"states": np.int8, "goal": np.int8, "exits": np.intp, "owner": np.intp}
        old, self._pool = self._pool, {}
        for name, shape in shapes.items():
            self._pool[name] = np.zeros((capacity, *shape), kinds.get(name, np.float64))
            if self.count:
                self._pool[name][: self.count] = old[name][: self.count]
        made = self._pool
        self.states, self.step, self.exits = made["states"], made["step"], made["exits"]
        self.owner, self.goal, self.row = made["owner"], made["goal"], made["row"]
        self.made_for, self.power, self.forced = made["made_for"], made["power"], made["forced"]
        self.turn, self.table, self.table_forced = made["turn"], made["table"], made["table_forced"]
        self.sizes, self.sizes_forced = made["sizes"], made["sizes_forced"]
        self.rounding, self.rounding_forced = made["rounding"], made["rounding_forced"]
        self.capacity = capacity

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def find(self, states: cython.schar[:, ::1], k: cython.Py_ssize_t) -> cython.Py_ssize_t:
        """The flow of the states in row k whose steps resolve the frequency too, -1 if there is none."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(self.count):
            if self.omega * self.step[i] > 1.0 + 1e-12:
                continue
            j = 0
            while j < self.contacts and self.states[i, j] == states[k, j]:
                j += 1
            if j == self.contacts:
                return i
        return -1

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
        factor: cython.double,
    ) -> cython.void:
        """Row b of z becomes factor A y, y being row a."""
        m: cython.Py_ssize_t = self.modes
        c: cython.Py_ssize_t = self.contacts
        last: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        state: cython.int
        f: cython.double
        n: cython.double
        u: cython.double
        v: cython.double
        sine: cython.double = y[a, last]
        cosine: cython.double = y[a, last + 1]
        for i in range(m):
            z[b, i] = factor * y[a, m + i]
            z[b, m + i] = (
                self.drive[0, i] * sine + self.drive[1, i] * cosine
                - self.stiffness[i] * y[a, i] - self.damping[i] * y[a, m + i]
            )  # fmt: skip
        for j in range(c):
            state = self.states[slot, j]
            u = v = 0.0
            for i in range(m):
                u += self.tangential[j, i] * y[a, m + i]
                v += self.normal[j, i] * y[a, m + i]
            v *= self.k_v[j]
            f, n = y[a, 2 * m + j], y[a, 2 * m + c + j]
            if state == _OPEN:  # the preload is missing
                f, n = 0.0, -max(self.n_0[j], 0.0) * y[a, last - 1]
                u = 0.0
            else:  # a gap is not pressed
                n += min(self.n_0[j], 0.0) * y[a, last - 1]
                if state == _STICK:
                    u = self.k_u[j] * u if self.rough[j] else 0.0
                else:
                    u = self.mu[j] * v if state == _POSITIVE else -self.mu[j] * v
            for i in range(m):
                z[b, m + i] -= self.push_u[j, i] * f + self.push_v[j, i] * n
            z[b, 2 * m + j] = factor * u
            z[b, 2 * m + c + j] = factor * v
        for i in range(m):
            z[b, m + i] *= factor
        z[b, last - 1] = 0.0
        z[b, last] = factor * self.omega * cosine
        z[b, last + 1] = -factor * self.omega * sine

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
        """Taylor coefficients of the motion from row k of y, by the position in a step: (ORDER + 1, d)."""
        i: cython.Py_ssize_t
        for i in range(self.size):
            terms[0, i] = y[k, i]
        self.extend(slot, terms, 0, _ORDER)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def part(
        self, slot: cython.Py_ssize_t, x: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.void:
        """Move row k of y by a part x of a step."""
        i: cython.Py_ssize_t
        j: cython.int = 0
        size: cython.double = 1.0
        a: cython.Py_ssize_t = 0
        for i in range(self.size):
            self._rates[0, i] = y[k, i]
        while size > 4e-19:  # 1 / 20!, as many terms as make a step complete
            j += 1
            size *= x / j
            self.derive(slot, self._rates, a, self._rates, 1 - a, x * self.step[slot] / j)
            a = 1 - a
            for i in range(self.size):
                y[k, i] += self._rates[a, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def extend(
        self, slot: cython.Py_ssize_t, terms: cython.double[:, ::1], known: cython.int, last: cython.int
    ) -> cython.void:
        """Taylor coefficients from those that are known up to an order to the last one."""
        j: cython.int
        for j in range(known, last):
            self.derive(slot, terms, j, terms, j + 1, self.step[slot] / (j + 1))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def advance(
        self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.void:
        """Move row k of y by 2**j steps."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        x: cython.double
        sine: cython.double = y[k, n]
        cosine: cython.double = y[k, n + 1]
        for i in range(n):
            self._whole[i] = self.forced[slot, j, 0, i] * sine + self.forced[slot, j, 1, i] * cosine
        for p in range(n):
            x = y[k, p]
            if x != 0.0:
                for i in range(n):
                    self._whole[i] += self.power[slot, j, p, i] * x
        for i in range(n):
            y[k, i] = self._whole[i]
        y[k, n] = self.turn[slot, j, 0] * sine + self.turn[slot, j, 1] * cosine
        y[k, n + 1] = self.turn[slot, j, 0] * cosine - self.turn[slot, j, 1] * sine

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def leave(
        self,
        slot: cython.Py_ssize_t,
        terms: cython.double[:, ::1],
        first: cython.int,
        last: cython.int,
        exits: cython.double[:, ::1],
    ) -> cython.void:
        """Taylor coefficients of the exits, (ORDER + 1, exit), from those of the state, of some orders."""
        m: cython.Py_ssize_t = self.modes
        e: cython.Py_ssize_t
        i: cython.Py_ssize_t
        f: cython.Py_ssize_t
        n: cython.Py_ssize_t
        j: cython.int
        g: cython.double
        for e in range(self.exits[slot]):
            f = 2 * m + self.owner[slot, e]
            n = f + self.contacts
            for j in range(first, last + 1):
                if self.goal[slot, e] == _STICK and self.states[slot, self.owner[slot, e]] != _OPEN:
                    g = 0.0  # the end of a slip: its velocity
                    for i in range(m, 2 * m):
                        g += self.row[slot, e, i] * terms[j, i]
                else:
                    g = self.row[slot, e, f] * terms[j, f] + self.row[slot, e, n] * terms[j, n]
                    g += self.row[slot, e, self.linear - 1] * terms[j, self.linear - 1]
                exits[j, e] = g

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def watch(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        seen: cython.double[::1],
    ) -> cython.void:
        """g, g' h and g'''' h**4 of the exits at 0 to BLOCK steps from row k of y."""
        wide: cython.Py_ssize_t = (_BLOCK + 1) * 3 * self.exits[slot]
        n: cython.Py_ssize_t = self.linear
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        x: cython.double = y[k, n]
        other: cython.double = y[k, n + 1]
        for w in range(wide):
            seen[w] = self.table_forced[slot, 0, w] * x + self.table_forced[slot, 1, w] * other
        for i in range(n):
            x = y[k, i]
            for w in range(wide):
                seen[w] += self.table[slot, i, w] * x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def bound(
        self, slot: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t, out: cython.double[::1]
    ) -> cython.void:
        """The size of the terms from which each component of row k of y is summed over a step."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        x: cython.double = fabs(y[k, n])
        other: cython.double = fabs(y[k, n + 1])
        for i in range(n):
            out[i] = self.sizes_forced[slot, 0, i] * x + self.sizes_forced[slot, 1, i] * other
        for p in range(n):
            x = fabs(y[k, p])
            for i in range(n):
                out[i] += self.sizes[slot, p, i] * x
        out[n] = out[n + 1] = 2.5  # of 1 + x + x**2 / 2, x <= 1 the angle of a step

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def refresh(self, slot: cython.Py_ssize_t) -> cython.void:
        """Make the columns of the forces for the frequency, unless they are."""
        if self.made_for[slot] == self.omega:
            return
        b: cython.Py_ssize_t
        for b in range(2):
            self._unit(slot, b)
        self._double(slot)
        self._look(slot)
        self.made_for[slot] = self.omega

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _unit(self, slot: cython.Py_ssize_t, b: cython.Py_ssize_t) -> cython.void:
        """One step from sin(theta) = 1 (b = 0) or cos(theta) = 1 alone, and its derivative by omega."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        j: cython.int
        e: cython.Py_ssize_t
        h: cython.double = self.step[slot]
        for i in range(self.size):
            self._rates[0, i] = self._grades[0, i] = 0.0
        self._rates[0, n + b] = 1.0
        self.taylor(slot, self._rates, 0, self._terms)
        self.leave(slot, self._terms, 0, _ORDER, self._exits)
        for i in range(n):
            self.forced[slot, 0, b, i] = self.forced[slot, 0, 2 + b, i] = 0.0
            self.sizes_forced[slot, b, i] = fabs(self._terms[1, i]) + fabs(self._terms[2, i])
        for j in range(_ORDER):
            self.derive(slot, self._grades, 0, self._grades, 1, h / (j + 1))
            self._grades[1, n] += h / (j + 1) * self._terms[j, n + 1]
            self._grades[1, n + 1] -= h / (j + 1) * self._terms[j, n]
            for i in range(self.size):
                self._grades[0, i] = self._grades[1, i]
            for i in range(n):
                self.forced[slot, 0, b, i] += self._terms[j + 1, i]
                self.forced[slot, 0, 2 + b, i] += self._grades[1, i]
        for e in range(self.exits[slot]):
            self.table_forced[slot, b, e] = self._exits[0, e]
            self.table_forced[slot, b, self.exits[slot] + e] = self._exits[1, e]
            self.table_forced[slot, b, 2 * self.exits[slot] + e] = 24.0 * self._exits[4, e]
            for j in range(_LEADING):
                self.rounding_forced[slot, j, e, b] = fabs(self._exits[j, e])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _double(self, slot: cython.Py_ssize_t) -> cython.void:
        """The columns over 1, 2, 4 ... steps: C(2 t) = E C + C R, with the rotation R of the forces."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        j: cython.int
        b: cython.int
        x: cython.double
        t: cython.double = self.step[slot]
        s: cython.double
        c: cython.double
        for j in range(_POWERS):
            c, s = cos(self.omega * t), sin(self.omega * t)
            self.turn[slot, j, 0], self.turn[slot, j, 1] = c, s
            if j + 1 == _POWERS:
                return
            for i in range(n):
                self.forced[slot, j + 1, 0, i] = (
                    c * self.forced[slot, j, 0, i] - s * self.forced[slot, j, 1, i]
                )
                self.forced[slot, j + 1, 1, i] = (
                    s * self.forced[slot, j, 0, i] + c * self.forced[slot, j, 1, i]
                )
                self.forced[slot, j + 1, 2, i] = (
                    c * self.forced[slot, j, 2, i]
                    - s * self.forced[slot, j, 3, i]
                    - t * (s * self.forced[slot, j, 0, i] + c * self.forced[slot, j, 1, i])
                )
                self.forced[slot, j + 1, 3, i] = (
                    s * self.forced[slot, j, 2, i]
                    + c * self.forced[slot, j, 3, i]
                    + t * (c * self.forced[slot, j, 0, i] - s * self.forced[slot, j, 1, i])
                )
            for b in range(4):
                for p in range(n):
                    x = self.forced[slot, j, b, p]
                    for i in range(n):
                        self.forced[slot, j + 1, b, i] += self.power[slot, j, p, i] * x
            t *= 2.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _look(self, slot: cython.Py_ssize_t) -> cython.void:
        """The columns of the table of exits: T[k + 1] = T[k] exp(A h)."""
        g: cython.Py_ssize_t = 3 * self.exits[slot]
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        b: cython.int
        x: cython.double
        c: cython.double = self.turn[slot, 0, 0]
        s: cython.double = self.turn[slot, 0, 1]
        for b in range(2):
            for w in range(g, (_BLOCK + 1) * g):
                self.table_forced[slot, b, w] = 0.0
            for i in range(self.linear):
                x = self.forced[slot, 0, b, i]
                for w in range(_BLOCK * g):
                    self.table_forced[slot, b, w + g] += self.table[slot, i, w] * x
        for w in range(_BLOCK * g):
            self.table_forced[slot, 0, w + g] += (
                c * self.table_forced[slot, 0, w] - s * self.table_forced[slot, 1, w]
            )
            self.table_forced[slot, 1, w + g] += (
                s * self.table_forced[slot, 0, w] + c * self.table_forced[slot, 1, w]
            )


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def summed(
    terms: cython.double[:, ::1], x: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
) -> cython.void:
    """Row k of y becomes the sum of terms[j] x**j."""
    i: cython.Py_ssize_t
    j: cython.int
    n: cython.Py_ssize_t = terms.shape[1]
    for i in range(n):
        y[k, i] = terms[_ORDER, i]
    for j in range(_ORDER - 1, -1, -1):
        for i in range(n):
            y[k, i] = y[k, i] * x + terms[j, i]
