"""Collocation at Radau's points: nodes, weights, derivatives and the tail of a polynomial on 0 to 1."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

STAGES = 8  # points of a panel, as panel.pxd says in C

FloatArray = npt.NDArray[np.float64]


class Radau(NamedTuple):
    """Radau's rule for polynomials of degree s, known at 0 and at its s points, the last of which is 1.

    Attributes
    ----------
    nodes, weights : ndarray, shape (s,)
        The rule is exact for polynomials of degree 2 s - 2.
    slopes : ndarray, shape (s + 1, s + 1)
        Derivatives at 0 and at the nodes, from the values there.
    inner : ndarray, shape (s, s)
        Derivatives at the nodes of a polynomial of degree s - 1, from the values there alone.
    tail : ndarray, shape (2, s + 1)
        The coefficients of Legendre's polynomials of degree s - 1 and s.
    bary : ndarray, shape (s + 1,)
        Weights of the barycentric formula (Berrut and Trefethen, 2004).
    """

    nodes: FloatArray
    weights: FloatArray
    slopes: FloatArray
    inner: FloatArray
    tail: FloatArray
    bary: FloatArray


@lru_cache
def radau(stages: int) -> Radau:
    """Radau's rule with s points, after Golub (1973).

    >>> rule = radau(3)
    >>> bool(abs(rule.weights @ rule.nodes**4 - 1 / 5) < 1e-15), rule.nodes[-1].item()
    (True, 1.0)
    """
    k = np.arange(1.0, stages)
    off_diagonal = k / np.sqrt(4.0 * k * k - 1.0)
    free = np.diag(off_diagonal[:-1], 1) + np.diag(off_diagonal[:-1], -1)
    last = np.zeros(stages - 1)
    last[-1] = off_diagonal[-1] ** 2
    jacobi = np.diag(off_diagonal, 1) + np.diag(off_diagonal, -1)
    jacobi[-1, -1] = 1.0 + np.linalg.solve(free - np.eye(stages - 1), last)[-1]
    points, vectors = np.linalg.eigh(jacobi)
    nodes = 0.5 * (1.0 + points)
    nodes[-1] = 1.0
    x = np.concatenate(([0.0], nodes))
    bary, slopes = _derivatives(x)
    tail = np.linalg.inv(_legendre(x, stages)).astype(np.float64)[-2:]
    return Radau(nodes, vectors[0] ** 2, slopes, _derivatives(nodes)[1], tail, bary)


def _derivatives(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Barycentric weights of points (point,), and the matrix from values to derivatives at the points."""
    apart = x[:, None] - x + np.eye(x.size)
    bary = 1.0 / apart.prod(axis=1)
    slopes = bary / bary[:, None] / apart
    np.fill_diagonal(slopes, 0.0)
    np.fill_diagonal(slopes, -slopes.sum(axis=1))
    return bary, slopes


def _legendre(x: FloatArray, degree: int) -> FloatArray:
    """Legendre polynomials on 0 to 1, of all degrees up to a given one, (point, degree)."""
    z = 2.0 * x - 1.0
    p = [np.ones_like(z), z]
    for k in range(2, degree + 1):
        p.append(((2 * k - 1) * z * p[-1] - (k - 1) * p[-2]) / k)
    return np.stack(p[: degree + 1], axis=1)
