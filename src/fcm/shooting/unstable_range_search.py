"""Motions where none that was found is stable, so that a branch was missed or the motion has no period.

There a simulation from rest tells what happens: if it becomes periodic, the motion is on a branch to which
neither the balances nor the level of the forces have led.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fcm.continuation import Path
from fcm.model.scene import FloatArray
from fcm.shooting.initial_orbits import first_point
from fcm.shooting.orbit_record import recorded
from fcm.shooting.periodic_orbit import Poll, approached
from fcm.shooting.problem import OrbitProblem
from fcm.stability.unstable_ranges import unstable_stretches
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.system import System


def orbits_in_unstable_ranges(
    problem: OrbitProblem, paths: Sequence[Path], poll: Poll
) -> Iterator[FloatArray]:
    """The stable motions (unknown + 1,) that simulations from rest come to in the widest stretches of the
    range in which every motion of some paths is unstable.

    A structure with a mode that nothing damps comes to none.
    """
    scene = problem.scene
    if not (scene.modal.damping > 0.0).all():
        return
    parts = [(path.parameter, np.array([_stable(problem, z) for z in path.z])) for path in paths]
    for low, high in unstable_stretches(parts, scene.frequency_range)[: problem.options.stability.max_ranges]:
        try:
            orbit = approached(System(scene, 0.5 * (low + high)), poll, problem.options)
            if orbit.stable:
                yield first_point(problem, orbit, poll)
        except SimulationError:  # it does not become periodic, or is not determined
            continue


def _stable(problem: OrbitProblem, z: FloatArray) -> float:
    return float(recorded(problem, z).stable)
