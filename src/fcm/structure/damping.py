"""Damping of modes: from a damping matrix, proportional to mass and stiffness, or from a loss factor."""

from __future__ import annotations

import numpy as np

from fcm.frozen import Frozen
from fcm.structure.eigen import FloatArray, Matrix, Modes, StructureError
from fcm.structure.options import DAMPING


def ratios(coefficients: FloatArray, stiffness: FloatArray) -> FloatArray:
    """Damping ratios c / (2 omega) of modes of mass 1; 0 for rigid-body modes, which have none."""
    omega = np.sqrt(stiffness)
    ratio: FloatArray = np.divide(coefficients, 2.0 * omega, out=np.zeros_like(omega), where=omega > 0.0)
    return ratio


def proportional(by_mass: float, by_stiffness: float, stiffness: FloatArray) -> FloatArray:
    """Damping ratios of the damping matrix by_mass M + by_stiffness K.

    >>> proportional(0.2, 0.01, np.array([4.0]))  # (0.2 + 0.01 * 4) / (2 * 2)
    array([0.06])
    """
    return ratios(by_mass + by_stiffness * stiffness, stiffness)


def projected(C: Matrix, modes: Modes) -> FloatArray:
    """The damping matrix in modal coordinates, (mode, mode)."""
    matrix: FloatArray = modes.shapes.conj().T @ (C @ modes.shapes)
    return matrix


def drag(C: Matrix, rigid: FloatArray) -> float:
    """Greatest damping coefficient of rigid-body modes (row, mode) of mass 1; 0 if it is rounding."""
    size = np.abs(rigid)
    terms = np.einsum("ij,ij->j", size, abs(C) @ size)
    own = np.abs(np.einsum("ij,ij->j", rigid.conj(), C @ rigid))
    return float(own[own > DAMPING.cancellation_tolerance * terms].max(initial=0.0))


def check_dissipates(coefficients: FloatArray) -> None:
    """Raise StructureError if the damping of a mode is negative beyond rounding."""
    least = float(coefficients.min(initial=0.0))
    if least < -DAMPING.rounding * np.abs(coefficients).max(initial=0.0):
        mode = int(coefficients.argmin()) + 1
        raise StructureError(f"the damping of mode {mode} is negative, {least:.3g} for a modal mass of 1")


class DampedModes(Frozen):
    """Modes of mass 1 with damping that couples them."""

    stiffness: FloatArray  # (mode,)
    damping: FloatArray  # (mode, mode) the damping matrix in modal coordinates
    rigid: int = 0  # number of rigid-body modes, which are the first


def coupling_effect(
    modes: DampedModes, pushes: FloatArray, seen: FloatArray, springs: FloatArray, ends: tuple[float, float]
) -> float:
    """Greatest relative change of the linear response by damping that the uncoupled modes leave out.

    That is the damping between modes, and all damping of the first `rigid` modes, which are rigid-body modes.

    The response of `seen` (mode, displacement) to each of `pushes` (mode, load) is compared between the
    `ends`, the lowest and highest angular frequency. Springs (load,) act along the loads: those of the stuck
    contacts. The response is sampled at resonances, beside and between them, and more finely where the change
    is greatest. inf if there is no response without the damping left out.
    """
    modal, rigid = modes.damping, modes.rigid
    matrix = np.diag(modes.stiffness) + (pushes * springs) @ pushes.conj().T
    own = np.diag(np.concatenate((np.zeros(rigid), np.diagonal(modal)[rigid:])))

    def change(omega: float) -> float:
        undamped = matrix - omega**2 * np.eye(len(matrix))
        whole = _response(undamped + 1j * omega * modal, pushes, seen)
        alone = _response(undamped + 1j * omega * own, pushes, seen)
        if whole is None:  # the resonance of an undamped mode: no force gives a finite response
            return 0.0
        size = float(np.abs(whole).max(initial=0.0))
        if alone is None:
            return np.inf
        return float(np.abs(whole - alone).max() / size) if 0.0 < size < np.inf else 0.0

    places = _places(matrix, modal, *ends)
    found = [change(omega) for omega in places.tolist()]
    at = int(np.argmax(found))
    before, after = places[max(at - 1, 0)], places[min(at + 1, places.size - 1)]
    return max(found[at], *map(change, np.linspace(before, after, DAMPING.refined_places).tolist()))


def _response(dynamic: FloatArray, pushes: FloatArray, seen: FloatArray) -> FloatArray | None:
    """Response of the displacements `seen` to pushes; None if the dynamic stiffness is singular."""
    try:
        response: FloatArray = seen.conj().T @ np.linalg.solve(dynamic, pushes)
    except np.linalg.LinAlgError:
        return None
    return response


def _places(matrix: FloatArray, damper: FloatArray, low: float, high: float) -> FloatArray:
    """Frequencies between low and high: resonances, their half-power points, and places in between."""
    value, turn = np.linalg.eigh(matrix)
    natural = np.sqrt(np.maximum(value, 0.0))
    width = 0.5 * np.einsum("ij,ij->j", turn.conj(), damper @ turn).real
    inside = np.flatnonzero((natural > low) & (natural < high))[: DAMPING.max_resonances]
    own, half_width = natural[inside], width[inside]
    ends = np.unique(np.clip([low, high, *own, *(own - half_width), *(own + half_width)], low, high))
    gaps = ends.size - 1
    each = int(
        np.clip(DAMPING.max_multiplications / (max(gaps, 1) * len(matrix) ** 3), 1, DAMPING.places_between)
    )
    places: FloatArray = np.interp(np.arange(gaps * each + 1) / each, np.arange(ends.size), ends)
    return places
