"""A curve beside another: what its values are at the same parameter, near the same place along the curve."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isnan

from fcm.model.scene import FloatArray

HALVINGS = cython.declare(cython.int, 40)  # of a piece, to where the parameter is a value
PARTS = cython.declare(cython.int, 8)  # of the way from a point to the next
NAN = cython.declare(cython.double, float("nan"))
INFINITY = cython.declare(cython.double, float("inf"))


@cython.cclass
class OtherCurve:
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

    def passings(
        self,
        orientation: cython.double[::1],
        value: cython.double[:, ::1],
        slope: cython.double[:, ::1],
        wanted: cython.double[::1],
        even: cython.double[::1],
        reference: cython.double[:, ::1],
        number: cython.int[::1],
        out: cython.double[:, ::1],
    ) -> None:
        """Values (place, value) of the other curve where it passes given parameters `wanted` (place,).

        Of several passings that with a number, counted along the curve from 0; where that is -1 the one whose
        first values are nearest to a reference (place, some of the values), of those that are as even as it:
        even (place,) and orientation (point,) times the sign of the rate. NaN where there is none.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        count: cython.int
        found = np.empty(value.shape[1])
        at: cython.double[::1] = found
        for i in range(wanted.shape[0]):
            least: cython.double = INFINITY
            count = 0
            for k in range(self.parameter.shape[0] - 1):
                before: cython.double = self.parameter[k]
                after: cython.double = self.parameter[k + 1]
                if (before < wanted[i]) == (after < wanted[i]) and not (
                    (k == 0 and before == wanted[i] and after > before)
                    or (k == self.parameter.shape[0] - 2 and after == wanted[i] and before > after)
                ):
                    continue
                count += 1
                if number[i] >= 0 and number[i] != count - 1:
                    continue
                if number[i] < 0 and orientation[k] * (1.0 if after > before else -1.0) * even[i] < 0.0:
                    continue
                self.solve(k, wanted[i])
                off: cython.double = 0.0
                length: cython.double = self.place[k + 1] - self.place[k]
                for j in range(value.shape[1]):
                    at[j] = cubic(
                        value[k, j], value[k + 1, j], slope[k, j] * length, slope[k + 1, j] * length, self.at
                    )
                    if j < reference.shape[1]:
                        off = max(off, fabs(at[j] - reference[i, j]))
                if off < least:
                    least = off
                    for j in range(value.shape[1]):
                        out[i, j] = at[j]
            if least == INFINITY:
                for j in range(value.shape[1]):
                    out[i, j] = NAN

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
        if wanted == before:  # as where the curves are the same
            self.at = 0.0
            return True
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


def shifted(
    place: cython.double[::1],
    z: cython.double[:, ::1],
    direction: cython.double[:, ::1],
    amplitude: cython.double[:, ::1],
    growth: cython.double[:, ::1],
    unit: cython.double[:, ::1],
    change: cython.double[:, ::1],
) -> FloatArray:
    """Differences (point, dof) from the amplitudes of a curve to those of another at the same parameter.

    z, direction (point, unknown + 1): the parameter is the last. change (point, 1 + dof): from each point to
    one of the other curve, of the parameter, relative, and of the amplitudes in their unit, in which the
    differences are, too. growth (point, dof) is that of the amplitudes along the curve. NaN as of
    `OtherCurve.values`.
    """
    i: cython.Py_ssize_t
    d: cython.Py_ssize_t
    n: cython.Py_ssize_t = z.shape[1] - 1
    count: cython.Py_ssize_t = place.shape[0]
    dofs: cython.Py_ssize_t = amplitude.shape[1]
    along, across = np.empty((4, count)), np.empty((2, count, dofs))
    out, differences = np.empty((count, dofs)), np.empty((count, 1 + dofs))
    moved: cython.double[:, ::1] = along  # the other's parameter, its rate; the first's, its sign of that
    other: cython.double[:, :, ::1] = across  # its amplitudes and their rates
    off: cython.double[:, ::1] = differences  # of the parameter and the amplitudes
    found: cython.double[:, ::1] = out
    for i in range(count):
        moved[0, i], moved[2, i] = z[i, n] * (1.0 + change[i, 0]), z[i, n]
        moved[3, i] = 1.0 if direction[i, n] > 0.0 else (-1.0 if direction[i, n] < 0.0 else 0.0)
        off[i, 0] = moved[0, i] - z[i, n]
        for d in range(dofs):
            other[0, i, d] = amplitude[i, d] + unit[i, d] * change[i, 1 + d]
            off[i, 1 + d] = other[0, i, d] - amplitude[i, d]
    for i in range(count):
        moved[1, i] = direction[i, n] + slope(place, off, i, 0)
        for d in range(dofs):
            other[1, i, d] = growth[i, d] + slope(place, off, i, 1 + d)
    OtherCurve(place, along[0], along[1]).values(along[2], along[3], across[0], across[1], out)
    for i in range(count):
        for d in range(dofs):
            found[i, d] = (found[i, d] - amplitude[i, d]) / unit[i, d]
    return out


@cython.cfunc
@cython.exceptval(check=False)
def slope(
    place: cython.double[::1], value: cython.double[:, ::1], i: cython.Py_ssize_t, j: cython.Py_ssize_t
) -> cython.double:
    """Rate of change at a point, from that before it to that behind: beside a corner points nearly
    coincide."""
    before: cython.Py_ssize_t = max(i - 1, 0)
    after: cython.Py_ssize_t = min(i + 1, place.shape[0] - 1)
    step: cython.double = place[after] - place[before]
    return (value[after, j] - value[before, j]) / (step if step > 0.0 else 1.0)


def rises(
    place: cython.double[::1],
    amplitude: cython.double[:, ::1],
    growth: cython.double[:, ::1],
    moved: cython.double[:, ::1],
    corner: cython.uchar[::1],
    tops: cython.Py_ssize_t[::1],
) -> FloatArray:
    """By how much (dof,) a curve is higher between its tops and the points next to them than at its tops.

    Its amplitudes (point, dof), with growth (point, dof), are moved (point, dof): they follow cubics, what
    they are moved by straight lines. Nothing is told of what lies between a point and a corner.
    """
    d: cython.Py_ssize_t
    k: cython.Py_ssize_t
    part: cython.int
    last: cython.Py_ssize_t = place.shape[0] - 1
    highest = np.zeros(tops.shape[0])
    out: cython.double[::1] = highest
    for d in range(tops.shape[0]):
        before: cython.Py_ssize_t = tops[d]
        after: cython.Py_ssize_t = tops[d]
        now: cython.double = amplitude[tops[d], d] + moved[tops[d], d]
        while before >= 0 and place[before] >= place[tops[d]]:  # points may coincide
            before -= 1
        while after < last and place[after + 1] <= place[tops[d]]:
            after += 1
        for k in (before, after):
            if k < 0 or k >= last or corner[k] or corner[k + 1] or isnan(moved[k, d] + moved[k + 1, d]):
                continue
            length: cython.double = place[k + 1] - place[k]
            begin: cython.double = growth[k, d] * length
            end: cython.double = growth[k + 1, d] * length
            for part in range(1, PARTS):
                x: cython.double = cython.cast(cython.double, part) / PARTS
                more: cython.double = moved[k, d] * (1.0 - x) + moved[k + 1, d] * x
                more += cubic(amplitude[k, d], amplitude[k + 1, d], begin, end, x)
                out[d] = max(out[d], more - now)
    return highest
