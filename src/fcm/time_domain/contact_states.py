"""The linear flow for one combination of contact states, without forces: matrix, exits, powers and tables.

The exits are rows g with g y positive while the states last. They are the conditions (9), (10), (13) to (16)
without division: E lasts while mu n - f > 0 and mu n + f > 0; P and N while n > 0 and +-k_u times the slip
velocity > 0; S while -n > 0.
"""

from __future__ import annotations

from math import factorial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.flow import BLOCK, NEGATIVE_SLIP, ORDER, POSITIVE_SLIP, SEPARATED, STICKING

if TYPE_CHECKING:
    from fcm.time_domain.equations_of_motion import EquationsOfMotion

SLOWEST = 1e-300  # [1/s] a lower rate counts as zero
BLOCKS = np.array([[1.0 / factorial(4 * i + j) for j in range(4)] for i in range((ORDER + 1) // 4)])
Codes = npt.NDArray[np.int8]


class Flow(NamedTuple):
    """Data of one flow for `Flows.add`; matrices are transposed, for the part of y without the forces."""

    states: Codes  # (contact,)
    step: float  # [s] the reciprocal of a bound of the rates of the motion
    halved: bool  # whether the step is shorter than that because the forces are faster
    rows: FloatArray  # (exit, linear)
    owner: list[int]  # (exit,) the contact of the exit
    goal: list[int]  # (exit,) the state after the exit
    power: FloatArray  # (linear, linear) effect of one step
    change: FloatArray  # (linear, linear) the matrix times the step
    series: FloatArray  # (linear, exit * (ORDER + 1)) the Taylor coefficients of the exits
    sizes: FloatArray  # (linear, linear) sizes of the terms that add up to a step
    table: FloatArray  # (linear, (BLOCK + 1) * 3 * exit) the exits on the steps of a block
    pushes: (
        FloatArray  # (ORDER, 4 waves, linear) h (A h)**k B; B: for each harmonic the forces of sin, of cos,
    )
    # and the parts of these that grow as omega^2


def made(system: EquationsOfMotion, states: Codes) -> Flow:
    """The flow of a combination of contact states, with steps that also resolve the forces."""
    matrix = _matrix(system, states)
    step, halved = _step(system, matrix)
    change = matrix.T * step
    rows, owner, goal = _exits(system, states)
    power = _exponential(change)
    leading = [rows.T]
    for j in range(1, ORDER + 1):
        leading.append(change @ leading[-1] / j)
    table = [np.hstack((leading[0], leading[1], 24.0 * leading[4]))]
    for _ in range(BLOCK):
        table.append(power @ table[-1])
    return Flow(
        states.copy(), step, halved, rows, owner, goal, power, change,
        np.stack(leading, axis=2).reshape(rows.shape[1], -1),
        np.eye(change.shape[0]) + np.abs(change) + 0.5 * np.abs(change @ change),
        np.hstack(table), _pushes(system, change, step),
    )  # fmt: skip


def _matrix(system: EquationsOfMotion, states: Codes) -> FloatArray:
    """Matrix (linear, linear) of the equations for (q, q', f, n, 1)."""
    modal, m = system.scene.modal, system.modes
    a = np.zeros((system.linear, system.linear))
    a[system.q, system.p] = np.eye(m)
    a[system.p, system.q] = -np.diag(modal.frequency**2) - system.pull.T @ system.stretch
    a[system.p, system.p] = -np.diag(2.0 * modal.damping * modal.frequency)
    a[system.p, -1] = system.steady / modal.mass
    for j, (contact, state) in enumerate(zip(system.contacts, states.tolist(), strict=True)):
        f, n = system.f.start + j, system.n.start + j
        push_u, push_v = system.tangential[j] / modal.mass, system.normal[j] / modal.mass
        a[n, system.p] = contact.k_v * system.normal[j]
        if state == SEPARATED:
            a[system.p, -1] += push_v * max(contact.n_0, 0.0)  # the missing preload
            continue
        a[system.p, -1] -= push_v * min(contact.n_0, 0.0)  # a gap does not press
        a[system.p, f], a[system.p, n] = -push_u, -push_v
        if state == STICKING:
            a[f, system.p] = contact.k_u * system.tangential[j] if contact.mu > 0.0 else 0.0
        else:
            a[f, system.p] = (1.0 if state == POSITIVE_SLIP else -1.0) * contact.mu * a[n, system.p]
    return a


def _step(system: EquationsOfMotion, a: FloatArray) -> tuple[float, bool]:
    """Step length [s], the reciprocal of a bound of the rates; and whether it was halved for the forces.

    It is halved only until it resolves the forces, so that the step does not depend on when it is computed.
    """
    loads = slice(system.f.start, system.n.stop)
    root = np.sqrt(system.scene.modal.mass)
    with np.errstate(over="ignore", invalid="ignore"):
        stiffness = -a[system.p, system.q] - a[system.p, loads] @ a[loads, system.p]
        stiffness *= root[:, None] / root
    if not np.isfinite(stiffness).all():
        raise SimulationError("the stiffness overflows; use units in which its numbers are smaller")
    damping = 2.0 * system.scene.modal.damping * system.scene.modal.frequency
    rate = float(np.sqrt(np.linalg.norm(stiffness, 2)) + np.abs(damping).max(initial=0.0))
    # where nothing has a rate, only the forces bound the step: begin with a long enough power of two
    fastest = system.flows.highest * system.omega
    longest = 1.0 / rate if rate > SLOWEST else 2.0 ** np.ceil(1.0 - np.log2(fastest))
    step = longest
    while fastest * step > system.flows.max_step_angle:
        step *= 0.5
    return float(step), bool(step < longest)


def _exponential(a: FloatArray) -> FloatArray:
    """Taylor polynomial of exp(a) of degree ORDER, in blocks of four powers (Paterson and Stockmeyer)."""
    square = a @ a
    powers = np.stack((np.eye(a.shape[0]), a, square, square @ a))
    blocks, fourth = np.tensordot(BLOCKS, powers, 1), square @ square
    total: FloatArray = blocks[-1]
    for block in blocks[-2::-1]:
        total = total @ fourth + block
    return total


def _pushes(system: EquationsOfMotion, change: FloatArray, step: float) -> FloatArray:
    """Products h (A h)**k B of the matrix with the forces of each harmonic; see `Flow.pushes`."""
    pushes, flows = np.zeros((ORDER, 4 * system.flows.waves, change.shape[0])), system.flows
    for b in (0, 1):
        pushes[0, b::4, system.p] = step * np.asarray(flows.constant)[b::2]
        pushes[0, b + 2 :: 4, system.p] = step * np.asarray(flows.square)[b::2]
    for k in range(1, ORDER):
        np.matmul(pushes[k - 1], change, out=pushes[k])
    return pushes


def _exits(system: EquationsOfMotion, states: Codes) -> tuple[FloatArray, list[int], list[int]]:
    """Rows of the exits (of f, n and the rates of u and v), and the contact and next state of each."""
    rows: list[FloatArray] = []
    owner: list[int] = []
    goal: list[int] = []

    def add(j: int, leads_to: int, f: float = 0.0, n: float = 0.0, u: float = 0.0, v: float = 0.0) -> None:
        contact, row = system.contacts[j], np.zeros(system.linear)
        row[system.f.start + j], row[system.n.start + j], row[-1] = f, n, n * contact.n_0
        row[system.p] = u * system.tangential[j] + v * system.normal[j]
        rows.append(row)
        owner.append(j)
        goal.append(leads_to)

    for j, (contact, state) in enumerate(zip(system.contacts, states.tolist(), strict=True)):
        rough = contact.mu > 0.0 and contact.k_u > 0.0
        if state == STICKING and rough:
            add(j, POSITIVE_SLIP, n=contact.mu, f=-1.0)
            add(j, NEGATIVE_SLIP, n=contact.mu, f=1.0)
        elif state in (POSITIVE_SLIP, NEGATIVE_SLIP):
            sign = 1.0 if state == POSITIVE_SLIP else -1.0
            add(j, STICKING, u=sign * contact.k_u, v=-contact.mu * contact.k_v)
        if state == SEPARATED:
            add(j, STICKING, n=-1.0)
        elif state != STICKING or not rough:
            add(j, SEPARATED, n=1.0)
    return np.array(rows).reshape(len(rows), system.linear), owner, goal
