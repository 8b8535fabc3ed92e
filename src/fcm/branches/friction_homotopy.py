"""Motions that slip beside one that sticks, found by raising friction from zero.

Friction that presses its own contact together may wedge it. Then a motion that sticks, by the residual
friction of earlier slip, exists beside one that slips, and no force level leads from one to the other. The
motion without friction leads to the second one if all coefficients of friction are raised together.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.branches.force_level import solutions
from fcm.branches.options import FRICTION, FrictionOptions
from fcm.branches.shakedown import may_wedge, shakedown_at
from fcm.branches.trace import Traced, with_further
from fcm.continuation import Problem, follow
from fcm.harmonic_balance.contact_cycles import ContactRecord
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class FrictionProblem(Problem):
    """A balance at omega, with a factor on all coefficients of friction as the parameter.

    >>> import fcm
    >>> from fcm.harmonic_balance.system import System
    >>> problem = FrictionProblem(System(fcm.load_scene("yang1998-n5"), (1,)), 1.0)
    >>> problem.evaluate(np.append(np.ones(problem.unknowns), 0.5))
    0
    """

    def __init__(self, system: System, omega: float, options: FrictionOptions = FRICTION) -> None:
        self.difference = options.difference
        self.balance = balance = system.new_balance()
        super().__init__(balance.unknowns, balance.margins, 0, balance.rank)
        self.group, self.residual, self.jacobian = balance.group, balance.residual, balance.jacobian
        self.margin, self.kind, self.angle = balance.margin, balance.kind, balance.angle
        self.unbounded, self.has_root_margins, self.costly = (
            balance.unbounded,
            balance.has_root_margins,
            balance.costly,
        )
        self.numbers = [(one.mu, one.k_u, one.k_v, one.n_0) for one in system.scene.contacts]
        self.z = np.append(np.zeros(balance.unknowns), omega)

    def _with_friction(self, z: FloatArray, part: float) -> FloatArray:
        """Set the factor on the coefficients of friction, and return the unknowns of the balance."""
        self.z[:-1] = z[:-1]
        for law, (mu, *others) in zip(self.balance.laws, self.numbers, strict=True):
            law.set_parameters(part * mu, *others)
        return self.z

    def evaluate(self, z: FloatArray) -> int:
        self.balance.evaluate_residual(self._with_friction(z, z[-1] + self.difference))
        further = np.array(self.balance.residual)
        self.balance.evaluate(self._with_friction(z, z[-1]))
        last = 0 if self.rank else self.unknowns
        np.asarray(self.jacobian)[:, last] = (further - np.asarray(self.residual)) / self.difference
        return 0

    def evaluate_residual(self, z: FloatArray) -> int:
        return int(self.balance.evaluate_residual(self._with_friction(z, z[-1])))

    def evaluate_scale(self, z: FloatArray) -> int:
        self.balance.evaluate_scale(self._with_friction(z, z[-1]))
        self.scale[:-1] = self.balance.scale[:-1]
        return 0

    def evaluate_margins(self, z: FloatArray) -> int:
        return int(self.balance.evaluate_margins(self._with_friction(z, z[-1])))

    def squared_margin(self, kind: int, z: FloatArray) -> float:
        return float(self.balance.squared_margin(kind, self._with_friction(z, z[-1])))

    def factor(self, row: FloatArray, scale: FloatArray) -> float:
        return float(self.balance.factor(row, scale))

    def solve(self, right: FloatArray) -> int:
        return int(self.balance.solve(right))

    def solved_sign(self) -> float:
        return float(self.balance.solved_sign())


def with_friction_raised(system: System, found: Traced) -> Traced:
    """The branches with those to which raising friction from zero leads, if contacts shake down."""
    paths, scene = found.branches.paths, system.scene
    if not (paths and scene.contacts) or scene.strained or system.own_laws or not may_wedge(scene):
        return found
    points = np.concatenate([path.z for path in paths])
    omega = shakedown_at(system, points[:, -1], ContactRecord.at(system, points).words)
    if np.isnan(omega):
        return found
    contacts = tuple(replace(one, mu=0.0) for one in scene.contacts)
    without_friction = solutions(system.of(replace(scene, contacts=contacts)), omega).solutions
    problem, starts = FrictionProblem(system, omega), list[FloatArray]()
    for start in without_friction:
        raised = follow(problem, np.append(start[:-1], 0.0), (0.0, 1.0))
        starts += [np.append(z[:-1], omega) for z in raised.z if z[-1] == 1.0]
    every = with_further(system, found, (), starts)
    return every if len(every.branches.paths) > len(found.branches.paths) else found
