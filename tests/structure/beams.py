"""Matrices of beams and their answer by a direct solution, which shares nothing with modes."""

from __future__ import annotations

import numpy as np
import scipy.sparse

LENGTH, STIFFNESS, LINE_MASS = 1.0, 1.0, 1.0  # EI and mass by length


def beam(elements: int, clamped: bool = True):
    """Stiffness, mass and names "1w", "1r", ... of an Euler beam, without those of a clamped end."""
    h = LENGTH / elements
    k = STIFFNESS / h**3 * np.array(
        [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h], [-12, -6 * h, 12, -6 * h],
         [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    )  # fmt: skip
    m = LINE_MASS * h / 420 * np.array(
        [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h], [54, 13 * h, 156, -22 * h],
         [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
    )  # fmt: skip
    rows = 2 * (elements + 1)
    at = 2 * np.arange(elements)[:, None, None]
    places = [np.broadcast_to(at + np.arange(4).reshape(shape), (elements, 4, 4)) for shape in ((4, 1), 4)]
    row, column = (place.ravel() for place in places)
    K, M = (
        scipy.sparse.coo_array((np.tile(one.ravel(), elements), (row, column)), (rows, rows))
        for one in (k, m)
    )
    names = [f"{node}{kind}" for node in range(elements + 1) for kind in "wr"]
    first = 2 if clamped else 0
    return K.tocsc()[first:, first:], M.tocsc()[first:, first:], names[first:]


def direct(K, M, C, loads, omega):
    """Displacements (row, load) under harmonic loads (row, load), by solving the whole equations."""
    matrix = K.toarray() - omega**2 * M.toarray() + 1j * omega * C
    return np.linalg.solve(matrix, loads)


def receptance(modal, loads, omega):
    """The same of modes at the degrees of freedom of loads."""
    denominator = modal.mass * (modal.frequency**2 - omega**2 + 2j * modal.damping * modal.frequency * omega)
    return modal.shapes.T @ ((modal.shapes @ loads) / denominator[:, None])
