"""Points of a balance displaced to the curve of the balance with more harmonics."""

from __future__ import annotations

import numpy as np

from fcm.continuation.newton import Newton
from fcm.harmonic.between import Between
from fcm.harmonic.further import Further, padded
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

FURTHER = 8  # harmonics beyond those of the balance: those that would do most
LEAST = 0.01  # of what the first of them would do; what does less is not taken
COVERED = 0.98  # of what the best of them do, by which a set that is there already is good enough
FAR = 0.5  # a displacement of this part of the solution's size is not believed
TURNED = 0.7  # nor a curve that goes another way, by the cosine of the angle
LARGE = 0.05  # a change of an amplitude beyond which the corrected point is corrected once more
GRADUAL = (0.1, 0.25, 0.45, 0.7, 1.0)  # parts of the equations' change, where at once is too much


class Corrector:
    """Balances of a scene with more harmonics than those of a system.

    What changes an amplitude much is corrected twice, with harmonics that the corrected motion asks for: a
    branch of few harmonics may have a neighbour with some more and none with many.
    """

    def __init__(self, system: System, again: bool = True) -> None:
        self.system, self.again = system, again
        self.known: dict[tuple[int, ...], tuple[Newton, Between]] = {}
        self.second: dict[tuple[int, ...], tuple[Further, Corrector]] = {}

    def displaced(
        self, z: FloatArray, direction: FloatArray, share: FloatArray, amplitude: FloatArray
    ) -> FloatArray | None:
        """Frequency and amplitudes (1 + dof,) of the corrected curve in the plane normal to the curve at z.

        direction is that of the curve at z, amplitude (dof,) what it has there, share (harmonic,) what each
        harmonic left out would do. None if no harmonic does anything; NaN if the corrected curve is not
        found, or too far to be believed.
        """
        more = self.chosen(share)
        if more == self.system.harmonics:
            return None
        if more not in self.known:
            between = Between(self.system.with_harmonics(more).balance())
            self.known[more] = Newton(between), between
        newton, between = self.known[more]
        problem = between.inner
        guess = padded(z, self.system.harmonics, more)
        problem.measure(guess)
        row = padded(direction, self.system.harmonics, more) / problem.scale
        row /= np.sqrt(row @ row)
        newton.scale[:], newton.row[:] = problem.scale, row
        found = np.full(1 + problem.outputs, np.nan)
        if not _corrected(newton, between, guess) or np.asarray(newton.tangent) @ row < TURNED:
            return found
        problem.report(newton.z, np.zeros_like(guess))
        found[0], found[1:] = newton.z[-1], problem.output
        if self.again and np.abs(found[1:] - amplitude).max() > LARGE * amplitude.max():
            return self.twice(more, np.array(newton.z), np.asarray(newton.tangent) * newton.scale, found)
        return found

    def twice(
        self, more: tuple[int, ...], z: FloatArray, direction: FloatArray, found: FloatArray
    ) -> FloatArray:
        """A corrected point corrected."""
        if more not in self.second:
            system = self.system.with_harmonics(more)
            self.second[more] = Further(system), Corrector(system, again=False)
        further, corrector = self.second[more]
        force, _ = further.forces(z[None])
        share = further.shares(z[None], force, found[None, 1:])[0]
        again = corrector.displaced(z, direction, share, found[1:])
        return found if again is None else again

    def chosen(self, share: FloatArray) -> tuple[int, ...]:
        """The harmonics of the system and those that would do most."""
        order = np.argsort(-share)[:FURTHER]
        order = order[share[order] > LEAST * share[order[0]]]
        square = share * share
        enough = COVERED**2 * square[order].sum()
        for more in self.known:
            if square[np.array(more) - 1].sum() >= enough:
                return more
        return tuple(sorted({*self.system.harmonics, *(int(k) + 1 for k in order)}))


def _corrected(newton: Newton, between: Between, guess: FloatArray) -> bool:
    """Move a guess to the curve in the plane of the row: at once, or gradually."""
    between.taken = 0.0
    newton.z[:] = guess
    if newton.correct(1.0):
        return bool(newton.moved <= FAR)
    newton.z[:] = guess
    between.evaluate(guess)
    between.removed[:] = between.residual
    for part in GRADUAL:
        between.taken = 1.0 - part
        if not newton.correct(1.0) or newton.moved > FAR:
            return False
    far = (np.asarray(newton.z) - guess) / newton.scale
    return bool(np.sqrt(far @ far) <= FAR)
