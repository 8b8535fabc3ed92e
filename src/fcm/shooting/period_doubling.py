"""Curves of motions that repeat after twice as many periods, from where the period doubles.

Where a multiplier passes -1 a motion loses its stability to one of twice its periods. The curve of those
passes through the flip and comes back by the same motions, a period later: it is followed to there.
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
    """Problem of motions with twice the periods of others.

    A curve of them has ended where it comes to those.
    """

    def __init__(self, once: OrbitProblem) -> None:
        super().__init__(once.scene, 2 * once.repeats, once.options)
        self.once, self._way = once, np.zeros(0)

    def reset_flips(self) -> None:
        """Forget what flips were passed, before another curve is followed."""
        self._way = np.zeros(0)

    def has_passed_flip(self, z: FloatArray) -> bool:
        """Whether the curve has passed a flip since the last call.

        There what half the periods lack turns round.
        """
        shot = self.once.shot(z)
        if shot is None:
            return False
        before, self._way = self._way, shot.closure / shot.scale
        return shot.residual < self.options.doubling.closure_tolerance or bool(
            before.size and before @ self._way < 0.0
        )

    def half_period_later(self, z: FloatArray) -> FloatArray:
        """The unknowns of the same motion, begun after half of its periods."""
        shot = self.once.shot(z)
        return z if shot is None else z + np.append(shot.closure[self.free], 0.0)


def doubled_paths(
    problem: DoubledPeriodProblem,
    branches: list[list[OrbitRecord]],
    along: Follow,
    poll: Poll = never_interrupt,
) -> tuple[list[Path], int]:
    """The curves that begin at the flips of branches, and how many flips none was found from."""
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
    """The points of a curve, with the flips of others at which it ends within the range."""
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
    """The places k in a branch where stability changes between the points k and k + 1, but at no fold."""
    for k, (one, other) in enumerate(pairwise(points)):
        if one.stable != other.stable and not (one.mark | other.mark) & Mark.FOLD:
            yield k, bifurcation_of((other if one.stable else one).multipliers.tolist())


def flips(points: list[OrbitRecord]) -> Iterator[int]:
    """The places k in a branch where the period doubles."""
    return (k for k, kind in bifurcations(points) if kind is Bifurcation.PERIOD_DOUBLING)


def flip(points: list[OrbitRecord], k: int) -> OrbitRecord:
    """The point at a bifurcation, which belongs to the stable side."""
    return points[k] if points[k].stable else points[k + 1]


def doubled_starts(
    problem: DoubledPeriodProblem, branches: list[list[OrbitRecord]], poll: Poll = never_interrupt
) -> tuple[list[FloatArray], int]:
    """Motions of twice the periods beside the flips of branches, and how many flips lead to none."""
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
    """Motions of twice the periods at the frequencies of points beside a flip, the unstable ones first.

    Not at flips themselves, beside which a motion hardly changes that does not repeat. Where none is near an
    unstable motion, that which a disturbance of it comes to may be one.
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
    """Motions in the direction in which a disturbance changes its sign after each period."""
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
    """The motion that a simulation comes to from a disturbed motion."""
    x, system = _disturbed(once, problem.options.doubling.distances[0]), once.system
    found = steady(system, State(x[system.q], x[system.p], x[system.f]), poll, problem.options)
    if isinstance(found, SteadyMotion) and found.periods == problem.repeats:
        state = found.state
        x = np.concatenate((state.q, state.velocity, state.friction))
        yield from _repeating_solution(
            problem, point, Shot(system, x, problem.shooting.resting, problem.repeats)
        )


def _disturbed(once: Shot, reach: float) -> FloatArray:
    """Start of a motion, moved by reach, relative to it, along the disturbance that changes its sign."""
    values, vectors = np.linalg.eig(once.derivative * (once.scale / once.scale[:, None]))
    way = vectors[:, values.real.argmin()].real
    x: FloatArray = once.x + reach * way / np.abs(way).max() * once.scale
    return x


def _repeating_solution(
    problem: DoubledPeriodProblem, point: OrbitRecord, shot: Shot
) -> Iterator[FloatArray]:
    """The solution of the doubled problem that a motion gives, unless it repeats before."""
    if (
        Shot(shot.system, shot.x, periods=problem.once.repeats).residual
        < problem.options.doubling.closure_tolerance
    ):
        return
    newton = Newton(problem)
    if correct_at_frequency(newton, np.append(shot.x[problem.free], point.frequency)):
        yield np.array(newton.z)
