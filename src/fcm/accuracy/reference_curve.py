"""The reference of a curve: found point by point, interpolated, or followed where Newton's method fails."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.accuracy.budget import Budget
from fcm.accuracy.curve_distance import (
    PartialInterpolant,
    PointwiseDisplacement,
    arc_lengths,
    shifted,
    steepness,
)
from fcm.accuracy.options import PairOptions
from fcm.accuracy.reference_harmonics import keep_for_next, prolongation_to, reference_harmonics
from fcm.accuracy.reference_pieces import (
    CurvePiece,
    ReportedPath,
    distinct,
    nearest,
    piece_of,
    piece_through,
    rates,
)
from fcm.accuracy.reference_stretch import ReferencePiece, StretchFollower
from fcm.accuracy.truncation_changes import changes_left_out
from fcm.continuation import Mark, Path
from fcm.distinct_values import distinct_values
from fcm.frozen import Frozen
from fcm.harmonic_balance.consecutive_points import runs
from fcm.harmonic_balance.contact_cycles import contact_loads_along
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.residual_spectrum import FurtherHarmonics
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.known_motions import KnownMotions

Indices = npt.NDArray[np.intp]
Mask = npt.NDArray[np.bool_]


class ReferenceTop(NamedTuple):
    """A top of the reference: a point of a followed piece, or one displaced from the curve."""

    height: float
    point: int
    piece: ReferencePiece | None = None

    def arc(self, reference: ReferenceCurve) -> float:
        """Arc length along the piece, or along the curve."""
        return float((reference if self.piece is None else self.piece).arc[self.point])


class FollowedStretch(Frozen):
    """A stretch of a curve (points first to end - 1) with the reference's pieces followed beside it."""

    first: int
    end: int
    pieces: list[ReferencePiece]


class ComparedQuantities(Frozen):
    """The quantities in which a curve is compared with its reference: amplitudes, then contact loads.

    value, growth (along the curve) and unit are (point, column). change (point, 1 + column) leads to the
    reference: first the relative change of the frequency, then the others in their unit.
    """

    value: FloatArray
    growth: FloatArray
    unit: FloatArray
    change: FloatArray


class SecondReference:
    """The second reference (the reference of a reference), computed at single points of the latter."""

    def __init__(self, finer: System, more: tuple[int, ...], options: PairOptions) -> None:
        self.finer, self.more = finer, more
        self.system, self.prolongation = finer.with_harmonics(more), prolongation_to(finer, more, options)
        self.before = self.prolongation.newton.evaluations
        self.amplitude = np.empty(0)

    def found(self, z: FloatArray, direction: FloatArray | None) -> bool:
        """Whether Newton's method finds the second reference from a point of the reference.

        It is sought at the point's frequency, or normal to a direction if one is given. `amplitude` (dof,) is
        set.
        """
        if direction is None:
            there = self.prolongation.find_at_frequency(self.system.extended(z, self.finer.harmonics), True)
        else:
            there = self.prolongation.find_normal(z, direction, True)
        self.amplitude = np.array(self.prolongation.found[1:])
        return bool(there)

    def seconds(self) -> float:
        """Estimated seconds that computing the second reference has taken."""
        count = self.prolongation.newton.evaluations - self.before
        return float(count * seconds_of(self.finer, 1, len(self.more)))


