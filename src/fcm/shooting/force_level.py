"""Exact motions found by continuation in the level of the forces, from rest.

The level is the parameter at the frequencies that a balance uses for this (`branches.force_level`). Each
curve goes from nearly 0, where the motion is linear, to well beyond the last crossing of level 1 by the
balance of a few harmonics. Every crossing of level 1 is an exact motion. Curves are also followed, in both
directions, from known motions that this curve does not pass, or does not reach because it stalls. Where a
curve turns back below level 1, several motions may exist at other frequencies (`level_folds`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.continuation import Checkpoint, Events, FollowOptions, Path, Status, all_branches, follow
from fcm.continuation.all_branches import Follow, Following
from fcm.continuation.corrector import Newton
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.linear_orbits import about_rest
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Poll, within_unit_circle
from fcm.shooting.problem import OrbitProblem, correct_at_frequency
from fcm.shooting.residual import Shot
from fcm.shooting.work_budget import BranchBudget
from fcm.time_domain.errors import SimulationError

if TYPE_CHECKING:
    from fcm.branches.level_folds import LevelFold
    from fcm.harmonic_balance.system import System


class ForceLevelShooting(OrbitProblem):
    """The closure of one period at a fixed omega [rad/s]; z = (q, q', f, level) at the forces' angle 0."""

    def __init__(self, scene: Scene, omega: float, options: ShootingOptions = SHOOTING) -> None:
        super().__init__(scene, options=options)
        self.omega = omega

    def _made(self, z: FloatArray) -> Shot | None:
        self.periods += 1
        try:
            return self.shooting.residual(z[:-1], self.omega, float(z[-1]), by_level=True)
        except SimulationError:
            return None

    def evaluate_scale(self, z: FloatArray) -> int:
        """Fill the units at z, see `OrbitProblem.evaluate_scale`; the level is its own unit."""
        super().evaluate_scale(z)
        self._scale[-1] = max(abs(float(z[-1])), self.options.level.level_floor)
        return 0

    def evaluate_outputs(self, z: FloatArray, direction: FloatArray) -> int:
        """Report no amplitudes: only crossings of level 1 matter."""
        return 0


class FrequencyShooting(OrbitProblem):
    """The closure of one period, z = (q, q', f, omega), with all harmonic forces times `load`."""

    @property
    def load(self) -> float:
        """The level of the forces."""
        return self._load

    @load.setter
    def load(self, level: float) -> None:
        self._load = level
        self.forget()

    def _made(self, z: FloatArray) -> Shot | None:
        self.periods += 1
        try:
            return self.shooting.residual(z[:-1], float(z[-1]), self._load)
        except SimulationError:
            return None


Known = Callable[[float], Sequence[FloatArray]]
Find = Callable[..., "LevelMotions"]


class LevelMotions(Frozen):
    """Motions (unknown + 1,), with their frequency last, found by continuation in the level at omega.

    omega: the frequency [rad/s] of the continuation. complete: whether the curve was followed to its end.
    out_of_time: whether it was not because its time was over.
    """

    omega: float
    motions: tuple[FloatArray, ...]
    complete: bool
    out_of_time: bool = False


def level_motions(
    scene: Scene, known: Known, bounded: BranchBudget, find: Find | None = None
) -> Iterator[LevelMotions]:
    """Yield the motions found by continuation in the level at each of several frequencies.

    Each frequency has an equal share of the time. Where that was too short, and the others leave a larger
    share, the continuation is repeated.

    known : gives the known motions (unknown + 1,) at a frequency. find : replaces `level_motions_at`.
    """
    from fcm.branches.force_level import level_frequencies
    from fcm.harmonic_balance.system import System

    whole = scene.whole()
    if not (whole.modal.frequency.all() and whole.contacts):
        return
    one = System(whole, (1,), other_options=bounded.options.balance.others)
    one.work.poll = bounded.poll
    waiting = [(omega, 0.0) for omega in level_frequencies(one)]
    while waiting:
        (omega, before), *waiting = waiting
        if (share := bounded.share(1 + len(waiting))) > before:
            found = (find or level_motions_at)(scene, one, omega, known(omega), bounded)
            waiting += [(omega, share)] * found.out_of_time
            yield found


def level_motions_at(
    scene: Scene,
    one: System,
    omega: float,
    known: Sequence[FloatArray],
    bounded: BranchBudget,
    along: Follow = follow,
) -> LevelMotions:
    """Motions found by continuation in the level at one frequency; one is the system of one harmonic.

    If the poll of bounded raises `WorkLimitError`, the motions found so far are returned. Curves are followed
    by `along`.
    """
    from fcm.harmonic_balance.work_budget import WorkLimitError

    found = list[FloatArray]()
    try:
        complete = _followed(
            ForceLevelShooting(scene, omega, bounded.options), one, known, bounded.poll, found, along
        )
    except WorkLimitError:
        return LevelMotions(omega, tuple(found), False, out_of_time=True)
    return LevelMotions(omega, tuple(found), complete)


def _followed(
    problem: ForceLevelShooting,
    one: System,
    known: Sequence[FloatArray],
    poll: Poll,
    found: list[FloatArray],
    follow: Follow,
) -> bool:
    """Follow the curves in the level and add their motions to found; return whether they are complete."""
    from fcm.branches.level_folds import level_folds
    from fcm.branches.linear_limits import lowest_linear_limit
    from fcm.branches.options import LEVEL_CURVE

    omega, options = problem.omega, problem.options

    def passes(path: Path) -> None:
        found.extend(np.append(z[:-1], omega) for z in path.z[path.parameter == 1.0])

    linear, top = (
        LEVEL_CURVE.linear_fraction * lowest_linear_limit(one, omega),
        _highest_level(one, omega, options),
    )
    if linear >= top:
        return True
    linear, along = min(linear, 1.0), _InterruptibleFollow(poll, passes, follow)
    span = options.level.linear_fraction * max(linear, LEVEL_CURVE.linear_levels[0]), top
    rest = _from_rest(problem, linear, span, along)
    if rest is None:
        return False
    there = [np.append(z[:-1], 1.0) for z in known]
    following = Following(FollowOptions(options.level.max_step), along)
    curves = all_branches(lambda: problem, there, span, following, rest)
    turns = [turn for path in curves.paths for turn in level_folds(path, omega)]
    found.extend(_beyond_level_folds(problem.scene, turns, poll, options))
    return curves.status is Status.COMPLETE


class _InterruptibleFollow(Frozen):
    """Follows a curve by `follow`, and gives its path to passes even if poll raises `WorkLimitError`."""

    poll: Poll
    passes: Callable[[Path], None]
    follow: Follow

    def __call__(self, *given: Any, **options: Any) -> Path:
        from fcm.harmonic_balance.work_budget import WorkLimitError

        checkpoints = list[Checkpoint]()

        def watch(checkpoint: Checkpoint) -> None:
            checkpoints[:] = [checkpoint]
            self.poll()

        try:
            path = self.follow(*given, **options, watch=watch)
        except WorkLimitError:
            for checkpoint in checkpoints:
                self.passes(checkpoint.path(Status.INTERRUPTED))
            raise
        self.passes(path)
        return path


def _from_rest(
    problem: ForceLevelShooting, linear: float, span: tuple[float, float], along: Follow
) -> tuple[Path] | None:
    """The curve from where contacts are linear to the end of the span; None if it cannot be followed.

    A curve that stalls is returned as far as it goes: other steps would not follow it further.
    """
    options = problem.options.level
    for step in (options.max_step, options.retry_fraction * options.max_step):
        for z in _linear_starts(problem, linear):
            path = along(problem, z, (0.0, span[1]), Events((1.0,)), FollowOptions(step), forward=True)
            whole = path.status is Status.COMPLETE and path.parameter[-1] == span[1]
            if whole or (path.status is Status.STALLED and path.z.shape[0]):
                return (path,)
    return None


def _beyond_level_folds(
    scene: Scene, turns: Sequence[LevelFold], poll: Poll, options: ShootingOptions = SHOOTING
) -> Iterator[FloatArray]:
    """Yield stable motions (unknown + 1,) near folds of the level below 1, at frequencies in the range."""
    from fcm.branches.level_folds import reaches_level_one, solutions_past_fold

    problem, (low, high) = FrequencyShooting(scene, options=options), scene.frequency_range
    newton = Newton(problem)
    for turn in turns:
        poll()
        if turn.may_reach_level_one and reaches_level_one(problem, newton, turn):
            for z in (one for one in solutions_past_fold(newton) if low <= one[-1] <= high):
                shot = problem.shot(z)
                if shot is not None and within_unit_circle(shot.multipliers, options):
                    yield z


def _linear_starts(problem: ForceLevelShooting, linear: float) -> Iterator[FloatArray]:
    """Yield motions (unknown + 1,) at levels at which contacts are linear, or nearly so."""
    from fcm.branches.options import LEVEL_CURVE

    newton = Newton(problem)
    for level in dict.fromkeys(max(weak, linear) for weak in LEVEL_CURVE.linear_levels):
        for state in about_rest(problem.scene, problem.omega, level):
            z = np.append(problem.shooting.unknowns(state), level)
            if correct_at_frequency(newton, z):
                yield np.array(newton.z)
                break


def _highest_level(one: System, omega: float, options: ShootingOptions = SHOOTING) -> float:
    """Level up to which the curve is followed, from that of the balance with a few harmonics."""
    from fcm.branches.force_level import solutions
    from fcm.branches.linear_limits import highest_linear_limit
    from fcm.branches.options import LEVEL_CURVE

    highest = solutions(one.with_harmonics(options.balance.guess_harmonics), omega).max_level
    return min(
        highest_linear_limit(one, omega),
        highest if np.isfinite(highest) else LEVEL_CURVE.reach_factor * LEVEL_CURVE.clear_level,
    )
