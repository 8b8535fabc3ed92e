"""Computes the modes of every nodal diameter from the matrices of a ring's sector."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from fcm.frozen import Frozen
from fcm.model.question import MissingModes
from fcm.model.ring import ComplexArray, FloatArray
from fcm.scene.errors import counted
from fcm.scene.modal_damping import Damping, damping_of
from fcm.scene.reduction import at_many, how_far_off, of_rounding, split
from fcm.scene.section import Section
from fcm.scene.structure_table import StructureMatrices
from fcm.structure.eigen import StructureError
from fcm.structure.reduced import ModeSelection, Reduced, reduced


class DiameterModes(Frozen):
    """The modes of one nodal diameter."""

    number: int
    found: Reduced
    damping: Damping


class LoadedRing(Frozen):
    """The matrices of a ring's sector, and the directions of what acts on it."""

    matrices: StructureMatrices
    sectors: int
    pushed: FloatArray  # (rows of two sectors, load) directions of contacts and forces
    springs: FloatArray  # (load,) contact stiffness along each direction, 0 for forces
    distributed: FloatArray  # (row, load) loads on the sector alone


def modal_of_ring(
    top: Section, ring: LoadedRing, outputs: list[int], ends: tuple[float, float]
) -> tuple[dict[str, Any] | None, list[str]]:
    """Modal table (frequencies in rad/s, shapes at all rows), and notes; None after a mistake.

    outputs: rows that are only reported. ends: lowest and highest angular frequency of the forces.
    """
    matrices, sectors, pushed, distributed = ring.matrices, ring.sectors, ring.pushed, ring.distributed
    rows = len(pushed) // 2
    springs = np.append(ring.springs, np.zeros(distributed.shape[1]))
    diameters = []
    for number in range(sectors // 2 + 1):
        turn = np.exp(2j * np.pi * number / sectors)
        loads = np.concatenate((pushed[:rows] + pushed[rows:] * np.conj(turn), distributed), axis=1)
        at = _plain(_at_diameter(matrices, turn), loads, number in (0, sectors / 2))
        try:
            diameters.append(_modes(*at, springs, number, outputs, ends))
        except StructureError as error:
            top.wrong("structure", f"{error} (at nodal diameter {number})")
            return None, []
    modes = [one.found.modes for one in diameters]
    counts = [one.count for one in modes]
    flexible = [np.arange(one.found.modes.count) >= one.found.kept for one in diameters]
    draft = {
        "mass": np.ones(sum(counts)),
        "frequency": np.concatenate([np.sqrt(one.stiffness) for one in modes]),
        "damping": np.concatenate([one.damping.ratio for one in diameters]),
        "shapes": np.concatenate([one.shapes.T for one in modes]).astype(np.complex128),
        "diameter": np.repeat([one.number for one in diameters], counts),
        "flexible": np.concatenate(flexible),
    }
    first, *others = _notes(matrices, diameters, ends)
    lost = max(one.damping.lost for one in diameters)
    return draft, [first, *at_many(matrices, len(outputs), _error_at_other_rows(diameters), lost), *others]


def all_alike(matrices: StructureMatrices) -> StructureMatrices:
    """The matrices of a sector at nodal diameter 0, where all sectors move alike."""
    return _at_diameter(matrices, 1.0)


def _error_at_other_rows(diameters: list[DiameterModes]) -> tuple[float, float]:
    """The greatest errors at other rows of all diameters."""
    own, damped = zip(*(one.found.other_rows for one in diameters), strict=True)
    return max(own), max(damped)


def _at_diameter(matrices: StructureMatrices, turn: complex) -> StructureMatrices:
    """The matrices of a sector if the next sector moves as it does times turn, a factor of magnitude 1."""
    if matrices.coupling is None:
        return matrices
    K, M = (block * turn + (block * turn).conj().T for block in (matrices.coupling.K, matrices.coupling.M))
    return replace(matrices, K=(matrices.K + K).tocsc(), M=(matrices.M + M).tocsc())


def _plain(matrices: StructureMatrices, loads: ComplexArray, standing: bool) -> tuple[StructureMatrices, Any]:
    """The arrays as real ones for standing waves, and if nothing is complex; otherwise as complex ones."""
    imaginary = any(np.any(matrix.imag.data) for matrix in (matrices.K, matrices.M)) or loads.imag.any()
    if standing or not imaginary:
        return replace(matrices, K=matrices.K.real, M=matrices.M.real), np.ascontiguousarray(loads.real)
    return replace(matrices, K=matrices.K.astype(complex), M=matrices.M.astype(complex)), loads


def _modes(
    matrices: StructureMatrices,
    loads: Any,
    springs: FloatArray,
    number: int,
    outputs: list[int],
    ends: tuple[float, float],
) -> DiameterModes:
    directions, others = split(loads, outputs)
    top = ends[1] if np.isfinite(ends[1]) else 0.0
    selection = ModeSelection(matrices.modes, matrices.flexibility, others)
    found = reduced(matrices.K, matrices.M, directions, top, selection)
    return DiameterModes(number, found, damping_of(matrices, found, loads, springs, outputs, ends))


def _notes(
    matrices: StructureMatrices, diameters: list[DiameterModes], ends: tuple[float, float]
) -> list[str]:
    """Notes on the modes kept of the structure, on their error, and on problems."""
    all_found = [one.found for one in diameters]
    kept = sorted({one.kept for one in all_found})
    count = counted(kept[0], "mode") if len(kept) == 1 else f"{kept[0]} to {kept[-1]} modes"
    verb = "is" if kept == [1] else "are"
    text = f"structure: {count} of each of the nodal diameters 0 to {len(diameters) - 1} {verb} kept"
    bound = max(one.bound for one in all_found)
    if not any(np.isfinite(one.beyond) for one in all_found):
        text += ", all that there are"
    elif not matrices.flexibility:
        text += "; the flexibility of the others is left out"
    elif np.isfinite(bound):
        damping = max(one.damping for one in all_found)
        lost = max(one.damping.lost for one in diameters)
        text += f", and the flexibility of the others. {how_far_off(matrices, bound, damping, lost)}"
    else:
        text += ", and the flexibility of the others; how far it is off is unknown"
    notes = [text]
    for note, what, which in (
        (str, "has rigid-body modes, of frequency 0", [one.found.rigid for one in diameters]),
        (
            MissingModes,
            "has modes within the range that are not kept. By how much this changes peaks is unknown: raise "
            "structure.modes",
            [one.beyond < ends[1] for one in all_found],
        ),
    ):
        numbers = [str(one.number) for one, flag in zip(diameters, which, strict=True) if flag]
        notes += [note(f"structure: nodal diameter {', '.join(numbers)} {what}")] if numbers else []
    ratios = np.concatenate([one.damping.ratio[one.found.rigid :] for one in diameters])
    notes += of_rounding(all_found, ratios)
    return [*notes, *dict.fromkeys(text for one in diameters for text in one.damping.said)]
