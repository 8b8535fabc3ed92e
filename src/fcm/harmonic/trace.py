"""Every branch of the response of a system over its range."""

from __future__ import annotations

from dataclasses import dataclass

from fcm.continuation import Branches, all_branches
from fcm.continuation.follow import Progress
from fcm.harmonic.start import Found, resonances, solutions
from fcm.harmonic.system import System


@dataclass(frozen=True)
class Traced:
    """Branches, and the frequencies at which solutions were looked for."""

    branches: Branches
    looked: tuple[Found, ...]


def traced(system: System, progress: Progress | None = None) -> Traced:
    """Trace the branches through all solutions at the ends of the range and at the resonances inside it."""
    span = system.scene.frequency_range
    exact = system.with_harmonics(system.harmonics)  # no table is asked for solutions to start from
    looked = tuple(solutions(exact, omega) for omega in (*span, *resonances(system)))
    starts = [z for found in looked for z in found.solutions]
    branches = all_branches(system.balance, starts, span, system.scene.max_step, progress)
    return Traced(branches, looked)
