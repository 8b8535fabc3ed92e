"""Matrices of a solid of bricks with eight nodes, by Gauss points."""

from __future__ import annotations

import numpy as np
import scipy.sparse

POISSON = 0.3  # modulus, density and edges are 1
CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def brick():
    """Stiffness and mass of one element, (24, 24), three displacements of each corner in turn."""
    second, shear = POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), 0.5 / (1 + POISSON)
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += second
    k, m = np.zeros((2, 24, 24))
    signs = 2 * CORNERS - 1
    for point in signs / np.sqrt(3):
        factors = 0.5 * (1 + signs * point)
        slope = np.array(
            [0.5 * 2 * signs[:, i] * np.delete(factors, i, axis=1).prod(axis=1) for i in range(3)]
        )
        strain = np.zeros((6, 24))
        for i in range(3):
            strain[i, i::3] = slope[i]
        for row, (i, j) in enumerate(((0, 1), (1, 2), (0, 2)), 3):
            strain[row, i::3], strain[row, j::3] = slope[j], slope[i]
        k += strain.T @ law @ strain / 8
        m += np.kron(np.outer(factors.prod(axis=1), factors.prod(axis=1)), np.eye(3)) / 8
    return k, m


def bricks(nx: int, ny: int, nz: int, clamped: bool = True):
    """Stiffness, mass and names "1x", "1y", ... of a bar of bricks, without its clamped first face."""
    k, m = brick()
    number = np.arange((nx + 1) * (ny + 1) * (nz + 1)).reshape(nx + 1, ny + 1, nz + 1)
    nodes = np.stack([number[i : i + nx, j : j + ny, h : h + nz].ravel() for i, j, h in CORNERS], axis=1)
    at = (3 * nodes[:, :, None] + np.arange(3)).reshape(-1, 24)
    place = np.repeat(at, 24, axis=1).ravel(), np.tile(at, (1, 24)).ravel()
    first = 3 * number[0].size if clamped else 0
    K, M = (
        scipy.sparse.coo_array((np.tile(one.ravel(), len(at)), place), (3 * number.size,) * 2).tocsc()[
            first:, first:
        ]
        for one in (k, m)
    )
    names = [f"{node}{axis}" for node in range(first // 3, number.size) for axis in "xyz"]
    return K, M, names
