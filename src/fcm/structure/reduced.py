"""Reduction of a structure to its lowest modes, and modes for the flexibility of the rest."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from fcm.frozen import Frozen
from fcm.structure.digits import digits_of
from fcm.structure.eigen import (
    OPTIONS,
    FactoredStructure,
    FloatArray,
    Matrix,
    Modes,
    StructureError,
    factored_structure,
    modes_of,
    of_shapes,
    polished,
    shifted,
    unit_columns,
)
from fcm.structure.flexibility import Truncation, error_at_other_rows, flexibility
from fcm.structure.options import REDUCTION
from fcm.structure.rigid_body import may_be_rigid, rigid_by_energy, unclear_below
from fcm.structure.rounding import of_frequencies, of_receptances


class ModeSelection(Frozen):
    """Options on what is kept of a structure in its reduction."""

    count: int | None = None  # of modes; None: all up to some times the highest frequency of interest
    flexibility: bool = True  # whether the flexibility of the other modes under the loads is kept as well
    other_rows: Sequence[int] = ()  # rows without loads whose displacements are reported


class Reduced(Frozen):
    """A reduced structure as modes of mass 1; the first `kept` are its own, the others flexibility modes."""

    modes: Modes
    kept: int
    rigid: int
    beyond: float  # [rad/s] first frequency left out; inf if there is none
    bound: float  # of the receptances between the loads, relative to their static ones
    damping: float = 0.0  # bound of the error of a resonance's damping, if all modes have one ratio
    rounding: float = 0.0  # relative error of a kept mode's frequency by rounding
    other_rows: tuple[float, float] = (0.0, 0.0)  # see `flexibility.error_at_other_rows`; with rounding
    digits: int | None = None  # digits with which the stiffness was written, if they are few
    unclear: float = 0.0  # see `rigid_body.unclear_below`


def reduced(K: Matrix, M: Matrix, loads: FloatArray, top: float, selection: ModeSelection) -> Reduced:
    """Reduces a structure to modes for loads (row, load) up to the angular frequency top.

    For the selection's other rows the error of their displacement is bounded as well.
    """
    count, rest, others = selection.count, selection.flexibility, selection.other_rows
    structure = factored_structure(K, M, top)
    found = _cleared(structure, _enough(lambda n: modes_of(structure, n), structure.rows, top, count))
    rigid = rigid_by_energy(K, M, found)
    if rigid == found.count < structure.rows:  # all of them are kept
        return reduced(K, M, loads, top, replace(selection, count=min(2 * rigid + 1, structure.rows)))
    structure, found = _elastic_apart(structure, found, rigid)
    if rigid < found.count and found.stiffness[rigid] < 0.0:
        raise StructureError("the stiffness has a negative eigenvalue, that of a structure has none")
    wanted = min(found.count, max(rigid, count or _within(found, top, structure.rows)))
    kept = Modes(found.stiffness[:wanted], found.shapes[:, :wanted])
    kept.stiffness[:rigid] = 0.0
    off = float(of_frequencies(K, kept).max(initial=0.0))
    unclear = unclear_below(K, found, rigid)
    plain = Reduced(kept, wanted, rigid, np.inf, 0.0, rounding=off, digits=digits_of(K), unclear=unclear)
    if found.count == wanted and (wanted == structure.rows or not (rest and loads.shape[1])):
        return plain
    beyond = float(found.stiffness[wanted]) if wanted < found.count else np.inf  # the rest is massless
    plain = replace(plain, beyond=float(np.sqrt(beyond)))
    if not (rest and loads.shape[1]):
        return replace(plain, bound=np.nan)
    truncation = Truncation(structure, kept, top, beyond)
    more = flexibility(truncation, loads)
    both = _together(kept, more.modes)
    bound, other_rows = more.bound + of_receptances(K, M, both, loads, top), (0.0, 0.0)
    if len(others) * structure.rows > REDUCTION.max_products:
        other_rows = np.inf, np.inf
    elif others:
        own, damped = error_at_other_rows(truncation, more, loads, others)
        other_rows = own + of_receptances(K, M, both, _stiffest(both, others), top), damped
    return replace(plain, modes=both, bound=bound, damping=more.damping, other_rows=other_rows)


def _cleared(structure: FactoredStructure, found: Modes) -> Modes:
    """The modes, with possible rigid-body modes cleared of all other modes."""
    count = may_be_rigid(structure.K, structure.M, found)
    if not count:
        return found
    first = of_shapes(structure, polished(structure, found.shapes[:, :count]))
    return _together(first, Modes(found.stiffness[count:], found.shapes[:, count:]))


def _elastic_apart(structure: FactoredStructure, found: Modes, rigid: int) -> tuple[FactoredStructure, Modes]:
    """The structure and its modes, rigid-body modes first, elastic modes orthogonal to them.

    Relative to rigid-body modes, with 1 / -s, elastic modes lose as many digits as s is nearer to zero than
    their lambda. If these are many, all modes are computed again with the shift -lambda of the first elastic
    mode.
    """
    if not 0 < rigid < found.count:
        return structure, found
    first, own = float(found.stiffness[rigid]), found.shapes[:, :rigid]
    if (
        first > REDUCTION.max_shift_ratio * -structure.shift
        or structure.rows <= OPTIONS.dense_size
        or first < -structure.shift
    ):
        structure = shifted(structure, -first)
        found = modes_of(structure, found.count)
    rest = found.shapes[:, rigid:]
    elastic = of_shapes(structure, rest - own @ (own.conj().T @ (structure.M @ rest)))
    return structure, _together(Modes(np.zeros(rigid), own), elastic)


def _together(kept: Modes, more: Modes) -> Modes:
    """The modes of the structure, followed by those that represent the rest."""
    return Modes(
        np.concatenate((kept.stiffness, more.stiffness)), np.concatenate((kept.shapes, more.shapes), axis=1)
    )


def _stiffest(modes: Modes, others: Sequence[int]) -> FloatArray:
    """Unit loads (row, load) on those of the other rows that move least under a load along themselves."""
    elastic = modes.stiffness > 0.0
    seen = np.abs(modes.shapes[list(others)][:, elastic].T) ** 2
    order = np.argsort((seen / modes.stiffness[elastic, None]).sum(axis=0))
    return unit_columns(
        len(modes.shapes), [others[i] for i in order[: REDUCTION.max_stiff_displacements].tolist()]
    )


def _within(modes: Modes, top: float, rows: int) -> int:
    """Number of modes kept if no number is given."""
    if rows <= REDUCTION.full_size:
        return modes.count
    return max(REDUCTION.min_modes, int((modes.stiffness < (REDUCTION.frequency_factor * top) ** 2).sum()))


def _enough(modes: Callable[[int], Modes], rows: int, top: float, count: int | None) -> Modes:
    """The modes that are kept, and one more if there is one."""
    if count is not None:
        return modes(min(count + 1, rows))
    number = min(rows, REDUCTION.full_size)
    while True:
        found = modes(number)
        enough = found.stiffness[-1] > (REDUCTION.frequency_factor * top) ** 2 and found.count > _within(
            found, top, rows
        )
        if enough or found.count < number or number == rows:
            return found
        number = min(rows, 2 * number)
