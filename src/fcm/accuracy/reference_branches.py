"""Motions of the reference at frequencies that no known branch of it reaches.

If the reference is another curve, few of its points lie normal to the path. Then it is followed only here,
with as many harmonics as the work allows. The motions belong to the whole response: those followed from one
branch serve the other branches, too, and all share one budget.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fcm.accuracy.budget import Budget, share_of
from fcm.accuracy.options import PairOptions
from fcm.accuracy.reference_curve import curve_piece
from fcm.accuracy.reference_harmonics import reference_harmonics
from fcm.accuracy.reference_pieces import CurvePiece
from fcm.accuracy.reference_stretch import StretchFollower
from fcm.continuation import Path, Status
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.options import DampedOptions, ProlongationOptions
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.reported_quantities import ReportedQuantities
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

if TYPE_CHECKING:
    from fcm.accuracy.embedded_pair import PathErrors

# with damped steps for any number of contacts, as the starts lie far from the motions that are sought
OF_FAR_MOTIONS = ProlongationOptions(damped=DampedOptions(min_contacts=0))


def further_reference_pieces(
    system: System,
    paths: Sequence[Path],
    quantities: Sequence[ReportedQuantities],
    errors: Sequence[PathErrors],
    first: int,
    options: PairOptions,
) -> list[list[CurvePiece]]:
    """Further pieces of each path's reference, so that at least one piece passes each frequency.

    The search ends when every frequency is passed, or the work allowed is spent.

    Starts are points of the paths from `first` on whose errors are unknown, the smallest motions first: there
    the reference has the fewest motions. After Newton's method from these points, the force level is
    followed, and then points between those that were tried.
    """
    search = _Search(system, paths, quantities, errors, first, options)
    interval = options.point_interval
    while interval and search.is_open and search.extends(interval):
        interval //= options.interval_factor
    # the work of the levels is charged already
    system.work.add(sum(one.each * one.evaluations for one in search.followers.values()))
    return search.found


def affordable_reference(
    system: System, path: Path, share: FloatArray, options: PairOptions
) -> tuple[int, ...]:
    """Harmonics of the reference on other branches; fewer if following it would exceed its budget.

    It is estimated to take the evaluations of the path, times the ratio of the numbers of harmonics. share is
    as in `reference_harmonics`.
    """
    most, ports = Budget.elsewhere(system.work, options).seconds, system.layout.ports
    more = reference_harmonics(system.harmonics, share, ports, options)
    for times in options.fewer_factors:
        growth = len(more) / len(system.harmonics)
        if seconds_of(system, 1, len(more)) * path.evaluations * growth <= most:
            break
        fewer = replace(options, harmonics_factor=times, max_named=1)
        more = reference_harmonics(system.harmonics, share, ports, fewer)
    return more


@dataclass(eq=False)
class _Front:
    """A point from which the reference of a path is followed further, with the direction there.

    `gain` is the number of points that its last piece reached first, per second of work.
    """

    path: int
    z: FloatArray
    direction: FloatArray | None
    forward: bool
    gain: float = np.inf


class _Search:
    """Search for pieces of references of each path, within a budget, until every frequency is passed."""

    def __init__(
        self,
        system: System,
        paths: Sequence[Path],
        quantities: Sequence[ReportedQuantities],
        errors: Sequence[PathErrors],
        first: int,
        options: PairOptions,
    ) -> None:
        self.system, self.paths, self.errors, self.first = system, paths, errors, first
        part = share_of([path.evaluations for path in paths], first)
        self.options, self.budget = options, Budget.elsewhere(system.work, options, part)
        self.each = self.budget.seconds * options.piece_fraction
        self.found: list[list[CurvePiece]] = [[] for _ in paths]
        self.known = [piece for one in errors for piece in one.pieces]
        self.unknown = [
            _UnknownError(*one, system.harmonics) for one in zip(paths, quantities, errors, strict=True)
        ]
        self.followers = dict[int, StretchFollower]()
        self.closed = list[FloatArray]()  # starts of closed pieces
        for piece in self.known:
            _newly_known(piece, self.unknown)

    @property
    def is_open(self) -> bool:
        """Whether points without an error and budget are left."""
        return self.budget.seconds > 0.0 and self.unknown_fraction > 0.0

    @property
    def unknown_fraction(self) -> float:
        """Fraction of the points, of the paths from the first on, that no piece has reached."""
        size = np.concatenate([one.size for one in self.unknown[self.first :]])
        return float(np.isfinite(size).mean()) if size.size else 0.0

    def extends(self, interval: int) -> bool:
        """Whether starting from points `interval` apart has found any new piece of a reference."""
        before = len(self.known)
        self.from_motions(interval)
        if interval == self.options.point_interval:
            self.from_levels(interval)
        return len(self.known) > before

    def from_motions(self, interval: int) -> None:
        """Follow the reference from motions `interval` points apart, then further from the best fronts."""
        left = list[_Front]()
        for k, i in self._places(interval):
            if self.unknown[k].sought[i]:  # it was tried before
                continue
            self.unknown[k].sought[i] = True
            for front in self._fronts(k, i, by_level=False):
                left += self._followed(front)
        self._follow(left)

    def from_levels(self, interval: int) -> None:
        """Follow the reference from motions that the force level passes at points `interval` apart.

        It stops when finding a motion takes more than the budget allows.
        """
        for k, i in self._places(interval):
            fronts = self._fronts(k, i, by_level=True)
            self._follow(fronts)
            if not fronts and self.followers[k].budget.seconds <= 0.0:
                break

    def _places(self, interval: int) -> Iterator[tuple[int, int]]:
        """Yield (path, point) of the smallest motions that no piece has reached, `interval` points apart."""
        for one in self.unknown:
            one.tried[:] = False
        while self.budget.seconds > 0.0:
            k = min(range(self.first, len(self.paths)), key=lambda k: self.unknown[k].least, default=-1)
            if k < 0 or not np.isfinite(self.unknown[k].least):
                break
            i = self.unknown[k].smallest
            self.unknown[k].tried[max(i - interval + 1, 0) : i + interval] = True
            yield k, i

    def _fronts(self, k: int, i: int, by_level: bool) -> list[_Front]:
        """Two fronts, forward and backward, at the reference's motion at a point; none if none is found."""
        stretches, most = self._stretches(k), self.each
        if by_level:
            most = self.budget.seconds * self.options.level_fraction * self.unknown_fraction
        stretches.budget = Budget(most)
        z = stretches.start(i, by_level)
        self.budget.seconds -= most - stretches.budget.seconds
        if z is None:
            return []
        return [_Front(k, z, None, forward) for forward in (True, False)]

    def _follow(self, fronts: list[_Front]) -> None:
        """Follow the reference from fronts, always from the one with the greatest gain."""
        while fronts and self.is_open:
            best = max(fronts, key=lambda one: one.gain)
            fronts.remove(best)
            fronts += self._followed(best)

    def _followed(self, front: _Front) -> list[_Front]:
        """Follow a piece from a front; return the front at its end if it was useful and interrupted."""
        stretches, count = self._stretches(front.path), 0
        given = min(self.each, self.budget.seconds)
        if given <= 0.0 or any(front.z is begin for begin in self.closed):
            return []
        stretches.budget = Budget(given)
        span = _gap(self.known, float(front.z[-1]), self.system.scene.frequency_range)
        piece = stretches.along(front.z, front.direction, span, front.forward)
        spent = given - stretches.budget.seconds
        self.budget.seconds -= spent
        path = piece.path
        if path.status is Status.CLOSED:
            self.closed.append(front.z)
        if len(path.z) > 1:
            new = curve_piece(stretches.finer, piece)
            self.found[front.path].append(new)
            self.known.append(new)
            count = _newly_known(new, self.unknown)
        if not count or path.status is not Status.INTERRUPTED:
            return []
        return [_Front(front.path, path.z[-1], path.direction[-1], True, count / spent)]

    def _stretches(self, k: int) -> StretchFollower:
        """The `StretchFollower` of path k's reference, made for motions that lie far from the path."""
        if k not in self.followers:
            more = self.errors[k].reference
            finer, options = self.system.with_harmonics(more), self.options
            prolongation = Prolongation(
                finer.new_balance(),
                list(self.system.harmonics),
                list(more),
                options.newton_tolerance,
                OF_FAR_MOTIONS,
            )
            coarse = options.coarse_following
            rough = replace(options, following=coarse, following_of_many=coarse)
            self.followers[k] = StretchFollower(
                self.system, finer, prolongation, self.paths[k], rough, Budget(0.0)
            )
        return self.followers[k]


