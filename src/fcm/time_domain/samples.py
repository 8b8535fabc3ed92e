"""A motion at given instants."""

from __future__ import annotations

import cython

if cython.compiled:
    from cython.cimports.fcm.time_domain.steps import Steps
else:
    from fcm.time_domain.steps import Steps

_ORDER = cython.declare(cython.int, 19)


def sample(
    steps: Steps, times: cython.double[::1], out: cython.double[:, ::1], done: cython.Py_ssize_t
) -> int:
    """State vectors at increasing times [s], into the rows of out from `done` on; returns how many there are.

    Fewer than all where a flow is missing; the last step serves later times too.
    """
    with cython.nogil:
        done = _sample(steps, times, out, done)
    return int(done)


@cython.cfunc
@cython.nogil
@cython.exceptval(-1, check=False)
def _sample(
    steps: Steps, times: cython.double[::1], out: cython.double[:, ::1], done: cython.Py_ssize_t
) -> cython.Py_ssize_t:
    stopped: cython.int
    until: cython.double
    x: cython.double
    i: cython.Py_ssize_t
    j: cython.int
    while done < times.shape[0]:
        stopped = steps.next()
        if stopped != 1:
            return done
        last: cython.bint = steps.left <= 1.0
        until = steps.time + steps.h * steps.length
        if last and steps.at + 1 < steps.segments.count:
            until = steps.segments.start[steps.at + 1]
        while done < times.shape[0] and (
            times[done] < until or (last and steps.at + 1 == steps.segments.count)
        ):
            x = (times[done] - steps.time) / steps.h
            for i in range(steps.flows.size):
                out[done, i] = steps.terms[_ORDER, i]
            for j in range(_ORDER - 1, -1, -1):
                for i in range(steps.flows.size):
                    out[done, i] = out[done, i] * x + steps.terms[j, i]
            done += 1
    return done
