r"""Tensor-product cubic B-splines on unit-spaced nodes: interpolation, values, first derivatives.

On an axis with n nodes a spline is ``sum_k c_k B(q - k)`` with n + 2 coefficients and, for q = i + f,

    B_i-1 .. B_i+2 = (1-f)^3/6, (4 - 6f^2 + 3f^3)/6, (1 + 3f + 3f^2 - 3f^3)/6, f^3/6.

It is twice continuously differentiable, local to evaluate (64 coefficients), and its error on a smooth function is
h^4 f''''/384.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

FREE, FLAT = "free", "flat"  # end conditions: third derivative continuous at the second node; zero slope

# rows: 1, f, f^2, f^3; columns: the four weights
WEIGHTS = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6.0
SLOPES = np.array([[-3, 0, 3, 0], [6, -12, 6, 0], [-3, 9, -9, 3], [0, 0, 0, 0]]) / 6.0
# for each axis, the factors of: value, derivative along axis 0, 1, 2
FACTORS = np.stack(
    [np.concatenate([SLOPES if k == axis + 1 else WEIGHTS for k in range(4)], axis=1) for axis in range(3)]
)


def interpolate(values: FloatArray, ends: tuple[tuple[str, str], ...]) -> FloatArray:
    """Coefficients, shape (n0+2, n1+2, n2+2, ...), of the spline through values, shape (n0, n1, n2, ...)."""
    for axis, end in enumerate(ends):
        matrix = _inverse(values.shape[axis], end)
        moved = np.moveaxis(values, axis, 0)
        solved = (matrix @ moved.reshape(moved.shape[0], -1)).reshape(-1, *moved.shape[1:])
        values = np.moveaxis(solved, 0, axis)
    return np.ascontiguousarray(values)


def _inverse(nodes: int, ends: tuple[str, str]) -> FloatArray:
    """Matrix from node values to coefficients."""
    matrix = np.zeros((nodes + 2, nodes + 2))
    rows = np.arange(nodes)
    for offset, weight in enumerate(WEIGHTS[0, :3]):
        matrix[rows + 1, rows + offset] = weight
    third = np.array([-1.0, 4.0, -6.0, 4.0, -1.0])
    slope = np.array([-0.5, 0.0, 0.5, 0.0, 0.0])
    matrix[0, :5] = slope if ends[0] == FLAT else third
    matrix[-1, -5:] = -slope[::-1] if ends[1] == FLAT else third
    inverse: FloatArray = np.linalg.inv(matrix)[:, 1:-1]
    return inverse


def neighbours(shape: tuple[int, ...]) -> IntArray:
    """Offsets of the 64 coefficients of a cell in a flattened array of this shape."""
    steps = np.arange(4)
    offsets = (steps[:, None, None] * shape[1] + steps[:, None]) * shape[2] + steps
    return offsets.reshape(64)


def evaluate(coefficients: FloatArray, cells: IntArray, fractions: FloatArray, derivatives: bool) -> FloatArray:
    """Value, or value and the three derivatives by the node coordinates.

    coefficients has shape (M, 3); cells, shape (p, 64), says which rows; fractions, shape (3, p), are the
    positions within the cell. The answer has shape (p, 1, 3) or (p, 4, 3).
    """
    powers = np.empty((3, fractions.shape[1], 4))
    powers[..., 0] = 1.0
    powers[..., 1] = fractions
    np.multiply(fractions, fractions, out=powers[..., 2])
    np.multiply(powers[..., 2], fractions, out=powers[..., 3])
    kinds = 4 if derivatives else 1
    factors = (powers @ FACTORS[:, :, :16] if derivatives else powers @ WEIGHTS).reshape(3, -1, kinds, 4)
    first, second, third = factors
    weights = (first[..., None] * second[:, :, None, :]).reshape(-1, kinds, 16, 1) * third[:, :, None, :]
    gathered = coefficients.take(cells, axis=0)
    result: FloatArray = weights.reshape(-1, kinds, 64) @ gathered
    return result
