"""Records of periodic solutions on a curve: all reported quantities, without the motion in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace

import numpy as np
import numpy.typing as npt

from fcm.continuation import Mark, Path
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import within_unit_circle
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.residual import Shot
from fcm.shooting.stability_changes import crossing
from fcm.shooting.stability_windows import with_windows
from fcm.shooting.steady_state import SteadyMotion, multi_period_motion
from fcm.time_domain.contact_loads import contact_loads
from fcm.time_domain.cycle_measures import Measure, measure
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State
from fcm.units import spoken


class OrbitRecord(Frozen):
    """A periodic solution with its reported quantities and its point on a curve."""

    frequency: float  # [rad/s]
    state: State  # at the forces' angle 0
    states: tuple[str, ...]  # of each contact over the period
    measure: Measure
    contact_loads: FloatArray  # (contact, 4) as of `contact_loads`
    multipliers: npt.NDArray[np.complex128]  # Floquet multipliers, the greatest first
    residual: float  # closure error of the period, relative to the motion
    stable: bool  # whether small disturbances do not grow
    z: FloatArray  # (unknown + 1,), the frequency last
    direction: FloatArray  # (unknown + 1,) of the curve, in the units of z
    mark: int = 0  # flags of `Mark`
    held: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))  # (held, 3): see `_held_distances`
    steady: SteadyMotion | None = None  # the steady motion, if it does not repeat after every period

    @property
    def repeats(self) -> int:
        """Periods of the force after which the motion repeats, 0 if it does not."""
        return 1 if self.steady is None else self.steady.periods


def recorded_point(problem: OrbitProblem, z: FloatArray, direction: FloatArray, mark: int = 0) -> OrbitRecord:
    """The record of a point of a curve, with its direction and mark."""
    return replace(recorded(problem, z), direction=direction, mark=mark)


def recorded(problem: OrbitProblem, z: FloatArray) -> OrbitRecord:
    """The record of a solution without direction and mark, made once for each z.

    If it is requested when the curve reaches z, the period is still cached.
    """
    key = z.tobytes()
    if key not in problem.samples:
        problem.samples[key] = _record_of(_shot(problem, z), z, problem.options)
    return problem.samples[key]


def _record_of(shot: Shot, z: FloatArray, options: ShootingOptions = SHOOTING) -> OrbitRecord:
    """The record of a period that begins at z."""
    multipliers, found = shot.multipliers, shot.scanned
    return OrbitRecord(
        float(z[-1]), shot.state, shot.cycle.states, measure(shot.cycle, found.displaced),
        contact_loads([shot.cycle], found), multipliers, shot.residual,
        within_unit_circle(multipliers, options),
        z, np.zeros(z.size), held=_held_distances(shot), steady=multi_period_motion(shot),
    )  # fmt: skip


def _held_distances(shot: Shot) -> FloatArray:
    """Distances of held contacts from their slip limit or gap, and their greatest forces: (held, 3)."""
    least, greatest = (one.reshape(2, -1) for one in shot.scanned.part(shot.system.parts.held))
    return np.column_stack((shot.held_distances, greatest[0], np.maximum(greatest[1], -least[1])))


def _shot(problem: OrbitProblem, z: FloatArray) -> Shot:
    """The period from a point of a curve; SimulationError if it cannot be computed."""
    shot = problem.shot(z)
    if shot is None:
        raise SimulationError(
            f"the period at {spoken(z[-1], problem.scene.frequency_unit)} cannot be computed"
        )
    return shot


def recorded_steady(omega: float, motion: SteadyMotion) -> OrbitRecord:
    """The record of a steady motion that a simulation has reached."""
    none = np.zeros(0)
    return OrbitRecord(
        omega, motion.state, motion.states, motion.measure, motion.contact_loads, motion.multipliers,
        motion.error, True, none, none, steady=motion,
    )  # fmt: skip


def samples(problem: OrbitProblem, path: Path, located: bool = True) -> list[OrbitRecord]:
    """Records of the points of a path, with points added at changes of stability between folds.

    A fold belongs to its stable side, and so does a point at which stability changes.

    located : whether to add these points; locating them takes three times as long as the rest.
    """
    points = [
        recorded_point(problem, path.z[k], path.direction[k], int(path.mark[k]))
        for k in range(path.z.shape[0])
    ]
    turns = [k for k in range(1, len(points) - 1) if points[k].mark & Mark.FOLD]
    for k in turns:
        points[k] = replace(points[k], stable=points[k - 1].stable or points[k + 1].stable)
    if not located:
        return points
    whole, inside = with_windows(problem, path, points)
    for k in inside:
        points.insert(k, recorded_point(problem, whole.z[k], whole.direction[k]))
    return _with_crossings(problem, whole, points)


def _with_crossings(problem: OrbitProblem, path: Path, points: Sequence[OrbitRecord]) -> list[OrbitRecord]:
    """Records with a point at each change of stability, added or marked if it is at a point already."""
    out = list(points[:1])
    for k, point in enumerate(points[1:]):
        before = points[k]
        if before.stable != point.stable and not (before.mark | point.mark) & Mark.FOLD:
            place = crossing(problem, path, k)
            if place is not None and 0.0 < place.part < 1.0:
                out.append(recorded_point(problem, place.z, place.direction, Mark.CROSSING))
            elif place is not None and before.stable:
                out[-1] = replace(out[-1], mark=before.mark | Mark.CROSSING)
            elif place is not None:
                point = replace(point, mark=point.mark | Mark.CROSSING)
        out.append(point)
    return out
