"""Distance of a curve to another, at the same parameter and near the same place along it.

`PartialInterpolant` interpolates values from known points to others, and checks the interpolation.
`ReferenceCurveData` finds the point of the other curve at the same parameter, along that curve.
`PointwiseDisplacement` finds the point of a reference with more harmonics near a point, by Newton's method in
the normal plane.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isnan, sqrt

from fcm.accuracy.options import CURVE_DISTANCE, CurveDistanceOptions
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.model.scene import FloatArray

if cython.compiled:
    from cython.cimports.fcm.cubic import cubic
else:
    from fcm.cubic import cubic

if TYPE_CHECKING:
    from fcm.accuracy.reference_curve import ComparedQuantities, ReferenceCurve
    from fcm.accuracy.reference_pieces import CurvePiece
    from fcm.harmonic_balance.reported_quantities import ReportedQuantities

LEAST = cython.declare(cython.double, 1e-300)  # unit of a curve without motion
INFINITY = cython.declare(cython.double, float("inf"))


@cython.cclass
class PartialInterpolant:
    """`interpolate` fills unknown values (point, column) by cubics through the known points (byte mask).

    place (point,) is the length along the curve up to each point. Slopes are those of parabolas through
    neighbours.
    """

    place: cython.double[::1]
    value: cython.double[:, ::1]
    known: cython.uchar[::1]
    number: cython.Py_ssize_t[::1]  # of the known points
    known_points: cython.Py_ssize_t
    coincident: cython.double  # fraction of the curve's length, below which points coincide

    def __init__(
        self,
        place: cython.double[::1],
        value: cython.double[:, ::1],
        known: cython.uchar[::1],
        options: CurveDistanceOptions = CURVE_DISTANCE,
    ) -> None:
        self.coincident = options.coincident
        self.place, self.value, self.known = place, value, known
        self.number, self.known_points = np.zeros(place.shape[0], dtype=np.intp), 0

    def interpolate(self, points: cython.Py_ssize_t[::1], out: cython.double[:, ::1]) -> None:
        """Fill out with interpolated values (point, column) at the given points."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        first: cython.Py_ssize_t
        self.sort()
        for i in range(points.shape[0]):
            first = self.before(points[i])
            for j in range(self.value.shape[1]):
                if self.known[points[i]] or self.known_points == 1:
                    out[i, j] = self.value[self.number[first], j]
                else:
                    out[i, j] = self.between(first, self.place[points[i]], j)

    @cython.cfunc
    @cython.exceptval(check=False)
    def sort(self) -> cython.void:
        """List the numbers of the known points, without those that nearly coincide with the one before.

        The difference of such points is rounding, and gives no slope.
        """
        i: cython.Py_ssize_t
        before: cython.Py_ssize_t
        near: cython.double = self.coincident * (self.place[self.place.shape[0] - 1] - self.place[0])
        self.known_points = 0
        for i in range(self.known.shape[0]):
            if not self.known[i]:
                continue
            if self.known_points:
                before = self.number[self.known_points - 1]
                same: cython.bint = isnan(self.value[i, 0]) == isnan(self.value[before, 0])
                if same and self.place[i] - self.place[before] < near:
                    continue
            self.number[self.known_points] = i
            self.known_points += 1

    @cython.cfunc
    @cython.exceptval(check=False)
    def before(self, point: cython.Py_ssize_t) -> cython.Py_ssize_t:
        """Index, among the known points, of the last one at or before a given point."""
        low: cython.Py_ssize_t = 0
        high: cython.Py_ssize_t = self.known_points
        while high - low > 1:
            middle: cython.Py_ssize_t = (low + high) // 2
            if self.number[middle] <= point:
                low = middle
            else:
                high = middle
        return low

    @cython.cfunc
    @cython.exceptval(check=False)
    def between(self, k: cython.Py_ssize_t, place: cython.double, j: cython.Py_ssize_t) -> cython.double:
        """Value on the cubic from known point k to the next, or beyond the last known point."""
        last: cython.Py_ssize_t = self.known_points - 1
        k = min(k, last - 1)
        begin: cython.double = self.place[self.number[k]]
        length: cython.double = self.place[self.number[k + 1]] - begin
        x: cython.double = (place - begin) / (length if length > 0.0 else 1.0)
        return cubic(
            self.value[self.number[k], j],
            self.value[self.number[k + 1], j],
            self.slope(k, j),
            self.slope(k + 1, j),
            length,
            x,
        )

    @cython.cfunc
    @cython.exceptval(check=False)
    def slope(self, k: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.double:
        """Slope at known point k from the secants on both sides; beside a gap from the only one."""
        one: cython.Py_ssize_t = max(k - 1, 0)
        other: cython.Py_ssize_t = min(k, self.known_points - 2)
        before: cython.double = self.secant(one, j)
        after: cython.double = self.secant(other, j)
        if isnan(before):
            return after
        if isnan(after):
            return before
        step: cython.double = self.step(one)
        next_step: cython.double = self.step(other)
        return (next_step * before + step * after) / (step + next_step)

    @cython.cfunc
    @cython.exceptval(check=False)
    def secant(self, k: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.double:
        """Slope of the secant from known point k to the next."""
        return (self.value[self.number[k + 1], j] - self.value[self.number[k], j]) / self.step(k)

    @cython.cfunc
    @cython.exceptval(check=False)
    def step(self, k: cython.Py_ssize_t) -> cython.double:
        """Arc length from known point k to the next; 1 where both coincide."""
        length: cython.double = self.place[self.number[k + 1]] - self.place[self.number[k]]
        return length if length > 0.0 else 1.0

    def misses_expected(
        self,
        points: cython.Py_ssize_t[:, ::1],
        expected: cython.double[:, ::1],
        weight: cython.double[::1],
        part: cython.double,
        nothing: cython.double,
        out: cython.uchar[::1],
    ) -> None:
        """Whether values differ from the expected ones by more than `part` of their size and `nothing`.

        points (3, place) are the points before, at and after each place, all known. The difference is the
        greater of the first value's, times the weight (point,), and the greatest of the other values. A value
        that is unexpectedly missing, or unexpectedly there, differs.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(points.shape[1]):
            k: cython.Py_ssize_t = points[1, i]
            missing: cython.bint = isnan(expected[i, 0])
            if missing or isnan(self.value[k, 0]):
                out[i] = missing != isnan(self.value[k, 0])
                continue
            off: cython.double = weight[k] * fabs(self.value[k, 0] - expected[i, 0])
            for j in range(1, self.value.shape[1]):
                off = max(off, fabs(self.value[k, j] - expected[i, j]))
            most: cython.double = self.size(k, weight[k])
            for j in (0, 2):
                most = max(most, self.size(points[j, i], weight[points[j, i]]))
            out[i] = off > max(part * most, nothing)

    @cython.cfunc
    @cython.exceptval(check=False)
    def size(self, k: cython.Py_ssize_t, weight: cython.double) -> cython.double:
        """Greatest magnitude of the values at point k, the first weighted; infinite if they are missing."""
        j: cython.Py_ssize_t
        if isnan(self.value[k, 0]):
            return INFINITY
        most: cython.double = weight * fabs(self.value[k, 0])
        for j in range(1, self.value.shape[1]):
            most = max(most, fabs(self.value[k, j]))
        return most


def arc_lengths(
    z: cython.double[:, ::1], direction: cython.double[:, ::1], range_of: cython.double, out: FloatArray
) -> None:
    """Fill out (point,) with lengths along a curve z (point, unknown + 1), in the unit of its directions.

    The parameter, the last of z, is relative to the width of its range, range_of.
    """
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    n: cython.Py_ssize_t = z.shape[1] - 1
    place: cython.double[::1] = out
    most: cython.double = LEAST
    before: cython.double = 0.0
    for i in range(z.shape[0]):
        for j in range(n):
            most = max(most, fabs(z[i, j]))
    for i in range(z.shape[0]):
        speed: cython.double = (direction[i, n] / range_of) ** 2
        chord: cython.double = ((z[i, n] - z[i - 1, n]) / range_of) ** 2 if i else 0.0
        for j in range(n):
            speed += (direction[i, j] / most) ** 2
            if i:
                chord += ((z[i, j] - z[i - 1, j]) / most) ** 2
        speed = sqrt(speed)
        place[i] = place[i - 1] + 2.0 * sqrt(chord) / (speed + before) if i else 0.0
        before = speed


def steepness(
    parameter: cython.double[::1], amplitude: cython.double[:, ::1], most: cython.double, out: FloatArray
) -> None:
    """Fill out (point,) with the greatest relative slope of an amplitude by the parameter, from 1 to most."""
    i: cython.Py_ssize_t
    d: cython.Py_ssize_t
    last: cython.Py_ssize_t = parameter.shape[0] - 1
    steep: cython.double[::1] = out
    for i in range(last + 1):
        a: cython.Py_ssize_t = max(i - 1, 0)
        b: cython.Py_ssize_t = min(i + 1, last)
        rise: cython.double = 0.0
        run: cython.double = fabs(parameter[b] - parameter[a]) / fabs(parameter[i])
        for d in range(amplitude.shape[1]):
            if amplitude[i, d] > 0.0:
                rise = max(rise, fabs(amplitude[b, d] - amplitude[a, d]) / amplitude[i, d])
        steep[i] = max(rise / run, 1.0) if rise < most * run else most


NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class ReferenceCurveData:
    """The second curve at its points (point,): length along it, parameter, and rate of the parameter."""

    place: cython.double[::1]
    parameter: cython.double[::1]
    rate: cython.double[::1]
    max_halvings: cython.int
    at: cython.double  # fraction of the way from a point to the next

    def __init__(
        self,
        place: cython.double[::1],
        parameter: cython.double[::1],
        rate: cython.double[::1],
        options: CurveDistanceOptions = CURVE_DISTANCE,
    ) -> None:
        self.max_halvings = options.max_halvings
        self.place, self.parameter, self.rate, self.at = place, parameter, rate, 0.0

    def values(
        self,
        parameter: cython.double[::1],
        forward: cython.double[::1],
        value: cython.double[:, ::1],
        slope: cython.double[:, ::1],
        out: cython.double[:, ::1],
    ) -> None:
        """Interpolate `value`, with its rates `slope`, on the second curve at given parameters.

        parameter, forward (point,) are the parameter of the first curve at its points, and the sign of its
        rate. out (point, value) is NaN where the second curve turns back before it comes to that parameter.
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
                    out[i, j] = continued(
                        value[k, j], value[k + 1, j], slope[k, j] * length, slope[k + 1, j] * length, self.at
                    )

    def values_at_crossings(
        self,
        piece: CurvePiece,
        wanted: cython.double[::1],
        parity: cython.double[::1],
        target: cython.double[:, ::1],
        number: cython.int[::1],
    ) -> FloatArray:
        """Values (place, value) of a piece where this, its curve, passes given parameters `wanted` (place,).

        If there are several passings, `number` selects one, counted along the curve from 0. For -1 it is the
        one whose first values are nearest to target (place, some of the values), among those of the same
        parity (place,). The parity of the curve is its orientation (point,) times the sign of the rate; 0
        admits both. NaN where there is no passing.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        count: cython.int
        orientation: cython.double[::1] = piece.orientation
        value: cython.double[:, ::1] = piece.value
        slope: cython.double[:, ::1] = piece.slope
        found, here = np.empty((wanted.shape[0], value.shape[1])), np.empty(value.shape[1])
        out: cython.double[:, ::1] = found
        at: cython.double[::1] = here
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
                if number[i] < 0 and orientation[k] * (1.0 if after > before else -1.0) * parity[i] < 0.0:
                    continue
                self.solve(k, wanted[i])
                off: cython.double = 0.0
                length: cython.double = self.place[k + 1] - self.place[k]
                for j in range(value.shape[1]):
                    at[j] = continued(
                        value[k, j], value[k + 1, j], slope[k, j] * length, slope[k + 1, j] * length, self.at
                    )
                    if j < target.shape[1]:
                        off = max(off, fabs(at[j] - target[i, j]))
                if off < least:
                    least = off
                    for j in range(value.shape[1]):
                        out[i, j] = at[j]
            if least == INFINITY:
                for j in range(value.shape[1]):
                    out[i, j] = NAN
        return found

    @cython.cfunc
    @cython.exceptval(check=False)
    def find(self, i: cython.Py_ssize_t, wanted: cython.double, forward: cython.double) -> cython.Py_ssize_t:
        """Find the interval k to k + 1, reached from point i, in which the parameter is `wanted`; -1 if none.

        Beyond its ends the curve continues along its tangents.
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
        """Set `at`, the fraction of interval k at which the parameter is `wanted`, by bisection."""
        length: cython.double = self.place[k + 1] - self.place[k]
        before: cython.double = self.parameter[k]
        after: cython.double = self.parameter[k + 1]
        low: cython.double = 0.0
        high: cython.double = 1.0
        rising: cython.bint = after > before
        if wanted == before:  # as where both curves are the same
            self.at = 0.0
            return True
        for _ in range(self.max_halvings):
            self.at = 0.5 * (low + high)
            now: cython.double = continued(
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
def continued(
    before: cython.double, after: cython.double, begin: cython.double, end: cython.double, x: cython.double
) -> cython.double:
    """The cubic with given values and slopes at 0 and 1, continued by its tangents outside."""
    if x < 0.0:
        return before + x * begin
    if x > 1.0:
        return after + (x - 1.0) * end
    return cubic(before, after, begin, end, 1.0, x)


def shifted(
    place: cython.double[::1],
    z: cython.double[:, ::1],
    direction: cython.double[:, ::1],
    compared: ComparedQuantities,
) -> FloatArray:
    """Differences (point, column) from the values of a curve to those of another at the same parameter.

    The parameter is the last of z, direction (point, unknown + 1). compared.change leads from each point to
    one of the other curve; the differences are in the same unit. NaN as in `ReferenceCurveData.values`.
    """
    amplitude: cython.double[:, ::1] = compared.value
    growth: cython.double[:, ::1] = compared.growth
    unit: cython.double[:, ::1] = compared.unit
    change: cython.double[:, ::1] = compared.change
    i: cython.Py_ssize_t
    d: cython.Py_ssize_t
    n: cython.Py_ssize_t = z.shape[1] - 1
    count: cython.Py_ssize_t = place.shape[0]
    dofs: cython.Py_ssize_t = amplitude.shape[1]
    along, across = np.empty((4, count)), np.empty((2, count, dofs))
    out, differences = np.empty((count, dofs)), np.empty((count, 1 + dofs))
    moved: cython.double[:, ::1] = along  # the other's parameter, its rate; the first's, its rate's sign
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
    ReferenceCurveData(place, along[0], along[1]).values(along[2], along[3], across[0], across[1], out)
    for i in range(count):
        for d in range(dofs):
            found[i, d] = (found[i, d] - amplitude[i, d]) / unit[i, d]
    return out


@cython.cfunc
@cython.exceptval(check=False)
def slope(
    place: cython.double[::1], value: cython.double[:, ::1], i: cython.Py_ssize_t, j: cython.Py_ssize_t
) -> cython.double:
    """Rate of change at a point: the difference quotient of its two neighbours.

    Beside a corner the point nearly coincides with a neighbour: a one-sided quotient would be rounding.
    """
    before: cython.Py_ssize_t = max(i - 1, 0)
    after: cython.Py_ssize_t = min(i + 1, place.shape[0] - 1)
    step: cython.double = place[after] - place[before]
    return (value[after, j] - value[before, j]) / (step if step > 0.0 else 1.0)


def rises(
    place: cython.double[::1],
    quantities: ReportedQuantities,
    moved: cython.double[:, ::1],
    corner: cython.uchar[::1],
    tops: cython.Py_ssize_t[::1],
    options: CurveDistanceOptions = CURVE_DISTANCE,
) -> FloatArray:
    """Rise (dof,) of a displaced curve above its tops, between each top and the points next to it.

    Between points, the amplitudes follow cubics with their growth, and their displacements moved (point, dof)
    follow straight lines. Intervals beside a corner are left out.
    """
    amplitude: cython.double[:, ::1] = quantities.amplitude
    growth: cython.double[:, ::1] = quantities.growth
    d: cython.Py_ssize_t
    k: cython.Py_ssize_t
    part: cython.int
    parts: cython.int = options.parts
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
            for part in range(1, parts):
                x: cython.double = cython.cast(cython.double, part) / parts
                more: cython.double = moved[k, d] * (1.0 - x) + moved[k + 1, d] * x
                more += continued(amplitude[k, d], amplitude[k + 1, d], begin, end, x)
                out[d] = max(out[d], more - now)
    return highest


@cython.cclass
class PointwiseDisplacement:
    """Displaces points of a curve to the reference by the prolongation, see `find`."""

    def __init__(self, prolongation: Prolongation) -> None:
        self.prolongation, self.missed = prolongation, 0.0

    def find(self, points: cython.Py_ssize_t[::1], curve: ReferenceCurve, most: cython.double) -> None:
        """Compute the unknown displacements of given points of a curve, and mark them known.

        curve.change (point, 1 + dof) is the relative change of the frequency, then those of the amplitudes in
        their unit. curve.reference_unknowns (point, reference's unknown + 1) is the reference's solution.
        Both are NaN where Newton's method finds no point of the reference near. Once failed points have taken
        more than `most` evaluations, all others are NaN, too.
        """
        z: cython.double[:, ::1] = curve.path.z
        direction: cython.double[:, ::1] = curve.path.direction
        amplitude: cython.double[:, ::1] = curve.amplitude
        unit: cython.double[:, ::1] = curve.unit
        change: cython.double[:, ::1] = curve.change
        reference_unknowns: cython.double[:, ::1] = curve.reference_unknowns
        known: cython.uchar[::1] = curve.known.view(np.uint8)
        n: cython.Py_ssize_t = z.shape[1] - 1
        p: cython.Py_ssize_t
        d: cython.Py_ssize_t
        for p in range(points.shape[0]):
            i: cython.Py_ssize_t = points[p]
            if known[i]:
                continue
            known[i] = 1
            before: cython.double = self.prolongation.newton.evaluations
            self.predict_from_nearest(i, z, reference_unknowns, known)
            if self.missed > most or not self.prolongation.find_normal(z[i], direction[i], True):
                self.missed += self.prolongation.newton.evaluations - before
                change[i, :] = NAN
                reference_unknowns[i, :] = NAN
                continue
            reference_unknowns[i, :] = self.prolongation.newton.z
            change[i, 0] = (self.prolongation.found[0] - z[i, n]) / z[i, n]
            for d in range(amplitude.shape[1]):
                change[i, 1 + d] = (self.prolongation.found[1 + d] - amplitude[i, d]) / unit[i, d]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def predict_from_nearest(
        self,
        i: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        reference_unknowns: cython.double[:, ::1],
        known: cython.uchar[::1],
    ) -> cython.int:
        """Start the predictor of a point from the nearest point with a known displacement."""
        off: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for off in range(1, known.shape[0]):
            for j in (i - off, i + off):
                if (
                    0 <= j < known.shape[0]
                    and known[j]
                    and reference_unknowns[j, 0] == reference_unknowns[j, 0]
                ):
                    return self.prolongation.predict_from(z[j], reference_unknowns[j])
        return 0
