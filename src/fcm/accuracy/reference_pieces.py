"""Pieces of the reference of a curve as they are known, and what it has at the frequencies of the curve."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from fcm.accuracy.curve_distance import ReferenceCurveData, arc_lengths
from fcm.continuation import Path
from fcm.frozen import Frozen
from fcm.harmonic_balance.reported_quantities import ReportedQuantities
from fcm.model.scene import FloatArray


class CurvePiece(Frozen):
    """A piece of a curve: frequency (point,) along it, what is compared and its slopes (point, column), of
    which the amplitudes are the first.

    orientation (point,) times the sign of the rate of the frequency tells whether the number of real
    multipliers above 1 is even.
    """

    curve: ReferenceCurveData
    frequency: FloatArray
    orientation: FloatArray
    value: FloatArray
    slope: FloatArray

    def passes(self, omega: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether it passes frequencies (place,)."""
        inside: npt.NDArray[np.bool_] = (self.frequency.min() <= omega) & (omega <= self.frequency.max())
        return inside

    def turns(self, side: float) -> npt.NDArray[np.intp]:
        """Its points where the frequency turns back: highest where side is 1, lowest where it is -1."""
        rise = side * np.diff(self.frequency)
        found: npt.NDArray[np.intp] = np.flatnonzero((rise[:-1] > 0.0) & (rise[1:] <= 0.0)) + 1
        return found

    def values_at(
        self,
        omega: FloatArray,
        even: FloatArray,
        target: FloatArray,
        number: npt.NDArray[np.intc] | None = None,
    ) -> FloatArray:
        """Values (place, column) where it passes frequencies omega (place,), whose amplitudes are nearest to
        target values (place, dof); as of `ReferenceCurveData.values_at_crossings`, with no number where all
        count."""
        found, every = np.empty((len(omega), self.value.shape[1])), np.full(len(omega), -1, dtype=np.intc)
        which = every if number is None else number
        self.curve.values_at_crossings(
            self.orientation, self.value, self.slope, omega, even, target, which, found
        )
        return found


class ReportedPath(Frozen):
    """A path that was followed, what is reported of it, and its contact loads (point, 4 contact)."""

    path: Path
    quantities: ReportedQuantities
    contact_loads: FloatArray


def piece_of(reported: ReportedPath) -> CurvePiece:
    """A path that has been followed, as a piece of a curve."""
    path, quantities, contact_loads = reported.path, reported.quantities, reported.contact_loads
    parameter, rate = (np.ascontiguousarray(one[:, -1]) for one in (path.z, path.direction))
    place = lengths(path)
    return CurvePiece(
        ReferenceCurveData(place, parameter, rate),
        parameter,
        np.ascontiguousarray(path.orientation),
        np.hstack((quantities.amplitude, contact_loads)),
        np.hstack((quantities.growth, rates(contact_loads, place))),
    )


def piece_through(
    place: FloatArray, omega: FloatArray, orientation: FloatArray, value: FloatArray
) -> CurvePiece | None:
    """A curve through points with these places, frequencies and orientations (point,) and values
    (point, column); of points that coincide through the first. None through less than two."""
    apart = np.append(True, np.diff(place) > 0.0)
    if np.count_nonzero(apart) < 2:
        return None
    place, omega, orientation, value = place[apart], omega[apart], orientation[apart], value[apart]
    rate = np.gradient(np.column_stack((omega, value)), place, axis=0)
    return CurvePiece(
        ReferenceCurveData(place, omega, np.ascontiguousarray(rate[:, 0])),
        omega,
        np.ascontiguousarray(orientation),
        np.ascontiguousarray(value),
        np.ascontiguousarray(rate[:, 1:]),
    )


def nearest(
    pieces: Iterable[CurvePiece], omega: FloatArray, even: FloatArray, target: FloatArray
) -> FloatArray:
    """Values (place, column) of the nearest of all motions that pieces have at frequencies omega (place,).

    The nearest to target values (place, dof) of those that are as even, else of all; NaN where there is none.
    """
    known = tuple(pieces)
    found = _nearest(known, omega, even, target)
    none = np.isnan(found).any(axis=1)
    if none.any():
        found[none] = _nearest(known, omega[none], np.zeros(int(none.sum())), target[none])
    return found


def _nearest(
    pieces: tuple[CurvePiece, ...], omega: FloatArray, even: FloatArray, target: FloatArray
) -> FloatArray:
    """The same of those that are as even, or of all where that is zero."""
    best, dofs = np.full((len(omega), pieces[0].value.shape[1]), np.nan), target.shape[1]
    omega, even = np.ascontiguousarray(omega), np.ascontiguousarray(even)
    target = np.ascontiguousarray(target)
    for piece in pieces:
        other = piece.values_at(omega, even, target)
        off, before = (np.abs(one[:, :dofs] - target).max(axis=1) for one in (other, best))
        nearer = np.isfinite(off) & ~(off >= before)
        best[nearer] = other[nearer]
    return best


def lengths(path: Path) -> FloatArray:
    """Along a path (point,)."""
    length = np.zeros(len(path.z))
    arc_lengths(path.z, path.direction, np.ptp(path.parameter) or 1.0, length)
    return length


def rates(values: FloatArray, place: FloatArray) -> FloatArray:
    """Rates of change (point, column) along a curve, from the point before to that behind."""
    k = np.arange(len(place))
    before, after = np.maximum(k - 1, 0), np.minimum(k + 1, len(place) - 1)
    step = place[after] - place[before]
    found: FloatArray = (values[after] - values[before]) / np.where(step > 0.0, step, 1.0)[:, None]
    return found


def distinct(place: FloatArray, near: float) -> npt.NDArray[np.intp]:
    """Which of places, in their order, lie farther than that behind the one before of these.

    >>> distinct(np.array([0.0, 0.1, 0.4, 0.6]), 0.3).tolist()
    [0, 2]
    """
    found = list[int]()
    for k, at in enumerate(place.tolist()):
        if not found or at - place[found[-1]] > near:
            found.append(k)
    return np.array(found, dtype=np.intp)
