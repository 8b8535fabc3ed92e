"""Effect of rounding on modes and receptances: most of a low mode's elastic energy cancels.

In fine meshes, and with stiff parts next to soft ones, the terms of a mode's elastic energy are many orders
greater than their sum. The error of the frequency is what this sum loses. The shapes err as well: exact modes
have no stiffness between them, the computed ones have some. At w^2 = -a < 0 nothing resonates, and the
response u to a load p has the energy u^T (K + a M) u = p^T u. The computed modes violate this, and the
difference is the error of their response.
"""

from __future__ import annotations

import numpy as np

from fcm.structure.digits import energy_uncertain
from fcm.structure.eigen import FloatArray, Matrix, Modes, elastic_energy
from fcm.structure.options import REDUCTION

LONG = float(np.finfo(np.longdouble).eps)  # epsilon of the numbers in which elastic energy is summed


def of_frequencies(K: Matrix, modes: Modes) -> FloatArray:
    """Relative error of each mode's frequency by rounding; 0 for rigid-body modes.

    The rows of the sum are rounded independently. Two standard deviations of their sum are taken, and of the
    sum for entries that were written with few digits.
    """
    rows = np.abs(modes.shapes) * (abs(K) @ np.abs(modes.shapes))
    size = rows.max(axis=0)  # squares of the rows may overflow
    together = size * np.linalg.norm(np.divide(rows, size, out=np.zeros_like(rows), where=size > 0.0), axis=0)
    lost = 2.0 * (LONG * together + energy_uncertain(K, modes.shapes))
    elastic = modes.stiffness > 0.0
    off: FloatArray = np.divide(0.5 * lost, modes.stiffness, out=np.zeros_like(lost), where=elastic)
    return off


def of_receptances(K: Matrix, M: Matrix, modes: Modes, loads: FloatArray, omega: float) -> float:
    """Error of a load's own receptance by rounding, relative to the static one, up to omega.

    It holds at rest, near rest, between resonances and at omega; at a resonance it grows with the receptance.
    Rigid-body modes have no static response; that at omega is taken. If there are many loads, only those with
    the greatest errors at rest, or the least motion at rest, are examined at other frequencies.
    """
    elastic = modes.stiffness > 0.0
    if not (elastic.any() and loads.size):
        return 0.0
    some = Modes(modes.stiffness[elastic], modes.shapes[:, elastic])
    static, off = _energy_and_error(K, M, some, loads, 0.0)
    if static.size > REDUCTION.max_loads:
        share = np.divide(off, static, out=np.zeros_like(off), where=static > 0.0)
        off_most, least = (
            np.argsort(one, kind="stable")[: REDUCTION.max_loads // 2] for one in (-share, static)
        )
        worst = np.union1d(off_most, least)
        static, off, loads = static[worst], off[worst], loads[:, worst]
    off = off + _energy_and_error(K, M, modes, loads, float(some.stiffness[0]))[1]
    between = [_energy_and_error(K, M, modes, loads, -(w**2))[1] for w in _between(some, omega)]
    off = REDUCTION.safety * np.max([off, *between], axis=0)
    if omega:
        static = static + (np.abs(modes.shapes[:, ~elastic].conj().T @ loads) ** 2).sum(axis=0) / omega**2
    return float(np.divide(off, static, out=np.zeros_like(off), where=static > 0.0).max())


def _between(modes: Modes, omega: float) -> FloatArray:
    """Frequencies up to omega that are far from all modes; the last is omega if it is.

    Empty for omega = 0.
    """
    if not omega:
        return np.zeros(0)
    ends = np.append(np.sqrt(modes.stiffness[modes.stiffness < omega**2]), omega)
    places = np.append(0.5 * (ends[1:] + ends[:-1]), omega)
    off = np.abs(1.0 - modes.stiffness / places[:, None] ** 2).min(axis=1)
    found: FloatArray = places[off > REDUCTION.min_resonance_distance]
    return found[:: max(1, found.size // REDUCTION.max_places)]


def _energy_and_error(
    K: Matrix, M: Matrix, modes: Modes, loads: FloatArray, a: float
) -> tuple[FloatArray, FloatArray]:
    """Displacement of each load along itself at w^2 = -a, and the rounding error of its energy."""
    on_modes = modes.shapes.conj().T @ loads
    answer = on_modes / (modes.stiffness + a)[:, None]
    work: FloatArray = np.einsum("ij,ij->j", on_modes.conj(), answer).real
    moved = modes.shapes @ answer
    energy = elastic_energy(K, moved) + (a * elastic_energy(M, moved) if a else 0.0)
    return work, np.abs(energy - work)
