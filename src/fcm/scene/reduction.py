"""Computes the modal table of a scene from the matrices of its [structure] table."""

from __future__ import annotations

from typing import Any

import numpy as np

from fcm.model.question import MissingModes
from fcm.model.scene import FloatArray
from fcm.scene.errors import counted
from fcm.scene.modal_damping import Damping, damping_of
from fcm.scene.options import LIMITS, MESSAGES, TOLERANCES
from fcm.scene.rules import RULES
from fcm.scene.section import Section
from fcm.scene.structure_table import StructureMatrices
from fcm.structure.eigen import StructureError, unit_columns
from fcm.structure.reduced import ModeSelection, Reduced, reduced


def modal_of_matrices(
    top: Section,
    matrices: StructureMatrices,
    loads: FloatArray,
    springs: FloatArray,
    outputs: list[int],
    ends: tuple[float, float],
) -> tuple[dict[str, Any] | None, FloatArray, list[str]]:
    """Modal table (frequencies in rad/s), shapes at all rows (row, mode), and notes; None after a mistake.

    loads (row, load): directions of contacts and forces. springs (load,): contact stiffness along each.
    outputs: rows that are only reported. ends: lowest and highest angular frequency of the forces.
    """
    if _same(matrices):
        top.wrong("structure", "stiffness and mass are the same matrix. Name the file of each")
        return None, np.zeros((len(matrices.dofs), 0)), []
    if mode := _exchanged_mesh(matrices, ends):
        top.wrong("structure", in_each_others_place(mode))
        return None, np.zeros((len(matrices.dofs), 0)), []
    directions, others = split(loads, outputs)
    top_frequency = ends[1] if np.isfinite(ends[1]) else 0.0
    try:
        selection = ModeSelection(matrices.modes, matrices.flexibility, others)
        found = reduced(matrices.K, matrices.M, directions, top_frequency, selection)
        damping = damping_of(matrices, found, loads, springs, outputs, ends)
    except StructureError as error:
        top.wrong("structure", str(error))
        return None, np.zeros((len(matrices.dofs), 0)), []
    frequency = np.sqrt(found.modes.stiffness)
    for value in frequency[RULES["frequency"].faulty(frequency)[:1, 0]].tolist():
        in_hertz = top.data.get("frequency_unit") == "Hz"
        value, unit = (value / (2.0 * np.pi), "Hz") if in_hertz else (value, "rad/s")
        top.wrong("structure", f"has a mode whose frequency in {unit} {RULES['frequency'].fault(value)}")
    draft = {
        "mass": np.ones(found.modes.count),
        "frequency": frequency,
        "damping": damping.ratio,
        "added": found.modes.count - found.kept,
        "complete": not np.isfinite(found.beyond),
    }
    return (
        draft,
        found.modes.shapes,
        [
            _kept(matrices, found, damping),
            *at_many(matrices, len(outputs), found.other_rows, damping.lost),
            *_warnings(found, ends),
            *damping.said,
            *of_rounding([found], damping.ratio[found.rigid :]),
        ],
    )


def _same(matrices: StructureMatrices) -> bool:
    """Whether stiffness and mass are equal and not diagonal.

    All modes would then have 1 rad/s, which is only plausible for single masses on springs.
    """
    K, M = matrices.K, matrices.M
    beside_diagonal = K.nnz > np.count_nonzero(K.diagonal())
    return bool(beside_diagonal and abs(K - M).max() == 0.0)


def _exchanged_mesh(matrices: StructureMatrices, ends: tuple[float, float]) -> float:
    """Detects exchanged matrices of a mesh, as `exchanged`, before its modes are computed.

    By Rayleigh's quotient the highest mode is not below sqrt(K_ii / M_ii) of any row. So the diagonals
    suffice to recognise matrices that are not exchanged.
    """
    own, low = matrices.M.diagonal(), ends[0] / MESSAGES.range_near
    if len(own) < LIMITS.mesh_rows or not (own > 0.0).all():
        return 0.0
    if not (matrices.K.diagonal() / own).max() < low * low:
        return 0.0
    return exchanged(matrices, np.zeros(0), ends)


def exchanged(matrices: StructureMatrices, kept: FloatArray, ends: tuple[float, float]) -> float:
    """Detects exchanged stiffness and mass; returns a frequency [rad/s] of a mode with them swapped, else 0.

    They count as exchanged if the structure as given has no mode near the range or above it, but with the
    matrices swapped has one within the range. The highest mode as given is the reciprocal of the lowest
    elastic mode after the swap. kept (mode,) [rad/s]: the computed modes of the structure as given.
    """
    if not (np.isfinite(ends).all() and ends[0] > 0.0):
        return 0.0
    low = ends[0] / MESSAGES.range_near
    if kept.max(initial=0.0) >= low:
        return 0.0
    nothing = np.zeros((len(matrices.dofs), 0))
    try:
        other = reduced(matrices.M, matrices.K, nothing, ends[1], ModeSelection(max(kept.size, 1), False))
    except StructureError:
        return 0.0
    elastic = np.sqrt(other.modes.stiffness[other.rigid :])
    within = elastic[(elastic >= ends[0]) & (elastic <= ends[1])]
    return float(within[0]) if within.size and 1.0 / elastic[0] < low else 0.0


