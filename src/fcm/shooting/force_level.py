"""Motions found by raising the level of the forces from rest, with the exact motion itself.

At the frequencies at which a balance follows it (`branches.force_level`), the level is followed from nearly
nothing, where the motion is linear, until it is well beyond where that of a few harmonics comes back to 1.
Every passing of the level 1 is a motion, and an exact one straight away. From motions that are known there
and that this curve does not pass, or where it stalls does not come to, it is followed as well, both ways.
Where it turns back below 1 the window of several motions may be at other frequencies (`level_turns`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.continuation import Checkpoint, Events, FollowOptions, Path, Status, all_branches, follow
from fcm.continuation.all_branches import Follow
from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.fixed_frequency import correct_at_frequency
from fcm.shooting.force_level_problem import AtLevel, LevelProblem
from fcm.shooting.linear_orbits import about_rest
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic import Poll, within_unit_circle
from fcm.shooting.work_budget import Bounded

if TYPE_CHECKING:
    from fcm.branches.level_turns import Turn
    from fcm.harmonic_balance.system import System

Known = Callable[[float], Sequence[FloatArray]]


@dataclass(frozen=True)
class Raised:
    """The motions (unknown + 1,) that the level leads to from a frequency [rad/s], the frequency last, and
    whether it was followed to its end; if not, whether because the time for that was over."""

    omega: float
    motions: tuple[FloatArray, ...]
    complete: bool
    over: bool = False


def raised(scene: Scene, known: Known, bounded: Bounded) -> Iterator[Raised]:
    """What the level leads to from each frequency at which it is followed, in an equal share of the time; and
    once more, to the end, where that was too short and others leave more than it.

    known : the motions (unknown + 1,) that are known at a frequency.
    """
    from fcm.branches.force_level import looked_at
    from fcm.harmonic_balance.system import System

    whole = scene.whole()
    if not (whole.modal.frequency.all() and whole.contacts):
        return
    one = System(whole, (1,))
    one.work.poll = bounded.poll
    waiting = [(omega, 0.0) for omega in looked_at(one)]
    while waiting:
        (omega, before), *waiting = waiting
        if (share := bounded.share(1 + len(waiting))) > before:
            found = raised_at(scene, one, omega, known(omega), bounded.poll, bounded.options)
            waiting += [(omega, share)] * found.over
            yield found


def raised_at(
    scene: Scene,
    one: System,
    omega: float,
    known: Sequence[FloatArray],
    poll: Poll,
    options: ShootingOptions = SHOOTING,
) -> Raised:
    """The same at one frequency; one is the balance of one harmonic. What was found is there, too, where look
    raises `TooLongError`."""
    from fcm.harmonic_balance.work_budget import TooLongError

    found = list[FloatArray]()
    try:
        complete = _followed(LevelProblem(scene, omega, options), one, known, poll, found)
    except TooLongError:
        return Raised(omega, tuple(found), False, over=True)
    return Raised(omega, tuple(found), complete)


def _followed(
    problem: LevelProblem, one: System, known: Sequence[FloatArray], poll: Poll, found: list[FloatArray]
) -> bool:
    """Whether the level was followed to its end; what it leads to is added to what is found."""
    from fcm.branches.level_turns import turns_of
    from fcm.branches.linear_limits import least
    from fcm.branches.options import LEVEL_CURVE

    omega, options = problem.omega, problem.options

    def passes(path: Path) -> None:
        found.extend(np.append(z[:-1], omega) for z in path.z[path.parameter == 1.0])

    linear, top = LEVEL_CURVE.before * least(one, omega), _top(one, omega, options)
    if linear >= top:
        return True
    linear, along = min(linear, 1.0), _Along(poll, passes)
    span = options.level.linear * max(linear, LEVEL_CURVE.weak[0]), top
    rest = _from_rest(problem, linear, span, along)
    if rest is None:
        return False
    there = [np.append(z[:-1], 1.0) for z in known]
    curves = all_branches(lambda: problem, there, span, FollowOptions(options.level.step), None, along, rest)
    turns = [turn for path in curves.paths for turn in turns_of(path, omega)]
    found.extend(_at_turns(problem.scene, turns, poll, options))
    return curves.status is Status.COMPLETE


@dataclass(frozen=True)
class _Along:
    """As `follow`; passes is told of the path also where poll raises `TooLongError`."""

    poll: Poll
    passes: Callable[[Path], None]

    def __call__(self, *given: Any, **options: Any) -> Path:
        from fcm.harmonic_balance.work_budget import TooLongError

        checkpoints = list[Checkpoint]()

        def watch(checkpoint: Checkpoint) -> None:
            checkpoints[:] = [checkpoint]
            self.poll()

        try:
            path = follow(*given, **options, watch=watch)
        except TooLongError:
            for checkpoint in checkpoints:
                self.passes(checkpoint.path(Status.INTERRUPTED))
            raise
        self.passes(path)
        return path


def _from_rest(
    problem: LevelProblem, linear: float, span: tuple[float, float], along: Follow
) -> tuple[Path] | None:
    """The curve from where contacts are linear to the end of the span; None if it cannot be followed.

    One that stalls is as far as it goes: from there on it would not be followed by other steps either.
    """
    options = problem.options.level
    for step in (options.step, options.shorter * options.step):
        for z in _begun(problem, linear):
            path = along(problem, z, (0.0, span[1]), Events((1.0,)), FollowOptions(step), forward=True)
            whole = path.status is Status.COMPLETE and path.parameter[-1] == span[1]
            if whole or (path.status is Status.STALLED and path.z.shape[0]):
                return (path,)
    return None


def _at_turns(
    scene: Scene, turns: Sequence[Turn], poll: Poll, options: ShootingOptions = SHOOTING
) -> Iterator[FloatArray]:
    """Stable motions (unknown + 1,) beside turns below the level 1, at frequencies within the range."""
    from fcm.branches.level_turns import beside, came

    problem, (low, high) = AtLevel(scene, options=options), scene.frequency_range
    newton = Newton(problem)
    for turn in turns:
        poll()
        if turn.may_come and came(problem, newton, turn):
            for z in (one for one in beside(newton) if low <= one[-1] <= high):
                shot = problem.shot(z)
                if shot is not None and within_unit_circle(shot.multipliers, options):
                    yield z


def _begun(problem: LevelProblem, linear: float) -> Iterator[FloatArray]:
    """The motions (unknown + 1,) at levels at which contacts are linear, or nearly so."""
    from fcm.branches.options import LEVEL_CURVE

    newton = Newton(problem)
    for level in dict.fromkeys(max(weak, linear) for weak in LEVEL_CURVE.weak):
        for state in about_rest(problem.scene, problem.omega, level):
            z = np.append(problem.shooting.unknowns(state), level)
            if correct_at_frequency(newton, z):
                yield np.array(newton.z)
                break


def _top(one: System, omega: float, options: ShootingOptions = SHOOTING) -> float:
    """Up to which level the curve is followed: as that of a few harmonics comes back."""
    from fcm.branches.force_level import solutions
    from fcm.branches.linear_limits import highest
    from fcm.branches.options import LEVEL_CURVE

    reach = solutions(one.with_harmonics(options.balance.few), omega).reach
    return min(highest(one, omega), reach if np.isfinite(reach) else LEVEL_CURVE.further * LEVEL_CURVE.near)
