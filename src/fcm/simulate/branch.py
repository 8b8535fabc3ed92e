"""The curves of periodic solutions of a scene over its frequencies, followed from both ends of the range."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from fcm.motion.errors import SimulationError
from fcm.orbit.family import chosen
from fcm.orbit.periodic import Orbit, periodic
from fcm.scene.modal import UNITS
from fcm.scene.model import Scene
from fcm.simulate.arc import Equations, Point, level, rescaled
from fcm.simulate.between import with_folds, with_peaks
from fcm.simulate.follow import Follower
from fcm.simulate.sample import Sample, sampled

CAME_BACK = "the curve came back to the frequency where it began"
Progress = Callable[[float, str], None]


@dataclass
class Branch:
    """Periodic solutions along one curve."""

    orbits: list[Sample] = field(default_factory=list)  # in the order along the curve
    folds: list[Sample] = field(default_factory=list)  # those of them at which it turns back in frequency
    complete: bool = False  # whether it goes from one end of the range to the other
    reason: str = ""  # why it does not, else ''

    @property
    def ended(self) -> bool:
        """Whether it ends at an end of the range, be it the one where it began."""
        return self.complete or self.reason == CAME_BACK


def trace_orbits(
    scene: Scene,
    max_step: float | None = None,
    start: Orbit | None = None,
    progress: Progress | None = None,
) -> Branch:
    """Follow the periodic solutions of a scene over its frequency range, stable or not.

    Pseudo-arclength continuation of the exact motion: the same points as `periodic` finds, in order, through
    folds and through the corners at which regimes begin.

    Parameters
    ----------
    scene : Scene
        Its `frequency_range` is traced.
    max_step : float, optional
        Longest step along the curve, relative to the range and to the size of the motion; by default the
        scene's.
    start : Orbit, optional
        Where to start, at an end of the range; at its lower end, from rest, by default.
    progress : optional
        Called now and then with the fraction of the range that is covered and a text.

    Returns
    -------
    Branch
        Its folds are located to 1e-8 of the arc, the greatest amplitude of each degree of freedom to 1e-9.

    Raises
    ------
    SimulationError
        If no periodic solution is found to start from.

    Examples
    --------
    >>> import fcm
    >>> from dataclasses import replace
    >>> scene = replace(fcm.load_scene("yang1998-n5"), frequency_range=(1.1, 1.3))
    >>> [round(fold.frequency, 4) for fold in trace_orbits(scene).folds]
    [1.2398, 1.1936]
    """
    longest = scene.max_step if max_step is None else max_step
    if not longest > 0.0:
        raise SimulationError(f"max_step is {longest:g}; it must be positive")
    equations, branch = Equations(scene), Branch()
    begin = periodic(scene, scene.frequency_range[0]) if start is None else start
    follow(branch, equations, first_point(equations, begin), longest, progress)
    finish(branch, equations)
    return branch


def first_point(equations: Equations, orbit: Orbit) -> Point:
    """The first point of a curve, its stuck contacts as little stressed as can be, directed inwards."""
    low, high = equations.scene.frequency_range
    state, omega = orbit.state, orbit.frequency
    z = np.append(equations.shooting.unknowns(state), omega)
    near = equations.shot(z)
    member = None if near is None else chosen(near, equations.shooting.resting)
    if member is not None:
        z = np.append(member.x[equations.free], omega)
    shot = equations.shot(z)
    row = level(z.size, 1.0 if omega - low <= high - omega else -1.0)
    found = None if shot is None else equations.correct(z, equations.scale(shot), row)
    if found is None:
        raise SimulationError(
            f"the solution at {omega:g} rad/s to start from is not determined: a mode is free to drift, or "
            "resonates without damping; add damping, or try another range"
        )
    return rescaled(equations, found)


def follow(
    branch: Branch, equations: Equations, first: Point, longest: float, progress: Progress | None
) -> None:
    """Put the points from the first on into a branch, as they are found."""
    low, high = equations.scene.frequency_range
    follower = Follower(equations, first, longest)
    branch.orbits.append(sampled(first))
    covered = 0.0
    for point in follower.points():
        branch.orbits.append(sampled(point))
        covered = max(covered, abs(float(point.z[-1] - first.z[-1])) / (high - low))
        if progress is not None:
            progress(covered, f"{len(branch.orbits)} points")
    last = branch.orbits[-1].frequency
    returned = last == first.z[-1]
    branch.complete = not follower.reason and not returned
    if follower.reason:
        branch.reason = f"stopped at {shown(equations.scene, last)}: {follower.reason}"
    elif returned:
        branch.reason = CAME_BACK


def finish(branch: Branch, equations: Equations) -> None:
    """Add the folds and peaks to a branch."""
    branch.orbits, branch.folds = with_folds(equations, branch.orbits)
    branch.orbits = with_peaks(equations, branch.orbits)


def shown(scene: Scene, omega: float) -> str:
    """A frequency [rad/s] in the scene's unit."""
    return f"{omega / UNITS[scene.frequency_unit]:.8g} {scene.frequency_unit}"
