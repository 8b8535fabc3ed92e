"""Every branch of a response, from those that the level of the forces leads to."""

from __future__ import annotations

from fcm.branches.isolas import crossings
from fcm.harmonic.system import System
from fcm.harmonic.trace import Traced, traced, with_further


def every_branch(system: System) -> Traced:
    """Trace all branches of the response of a system."""
    return with_isolas(system, traced(system))


def with_isolas(system: System, found: Traced) -> Traced:
    """With the isolated branches that curves of folds come to."""
    met = crossings(system, found.found, found.branches.paths)
    return with_further(system, found, (), met.solutions) if met.solutions else found
