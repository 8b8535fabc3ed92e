"""Rest under static loads: the equilibrium to which they bring the structure and its contacts.

The loads grow from nothing, all in proportion, with no harmonic force beside them. A closed contact resists
with k_u (u - 0) as far as mu n allows, for it is unstressed without them, and with its k_v; what is a preload
without the loads is one still. The harmonic balance has this equilibrium as the limit of small forces.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from fcm.continuation import FollowOptions, Status, follow
from fcm.continuation.corrector import Newton
from fcm.continuation.problem import Problem
from fcm.harmonic_balance.options import HARMONIC_BALANCE
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.structure.linear import Linear
from fcm.structure.options import RIGID_BODY

RIGID_BODY_FAULT = (
    "the static loads push the structure along a rigid-body mode that no contact holds along its normal. "
    "It does not come to rest. Hold it by a contact along its normal, or by a small frequency of that mode"
)
FLOATING = (
    "no contact is closed at rest, and contact forces cannot balance along the rigid-body modes. The first "
    "touch ends contact for good, so that there is no steady state. Rigid-body modes are at rest only while "
    "closed contacts hold them: give contacts a preload (n_0 above 0), or a static load that closes them"
)
NO_EQUILIBRIUM = "no equilibrium with the static loads was found. The contacts may not be able to hold them"


class RestError(ValueError):
    """There is no equilibrium; the message says why."""


class StaticLoadProblem(Problem):
    """The balance without harmonic forces, followed in the share of the static loads.

    Shares are measured by themselves, and below a unit by that.
    """

    def __init__(
        self, balance: Balance, omega: float, unit: float = HARMONIC_BALANCE.rest.min_share_unit
    ) -> None:
        Problem.__init__(self, balance.unknowns, balance.margins, 0, balance.rank)
        self.rooted, self.unit = balance.rooted, unit
        self.balance, self.at_omega = balance, np.full(balance.unknowns + 1, omega)
        self.by_share = np.zeros(balance.unknowns)
        self.by_share[balance.layout.mean_at] = -np.asarray(balance.rest)
        balance.load = 0.0

    def evaluate(self, z: FloatArray) -> int:
        """Residual and derivatives."""
        self.balance.evaluate(self._placed(z))
        self.residual[:] = self.balance.residual
        if not self.rank:
            np.asarray(self.jacobian)[:] = self.balance.jacobian
        np.asarray(self.jacobian)[:, -1] = self.by_share
        return 0

    def measure(self, z: FloatArray) -> int:
        """Scale."""
        self.balance.measure(self._placed(z))
        self.scale[:] = self.balance.scale
        self.scale[self.unknowns] = max(abs(z[-1]), self.unit)
        return 0

    def bound(self, z: FloatArray) -> int:
        """Margins."""
        self.balance.bound(self._placed(z))
        self.margin[:] = self.balance.margin
        self.kind[:], self.angle[:] = self.balance.kind, self.balance.angle
        return 0

    def factor(self, row: FloatArray, scale: FloatArray) -> float:
        """The system closed by a row."""
        self.balance.jacobian[:, :] = self.jacobian
        return float(self.balance.factor(row, scale))

    def solve(self, right: FloatArray) -> int:
        """Its solution for a right side."""
        return int(self.balance.solve(right))

    def _placed(self, z: FloatArray) -> FloatArray:
        self.at_omega[:-1] = np.asarray(z)[:-1]
        self.balance.share = float(z[-1])
        return self.at_omega


def at_rest(system: System) -> FloatArray:
    """Displacements (port,) at rest under the static loads of a system; zeros without any.

    Raises
    ------
    RestError
        If there is no equilibrium.
    """
    linear, ports = system.linear, system.layout.ports
    if loads_move_rigid_body(linear):
        raise RestError(RIGID_BODY_FAULT)
    if not linear.load.any() or not ports:
        return np.zeros(ports)
    options = system.options.rest
    single = System(system.scene, options=system.options)
    omega = max(float(linear.natural.max(initial=0.0)), 1.0)  # any: nothing moves
    for guess in _linear(single, options.initial_share):
        problem = StaticLoadProblem(single.new_balance(), omega, options.min_share_unit)
        start, span = np.append(guess, options.initial_share), (options.initial_share, 1.0)
        path = follow(problem, start, span, options=FollowOptions(options.max_step))
        complete = path.status is Status.COMPLETE and path.z.shape[0] and path.parameter[-1] == 1.0
        if complete and _balances_rigid_body(single, problem, path.z[-1]):
            return path.z[-1][single.layout.mean_at]  # type: ignore[no-any-return]
    for guess in _linear(single, 1.0):
        problem = StaticLoadProblem(single.new_balance(), omega, options.min_share_unit)
        newton, z = Newton(problem), np.append(guess, 1.0)
        problem.measure(z)
        newton.scale[:], newton.z[:] = problem.scale, z
        newton.row[:] = np.eye(z.size)[-1]
        if newton.correct(1.0) and _balances_rigid_body(single, problem, newton.z):
            return np.asarray(newton.z)[single.layout.mean_at]
    raise RestError(NO_EQUILIBRIUM)


def normal_forces_at_rest(scene: Scene) -> FloatArray:
    """Of each contact under the static loads of a scene, (contact,); 0 of those that are open.

    Raises
    ------
    RestError
        If there is no equilibrium.
    """
    return np.maximum(System(scene).loads_at_rest, 0.0)


def loads_move_rigid_body(linear: Linear) -> bool:
    """Whether static loads push along a rigid-body mode that nothing holds."""
    size = np.abs(linear.load)
    return bool((size[linear.adrift] > RIGID_BODY.min_normal_motion * size.max(initial=0.0)).any())


def check_contacts_can_close(system: System) -> None:
    """Raise RestError where no contact can bear a normal force in the mean, though contacts must hold the
    structure.

    In the mean the forces of a steady state balance along each rigid-body mode. Without preloads or loads
    these are normal forces, none of them negative, and friction of no more than mu times each. If they are
    all zero wherever they balance, which a linear program tells, no contact closes. The circle of friction in
    a plane is within a square here, so that nothing is refused that may close.
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