class ReferenceCurve:
    """Relative displacements from points of a path to its reference: of frequency, then of amplitudes.

    unit (point, dof): unit of the displacements of amplitudes. It is the amplitude, but at least a part of
    the greatest amplitude: the rounding of a degree of freedom that hardly moves would hide the others.
    linear (point,): where no contact slips or separates, so that nothing is displaced.
    arc (point,): arc length along the path, in scaled coordinates.
    contact_loads (point, 4 contact): those of the path's contacts.
    ends_before (point,): where the reference turns back earlier, and passes the frequency less often.
    followed: the stretches beside which it was followed, see `follow_stretches`.
    """

    def __init__(
        self,
        system: System,
        reported: ReportedPath,
        more: tuple[int, ...],
        options: PairOptions,
        budget: Budget,
    ) -> None:
        path, quantities = reported.path, reported.quantities
        self.path, self.quantities, self.options, self.fewer = path, quantities, options, system.harmonics
        self.contact_loads = reported.contact_loads
        self.amplitude, self.linear = quantities.amplitude, _with_ends(path, quantities.linear)
        least = system.options.spectrum.least_amplitude * self.amplitude.max(axis=1, keepdims=True)
        self.unit = np.maximum(self.amplitude, least)
        self.unit[self.unit == 0.0] = 1.0
        prolongation, finer = prolongation_to(system, more, options), system.with_harmonics(more)
        self.system, self.more = system, more
        self.finding = PointwiseDisplacement(prolongation)
        self.stretches = StretchFollower(system, finer, prolongation, path, options, budget)
        self.each = seconds_of(finer, 1, len(more))  # seconds for one evaluation
        self.second: SecondReference | None = None  # the second reference, if it is affordable
        self.is_costly = False
        self.errors_at_tops = list[tuple[ReferenceTop, tuple[FloatArray, float]]]()
        self.failed, self.before = budget.seconds / self.each, prolongation.newton.evaluations
        count, dofs = self.amplitude.shape
        self.arc, self.weight = np.zeros((2, count))
        arc_lengths(path.z, path.direction, np.ptp(path.parameter) or 1.0, self.arc)
        steepness(np.ascontiguousarray(path.parameter), self.amplitude, options.max_steepness, self.weight)
        self.change = np.zeros((count, 1 + dofs))
        self.reference_unknowns = np.full((count, len(prolongation.newton.z)), np.nan)  # where it was found
        self.known, self.ends_before = self.linear.copy(), np.zeros_like(self.linear)
        self.followed = list[FollowedStretch]()
        self.filled = PartialInterpolant(self.arc, self.change, self.known.view(np.uint8), options.distance)

    def displacements(self, special: Indices) -> FloatArray:
        """Displacements (point, 1 + dof) to the reference: computed at some points, interpolated elsewhere.

        They are computed at special points, at equally spaced points, and at both ends of linear parts. The
        interval between two of these is bisected until the interpolation predicts the middle.
        """
        count = len(self.known)
        changes = np.flatnonzero(np.diff(self.linear))
        spaced = np.arange(0, count, self.options.point_interval)
        first = distinct_values(special, spaced, np.array([0, count - 1]), changes, changes + 1)
        self.find(first)
        before, after = first[:-1], first[1:]
        while len(before):
            wide = (after - before > 1) & ~(self.linear[before] & self.linear[after])
            wide &= ~(np.isnan(self.change[before, 0]) & np.isnan(self.change[after, 0]))
            before, after = before[wide], after[wide]
            middle = (before + after) // 2
            expected = self.interpolated(middle)
            self.find(middle)
            more = self._misses_expected(before, middle, after, expected)
            before, after = (
                np.concatenate((before[more], middle[more])),
                np.concatenate((middle[more], after[more])),
            )
        return self.interpolated(np.arange(count))

    def frequency_of(self, top: ReferenceTop, change: FloatArray) -> float:
        """The frequency [rad/s] of a top; change (point, 1 + dof): the displacements from the curve."""
        if top.piece is not None:
            return float(top.piece.path.parameter[top.point])
        return float(self.path.parameter[top.point] * (1.0 + change[top.point, 0]))

    def is_same_curve(self) -> bool:
        """Whether the reference is found from most of a few points spread evenly along the curve."""
        spaced = np.arange(0, len(self.known), self.options.point_interval)
        some = spaced[:: max(len(spaced) // self.options.probes, 1)].copy()
        self.find(some)
        return bool(np.isfinite(self.change[some, 0]).mean() >= self.options.min_found)

    def distinct_points(self, points: Indices) -> Indices:
        """The given points, in order, without those close to one already taken.

        Many degrees of freedom each have a peak of their own; the reference at one is interpolated to the
        next.
        """
        return points[distinct(self.arc[points], self._near)]

    def release(self) -> None:
        """Return the prolongations to the cache, for the next curve."""
        keep_for_next(self.finding.prolongation, self.system, self.more, self.options)
        if self.second is not None:
            keep_for_next(self.second.prolongation, self.second.finer, self.second.more, self.options)

    def seconds(self) -> float:
        """Estimated seconds that all searches of this reference have taken."""
        point_by_point = self.finding.prolongation.newton.evaluations - self.before
        seconds = self.each * (point_by_point + self.stretches.evaluations)
        return float(seconds + (self.second.seconds() if self.second else 0.0))

    def find(self, points: Indices) -> None:
        """Compute the displacements of given points; once the work allowed is spent, they are NaN."""
        most = self.options.max_point_seconds / self.each
        if most < np.inf:
            for k, i in enumerate(points.tolist()):
                if self.finding.prolongation.newton.evaluations - self.before > most:
                    rest = points[k:][~self.known[points[k:]]]
                    self.change[rest], self.reference_unknowns[rest], self.known[rest] = np.nan, np.nan, True
                    return
                if not self.known[i]:
                    self.finding.find(points[k : k + 1], self, self.failed)
            return
        self.finding.find(points, self, self.failed)

    @cached_property
    def _further(self) -> FurtherHarmonics:
        """The harmonics that the reference itself leaves out."""
        return FurtherHarmonics(self.stretches.finer)

    @property
    def is_found(self) -> Mask:
        """Mask (point,) of the points displaced to the reference at which contacts slip or separate."""
        found: Mask = self.known & ~self.linear & np.isfinite(self.change).all(axis=1)
        return found

    def left_out(self, points: Indices) -> FloatArray:
        """Sum (place,) of the relative changes by the harmonics beyond the reference, without feedback.

        The points must have been found. The change by a harmonic is that of the degree of freedom to which it
        matters most.
        """
        amplitude = self.amplitude[points] + self.unit[points] * self.change[points, 1:]
        shares = self._further.shares(self.reference_unknowns[points], amplitude)
        total: FloatArray = shares.sum(axis=1)
        return total

    @property
    def may_have_second(self) -> bool:
        """Whether a second reference is affordable, judged by the reference's number of harmonics."""
        finer = self.stretches.finer
        return 2 * finer.layout.ports * len(finer.harmonics) <= self.options.max_second_unknowns

    def own_error(self, i: int) -> FloatArray | None:
        """Differences (dof,) between the second reference and the reference, in the unit of the curve.

        They are compared at the frequency to which point i is displaced; None if either has no motion there.
        """
        self.find(np.array([i]))
        z, amplitude = self.reference_unknowns[i], self.amplitude[i] + self.unit[i] * self.change[i, 1:]
        if np.isnan(amplitude).any():
            return None
        second = self._second(z, amplitude)
        if second is None or not second.found(z, None):
            return None
        off: FloatArray = np.abs(second.amplitude - amplitude) / self.unit[i]
        return off

    def error_at_top(self, top: ReferenceTop, d: int, difference: float) -> FloatArray:
        """Errors (2,) of the reference itself at a top of degree of freedom d.

        The first is the difference of the second reference's amplitude; 0 if there is no second reference.
        The other is the change by the harmonics that the second reference lacks, too. Both are NaN if the
        second reference is not found, and its error may exceed the curve's relative difference.

        The references are compared normal to the first, at the nearest point that has both, or at an end of
        the curve at its frequency. Tops close together share the errors of the first.
        """
        arc = top.arc(self)
        beside = (
            found
            for one, found in self.errors_at_tops
            if one.piece is top.piece and abs(one.arc(self) - arc) <= self._near
        )
        found = next(beside, None)
        if found is None:
            found = self._errors_at_top(top)
            self.errors_at_tops.append((top, found))
        errors, left_out = found
        return errors[:, d] if left_out <= difference else np.full(2, np.nan)

    def _errors_at_top(self, top: ReferenceTop) -> tuple[FloatArray, float]:
        """Errors (2, dof) as in `error_at_top`, and the estimated error if no second reference is found.

        That estimate is relative, from the shares of the harmonics left out; it is 0 if the errors are known.
        """
        none = np.zeros((2, self.amplitude.shape[1]))
        if top.piece is None and self.linear[top.point]:
            return none, 0.0
        left_out = np.inf
        for z, amplitude, direction in self._motions_around(top):
            second = self._second(z, amplitude)
            if second is None:
                none[1] = self._left_out(self.stretches.finer, self.finding.prolongation, z)
                return none, 0.0
            if second.found(z, direction):
                there = np.array(second.prolongation.newton.z)
                left = self._left_out(second.system, second.prolongation, there)
                return np.stack((second.amplitude - amplitude, left)), 0.0
            if left_out == np.inf:
                left_out = float(self._further.shares(z[None], amplitude[None]).sum())
        return none, self.options.feedback_factor * left_out

    def _motions_around(
        self, top: ReferenceTop
    ) -> Iterator[tuple[FloatArray, FloatArray, FloatArray | None]]:
        """Yield motions of the reference at a top and on either side of it where contacts slip or separate.

        Each comes with its amplitudes and the direction of the curve. The direction is None at an end, where
        motions are compared at the same frequency.
        """
        count = len(self.linear) if top.piece is None else len(top.piece.path.z)
        inside = top.piece is not None or 0 < top.point < count - 1
        neighbours = (0, *(way * step for step in self.options.peak_offsets for way in (-1, 1)))
        places = [i for i in (top.point + step for step in neighbours) if 0 <= i < count]
        for i in places if inside else (top.point,):
            if top.piece is not None:
                path, amplitude = top.piece.path, top.piece.quantities.amplitude
                yield path.z[i], amplitude[i], path.direction[i]
            elif not self.linear[i] and self._has_point(i, inside):
                prolongation = self.finding.prolongation
                newton = prolongation.newton
                direction = np.array(newton.tangent) * np.array(newton.scale)
                z, amplitude = np.array(newton.z), np.array(prolongation.found[1:])
                yield z, amplitude, direction if inside else None

    def _left_out(self, system: System, prolongation: Prolongation, z: FloatArray) -> FloatArray:
        """Changes (dof,) of the amplitudes of a motion by the harmonics that its system leaves out."""
        return changes_left_out(system, prolongation.balance, z, self.options)

    def _has_point(self, i: int, normal: bool) -> bool:
        """Whether Newton's method finds the reference normal to a point of the curve, or at its frequency."""
        prolongation, path = self.finding.prolongation, self.path
        if normal and prolongation.find_normal(path.z[i], path.direction[i], True):
            return True
        return not normal and bool(prolongation.find_at_frequency(self._guesses[i], True))

    def _second(self, z: FloatArray, amplitude: FloatArray) -> SecondReference | None:
        """The second reference; None if it has no more harmonics, or too many unknowns.

        Its harmonics are chosen at the first point z at which it is needed.
        """
        finer, options = self.stretches.finer, self.options
        if self.is_costly:
            return None
        if self.second is None:
            share = self._further.shares(z[None], amplitude[None])[0]
            more = reference_harmonics(finer.harmonics, share, finer.layout.ports, options.second_pair)
            unknowns = 2 * finer.layout.ports * len(more)  # besides the means
            self.is_costly = more == finer.harmonics or unknowns > options.max_second_unknowns
            self.second = None if self.is_costly else SecondReference(finer, more, options)
        return self.second

    def amplitude_at_frequency(self, i: int) -> FloatArray | None:
        """Amplitudes (dof,) of the reference at the frequency of point i, from Newton's method.

        None if that diverges, or finds a motion whose number of real multipliers above 1 has another parity.
        """
        prolongation, path = self.finding.prolongation, self.path
        if self.linear[i] or not prolongation.find_at_frequency(self._guesses[i], True):
            return None
        if not prolongation.newton.orientation * prolongation.newton.tangent[-1] * path.parity[i] > 0.0:
            return None
        return np.array(prolongation.found[1:])

    @cached_property
    def _guesses(self) -> FloatArray:
        """The points of the curve (point, unknown + 1) extended to the unknowns of the reference."""
        return self.stretches.finer.extended(self.path.z, self.fewer)

    def interpolated(self, points: Indices) -> FloatArray:
        """Displacements (point, 1 + dof) at given points, by cubics through the known ones."""
        values = np.empty((len(points), self.change.shape[1]))
        self.filled.interpolate(points, values)
        return values

    def _misses_expected(
        self, before: Indices, middle: Indices, after: Indices, expected: FloatArray
    ) -> Mask:
        """Mask of the middle points whose displacement differs from the interpolated one.

        The displacement of the frequency is weighted by the steepness of the curve.
        """
        more, options = np.zeros(len(middle), dtype=np.uint8), self.options
        points = np.array((before, middle, after))
        self.filled.misses_expected(
            points,
            expected,
            self.weight,
            options.interpolation_tolerance,
            options.negligible_displacement,
            more,
        )
        return more.view(np.bool_)

    def follow_stretches(self, change: FloatArray) -> None:
        """Follow the reference beside the stretches without displacements, the highest first."""
        found = [run for run in runs(np.any(np.isnan(change), axis=1)) if not self._is_bridged(*run, change)]
        found.sort(key=lambda run: -float(self.amplitude[run[0] : run[1]].max()))
        self.followed = [
            FollowedStretch(first, end, self.stretches.between(first - 1, end, self.reference_unknowns))
            for first, end in found
        ]

    def _is_bridged(self, first: int, end: int, change: FloatArray) -> bool:
        """Whether a short gap (first to end - 1) can be interpolated from its two nearly equal neighbours.

        If so, fill `change` there. A gap at a fold is never bridged.
        """
        before, after = first - 1, end
        if (self.path.mark[max(before, 0) : after + 1] & Mark.FOLD).any():
            return False
        if before < 0 or after == len(change) or self.arc[after] - self.arc[before] > self._near:
            return False
        one, other = change[before], change[after]
        most = max(np.abs(one).max(), np.abs(other).max(), self.options.negligible_displacement)
        if not np.abs(other - one).max() < self.options.interpolation_tolerance * most:
            return False
        self.known[first:end] = False
        change[first:end] = self.interpolated(np.arange(first, end))
        return True

    @property
    def _near(self) -> float:
        return float(self.options.peak_spacing * (self.arc[-1] - self.arc[0]))

    def compared_quantities(self, change: FloatArray) -> ComparedQuantities:
        """Amplitudes and contact loads of the curve, with changes to the reference at all points.

        change (point, 1 + dof) is that of frequency and amplitudes; those of the contact loads are
        interpolated. The unit of a contact load is its maximum along the curve.
        """
        most = self.contact_loads.max(axis=0)
        unit = np.tile(np.where(most > 0.0, most, 1.0), (len(self.contact_loads), 1))
        found = np.zeros((len(change), 1 + self.contact_loads.shape[1]))
        found[:, 0] = self.change[:, 0]
        there = self.known & ~self.linear & np.isfinite(self.change[:, 0])
        of_reference = contact_loads_along(self.stretches.finer, self.reference_unknowns[there]).reshape(
            -1, self.contact_loads.shape[1]
        )
        found[there, 1:] = (of_reference - self.contact_loads[there]) / unit[there]
        found[np.isnan(found[:, 0])] = np.nan
        every = np.empty_like(found)
        PartialInterpolant(self.arc, found, self.known.view(np.uint8), self.options.distance).interpolate(
            np.arange(len(change)), every
        )
        return ComparedQuantities(
            np.hstack((self.amplitude, self.contact_loads)),
            np.hstack((self.quantities.growth, rates(self.contact_loads, self.arc))),
            np.hstack((self.unit, unit)),
            np.hstack((change, every[:, 1:])),
        )

    def shifts(self, compared: ComparedQuantities) -> FloatArray:
        """Differences (point, column) from curve to reference at equal frequency, in their unit.

        NaN where the reference does not reach that frequency.
        """
        path, change = self.path, compared.change
        shift = shifted(self.arc, path.z, path.direction, compared)
        shift[np.isnan(change).any(axis=1)] = np.nan
        self._fill_beyond_folds(compared, shift)
        for one in self.followed:
            self._fill_from_pieces(one, compared, shift)
        return shift

    def _fill_beyond_folds(self, compared: ComparedQuantities, shift: FloatArray) -> None:
        """Fill shifts at points whose frequency the reference does not reach before it turns back.

        Nothing is done unless all of the reference is known. Points whose frequency both curves pass exactly
        once are filled. Points whose frequency the reference passes less often are marked in `ends_before`.
        """
        missing = np.isnan(shift).any(axis=1) & np.isfinite(compared.change).all(axis=1)
        whole = all(len(one.pieces) == 1 and one.pieces[0].reached_end for one in self.followed)
        rows, own = np.flatnonzero(missing), self.path.parameter
        if not whole or not rows.size:
            return
        pieces, of_curve = self.pieces(compared), passings(own, own[rows])
        of_reference = sum((passings(one.frequency, own[rows]) for one in pieces), np.zeros_like(of_curve))
        self.ends_before[rows] = of_reference < of_curve
        some = rows[(of_curve == 1) & (of_reference == 1)]
        if not some.size:
            return
        now, parity = compared.value[some], np.zeros(len(some))
        by = np.ascontiguousarray(now[:, : self.amplitude.shape[1]])
        shift[some] = (nearest(pieces, own[some], parity, by) - now) / compared.unit[some]

    def _fill_from_pieces(
        self, one: FollowedStretch, compared: ComparedQuantities, shift: FloatArray
    ) -> None:
        """Fill the shifts along a followed stretch, and next to it, from the pieces followed.

        Where these do not reach, the reference at the points before and after the stretch is used.
        """
        first, end = one.first, one.end
        missing: Mask = np.any(np.isnan(shift), axis=1)
        while first > 0 and missing[first - 1]:
            first -= 1
        while end < len(shift) and missing[end]:
            end += 1
        rows = np.arange(first, end)
        omega, parity = self.path.parameter[rows], self.path.parity[rows]
        number = np.full(len(rows), -1, dtype=np.intc)
        if (self.path.mark[first:end] & Mark.FOLD).any():
            number = self._passing_numbers(one, rows)
        now = compared.value[rows]
        dofs = self.amplitude.shape[1]  # amplitudes identify the motion
        by = np.ascontiguousarray(now[:, :dofs])
        for way in (map(self._of_piece, one.pieces), self._pieces_near(compared, one.first, one.end)):
            new, own = shift[rows], np.isnan(shift[rows]).any(axis=1) & (number > -2)
            for other in way:
                found = (other.values_at(omega, parity, by, number) - now) / compared.unit[rows]
                off, before = (np.abs(x[:, :dofs]).max(axis=1) for x in (found, new))
                nearer = ~(off >= before) & own
                nearer &= np.isfinite(found).all(axis=1)
                new[nearer] = found[nearer]
            shift[rows], number = new, np.minimum(number, -1)

    def _pieces_near(self, compared: ComparedQuantities, first: int, end: int) -> Iterator[CurvePiece]:
        """Yield the reference at the known points before a stretch, and after it, as pieces of a curve."""
        missed = np.flatnonzero(np.isnan(compared.change).any(axis=1))
        low = max(missed[missed < first], default=-1) + 1
        high = min(missed[missed >= end], default=len(compared.change))
        for rows in (slice(low, first), slice(end, high)):
            piece = self._displaced(compared, rows)
            if piece is not None:
                yield piece

    def pieces(self, compared: ComparedQuantities) -> tuple[CurvePiece, ...]:
        """All known pieces of the reference: through displaced points, and along followed stretches."""
        missed: Mask = np.any(np.isnan(compared.change), axis=1)
        through = [self._displaced(compared, slice(first, end)) for first, end in runs(~missed)]
        along = [self._of_piece(piece) for one in self.followed for piece in one.pieces]
        return tuple(one for one in (*through, *along) if one is not None)

    def motions(self) -> KnownMotions:
        """All motions of the reference that were found, in order along each piece of its curve."""
        found = [self.reference_unknowns[np.isfinite(self.reference_unknowns).all(axis=1)]]
        found += [piece.path.z for one in self.followed for piece in one.pieces]
        return KnownMotions(self.stretches.finer.harmonics, tuple(one for one in found if len(one) > 1))

    def _displaced(self, compared: ComparedQuantities, rows: slice) -> CurvePiece | None:
        """The piece of the reference through points that are all displaced to it."""
        change = compared.change[rows]
        omega = self.path.parameter[rows] * (1.0 + change[:, 0])
        value = compared.value[rows] + compared.unit[rows] * change[:, 1:]
        return piece_through(self.arc[rows], omega, self.path.orientation[rows], value)

    def _of_piece(self, piece: ReferencePiece) -> CurvePiece:
        return curve_piece(self.stretches.finer, piece)

    def contact_loads_of(self, piece: ReferencePiece) -> FloatArray:
        """Contact loads (point, 4 contact) along a followed piece of the reference."""
        return contact_loads_along(self.stretches.finer, piece.path.z).reshape(len(piece.path.z), -1)

    def _passing_numbers(self, one: FollowedStretch, rows: Indices) -> npt.NDArray[np.intc]:
        """Number (row,) of the reference's passing that matches each point of a stretch with folds.

        If curve and reference pass the frequency equally often, passings match in order. It is -1 (the
        nearest) if the reference passes more often, or is not one piece, and -2 (none) if less often.
        """
        own, omega = self.path.parameter[max(rows[0] - 1, 0) : rows[-1] + 2], self.path.parameter[rows]
        offset, of_curve = rows[0] - max(rows[0] - 1, 0), passings(own, omega)
        of_reference = sum(
            (passings(piece.path.parameter, omega) for piece in one.pieces), np.zeros_like(of_curve)
        )
        number = np.where(of_reference < of_curve, -2, -1).astype(np.intc)
        same = (
            np.flatnonzero(of_reference == of_curve) if len(one.pieces) == 1 else np.empty(0, dtype=np.intp)
        )
        for first in range(0, len(same), self.options.batch):
            some = same[first : first + self.options.batch]
            passes = _passes(own, omega[some])
            before = np.arange(passes.shape[1]) < (offset + some - 1)[:, None]
            number[some] = (passes & before).sum(axis=1)
        return number


def curve_piece(finer: System, piece: ReferencePiece) -> CurvePiece:
    """The `CurvePiece` of a followed piece of the reference, with its contact loads."""
    contact_loads = contact_loads_along(finer, piece.path.z).reshape(len(piece.path.z), -1)
    return piece_of(ReportedPath(piece.path, piece.quantities, contact_loads))


def passings(parameter: FloatArray, omega: FloatArray) -> Indices:
    """How often (place,) a curve passes given frequencies.

    Intervals that begin below and end at or above the frequency count, and the other way round.

    >>> passings(np.array([0.0, 2.0, 1.0, 3.0]), np.array([0.0, 0.5, 1.5, 3.0, 4.0])).tolist()
    [1, 1, 3, 1, 0]
    """
    if len(parameter) < 2:
        return np.zeros(len(omega), dtype=np.intp)
    one, other = parameter[:-1], parameter[1:]
    found: Indices = np.searchsorted(np.sort(np.minimum(one, other)), omega)
    found -= np.searchsorted(np.sort(np.maximum(one, other)), omega)
    for end, beside in ((0, 1), (-1, -2)):  # an end at the frequency counts, too
        found += (parameter[end] == omega) & (omega < parameter[beside])
    return found


def _passes(parameter: FloatArray, omega: FloatArray) -> Mask:
    """Mask (place, interval) of the intervals between neighbouring points that pass given frequencies."""
    below = parameter < omega[:, None]
    passes: Mask = below[:, 1:] != below[:, :-1]
    if passes.shape[1]:  # an end at the frequency counts, too
        passes[:, 0] |= (parameter[0] == omega) & (omega < parameter[1])
        passes[:, -1] |= (parameter[-1] == omega) & (omega < parameter[-2])
    return passes


def _with_ends(path: Path, linear: Mask) -> Mask:
    """The linear points, together with the corners at which linear parts end.

    Rounding decides on which side of a corner its point lies.
    """
    neighbours = np.zeros_like(linear)
    neighbours[1:] |= linear[:-1]
    neighbours[:-1] |= linear[1:]
    ends: Mask = linear | (neighbours & ((path.mark & Mark.CORNER) > 0))
    return ends
