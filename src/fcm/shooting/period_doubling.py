"""Curves of motions of doubled period, from the period doublings (flips) on.

Where a multiplier passes -1, a motion loses its stability to one of twice its period. The curve of these
motions passes through the flip and returns by the same motions, shifted by half their period. So it is
followed only up to the flip.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from fcm.continuation import Events, FollowOptions, Mark, Path
from fcm.continuation.all_branches import Follow, Following, branch_through, contains
from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray
from fcm.shooting.orbit_record import OrbitRecord
from fcm.shooting.periodic_orbit import Poll, converged, never_interrupt
from fcm.shooting.problem import OrbitProblem, correct_at_frequency
from fcm.shooting.residual import Shot
from fcm.shooting.steady_state import SteadyMotion, steady
from fcm.stability.classification import Bifurcation, bifurcation_of
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State


class DoubledPeriodProblem(OrbitProblem):
    """Problem of motions with twice the period of another problem, at whose motions their curves end."""

    def __init__(self, once: OrbitProblem) -> None:
        super().__init__(once.scene, 2 * once.repeats, once.options)
        self.once, self._way = once, np.zeros(0)

    def reset_flips(self) -> None:
        """Reset the detection of flips before another curve is followed."""
        self._way = np.zeros(0)

    def has_passed_flip(self, z: FloatArray) -> bool:
        """Whether the curve has passed a flip since the last call.

        At a flip the closure error after half the period changes its sign.
        """
        shot = self.once.shot(z)
        if shot is None:
            return False
        before, self._way = self._way, shot.closure / shot.scale
        return shot.residual < self.options.doubling.closure_tolerance or bool(
            before.size and before @ self._way < 0.0
        )

    def half_period_later(self, z: FloatArray) -> FloatArray:
        """The unknowns of the same motion, shifted by half its period."""
        shot = self.once.shot(z)
        return z if shot is None else z + np.append(shot.closure[self.free], 0.0)


def doubled_paths(
    problem: DoubledPeriodProblem,
    branches: list[list[OrbitRecord]],
    along: Follow,
    poll: Poll = never_interrupt,
) -> tuple[list[Path], int]:
    """The curves that begin at the flips of branches, and the number of flips without one."""
    starts, lost = doubled_starts(problem, branches, poll)
    span, options = problem.scene.frequency_range, FollowOptions(problem.scene.max_step)
    following = Following(options, along)
    wanted = Events(sorted({float(z[-1]) for z in starts}))
    paths = list[Path]()
    for z in starts:
        if not any(
            contains(path, one, problem) for path in paths for one in (z, problem.half_period_later(z))
        ):
            path = branch_through(lambda: problem, z, span, wanted, following)
            if path.z.shape[0]:
                paths.append(path)
            else:
                lost += 1
    return paths, lost


def to_flips(
    problem: DoubledPeriodProblem, points: list[OrbitRecord], branches: list[list[OrbitRecord]]
) -> list[OrbitRecord]:
    """The points of a curve, extended by the flips of other branches at which it ends within the range."""
    ends = [flip(branch, k) for branch in branches for k in flips(branch)]
    for end in (0, -1):
        last = points[end]
        problem.evaluate_scale(last.z)
        scale = np.array(problem.scale)
        near = [
            one
            for one in ends
            if np.linalg.norm((one.z - last.z) / scale) < problem.options.doubling.max_distance
        ]
        if near and last.frequency not in problem.scene.frequency_range:
            nearest = min(near, key=lambda one: float(np.linalg.norm((one.z - last.z) / scale)))
            points = [nearest, *points] if end == 0 else [*points, nearest]
    return points


def bifurcations(points: list[OrbitRecord]) -> Iterator[tuple[int, Bifurcation]]:
    """Yield the indices k where stability changes between points k and k + 1, but not at a fold."""
    for k, (one, other) in enumerate(pairwise(points)):
        if one.stable != other.stable and not (one.mark | other.mark) & Mark.FOLD:
            yield k, bifurcation_of((other if one.stable else one).multipliers.tolist())


def flips(points: list[OrbitRecord]) -> Iterator[int]:
    """Yield the indices k of `bifurcations` at which the period doubles."""
    return (k for k, kind in bifurcations(points) if kind is Bifurcation.PERIOD_DOUBLING)


def flip(points: list[OrbitRecord], k: int) -> OrbitRecord:
    """The point at a bifurcation, which belongs to the stable side."""
    return points[k] if points[k].stable else points[k + 1]


def doubled_starts(
    problem: DoubledPeriodProblem, branches: list[list[OrbitRecord]], poll: Poll = never_interrupt
) -> tuple[list[FloatArray], int]:
    """Motions of doubled period near the flips of branches, and the number of flips without one."""
    found, lost = list[FloatArray](), 0
    for points in branches:
        for k in flips(points):
            z = next(_near_flip(problem, points, k, poll), None)
            if z is None:
                lost += 1
            else:
                found.append(z)
    return found, lost


def _near_flip(
    problem: DoubledPeriodProblem, points: list[OrbitRecord], k: int, poll: Poll
) -> Iterator[FloatArray]:
    """Yield motions of doubled period at the frequencies of points near a flip, unstable points first.

    Flips themselves are left out: close to one, the two motions hardly differ. If Newton's method finds none,
    the motion that a disturbed unstable motion approaches may be one.
    """
    ends = [id(flip(points, j)) for j in flips(points)]
    after, before = (
        points[k + 1 : k + 1 + problem.options.doubling.max_points],
        points[k : max(k - problem.options.doubling.max_points, -1) : -1],
    )
    sides = (after, before) if points[k].stable else (before, after)
    near = [point for side in sides for point in side if id(point) not in ends]
    for point in near:
        poll()
        shot = problem.once.shot(point.z)
        if shot is not None:
            yield from _doubled(problem, point, shot)
    for point in near[:1]:
        shot = problem.once.shot(point.z)
        if shot is not None:
            yield from _approached(problem, point, shot, poll)


def _doubled(problem: DoubledPeriodProblem, point: OrbitRecord, once: Shot) -> Iterator[FloatArray]:
    """Yield motions found in the direction of the disturbance that changes its sign after each period."""
    for reach in problem.options.doubling.distances:
        try:
            guess = Shot(once.system, _disturbed(once, reach), problem.shooting.resting, problem.repeats)
            found = converged(guess, options=problem.options)
        except SimulationError:
            continue
        if found is not None:
            yield from _repeating_solution(problem, point, found[0])


def _approached(
    problem: DoubledPeriodProblem, point: OrbitRecord, once: Shot, poll: Poll
) -> Iterator[FloatArray]:
    """Yield the motion that a simulation from a disturbed motion approaches."""
    x, system = _disturbed(once, problem.options.doubling.distances[0]), once.system
    found = steady(system, State(x[system.q], x[system.p], x[system.f]), poll, problem.options)
    if isinstance(found, SteadyMotion) and found.periods == problem.repeats:
        state = found.state
        x = np.concatenate((state.q, state.velocity, state.friction))
        yield from _repeating_solution(
            problem, point, Shot(system, x, problem.shooting.resting, problem.repeats)
        )


def _disturbed(once: Shot, reach: float) -> FloatArray:
    """The start of a motion, moved along the disturbance that changes its sign; reach is relative to it."""
    values, vectors = np.linalg.eig(once.derivative * (once.scale / once.scale[:, None]))
    way = vectors[:, values.real.argmin()].real
    x: FloatArray = once.x + reach * way / np.abs(way).max() * once.scale
    return x


def _repeating_solution(
    problem: DoubledPeriodProblem, point: OrbitRecord, shot: Shot
) -> Iterator[FloatArray]:
    """Yield the solution of the doubled problem for a motion, unless it repeats after half the period."""
    if (
        Shot(shot.system, shot.x, periods=problem.once.repeats).residual
        < problem.options.doubling.closure_tolerance
    ):
        return
    newton = Newton(problem)
    if correct_at_frequency(newton, np.append(shot.x[problem.free], point.frequency)):
        yield np.array(newton.z)
