"""The damping of modes: from a matrix, in proportion to mass and stiffness, from a loss factor."""

from __future__ import annotations

import numpy as np

from fcm.structure.eigen import FloatArray, Matrix, Modes, StructureError

MOST_FREQUENCIES = 60  # at which two responses are compared
ROUNDING = 1e-9  # of the greatest coefficient: less negative than that is none


def ratios(coefficients: FloatArray, stiffness: FloatArray) -> FloatArray:
    """Damping ratios c / (2 omega) of modes of mass 1; 0 for rigid-body modes, which have none."""
    omega = np.sqrt(stiffness)
    ratio: FloatArray = np.divide(coefficients, 2.0 * omega, out=np.zeros_like(omega), where=omega > 0.0)
    return ratio


def proportional(by_mass: float, by_stiffness: float, stiffness: FloatArray) -> FloatArray:
    """Ratios of the damping matrix by_mass M + by_stiffness K.

    >>> proportional(0.2, 0.01, np.array([4.0]))  # (0.2 + 0.01 * 4) / (2 * 2)
    array([0.06])
    """
    return ratios(by_mass + by_stiffness * stiffness, stiffness)


def projected(C: Matrix, modes: Modes) -> FloatArray:
    """The damping matrix in modal coordinates, (mode, mode)."""
    matrix: FloatArray = modes.shapes.conj().T @ (C @ modes.shapes)
    return matrix


def check_dissipates(coefficients: FloatArray) -> None:
    """Raise StructureError where the damping of a mode is negative, beyond rounding."""
    least = float(coefficients.min(initial=0.0))
    if least < -ROUNDING * np.abs(coefficients).max(initial=0.0):
        mode = int(coefficients.argmin()) + 1
        raise StructureError(f"the damping of mode {mode} is negative, {least:.3g} for a modal mass of 1")


def coupling_effect(
    modal: FloatArray, stiffness: FloatArray, pushes: FloatArray, seen: FloatArray, low: float, high: float
) -> float:
    """Greatest change of the linear response by the damping between modes, relative.

    The response of `seen` (mode, displacement) to each of `pushes` (mode, load), of modes of mass 1 with the
    damping matrix `modal`, at the natural frequencies from low to high and at its ends.
    """
    natural = np.sqrt(stiffness)
    inside = natural[(natural > low) & (natural < high)][:MOST_FREQUENCIES]
    worst = 0.0
    for omega in (low, *inside.tolist(), high):
        undamped = np.diag(stiffness - omega**2).astype(np.complex128)
        of_each = np.diagonal(undamped) + 1j * omega * np.diagonal(modal)
        if not of_each.all():
            continue  # at the resonance of an undamped mode: no force gives a response
        try:
            whole = seen.conj().T @ np.linalg.solve(undamped + 1j * omega * modal, pushes)
        except np.linalg.LinAlgError:
            continue
        alone = seen.conj().T @ (pushes / of_each[:, None])
        size = np.abs(whole).max(initial=0.0)
        worst = max(worst, float(np.abs(whole - alone).max() / size) if size else 0.0)
    return worst
