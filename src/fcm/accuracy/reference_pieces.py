"""Known pieces of the reference of a curve, and its values at the frequencies of the curve."""

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
    """A piece of a curve: frequency (point,), compared quantities and their slopes (point, column).

    The first columns are the amplitudes. orientation (point,) times the sign of the frequency's rate is the
    parity: positive if the number of real multipliers above 1 is even.
    """

    curve: ReferenceCurveData
    frequency: FloatArray
    orientation: FloatArray
    value: FloatArray
    slope: FloatArray

    def passes(self, omega: FloatArray) -> npt.NDArray[np.bool_]:
        """Mask (place,) of the frequencies that lie within the piece's frequency range."""
        inside: npt.NDArray[np.bool_] = (self.frequency.min() <= omega) & (omega <= self.frequency.max())
        return inside

    def turns(self, side: float) -> npt.NDArray[np.intp]:
        """Indices of the points where the frequency turns back: maxima for side 1, minima for side -1."""
        rise = side * np.diff(self.frequency)
        found: npt.NDArray[np.intp] = np.flatnonzero((rise[:-1] > 0.0) & (rise[1:] <= 0.0)) + 1
        return found

    def values_at(
        self,
        omega: FloatArray,
        parity: FloatArray,
        target: FloatArray,
        number: npt.NDArray[np.intc] | None = None,
    ) -> FloatArray:
        """Values (place, column) nearest to target (place, dof) where the piece passes omega (place,).

        See `ReferenceCurveData.values_at_crossings`; without `number` every passing is considered.
        """
        which = np.full(len(omega), -1, dtype=np.intc) if number is None else number
        return self.curve.values_at_crossings(self, omega, parity, target, which)


class ReportedPath(Frozen):
    """A followed path, the quantities reported along it, and its contact loads (point, 4 contact)."""

    path: Path
    quantities: ReportedQuantities
    contact_loads: FloatArray


def piece_of(reported: ReportedPath) -> CurvePiece:
    """The `CurvePiece` of a followed path."""
    path, quantities, contact_loads = reported.path, reported.quantities, reported.contact_loads
    parameter, rate = (np.ascontiguousarray(one[:, -1]) for one in (path.z, path.direction))
    arc = lengths(path)
    return CurvePiece(
        ReferenceCurveData(arc, parameter, rate),
        parameter,
        np.ascontiguousarray(path.orientation),
        np.hstack((quantities.amplitude, contact_loads)),
        np.hstack((quantities.growth, rates(contact_loads, arc))),
    )


def piece_through(
    arc: FloatArray, omega: FloatArray, orientation: FloatArray, value: FloatArray
) -> CurvePiece | None:
    """A curve piece through points with given arc lengths, frequencies, orientations and values.

    The values are (point, column), the others (point,). Of coincident points the first is used. None if fewer
    than two remain.
    """
    apart = np.append(True, np.diff(arc) > 0.0)
    if np.count_nonzero(apart) < 2:
        return None
    arc, omega, orientation, value = arc[apart], omega[apart], orientation[apart], value[apart]
    rate = np.gradient(np.column_stack((omega, value)), arc, axis=0)
    return CurvePiece(
        ReferenceCurveData(arc, omega, np.ascontiguousarray(rate[:, 0])),
        omega,
        np.ascontiguousarray(orientation),
        np.ascontiguousarray(value),
        np.ascontiguousarray(rate[:, 1:]),
    )


def nearest(
    pieces: Iterable[CurvePiece], omega: FloatArray, parity: FloatArray, target: FloatArray
) -> FloatArray:
    """Values (place, column) of the motion nearest to target (place, dof) at frequencies omega (place,).

    Motions of the same parity are preferred, from all pieces; NaN where there is no motion.
    """
    known = tuple(pieces)
    found = _nearest(known, omega, parity, target)
    none = np.isnan(found).any(axis=1)
    if none.any():
        found[none] = _nearest(known, omega[none], np.zeros(int(none.sum())), target[none])
    return found


def _nearest(
    pieces: tuple[CurvePiece, ...], omega: FloatArray, parity: FloatArray, target: FloatArray
) -> FloatArray:
    """Values (place, column) of the nearest motion of a parity; 0 admits any parity."""
    best, dofs = np.full((len(omega), pieces[0].value.shape[1]), np.nan), target.shape[1]
    omega, parity = np.ascontiguousarray(omega), np.ascontiguousarray(parity)
    target = np.ascontiguousarray(target)
    for piece in pieces:
        other = piece.values_at(omega, parity, target)
        off, before = (np.abs(one[:, :dofs] - target).max(axis=1) for one in (other, best))
        nearer = np.isfinite(off) & ~(off >= before)
        best[nearer] = other[nearer]
    return best


def lengths(path: Path) -> FloatArray:
    """Arc lengths (point,) along a path, from its first point."""
    length = np.zeros(len(path.z))
    arc_lengths(path.z, path.direction, np.ptp(path.parameter) or 1.0, length)
    return length


def rates(values: FloatArray, arc: FloatArray) -> FloatArray:
    """Rates of change (point, column) along a curve: difference quotients of the neighbours."""
    k = np.arange(len(arc))
    before, after = np.maximum(k - 1, 0), np.minimum(k + 1, len(arc) - 1)
    step = arc[after] - arc[before]
    found: FloatArray = (values[after] - values[before]) / np.where(step > 0.0, step, 1.0)[:, None]
    return found


def distinct(arc: FloatArray, near: float) -> npt.NDArray[np.intp]:
    """Indices of the arc lengths, in order, that are more than `near` beyond the last one taken.

    >>> distinct(np.array([0.0, 0.1, 0.4, 0.6]), 0.3).tolist()
    [0, 2]
    """
    found = list[int]()
    for k, at in enumerate(arc.tolist()):
        if not found or at - arc[found[-1]] > near:
            found.append(k)
    return np.array(found, dtype=np.intp)
