"""Motions found by raising the level of the forces from rest, with the exact motion itself.

At the frequencies at which a balance follows it (`fcm.harmonic.start`), the level is followed from nearly
nothing, where the motion is linear, until it is well beyond where that of a few harmonics comes back to 1.
Every passing of the level 1 is a motion, and an exact one straight away. From motions that are known there
and that this curve does not pass it is followed as well, both ways. Where it turns short of 1 the window of
several motions may be at other frequencies (`fcm.harmonic.turned`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fcm.continuation import Path, Status, all_branches, follow
from fcm.continuation.branches import Follow
from fcm.continuation.newton import Newton
from fcm.orbit.harmonic import FEW
from fcm.orbit.held import held
from fcm.orbit.level import AtLevel, LevelProblem
from fcm.orbit.linear_motion import about_rest
from fcm.orbit.periodic import Look, within_unit_circle
from fcm.scene.model import FloatArray, Scene

if TYPE_CHECKING:
    from fcm.harmonic.system import System
    from fcm.harmonic.turned import Turn

Known = Callable[[float], Sequence[FloatArray]]

STEP = 0.2  # longest, along the curve of a level,
SHORTER = 0.25  # and of that, where the curve has stalled
BELOW = 0.5  # part of the level up to which contacts are linear, down to which others are followed


@dataclass(frozen=True)
class Raised:
    """The motions (unknown + 1,) that the level leads to from a frequency [rad/s], the frequency last, and
    whether it was followed to its end."""

    omega: float
    motions: tuple[FloatArray, ...]
    complete: bool


def raised(scene: Scene, known: Known, look: Look) -> Iterator[Raised]:
    """What the level leads to from each frequency at which it is followed.

    known : the motions (unknown + 1,) that are known at a frequency. look : called now and then.
    """
    from fcm.harmonic.start import looked_at
    from fcm.harmonic.system import System

    whole = scene.whole()
    if not (whole.modal.frequency.all() and whole.contacts):
        return
    one = System(whole, (1,))
    one.work.look = look
    for omega in looked_at(one):
        yield raised_at(scene, one, omega, known(omega), look)


def raised_at(scene: Scene, one: System, omega: float, known: Sequence[FloatArray], look: Look) -> Raised:
    """The same at one frequency; one is the balance of one harmonic."""
    from fcm.harmonic.linear_contacts import least
    from fcm.harmonic.start import BEFORE, WEAK
    from fcm.harmonic.turned import turns_of

    linear, top = BEFORE * least(one, omega), _top(one, omega)
    if linear >= top:
        return Raised(omega, (), True)
    linear, problem = min(linear, 1.0), LevelProblem(scene, omega)
    span, along = (BELOW * max(linear, WEAK[0]), top), partial(follow, watch=lambda _: look())
    rest = _from_rest(problem, linear, span, along)
    if rest is None:
        return Raised(omega, (), False)
    there = [np.append(z[:-1], 1.0) for z in known]
    curves = all_branches(lambda: problem, there, span, STEP, None, along, rest)
    passed = [np.append(z[:-1], omega) for path in curves.paths for z in path.z[path.parameter == 1.0]]
    turns = [turn for path in curves.paths for turn in turns_of(path, omega)]
    return Raised(omega, (*passed, *_beside(scene, turns, look)), curves.status is Status.COMPLETE)


def _from_rest(
    problem: LevelProblem, linear: float, span: tuple[float, float], along: Follow
) -> tuple[Path] | None:
    """The curve from where contacts are linear to the end of the span; None if it cannot be followed."""
    for step in (STEP, SHORTER * STEP):
        for z in _begun(problem, linear):
            path = along(problem, z, (0.0, span[1]), True, step, (1.0,))
            if path.status is Status.COMPLETE and path.parameter[-1] == span[1]:
                return (path,)
    return None


def _beside(scene: Scene, turns: Sequence[Turn], look: Look) -> Iterator[FloatArray]:
    """Stable motions (unknown + 1,) beside turns short of the level 1, at frequencies within the range."""
    from fcm.harmonic.turned import beside, came

    problem, (low, high) = AtLevel(scene), scene.frequency_range
    newton = Newton(problem)
    for turn in turns:
        look()
        if turn.may_come and came(problem, newton, turn):
            for z in (one for one in beside(newton) if low <= one[-1] <= high):
                shot = problem.shot(z)
                if shot is not None and within_unit_circle(shot.multipliers):
                    yield z


def _begun(problem: LevelProblem, linear: float) -> Iterator[FloatArray]:
    """The motions (unknown + 1,) at levels at which contacts are linear, or nearly so."""
    from fcm.harmonic.start import WEAK

    newton = Newton(problem)
    for level in dict.fromkeys(max(weak, linear) for weak in WEAK):
        for state in about_rest(problem.scene, problem.omega, level):
            z = np.append(problem.shooting.unknowns(state), level)
            if held(newton, z):
                yield np.array(newton.z)
                break


def _top(one: System, omega: float) -> float:
    """Up to which level the curve is followed: as that of a few harmonics comes back."""
    from fcm.harmonic.linear_contacts import highest
    from fcm.harmonic.start import FURTHER, NEAR, solutions

    reach = solutions(one.with_harmonics(FEW), omega).reach
    return min(highest(one, omega), reach if np.isfinite(reach) else FURTHER * NEAR)
