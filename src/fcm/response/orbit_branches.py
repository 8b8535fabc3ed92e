"""Branches of exact motions that repeat after the same number of periods."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from fcm.continuation import Path
from fcm.frozen import Frozen
from fcm.shooting.jump_landings import with_landings
from fcm.shooting.orbit_record import OrbitRecord, samples
from fcm.shooting.period_doubling import DoubledPeriodProblem, to_flips
from fcm.shooting.problem import OrbitProblem


class OrbitBranches(Frozen):
    """The paths of a problem of exact motions.

    For a doubled period, once has the branches of half the period, at whose flips these paths end. mirrored:
    number of paths whose mirror images are left out.
    """

    problem: OrbitProblem
    paths: Sequence[Path]
    once: OrbitBranches | None = None
    mirrored: int = 0
    cut_off: bool = False  # interrupted: nothing is located between the points any more

    @cached_property
    def own(self) -> list[list[OrbitRecord]]:
        """The points of each path, with those at which its stability changes."""
        return [samples(self.problem, path, located=not self.cut_off) for path in self.paths]

    @cached_property
    def points(self) -> list[list[OrbitRecord]]:
        """The points of each path, with those at the frequencies at which other paths end."""
        found = self.own
        if self.cut_off:
            return found
        if isinstance(self.problem, DoubledPeriodProblem) and self.once is not None:
            before = self.once.points
            found = [to_flips(self.problem, one, before) for one in found]
        return with_landings(self.problem, found)
