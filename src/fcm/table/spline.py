r"""Tensor-product cubic B-splines on unit-spaced nodes: interpolation; `Cubic` evaluates them.

On an axis with n nodes a spline is ``sum_k c_k B(q - k)`` with n + 2 coefficients and, for q = i + f,

    B_i-1 .. B_i+2 = (1-f)^3/6, (4 - 6f^2 + 3f^3)/6, (1 + 3f + 3f^2 - 3f^3)/6, f^3/6.

It is twice continuously differentiable, local to evaluate (64 coefficients), and its error on a smooth
function is h^4 f''''/384.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.table.options import NODE_OPTIONS

FloatArray = npt.NDArray[np.float64]

FREE, FLAT = "free", "flat"  # end conditions: third derivative continuous at the second node; zero slope

# rows: the four weights; columns: 1, f, f^2, f^3
WEIGHTS = np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6.0


def interpolate(values: FloatArray, ends: tuple[tuple[str, str], ...]) -> FloatArray:
    """Coefficients, shape (3, n0+2, n1+2, n2+2), of the splines through values, shape (3, n0, n1, n2)."""
    for axis, end in enumerate(ends, start=1):
        values = _along(axis, _inverse(values.shape[axis], end), values)
    return values


def _along(axis: int, matrix: FloatArray, values: FloatArray) -> FloatArray:
    """Product of a matrix with one axis of values, in parts too small for BLAS to start threads.

    If several programs share the processor, threads that wait for each other take ten times as long.
    """
    before, after = values.shape[:axis], values.shape[axis + 1 :]
    width = max(1, NODE_OPTIONS.serial_multiplications // matrix.size)
    if not after:
        rows = values.reshape(-1, values.shape[axis])
        parts = [rows[first : first + width] @ matrix.T for first in range(0, rows.shape[0], width)]
        return np.concatenate(parts).reshape(*before, -1)
    planes = values.reshape(-1, values.shape[axis], int(np.prod(after)))
    product = np.empty((planes.shape[0], matrix.shape[0], planes.shape[2]))
    for first in range(0, planes.shape[2], width):
        part = slice(first, first + width)
        np.matmul(matrix, planes[:, :, part], out=product[:, :, part])
    return product.reshape(*before, -1, *after)


def _inverse(nodes: int, ends: tuple[str, str]) -> FloatArray:
    """Matrix from node values to coefficients."""
    matrix = np.zeros((nodes + 2, nodes + 2))
    rows = np.arange(nodes)
    for offset, weight in enumerate(WEIGHTS[:3, 0]):
        matrix[rows + 1, rows + offset] = weight
    third = np.array([-1.0, 4.0, -6.0, 4.0, -1.0])
    slope = np.array([-0.5, 0.0, 0.5, 0.0, 0.0])
    matrix[0, :5] = slope if ends[0] == FLAT else third
    matrix[-1, -5:] = -slope[::-1] if ends[1] == FLAT else third
    return np.asarray(np.linalg.inv(matrix)[:, 1:-1], dtype=np.float64)


def stack(*parts: FloatArray) -> npt.NDArray[np.float32]:
    """Coefficients of several splines in sequence along the first axis, the three of a node together.

    They are in single precision, as the values in the file, which halves the memory traffic of look-ups. A
    point on the last node of a row of cells reads beyond it with weight 0; hence the zeros at the end.
    """
    planes = sum(part.shape[1] for part in parts)
    stacked = np.zeros((planes + 2, *parts[0].shape[2:], 3), dtype=np.float32)
    np.concatenate([np.moveaxis(part, 0, -1) for part in parts], out=stacked[:planes])
    return stacked
