"""Newton's method for a point of a curve: the corrector.

The point is sought in the plane through the guess whose normal is the row that closes the equations, see
`bordered`. A row along the curve gives the next point; a row along the parameter holds that.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import sqrt

from fcm.continuation.bordered import Bordered
from fcm.continuation.problem import Problem

if cython.compiled:
    from cython.cimports.fcm.continuation.bordered import FAR, ROUNDINGS
else:
    from fcm.continuation.bordered import FAR, ROUNDINGS

ITERATIONS = cython.declare(cython.int, 8)  # Newton steps before a guess is judged too far away
CLOSE = cython.declare(cython.double, 1e-13)  # `close` where nothing else is said
SMALL = cython.declare(cython.double, 1e-12)  # a step after which there is no further one
EXACT = cython.declare(cython.double, 1e-11)  # a step that is not worth another evaluation
ROUGH = cython.declare(cython.double, 1e-9)  # and one that does not shrink, though the way was long
LEFT = cython.declare(cython.double, 1e-10)  # and one that grows: longer ones have met a corner
CHORD = cython.declare(cython.double, 1e-6)  # a step after which the Jacobian from before it will do
HOPELESS = cython.declare(cython.double, 0.5)  # of the step before, from the fourth on, where each is dear
# of the most: a second step this short is no sign of failure. Of very unstable motions, and across a corner
# close by, it may be as long as the first, and those after it shrink
SLIGHT = cython.declare(cython.double, 0.02)
CHORDS = cython.declare(cython.int, 3)  # steps with that Jacobian
KEPT = cython.declare(cython.int, 16)  # the same where to solve takes far less than to factor,
SHRINKING = cython.declare(cython.double, 0.3)  # and each is at most this part of the one before
# a step after which a last one takes the Jacobian from before it, and the direction is that from there
SHORT = cython.declare(cython.double, 1e-5)
COARSEST = cython.declare(cython.double, 1e-6)  # a longer step is none that rounding makes


@cython.cclass
class Newton(Bordered):
    """Fill z, scale and row; `correct` moves z to the curve and leaves its tangent and orientation.

    close: the error that a point may have, estimated from the convergence.
    """

    def __init__(self, problem: Problem) -> None:
        Bordered.__init__(self, problem)
        self.close = CLOSE
        self.unsure = 0.0  # length of the last step of `correct`, if rounding made it

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def correct(self, reach: cython.double, most: cython.double = FAR) -> cython.bint:
        """Whether z came to the curve; moved is then how far, and tangent and orientation are those there.

        reach is the length, in scaled coordinates, that stands before the first step. Where that is longer
        than the most, or the second neither slight nor half as long, it is given up; moved is then the first.
        Converged is what is close, for convergence of the order 1.5, that of a force whose
        slope changes as a root.
        """
        count: cython.int
        step: cython.double
        ratio: cython.double
        before: cython.double = reach
        i: cython.Py_ssize_t
        for i in range(self.z.shape[0]):  # a copy of all at once takes ten times as long
            self.guess[i] = self.z[i]
        self.unsure = 0.0
        for count in range(ITERATIONS):
            if not self.factor():
                return False
            step = self.step()
            if most < FAR and self.too_far(step, before, most, count):
                return False
            if self.problem.soft and self.settled(step, step / before, count):
                return self.direct()
            noise: cython.bint = count > 0 and step > 0.25 * before and self.noise(step, count)
            worse: cython.double = HOPELESS if self.problem.soft or self.problem.dear else 2.0
            if not step < FAR or (count > 2 and step > worse * before and not noise):
                return False
            _move(self)
            ratio = step / before
            # the first step says nothing of the convergence yet; that to a corner that is not seen never
            if self.problem.soft:
                if count > 0 and step * ratio < CHORD and self.chords(step):
                    return self.direct()
                before = step
                continue
            if (count > 0 and step * ratio * sqrt(ratio) < self.close) or step < SMALL:
                return self.direct()
            if noise:
                self.unsure = step
                return self.direct()
            # the Jacobian hardly changes along a step that is shorter than the square of the one before
            steady: cython.bint = count > 0 and (self.problem.dear or step < before * before)
            if steady and step < SHORT and _again(self, step):
                return self.direct()
            before = step
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def too_far(
        self, step: cython.double, before: cython.double, most: cython.double, count: cython.int
    ) -> cython.bint:
        """Whether the first step is longer than the most, or the second neither slight nor half as long."""
        if count == 0:
            self.moved = step
            return not step < most
        if count == 1:  # of short steps the first may be rounding, in a stiff direction
            return not step < max(0.5 * before, SLIGHT * most)
        return not step < FAR

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def noise(self, step: cython.double, count: cython.int) -> cython.bint:
        """Whether a step that has not shrunk is one that rounding makes.

        Of what the equations lose to cancellation within them their derivatives know nothing.
        """
        if self.problem.soft:
            return False
        return (count > 2 and step < ROUGH) or (step < COARSEST and step < ROUNDINGS * self.rounding())

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def settled(self, step: cython.double, ratio: cython.double, count: cython.int) -> cython.bint:
        """Whether z, from which a step would lead on, is as near to the curve as rounding lets it be.

        Of the steps that rounding makes the next one may be longer.
        """
        if step < EXACT and ratio < 1.0:
            return True
        return count > 0 and ratio > 0.25 and step < (ROUGH if ratio < 1.0 else LEFT)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def chords(self, before: cython.double) -> cython.bint:
        """Whether z, to which a step has led, is on the curve; else it is moved on with the same Jacobian."""
        return _chords(self, before, CHORDS, 0.1)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def look(self) -> cython.bint:
        """Tangent and orientation at z as it stands; false if they are not determined there."""
        self.guess[:] = self.z
        return self.factor() and self.direct()


@cython.cfunc
@cython.exceptval(-1, check=False)
def _again(newton: Newton, before: cython.double) -> cython.bint:
    """Whether a step with the Jacobian from before the last, of a length, leads to the curve; else it is not
    taken. What it leaves is less by as much again."""
    newton.problem.probe(newton.z)
    step: cython.double = newton.step()
    if not step * step < newton.close * before:
        return False
    _move(newton)
    return True


def settle(newton: Newton, most: float) -> bool:
    """As `correct` from a length of 1, where the direction does not matter: a Jacobian is kept as long as
    steps with it shrink."""
    count: cython.int
    step: cython.double
    before: cython.double = 1.0
    newton.guess[:] = newton.z
    for count in range(ITERATIONS):
        if not newton.factor():
            return False
        step = newton.step()
        if newton.too_far(step, before, most, count):
            return False
        _move(newton)
        if step < SMALL or _chords(newton, step, KEPT, SHRINKING):
            return bool(newton.direct())
        before = step
    return False


@cython.cfunc
@cython.exceptval(-1, check=False)
def _chords(newton: Newton, before: cython.double, most: cython.int, ratio: cython.double) -> cython.bint:
    """Whether at most so many steps with the same Jacobian, each shorter than the one before by a ratio, lead
    from z, to which a step has led, to the curve."""
    count: cython.int
    step: cython.double
    for count in range(most):  # noqa: B007
        newton.problem.probe(newton.z)
        step = newton.step()
        if step < EXACT:
            return True
        if not step < ratio * before:
            return False
        _move(newton)
        before = step
    return False


@cython.cfunc
@cython.exceptval(check=False)
def _move(newton: Newton) -> cython.void:
    """Take the step that is in delta."""
    i: cython.Py_ssize_t
    for i in range(newton.problem.unknowns + 1):
        newton.z[i] += newton.scale[i] * newton.delta[i]