def _balances_rigid_body(system: System, problem: StaticLoadProblem, z: FloatArray) -> bool:
    """Whether contact forces balance the loads along the rigid-body modes that contacts hold.

    Where all these contacts open the equations are singular, and what solves them is rounding.
    """
    linear, mean = system.linear, system.layout.mean_at
    problem.evaluate(z)
    force, d = np.array(problem.balance.force)[mean], linear.directions_of_contact
    force[d - 1 :: d] += linear.counted * np.asarray(z)[mean][d - 1 :: d]
    rigid = (linear.natural == 0.0) & ~linear.adrift
    load, ports = linear.load[rigid], linear.ports[rigid]
    size = np.abs(load) + np.abs(ports) @ np.abs(force)
    return bool((np.abs(load - ports @ force) <= system.options.rest.balance_tolerance * size).all())


def _held(linear: Linear, closed: npt.NDArray[np.bool_]) -> bool:
    """Whether closed contacts (contact,) hold the rigid-body modes that all of them would."""
    rigid = (linear.natural == 0.0) & ~linear.adrift
    size = np.linalg.svd(linear.normal[rigid] * (closed & (linear.counted > 0.0)), compute_uv=False)
    return int((size > RIGID_BODY.min_normal_motion * size.max(initial=0.0)).sum()) == int(rigid.sum())


def _linear(system: System, share: float) -> Iterator[FloatArray]:
    """Unknowns with the contacts as they are without the loads, then all stuck, then all open."""
    contacts, balance, layout = system.scene.contacts, system.new_balance(), system.layout
    d = layout.directions
    n_0 = np.array([c.n_0 for c in contacts])
    static, rest = np.asarray(balance.receptance.static), share * np.asarray(balance.rest)
    for closed in (n_0 > 0.0, np.ones(n_0.size, dtype=bool), np.zeros(n_0.size, dtype=bool)):
        if not _held(system.linear, closed):
            continue
        stiffness = system.springs(stuck=True) * np.repeat(closed, d)
        stiffness[d - 1 :: d] -= system.linear.counted
        force = np.zeros(rest.size)  # of the normal springs where v = 0
        force[d - 1 :: d] = np.where(closed, np.minimum(n_0, 0.0), -np.maximum(n_0, 0.0))
        ports = np.linalg.solve(np.eye(rest.size) + static * stiffness, rest - static @ force)
        x = np.zeros(layout.unknowns)
        x[layout.mean_at] = ports
        yield x


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
    q = linear.flexibility @ (linear.load - linear.ports @ force)  # of mass 1, rigid ones turned
    moved, rigid = q / np.sqrt(modal.mass), linear.natural == 0.0
    if rigid.any():
        displacements = linear.dofs[rigid].T @ q[rigid]
        moved[rigid] = np.linalg.lstsq(modal.shapes[rigid].T, displacements, rcond=None)[0]
    return moved, force[:: balance.directions].copy()
