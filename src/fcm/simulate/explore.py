"""All curves of periodic solutions of a scene that reach an end of its range."""

from __future__ import annotations

from dataclasses import replace

from fcm.motion.errors import SimulationError
from fcm.motion.system import System
from fcm.orbit.harmonic import balanced_state
from fcm.orbit.periodic import Orbit, periodic, shoot
from fcm.scene.model import Scene
from fcm.simulate.arc import Equations, Point
from fcm.simulate.branch import Branch, Progress, finish, first_point, follow
from fcm.simulate.sample import Sample, distance, sampled

DISTINCT = 1e-5  # solutions further apart than this, relative to their size, are different


class Explorer:
    """The branches of a scene: followed from the low end, and from the high end where that finds more.

    They are there as far as they have been found, whenever the work is interrupted.
    """

    def __init__(self, scene: Scene, progress: Progress | None) -> None:
        self.scene, self.equations, self.progress = scene, Equations(scene), progress
        self.branches: list[Branch] = []
        self.problem = ""  # why there is no solution to start from

    def run(self) -> None:
        """Find the branches, none if there is no solution to start from."""
        for omega in self.scene.frequency_range:
            first = self._first(omega)
            if first is not None and self._is_new(sampled(first)):
                self.branches.append(Branch())
                follow(self.branches[-1], self.equations, first, self.scene.max_step, self.progress)
        if len(self.branches) == 2 and self.branches[1].complete:
            self._turn_second()
        for branch in self.branches:
            finish(branch, self.equations)

    @property
    def complete(self) -> bool:
        """Whether every branch goes from end to end, or there are those of both ends."""
        ended = all(branch.ended for branch in self.branches)
        return ended and (len(self.branches) > 1 or any(branch.complete for branch in self.branches))

    @property
    def reason(self) -> str:
        """Why the curve is not complete, else ''."""
        reasons = dict.fromkeys(branch.reason for branch in self.branches if branch.reason)
        return "" if self.complete else "; ".join(reasons) or self.problem

    @property
    def at(self) -> float:
        """The frequency to which the work has come [rad/s]."""
        return self.branches[-1].orbits[-1].frequency

    def _first(self, omega: float) -> Point | None:
        try:
            return first_point(self.equations, solution_at(self.scene, omega))
        except SimulationError as error:
            self.problem = str(error)
            return None

    def _is_new(self, solution: Sample) -> bool:
        ends = [branch.orbits[i] for branch in self.branches for i in (0, -1)]
        return all(end.frequency != solution.frequency or distance(solution, end) > DISTINCT for end in ends)

    def _turn_second(self) -> None:
        """Turn a branch that came down from the high end; one that stopped on its way up is part of it."""
        second = self.branches[1]
        second.orbits = [replace(orbit, tangent=-orbit.tangent) for orbit in reversed(second.orbits)]
        if not self.branches[0].ended and distance(second.orbits[0], self.branches[0].orbits[0]) <= DISTINCT:
            del self.branches[0]


def solution_at(scene: Scene, omega: float) -> Orbit:
    """A stable solution near harmonic balance, or the one that a motion from rest comes near to, or any."""
    near = _balanced(scene, omega)
    if near is not None and near.stable:
        return near
    try:
        return periodic(scene, omega)
    except SimulationError:
        if near is None:
            raise
        return near


def _balanced(scene: Scene, omega: float) -> Orbit | None:
    try:
        guess = balanced_state(scene, omega)
        return None if guess is None else shoot(System(scene, omega), guess)
    except SimulationError:
        return None