def in_each_others_place(mode: float) -> str:
    """Sentence on exchanged matrices, with a mode [rad/s] that they have after the swap."""
    return (
        "all its modes are far below the range of frequencies. Stiffness and mass are in each other's place: "
        f"exchanged, they have a mode at {mode / (2.0 * np.pi):.6g} Hz, which is {mode:.6g} rad/s"
    )


def split(loads: FloatArray, outputs: list[int]) -> tuple[FloatArray, list[int]]:
    """Directions whose flexibility is kept, and the outputs without: all of them if they are too many."""
    few = len(outputs) if len(outputs) <= LIMITS.outputs else 0
    return np.concatenate((loads, unit_columns(len(loads), outputs[:few])), axis=1), outputs[few:]


def at_many(matrices: StructureMatrices, count: int, aside: tuple[float, float], lost: float) -> list[str]:
    """Note on many outputs, whose own flexibility is not kept, with the error of their receptances."""
    if not (count > LIMITS.outputs and any(aside)):
        return []
    most = lost + aside[0] + 2.0 * (matrices.ratio or matrices.hysteretic / 2.0) * aside[1]
    off = f"are off by at most {_upwards(most)}" if np.isfinite(most) else "are off by an unknown amount"
    return [
        f"structure: the {count} outputs are more than {LIMITS.outputs}, so that their own flexibility is "
        f"not kept: receptances from contacts and forces to them {off}"
    ]


def of_rounding(parts: list[Reduced], ratios: FloatArray) -> list[str]:
    """Notes on frequencies that rounding changes noticeably, and on unclear rigid-body modes."""
    off, digits = max(one.rounding for one in parts), next((one.digits for one in parts if one.digits), None)
    said = []
    if unclear := max(one.unclear for one in parts):
        said.append(
            f"structure: its stiffness was written with {digits} digits. Modes below {100 * unclear:.2g} % "
            "of the first elastic frequency cannot be distinguished from rigid-body modes, and are taken for "
            "such. Write it with more digits"
        )
    width = float(ratios.min(initial=1.0, where=ratios > 0.0))  # undamped modes have no finite peak
    if off > max(MESSAGES.damping_left_out * width, TOLERANCES.undamped):
        why = f"was written with {digits} digits" if digits else "has stiff parts that hide the soft ones"
        said.append(
            f"structure: rounding changes the frequencies of its modes by up to {_upwards(off)}, relative, "
            f"as its stiffness {why}"
        )
    return said


def _kept(matrices: StructureMatrices, found: Reduced, damping: Damping) -> str:
    """Note on the modes and flexibility kept of the structure, and on the error."""
    rows, added = len(matrices.dofs), found.modes.count - found.kept
    verb = "is" if found.kept == 1 else "are"
    text = (
        f"structure: {counted(found.kept, 'mode')} of {rows} degree{'s' * (rows != 1)} of freedom {verb} kept"
    )
    every = not np.isfinite(found.beyond)
    if every and not added:
        return f"{text}, all that there are"
    if not matrices.flexibility:
        return f"{text}; the flexibility of the others is left out"
    of = "rows without mass" if every else "the others"
    text += (
        f"{', all that there are' if every else ''}, and the flexibility of {of} as {counted(added, 'mode')}"
    )
    if not np.isfinite(found.bound):
        return f"{text}; how far it is off is unknown"
    return f"{text}. {how_far_off(matrices, found.bound, found.damping, damping.lost)}"


def how_far_off(matrices: StructureMatrices, bound: float, damping: float, lost: float) -> str:
    """Sentence on the error of receptances and, with a common damping ratio, of resonance damping.

    lost: the part of the error from omitting the damping of rigid-body modes (`modal_damping.Damping`). If it
    is not 0, the sentence names it as the cause.
    """
    ratio = matrices.ratio or matrices.hysteretic / 2.0
    most = _upwards(max(bound + 2.0 * ratio * damping + lost, 1e-15))
    if lost:
        why = "the damping of rigid-body modes, which have no ratio, being left out"
        return f"Receptances at the forces' frequencies are off by at most {most}, {why}"
    text = (
        f"Receptances up to the forces' highest frequency, not at higher harmonics, are off by at most {most}"
    )
    return f"{text}, the damping of a resonance by at most {_upwards(max(damping, 1e-15))}" if ratio else text


def _upwards(bound: float) -> str:
    """A bound with two digits, rounded up.

    >>> _upwards(1.31e-5), _upwards(1.3e-5), _upwards(9.96e-5)
    ('1.4e-05', '1.3e-05', '1.0e-04')
    """
    text = f"{bound:.1e}"
    return text if float(text) >= bound else f"{float(text) + 0.1 * 10.0 ** int(text[-3:]):.1e}"


def _warnings(found: Reduced, ends: tuple[float, float]) -> list[str]:
    said = []
    if found.rigid:
        said.append(f"structure: {counted(found.rigid, 'rigid-body mode')}, of frequency 0")
    if found.beyond < ends[1]:
        said.append(
            MissingModes(
                "structure: there are modes within the range that are not kept. By how much this changes "
                "peaks is unknown: raise structure.modes"
            )
        )
    return said
