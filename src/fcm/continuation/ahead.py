"""How far the prediction of a step goes before a margin of the problem changes its sign."""

from __future__ import annotations

import cython

from fcm.continuation.front import Front

LOOKS = cython.declare(cython.int, 50)  # bisections of the predicted step to where a margin changes sign
KNOWN = cython.declare(cython.double, 1e-4)  # of the length to there, to which it is found
ROUGHLY = cython.declare(cython.double, 2e-3)  # and where a label changes


@cython.ccall
@cython.exceptval(-1, check=False)
def ahead(front: Front, step: cython.double) -> cython.double:
    """The step, or where on it the prediction comes to the first change of sign of a margin: of which."""
    count: cython.int
    at: cython.double
    before: cython.double
    after: cython.double
    low: cython.double = front.past
    high: cython.double = step
    width: cython.double = 2.0 * step
    aside: cython.double = KNOWN / 3.0  # of the root, to come to either side of it
    if front.problem.soft:
        return softly(front, step)
    if front.problem.margins == 0 or step <= low or not crossed(front, step):
        return step
    before, after = front.here.margin[front.which], front.here.asked(front.which, front.problem)
    for count in range(LOOKS):
        if high - low < KNOWN * high:
            break
        at = (low * after - high * before) / (after - before) + aside * high
        if not low < at < high or (count % 3 == 2 and high - low > 0.5 * width):
            at = 0.5 * (low + high)
        width = high - low if count % 3 == 0 else width
        which: cython.Py_ssize_t = front.which
        if crossed(front, at):
            high, after, aside = at, front.here.asked(front.which, front.problem), -KNOWN / 3.0
            before = before if which == front.which else -after  # of another: by halves at first
        else:
            low, aside = at, KNOWN / 3.0
            before = front.here.asked(which, front.problem) or before
    return high


@cython.cfunc
@cython.exceptval(-1, check=False)
def softly(front: Front, step: cython.double) -> cython.double:
    """The step, or where on it a label of the prediction changes: a label has no root, but halves."""
    count: cython.int
    low: cython.double = 0.0
    high: cython.double = step
    if front.problem.margins == 0 or not crossed(front, step):
        return step
    for count in range(LOOKS):  # noqa: B007
        if high - low < ROUGHLY * high:
            break
        if crossed(front, 0.5 * (low + high)):
            high = 0.5 * (low + high)
        else:
            low = 0.5 * (low + high)
    return high


@cython.cfunc
@cython.exceptval(-1, check=False)
def crossed(front: Front, step: cython.double) -> cython.bint:
    """Whether the prediction a step ahead has a margin of the other sign than here, or a label of
    another value; which is then one of those."""
    k: cython.Py_ssize_t
    front.prediction.put(front.here, front.newton.scale, step, front.guess)
    front.problem.bound(front.guess)
    for k in range(front.problem.margins):
        if front.problem.soft:
            changed: cython.bint = front.problem.margin[k] != front.here.margin[k]
        else:
            changed = front.here.asked(k, front.problem) * front.here.margin[k] < 0.0
        if changed:
            front.which = k
            return True
    return False
