"""Corners: one is found in a step, kept as a point, and left in the direction of the curve beyond."""

from __future__ import annotations

import cython
import numpy as np

from fcm.continuation import events
from fcm.continuation.front import Front
from fcm.continuation.passage import Passage
from fcm.continuation.path import Mark
from fcm.continuation.place import Place

if cython.compiled:
    from cython.cimports.fcm.continuation.corner import come, cross, cross_softly
    from cython.cimports.fcm.continuation.step_rule import good, kept
else:
    from fcm.continuation.corner import come, cross, cross_softly
    from fcm.continuation.step_rule import good, kept

BEFORE = cython.declare(cython.double, 1e-6)  # of the way to a corner: up to here the curve is smooth
FOLD = cython.declare(cython.long, int(Mark.FOLD))
PEAK = cython.declare(cython.long, int(Mark.PEAK))


@cython.cfunc
@cython.exceptval(-1, check=True)
def before_corner(front: Front) -> cython.double:
    """Length to the first corner of the step, which is shortened to end just before; negative if it is none.

    That is where the curve is not found up to there, or not where it was predicted.
    """
    if not kept(front):  # what is there is another part of a curve that goes back in the corner
        return -1.0
    at: cython.double = events.first_margin(front)
    if at < 0.0 or not front.shorten((1.0 - BEFORE) * at) or not kept(front) or not good(front):
        return -1.0
    return at


@cython.cclass
class Leaving:
    """At corners of the curve of a `passage`; `softly` where a change of label is what tells of them."""

    def __init__(self, passage: Passage, softly: bool) -> None:
        self.passage, self.softly = passage, softly
        self.grew = np.zeros(passage.front.problem.outputs)  # growth before a corner

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def at(self, place: Place, length: cython.double, past: cython.double) -> cython.int:
        """Keep the corner, a place at a length from here, and take the direction beyond it.

        past: the length at which that is looked for where the corner is a change of label.
        """
        passage: Passage = self.passage
        front: Front = passage.front
        passage.note(place)
        if place is not front.here:
            come(front, place, length)
        rise: cython.double = front.here.tangent[passage.n]
        self.grew[:] = front.here.growth
        if self.softly:
            cross_softly(front, past)
        else:
            cross(front, passage.stops)
        fold: cython.long = FOLD if rise * front.here.tangent[passage.n] < 0.0 else 0
        passage.trail.mark_last(fold | (PEAK if self.peaked() else 0))
        passage.rise()
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def peaked(self) -> cython.bint:
        """Whether an output grew before the corner that is here, and falls beyond it."""
        k: cython.Py_ssize_t
        growth: cython.double[::1] = self.passage.front.here.growth
        for k in range(self.grew.shape[0]):  # noqa: SIM110 - a loop in C
            if self.grew[k] > 0.0 and growth[k] < 0.0:
                return True
        return False
