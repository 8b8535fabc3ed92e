"""Motions of the partner at frequencies to which no branch of it is known to come.

Where the partner is another curve, few of its points lie normal to the path, and it is followed here alone,
with as many harmonics as the work allows.
They belong to the whole response: what is followed from one branch tells the others, too, and all of it has
one budget.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fcm.accuracy.budget import Budget, share_of
from fcm.accuracy.options import PairOptions
from fcm.accuracy.partner import partner_of
from fcm.accuracy.partner_curve import curve_piece
from fcm.accuracy.partner_pieces import CurvePiece
from fcm.accuracy.partner_stretch import StretchFollower
from fcm.continuation import Path
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.options import DampedOptions, ProlongationOptions
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.reported_quantities import ReportedQuantities
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

if TYPE_CHECKING:
    from fcm.accuracy.embedded_pair import Errors

# of any number of contacts, as the motions lie far from those that are sought
OF_FAR_MOTIONS = ProlongationOptions(damped=DampedOptions(min_contacts=0))


def further_partner_pieces(
    system: System,
    paths: Sequence[Path],
    shown: Sequence[ReportedQuantities],
    errors: Sequence[Errors],
    first: int,
    options: PairOptions,
) -> list[list[CurvePiece]]:
    """For each path pieces of its partner, of which at least one passes each frequency that no piece is known
    to pass, as far as the work allows.

    They are followed from points of the paths from the first on whose errors are not told, those of the
    smallest motions before the others: there the partner has fewest. Where no motion of such a path leads to
    one of its partner, the level of the forces may.
    """
    found: list[list[CurvePiece]] = [[] for _ in paths]
    known = [piece for one in errors for piece in one.pieces]
    untold = [_UnknownError(*one, system.harmonics) for one in zip(paths, shown, errors, strict=True)]
    for piece in known:
        _told_by(piece, untold)
    part = share_of([path.evaluations for path in paths], first)
    budget, followers = Budget.elsewhere(system.work, options, part), dict[int, StretchFollower]()
    for by_level in (False, True):
        for one in untold:
            one.tried[:] = False
        while budget.seconds > 0.0:
            k = min(range(first, len(paths)), key=lambda k: untold[k].least, default=-1)
            if k < 0 or not np.isfinite(untold[k].least):
                break
            i = untold[k].smallest
            untold[k].tried[max(i - options.point_interval, 0) : i + options.point_interval] = True
            stretches = followers.get(k)
            if stretches is None:
                stretches = followers[k] = _stretches(system, paths[k], errors[k].partner, options)
            stretches.budget = Budget(budget.seconds * options.piece_fraction)
            given = stretches.budget.seconds
            span = _gap(known, float(paths[k].parameter[i]), system.scene.frequency_range)
            for piece in (curve_piece(stretches.finer, one) for one in stretches.through(i, span, by_level)):
                found[k].append(piece)
                known.append(piece)
                _told_by(piece, untold)
            budget.seconds -= given - stretches.budget.seconds
    # what the levels took is paid already
    system.work.add(sum(one.each * one.evaluations for one in followers.values()))
    return found


def affordable_partner(
    system: System, path: Path, share: FloatArray, options: PairOptions
) -> tuple[int, ...]:
    """The partner's harmonics where it is another curve; fewer where following it takes longer than it may.

    That is about as many evaluations as the path took, for so many times as many harmonics. share as of
    `partner_of`.
    """
    most, ports = Budget.elsewhere(system.work, options).seconds, system.layout.ports
    more = partner_of(system.harmonics, share, ports, options)
    for times in options.fewer_factors:
        growth = len(more) / len(system.harmonics)
        if seconds_of(system, 1, len(more)) * path.evaluations * growth <= most:
            break
        fewer = replace(options, harmonics_factor=times, max_named=1)
        more = partner_of(system.harmonics, share, ports, fewer)
    return more


class _UnknownError:
    """The points of a path whose errors are not told, and whether they were tried, with the sizes of their
    motions."""

    def __init__(
        self, path: Path, shown: ReportedQuantities, errors: Errors, harmonics: tuple[int, ...]
    ) -> None:
        self.path, self.size = path, shown.amplitude.max(axis=1)
        self.size[errors.is_same_curve] = np.inf
        if errors.partner == harmonics:  # it has none
            self.size[:] = np.inf
        self.tried = np.zeros(len(self.size), dtype=np.bool_)

    @property
    def least(self) -> float:
        return float(np.where(self.tried, np.inf, self.size).min(initial=np.inf))

    @property
    def smallest(self) -> int:
        return int(np.where(self.tried, np.inf, self.size).argmin())


def _told_by(piece: CurvePiece, untold: Sequence[_UnknownError]) -> None:
    for one in untold:
        one.size[piece.passes(one.path.parameter)] = np.inf


def _gap(known: Sequence[CurvePiece], omega: float, span: tuple[float, float]) -> tuple[float, float]:
    """Between the frequencies next to one, below and above, that pieces are known to pass."""
    low = max((top for piece in known if (top := float(piece.frequency.max())) < omega), default=span[0])
    high = min((end for piece in known if (end := float(piece.frequency.min())) > omega), default=span[1])
    return max(low, span[0]), min(high, span[1])


def _stretches(system: System, path: Path, more: tuple[int, ...], options: PairOptions) -> StretchFollower:
    """Of the partner of a path, sought from motions that lie far from it."""
    finer = system.with_harmonics(more)
    lifted = Prolongation(
        finer.new_balance(), list(system.harmonics), list(more), options.newton_tolerance, OF_FAR_MOTIONS
    )
    rough = replace(options, following=options.coarse_following)
    return StretchFollower(system, finer, lifted, path, rough, Budget(0.0))
