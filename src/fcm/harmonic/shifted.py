"""A curve beside another: what its values are at the same parameter, near the same place along the curve."""

from __future__ import annotations

import cython

HALVINGS = cython.declare(cython.int, 40)  # of a piece, to where the parameter is a value
NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class Beside:
    """The other curve at its points (point,): where along the curve, its parameter and the rate of that."""

    place: cython.double[::1]
    parameter: cython.double[::1]
    rate: cython.double[::1]
    at: cython.double  # fraction of the way from a point to the next

    def __init__(
        self, place: cython.double[::1], parameter: cython.double[::1], rate: cython.double[::1]
    ) -> None:
        self.place, self.parameter, self.rate, self.at = place, parameter, rate, 0.0

    def values(
        self,
        parameter: cython.double[::1],
        forward: cython.double[::1],
        value: cython.double[:, ::1],
        slope: cython.double[:, ::1],
        out: cython.double[:, ::1],
    ) -> None:
        """Values of the other curve, which are `value` at its points with rates `slope`, at given parameters.

        parameter, forward (point,): of the first curve at its points, and the sign of its rate. Results
        (point, value) in out: NaN where the other curve does not come to that parameter before it turns
        back.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for i in range(parameter.shape[0]):
            k = self.find(i, parameter[i], forward[i])
            for j in range(value.shape[1]):
                if k < 0:
                    out[i, j] = NAN
                else:
                    length: cython.double = self.place[k + 1] - self.place[k]
                    out[i, j] = cubic(
                        value[k, j], value[k + 1, j], slope[k, j] * length, slope[k + 1, j] * length, self.at
                    )

    @cython.cfunc
    @cython.exceptval(check=False)
    def find(self, i: cython.Py_ssize_t, wanted: cython.double, forward: cython.double) -> cython.Py_ssize_t:
        """The piece k to k + 1, next to the point i, on which the parameter is the one wanted; -1 if none is.

        Beyond its ends the curve goes on as it does there.
        """
        k: cython.Py_ssize_t
        last: cython.Py_ssize_t = self.parameter.shape[0] - 1
        step: cython.Py_ssize_t = -1 if (self.parameter[i] - wanted) * forward > 0.0 else 1
        onward: cython.double = forward if step > 0 else -forward
        k = i
        while 0 <= k + step <= last:
            if not (self.parameter[k + step] - self.parameter[k]) * onward >= 0.0:
                return -1
            if (self.parameter[k + step] - wanted) * onward >= 0.0:
                k = k if step > 0 else k - 1
                return k if self.solve(k, wanted) else -1
            k += step
        if last < 1 or not self.rate[k] * forward > 0.0:
            return -1
        self.at = (wanted - self.parameter[k]) / self.rate[k]
        k = 0 if step < 0 else last - 1
        if self.place[k + 1] <= self.place[k]:
            return -1
        self.at = self.at / (self.place[k + 1] - self.place[k]) + (0.0 if step < 0 else 1.0)
        return k

    @cython.cfunc
    @cython.exceptval(check=False)
    def solve(self, k: cython.Py_ssize_t, wanted: cython.double) -> cython.bint:
        """Where on a piece the parameter is the one wanted, by halving."""
        length: cython.double = self.place[k + 1] - self.place[k]
        before: cython.double = self.parameter[k]
        after: cython.double = self.parameter[k + 1]
        low: cython.double = 0.0
        high: cython.double = 1.0
        rising: cython.bint = after > before
        for _ in range(HALVINGS):
            self.at = 0.5 * (low + high)
            now: cython.double = cubic(
                before, after, self.rate[k] * length, self.rate[k + 1] * length, self.at
            )
            if (now < wanted) == rising:
                low = self.at
            else:
                high = self.at
        return True


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def cubic(
    before: cython.double, after: cython.double, begin: cython.double, end: cython.double, x: cython.double
) -> cython.double:
    """The cubic with two values and slopes at 0 and 1; beyond, its tangents."""
    if x < 0.0:
        return before + x * begin
    if x > 1.0:
        return after + (x - 1.0) * end
    return (
        before * (1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x)
        + after * x * x * (3.0 - 2.0 * x)
        + begin * x * (1.0 - x) * (1.0 - x)
        - end * x * x * (1.0 - x)
    )