class _UnknownError:
    """The points of a path whose errors are unknown, with the sizes of their motions.

    `tried` (point,): used at the present interval. `sought` (point,): used at any interval.
    """

    def __init__(
        self, path: Path, quantities: ReportedQuantities, errors: PathErrors, harmonics: tuple[int, ...]
    ) -> None:
        self.path, self.size = path, quantities.amplitude.max(axis=1)
        self.size[errors.is_same_curve] = np.inf
        if errors.reference == harmonics:  # it has no reference
            self.size[:] = np.inf
        self.tried, self.sought = np.zeros((2, len(self.size)), dtype=np.bool_)

    @property
    def least(self) -> float:
        return float(np.where(self.tried, np.inf, self.size).min(initial=np.inf))

    @property
    def smallest(self) -> int:
        return int(np.where(self.tried, np.inf, self.size).argmin())


def _newly_known(piece: CurvePiece, unknown: Sequence[_UnknownError]) -> int:
    """Number of points whose frequency a piece is the first to pass."""
    count = 0
    for one in unknown:
        passed = piece.passes(one.path.parameter)
        count += int(np.isfinite(one.size[passed]).sum())
        one.size[passed] = np.inf
    return count


def _gap(known: Sequence[CurvePiece], omega: float, span: tuple[float, float]) -> tuple[float, float]:
    """The frequency range around omega that no known piece passes, within a given span."""
    low = max((top for piece in known if (top := float(piece.frequency.max())) < omega), default=span[0])
    high = min((end for piece in known if (end := float(piece.frequency.min())) > omega), default=span[1])
    return max(low, span[0]), min(high, span[1])
