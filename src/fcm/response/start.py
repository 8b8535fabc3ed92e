"""A point of each curve at the low end of its range, from which it is traced."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance, Evaluation
from fcm.response.newton import amplitudes, correct, scales
from fcm.response.path import COMPLETE, follow
from fcm.response.structure import BoolArray, IntArray

TRIES = 25  # Newton steps from a linear response
WEAK = (1e-3, 1e-6, 1e-9)  # fractions of the load at which contacts are nearly linear
LOAD_STEP = 0.1


@dataclass
class _UnderLoad:
    """The balanced equations at a fixed frequency, with the load factor as the parameter of the path."""

    balance: Balance
    omega: FloatArray

    def evaluate(self, x: FloatArray, load: FloatArray) -> Evaluation:
        at = self.balance.evaluate(x, self.omega, load)
        return Evaluation(at.residual, at.jacobian, self.balance.by_load(self.omega))

    def take(self, index: IntArray) -> _UnderLoad:
        return _UnderLoad(self.balance.take(index), self.omega[index])


def starting_points(balance: Balance, omega: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Unknowns of each curve at omega (curve,), and whether a solution was found.

    Newton's method from the response with the contacts stuck or open; where that fails, the load is raised
    from a small fraction along its own path, as an experiment would.
    """
    preloaded = np.broadcast_to(balance.group.n_0 > 0.0, (omega.size, balance.group.contacts))
    x = np.zeros((omega.size, 5 * balance.group.contacts))
    found = np.zeros(omega.size, dtype=bool)
    for stuck in (preloaded, np.ones_like(preloaded), np.zeros_like(preloaded)):
        left = np.flatnonzero(~found)
        if left.size:
            x[left], found[left] = _from_linear(balance.take(left), omega[left], stuck[left])
    for weak in WEAK:
        left = np.flatnonzero(~found)
        if left.size:
            x[left], found[left] = _raise_load(balance.take(left), omega[left], preloaded[left], weak)
    return x, found


def linear_starts(balance: Balance, omega: FloatArray) -> Iterator[tuple[FloatArray, BoolArray]]:
    """Solutions at omega that Newton's method finds with all contacts stuck, then with all of them open."""
    shape = (omega.size, balance.group.contacts)
    for stuck in (np.ones(shape, dtype=bool), np.zeros(shape, dtype=bool)):
        yield _from_linear(balance, omega, stuck)


def _from_linear(balance: Balance, omega: FloatArray, stuck: BoolArray) -> tuple[FloatArray, BoolArray]:
    return _at_level(balance, balance.linear(omega, stuck.astype(np.float64)), omega)


def _at_level(
    equations: Balance | _UnderLoad, x: FloatArray, level: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Newton's method with the parameter held."""
    z = np.column_stack((x, level))
    row = np.zeros_like(z)
    row[:, -1] = 1.0
    found = np.ones(level.size, dtype=bool)
    for _ in range(2):  # once more in the solution's own scale: the first guess may be far larger
        scale = scales(z[:, :-1], amplitudes(z[:, :-1]), np.ones(level.size))
        end = correct(equations, z, scale, row, iterations=TRIES)
        z, found = end.z, found & end.converged
    return z[:, :-1], found


def _raise_load(
    balance: Balance, omega: FloatArray, preloaded: BoolArray, fraction: float
) -> tuple[FloatArray, BoolArray]:
    equations = _UnderLoad(balance, omega)
    weak = np.full(omega.size, fraction)
    x = fraction * balance.linear(omega, preloaded.astype(np.float64))
    x, started = _at_level(equations, x, weak)
    some = np.flatnonzero(started)
    found = np.zeros(omega.size, dtype=bool)
    if some.size:
        z = np.column_stack((x[some], weak[some]))
        full = np.ones(some.size)
        trace = follow(equations.take(some), z, weak[some], full, LOAD_STEP, boundless=np.inf)
        arrived = np.flatnonzero(trace.status == COMPLETE)
        last = np.searchsorted(trace.curve, arrived, side="right") - 1
        x[some[arrived]], found[some[arrived]] = trace.z[last, :-1], True
    return x, found
