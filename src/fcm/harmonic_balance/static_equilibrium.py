"""Equilibrium of the structure and its contacts under static loads.

All loads grow from zero in proportion, without harmonic forces. A closed contact resists with k_u u as far as
mu n allows, as it is unstressed without the loads, and with k_v. Preloads remain. So contacts that stick can
hold a rigid-body mode that moves no contact along its normal: the mode rests where their friction balances
the loads along it. Vibration leaves its mean there. This equilibrium is the limit of the harmonic balance for
small forces.

Initial friction of contacts, by [start], grows with the loads and strains the structure as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from fcm.continuation import FollowOptions, Status, follow
from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import solution_near
from fcm.continuation.problem import Problem
from fcm.frozen import Frozen
from fcm.harmonic_balance.options import HARMONIC_BALANCE
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.structure.linear import Linear
from fcm.structure.options import RIGID_BODY

RIGID_BODY_FAULT = (
    "the static loads push the structure along a rigid-body mode that no contact holds, nor its friction. "
    "It does not come to rest. Hold it by a contact, or by a small frequency of that mode"
)
FLOATING = (
    "no contact is closed at rest, and contact forces cannot balance along the rigid-body modes. The first "
    "touch ends contact for good, so that there is no steady state. Rigid-body modes are at rest only while "
    "closed contacts hold them: give contacts a preload (n_0 above 0), or a static load that closes them"
)
NO_EQUILIBRIUM = (
    "no equilibrium with the static loads was found, or with the friction of [start]. The contacts may not "
    "be able to hold them: they push and do not pull, and friction is at most mu n"
)


class RestError(ValueError):
    """No equilibrium under the static loads exists; the message says why."""


class HeldStructure(Frozen):
    """The structure in coordinates that the contacts, if all stick, hold.

    The coordinates are the modes; rigid-body modes adrift are replaced by those of their combinations that
    move a contact with friction. modes (mode, coordinate); stiffness (coordinate,), 0 for rigid-body motions;
    ports (coordinate, port); load (coordinate,).
    """

    modes: FloatArray
    stiffness: FloatArray
    ports: FloatArray
    load: FloatArray

    @classmethod
    def of(cls, system: System) -> HeldStructure:
        """The held structure of a system."""
        linear = system.linear
        turn, count = _held_by_friction(linear, system.springs(stuck=True))
        modes = np.hstack(
            [np.eye(linear.natural.size)[:, ~linear.adrift], np.zeros((linear.natural.size, count))]
        )
        modes[linear.adrift, modes.shape[1] - count :] = turn[:, :count]
        stiffness = np.append(linear.natural[~linear.adrift] ** 2, np.zeros(count))
        return cls(modes, stiffness, modes.T @ linear.ports, modes.T @ linear.load)

    def rigid_by(self, springs: FloatArray) -> bool:
        """Whether springs (port,) hold all rigid-body motions."""
        rigid = self.ports[self.stiffness == 0.0]
        size = np.linalg.svd(rigid * (springs > 0.0), compute_uv=False)
        held = np.count_nonzero(size > RIGID_BODY.min_normal_motion * size.max(initial=0.0))
        return bool(held == len(rigid))


def _held_by_friction(linear: Linear, springs: FloatArray) -> tuple[FloatArray, int]:
    """Rotate the rigid-body modes adrift so that the first ones move contacts with friction.

    Return the rotation (adrift, adrift) and the number of these modes.
    """
    turn, size, _ = np.linalg.svd(linear.ports[linear.adrift] * (springs > 0.0))
    return turn, int(np.count_nonzero(size > RIGID_BODY.min_normal_motion * size.max(initial=0.0)))


class StaticLoadProblem(Problem):
    """Static equilibrium as a continuation problem, with the share of the loads as parameter.

    The unknowns are the coordinates of `HeldStructure`. unit is the least unit of the share; a greater share
    is its own unit.
    """

    def __init__(
        self, system: System, held: HeldStructure, unit: float = HARMONIC_BALANCE.rest.min_share_unit
    ) -> None:
        balance = system.new_balance(loaded=False)
        balance.load = 0.0
        Problem.__init__(self, held.stiffness.size, balance.margins, 0)
        self.has_root_margins, self.unit, self.balance, self.held = (
            balance.has_root_margins,
            unit,
            balance,
            held,
        )
        self.counted, self.mean_at, self.moved = system.linear.counted, system.layout.mean_at, 0.0
        self.force = np.zeros(held.ports.shape[1])  # of the contacts, without their preloads
        self.sliders = system.scene.sliders()
        self.at = np.zeros(balance.unknowns + 1)
        self.at[-1] = max(float(system.linear.natural.max(initial=0.0)), 1.0)  # any frequency will do
        self.stiffest = held.stiffness + held.ports**2 @ system.springs(stuck=True)

    def evaluate(self, z: FloatArray) -> int:
        """Fill residual and Jacobian; each row is divided by the stiffness with all contacts stuck."""
        y, share, d = np.asarray(z)[:-1], float(z[-1]), self.balance.directions
        at = self._placed(z)
        self.balance.evaluate(at)
        tangent = np.array(self.balance.tangent)[:, :d, :d]
        tangent[:, d - 1, d - 1] += self.counted
        self.force[:] = np.asarray(self.balance.force)[self.mean_at]
        self.force[d - 1 :: d] += self.counted * at[self.mean_at][d - 1 :: d]
        ports, unit = self.held.ports, 1.0 / self.stiffest
        by_contact = ports.reshape(y.size, -1, d)
        yields = np.einsum("icp,cpq->icq", by_contact, tangent).reshape(y.size, -1)
        stiffness = np.diag(self.held.stiffness) + yields @ ports.T
        self.residual[:] = unit * (self.held.stiffness * y + ports @ self.force - share * self.held.load)
        np.asarray(self.jacobian)[:, :-1] = unit[:, None] * stiffness
        np.asarray(self.jacobian)[:, -1] = -unit * (self.held.load + yields @ self.sliders)
        return 0

    def evaluate_scale(self, z: FloatArray) -> int:
        """Fill the units; those of coordinates follow from the greatest RMS port displacement so far."""
        y, ports = np.asarray(z)[:-1], self.held.ports
        self.moved = max(self.moved, float(np.sqrt(np.mean((y @ ports) ** 2))))
        motion = np.abs(ports).max(axis=1)
        own = np.where(motion > 0.0, self.moved / np.where(motion > 0.0, motion, 1.0), np.abs(y))
        self.scale[:-1] = np.sqrt(y.size) * np.where(own > 0.0, own, 1.0)
        self.scale[self.unknowns] = max(abs(z[-1]), self.unit)
        return 0

    def evaluate_margins(self, z: FloatArray) -> int:
        """Fill the margins of the contacts."""
        self.balance.evaluate_margins(self._placed(z))
        self.margin[:] = self.balance.margin
        self.kind[:], self.angle[:] = self.balance.kind, self.balance.angle
        return 0

    def balances_rigid_body(self, z: FloatArray, tolerance: float) -> bool:
        """Whether contact forces balance the loads along all rigid-body motions.

        Where no contact holds such a motion, the equations are singular and their solution is rounding error.
        """
        self.evaluate(z)
        rigid = self.held.stiffness == 0.0
        load, ports = float(z[-1]) * self.held.load[rigid], self.held.ports[rigid]
        size = np.abs(load) + np.abs(ports) @ np.abs(self.force)
        return bool((np.abs(load - ports @ self.force) <= tolerance * size.max(initial=0.0)).all())

    def solved_sign(self) -> float:
        """Sign of the determinant of the Jacobian."""
        return float(self.balance.solved_sign())

    def _placed(self, z: FloatArray) -> FloatArray:
        self.at[self.mean_at] = np.asarray(z)[:-1] @ self.held.ports - float(z[-1]) * self.sliders
        return self.at


class AtRest(NamedTuple):
    """Displacements at rest under the static loads.

    ports (port,) count from where contacts start unstressed. adrift (mode,) are those of the modes adrift,
    which the friction of sticking contacts holds; 0 for other modes.
    """

    ports: FloatArray
    adrift: FloatArray


def equilibrium(system: System) -> AtRest:
    """Equilibrium of a system under its static loads and initial friction; zeros if it has neither.

    Raises
    ------
    RestError
        If there is no equilibrium.
    """
    linear, ports = system.linear, system.layout.ports
    nothing = AtRest(np.zeros(ports), np.zeros(linear.natural.size))
    if not linear.load.any() and not system.scene.strained:
        return nothing
    if linear.load.any() and loads_move_rigid_body(linear, system.springs(stuck=True)):
        raise RestError(RIGID_BODY_FAULT)
    if not ports:
        return nothing
    options = system.options.rest
    single = System(system.scene, options=system.options)
    held = HeldStructure.of(single)
    for y in _linear(single, held, options.initial_share):
        problem = StaticLoadProblem(single, held, options.min_share_unit)
        start, span = np.append(y, options.initial_share), (options.initial_share, 1.0)
        path = follow(problem, start, span, options=FollowOptions(options.max_step))
        complete = path.status is Status.COMPLETE and path.z.shape[0] and path.parameter[-1] == 1.0
        if complete and problem.balances_rigid_body(path.z[-1], options.balance_tolerance):
            return _found(linear, held, path.z[-1][:-1], problem.sliders)
    for y in _linear(single, held, 1.0):
        problem = StaticLoadProblem(single, held, options.min_share_unit)
        z = solution_near(Newton(problem), np.append(y, 1.0))
        if z is not None and problem.balances_rigid_body(z, options.balance_tolerance):
            return _found(linear, held, z[:-1], problem.sliders)
    raise RestError(NO_EQUILIBRIUM)


def _found(linear: Linear, held: HeldStructure, y: FloatArray, sliders: FloatArray) -> AtRest:
    return AtRest(y @ held.ports - sliders, np.where(linear.adrift, held.modes @ y, 0.0))


def normal_forces_at_rest(scene: Scene) -> FloatArray:
    """Normal force (contact,) of each contact under the static loads of a scene; 0 of those that are open.

    Raises
    ------
    RestError
        If there is no equilibrium.
    """
    return np.maximum(System(scene).loads_at_rest, 0.0)


def loads_move_rigid_body(linear: Linear, springs: FloatArray) -> bool:
    """Whether static loads push along a rigid-body mode that the springs (port,) do not hold.

    springs are the stiffnesses with all contacts stuck.
    """
    if not linear.adrift.any():
        return False
    turn, count = _held_by_friction(linear, springs)
    loose = np.abs(turn.T @ linear.load[linear.adrift])[count:]
    return bool((loose > RIGID_BODY.min_normal_motion * np.abs(linear.load).max()).any())


def check_contacts_can_close(system: System) -> None:
    """Raise RestError where no contact can bear a mean normal force, though contacts must hold the structure.

    In a steady state the mean forces balance along each rigid-body mode. Without preloads or loads they are
    normal forces >= 0, and friction of at most mu times each. A linear program maximises the normal forces.
    If its maximum is 0, no contact closes. A square replaces the friction circle of a plane and contains it,
    so that no structure is refused whose contacts may close.
    """
    scene, linear = system.scene, system.linear
    rigid = (linear.natural == 0.0) & ~linear.adrift
    pressed = any(c.n_0 > 0.0 or c.law is not None for c in scene.contacts) or linear.load[rigid].any()
    if pressed or not rigid.any() or scene.ring is not None or not scene.contacts:
        return
    from scipy.optimize import linprog
    from scipy.sparse import block_diag

    d = linear.directions_of_contact
    ports = linear.ports[rigid] / np.abs(linear.ports[rigid]).max(axis=1, keepdims=True)
    each = []
    for one in scene.contacts:
        sides = np.vstack([np.eye(d)[:-1], -np.eye(d)[:-1]])
        sides[:, -1] = -one.mu
        each.append(sides)
    bounds = [((-np.inf, np.inf) if k < d - 1 else (0.0, 1.0)) for _ in each for k in range(d)]
    normal = np.tile(np.eye(d)[-1], len(each))
    limits = block_diag(each, format="csr")
    found = linprog(-normal, limits, np.zeros(limits.shape[0]), ports, np.zeros(len(ports)), bounds)
    if found.success and -found.fun <= RIGID_BODY.min_normal_motion * len(each):
        raise RestError(FLOATING)


def _linear(system: System, held: HeldStructure, share: float) -> Iterator[FloatArray]:
    """Yield linear equilibria: with the contacts as without loads, then all stuck, then all open."""
    n_0 = np.array([c.n_0 for c in system.scene.contacts])
    d, sliders = system.layout.directions, system.scene.sliders()
    for closed in (n_0 > 0.0, np.ones(n_0.size, dtype=bool), np.zeros(n_0.size, dtype=bool)):
        springs = system.springs(stuck=True) * np.repeat(closed, d)
        if not held.rigid_by(springs):
            continue
        force = 0.0 - share * springs * sliders  # spring forces at u = v = 0
        force[d - 1 :: d] = np.where(closed, np.minimum(n_0, 0.0), -np.maximum(n_0, 0.0))
        stiffness = np.diag(held.stiffness) + (held.ports * springs) @ held.ports.T
        unit = 1.0 / np.sqrt(stiffness.diagonal())
        right = unit * (share * held.load - held.ports @ force)
        yield unit * np.linalg.solve(stiffness * unit[:, None] * unit, right)


def rest_of(scene: Scene) -> tuple[FloatArray, FloatArray]:
    """Modal displacements (mode,) and friction forces (contact,) at rest under the static loads of a scene.

    Raises
    ------
    RestError
        If there is no equilibrium.
    """
    system = System(scene)
    ports = system.rest
    balance, linear, modal = system.new_balance(), system.linear, scene.modal
    balance.load = 0.0
    z = np.zeros(balance.unknowns + 1)
    z[balance.layout.mean_at], z[-1] = ports, 1.0
    balance.evaluate(z)
    force = np.asarray(balance.force)[balance.layout.mean_at]
    q = linear.flexibility @ (linear.load - linear.ports @ force)  # mass-normalised, rigid-body modes rotated
    q += system.adrift_at_rest
    moved, rigid = q / np.sqrt(modal.mass), linear.natural == 0.0
    if rigid.any():
        displacements = linear.dofs[rigid].T @ q[rigid]
        moved[rigid] = np.linalg.lstsq(modal.shapes[rigid].T, displacements, rcond=None)[0]
    return moved, force[:: balance.directions].copy()
