"""Branches of the exact motion beside others: what all branches of the balance over the range lead to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.continuation import Path
from fcm.continuation.branches import SAME
from fcm.continuation.newton import Newton
from fcm.motion.state import State
from fcm.orbit.harmonic import MANY, computed_state
from fcm.orbit.held import held
from fcm.orbit.periodic import Look
from fcm.orbit.problem import OrbitProblem
from fcm.scene.model import FloatArray, Scene

if TYPE_CHECKING:
    from fcm.harmonic.choice import Outline

SOME = (1, 2, 3, 4, 5)  # harmonics: with three a closed branch may be as far off as another one is
Place = tuple[float, State]  # frequency [rad/s], and a guess there


def passes(path: Path, z: FloatArray, problem: OrbitProblem) -> bool:
    """Whether a path passes the motion z, which need not be one of its points."""
    before, after = path.z[:-1], path.z[1:]
    rise, ahead = after[:, -1] - before[:, -1], z[-1] - before[:, -1]
    across = np.flatnonzero(ahead * (z[-1] - after[:, -1]) <= 0.0)
    if not across.size:
        return False
    problem.measure(z)
    scale, newton = np.array(problem.scale), Newton(problem)
    share = np.divide(ahead, rise, out=np.zeros_like(rise), where=rise != 0.0)[across, None]
    guesses = before[across] + share * (after[across] - before[across])
    width = np.linalg.norm((after[across] - before[across]) / scale, axis=1)
    off = np.linalg.norm((guesses - z) / scale, axis=1)
    return any(_leads_to(newton, guess, z, scale) for guess in guesses[off <= width + SAME])


def _leads_to(newton: Newton, guess: FloatArray, z: FloatArray, scale: FloatArray) -> bool:
    """Whether Newton's method leads from a guess to the motion z, at its frequency."""
    there = held(newton, np.append(guess[:-1], z[-1]))
    return there and bool(np.linalg.norm((np.asarray(newton.z) - z) / scale) < SAME)


def states_along(scene: Scene, look: Look) -> Iterator[list[Place]]:
    """Guesses beside each top of each branch of the balance, the nearest to the top first."""
    from fcm.harmonic.beside import around, tops

    found, harmonics = _balanced(scene, look)
    for path, shown in zip(found.traced.branches.paths, found.shown, strict=True):
        for top, even in tops(path, shown.amplitude):
            places = around(even, top)
            yield [(float(path.z[i, -1]), computed_state(scene, harmonics, path.z[i])) for i in places]


def states_across(scene: Scene, frequencies: Sequence[float], look: Look) -> dict[float, list[State]]:
    """Guesses where branches of the balance pass frequencies [rad/s] that are within the scene's range."""
    from fcm.harmonic.rest import RestError

    whole, (low, high) = scene.whole(), scene.frequency_range
    inside = [omega for omega in frequencies if low <= omega <= high]  # none where there is no range
    if not (inside and whole.contacts and whole.modal.frequency.all()):
        return {}
    try:
        found, harmonics = _balanced(scene, look)
    except RestError:
        return {}
    return {
        omega: [computed_state(scene, harmonics, z) for z in _crossings(found.traced.branches.paths, omega)]
        for omega in inside
    }


def _crossings(paths: Sequence[Path], omega: float) -> Iterator[FloatArray]:
    """Places of paths at a frequency, between their points."""
    for path in paths:
        before, after = path.z[:-1], path.z[1:]
        ahead, rise = omega - before[:, -1], after[:, -1] - before[:, -1]
        for k in np.flatnonzero(ahead * (omega - after[:, -1]) <= 0.0):
            share = ahead[k] / rise[k] if rise[k] else 0.0
            yield np.append((before[k] + share * (after[k] - before[k]))[:-1], omega)


def _balanced(scene: Scene, look: Look) -> tuple[Outline, tuple[int, ...]]:
    """The branches of the balance over the range, and its harmonics."""
    from fcm.harmonic.choice import outlined
    from fcm.harmonic.system import System as Balanced

    whole = scene.whole()
    harmonics = SOME if len(whole.contacts) < MANY else SOME[:1]
    balanced = Balanced(whole, harmonics)
    balanced.work.look = look
    return outlined(balanced), harmonics
