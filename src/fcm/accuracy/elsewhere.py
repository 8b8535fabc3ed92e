"""Motions of the partner at frequencies to which no branch of it is known to come.

They belong to the whole response: what is followed from one branch tells the others, too, and all of it has
one budget.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.accuracy.budget import Budget
from fcm.accuracy.options import PairOptions
from fcm.accuracy.partner import give_back, lifted_of
from fcm.accuracy.partner_curve import curve_piece
from fcm.accuracy.partner_pieces import CurvePiece
from fcm.accuracy.partner_stretch import Stretches
from fcm.continuation import Path
from fcm.harmonic_balance.reported_quantities import Reported
from fcm.harmonic_balance.system import System

if TYPE_CHECKING:
    from fcm.accuracy.embedded_pair import Errors


def elsewhere(
    system: System,
    paths: Sequence[Path],
    shown: Sequence[Reported],
    errors: Sequence[Errors],
    first: int,
    options: PairOptions,
) -> list[list[CurvePiece]]:
    """For each path pieces of its partner, of which at least one passes each frequency that no piece is known
    to pass, as far as the work allows.

    They are followed from points of the paths from the first on whose errors are not told, those of the
    smallest motions before the others: there the partner has fewest.
    """
    found: list[list[CurvePiece]] = [[] for _ in paths]
    known = [piece for one in errors for piece in one.pieces]
    sizes = [
        np.where(one.met, np.inf, each.amplitude.max(axis=1)) for one, each in zip(errors, shown, strict=True)
    ]
    for size, path, one in zip(sizes, paths, errors, strict=True):
        for piece in known:
            size[piece.within(path.parameter)] = np.inf
        if one.partner == system.harmonics:  # it has none
            size[:] = np.inf
    budget, followers = Budget.of(system.work, options), dict[int, Stretches]()
    while budget.left > 0.0:
        least = [size.min(initial=np.inf) if k >= first else np.inf for k, size in enumerate(sizes)]
        k = int(np.argmin(least)) if least else -1
        if k < 0 or not np.isfinite(least[k]):
            break
        untold = np.concatenate(
            [path.parameter[np.isfinite(size)] for path, size in zip(paths, sizes, strict=True)]
        )
        i = int(sizes[k].argmin())
        stretches = followers.get(k)
        if stretches is None:
            more = errors[k].partner
            finer = system.with_harmonics(more)
            lifted = lifted_of(system, more)
            stretches = Stretches(system, finer, lifted, paths[k], options, budget)
            followers[k] = stretches
        new = stretches.through(i, (float(untold.min()), float(untold.max())))
        sizes[k][i] = np.inf
        for piece in (curve_piece(stretches.finer, one) for one in new):
            found[k].append(piece)
            for size, path in zip(sizes, paths, strict=True):
                size[piece.within(path.parameter)] = np.inf
    for k, stretches in followers.items():
        give_back(stretches.lifted, system, errors[k].partner)
    # what the levels took is paid already
    system.work.take(sum(one.each * one.evaluations for one in followers.values()))
    return found
