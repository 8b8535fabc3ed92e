r"""Tensor-product cubic B-splines on unit-spaced nodes: interpolation, values, first derivatives.

On an axis with n nodes a spline is ``sum_k c_k B(q - k)`` with n + 2 coefficients and, for q = i + f,

    B_i-1 .. B_i+2 = (1-f)^3/6, (4 - 6f^2 + 3f^3)/6, (1 + 3f + 3f^2 - 3f^3)/6, f^3/6.

It is twice continuously differentiable, local to evaluate (64 coefficients), and its error on a smooth
function is h^4 f''''/384.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

FREE, FLAT = "free", "flat"  # end conditions: third derivative continuous at the second node; zero slope

# rows: the four weights; columns: 1, f, f^2, f^3
WEIGHTS = np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6.0
SLOPES = np.array([[-3, 6, -3, 0], [0, -12, 9, 0], [3, 6, -9, 0], [0, 0, 3, 0]]) / 6.0
# for each axis, the factors of: value, derivative along axis 0, 1, 2
FACTORS = np.stack(
    [np.concatenate([SLOPES if k == axis else WEIGHTS for k in (-1, 0, 1, 2)]) for axis in range(3)]
)

UNTHREADED = 200_000  # multiplications of a matrix product that OpenBLAS does in one thread
PART = 256  # points at a time, so that their 64 weights and coefficients stay in the processor's cache


def interpolate(values: FloatArray, ends: tuple[tuple[str, str], ...]) -> FloatArray:
    """Coefficients, shape (3, n0+2, n1+2, n2+2), of the splines through values, shape (3, n0, n1, n2)."""
    for axis, end in enumerate(ends, start=1):
        values = _along(axis, _inverse(values.shape[axis], end), values)
    return values


def _along(axis: int, matrix: FloatArray, values: FloatArray) -> FloatArray:
    """Product of a matrix with one axis of values, in parts too small for BLAS to start threads.

    Where several programs share the processor, threads that wait for each other take ten times as long.
    """
    before, after = values.shape[:axis], values.shape[axis + 1 :]
    width = max(1, UNTHREADED // matrix.size)
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


def stack(*parts: FloatArray) -> FloatArray:
    """Coefficients of several splines one after the other along their first axis, shape (3, rows).

    A point on the last node of a row of cells reads beyond it, with weight 0: hence the zeros at the end.
    """
    beyond = np.zeros_like(parts[0][:, :2])
    return np.concatenate((*parts, beyond), axis=1).reshape(3, -1)


def strides(shape: tuple[int, int]) -> tuple[IntArray, IntArray]:
    """Steps of the three axes in stacked coefficients with last axes of this shape, and the 64 neighbours."""
    steps = np.array((shape[0] * shape[1], shape[1], 1))
    four = np.arange(4)
    offsets = four[:, None, None] * steps[0] + four[:, None] * steps[1] + four
    return steps, offsets.reshape(64, 1)


def evaluate(
    coefficients: FloatArray, q: FloatArray, steps: IntArray, neighbours: IntArray, kinds: int
) -> FloatArray:
    """Value (kinds = 1), or value and the three derivatives by q (kinds = 4): shape (3, kinds, p).

    coefficients as from `stack`; q, shape (3, p), not negative, in units of nodes; the others from `strides`.
    """
    cells = q.astype(np.int64)
    powers = np.empty((3, 4, q.shape[1]))
    powers[:, 0] = 1.0
    fraction = np.subtract(q, cells, out=powers[:, 1])
    square = np.multiply(fraction, fraction, out=powers[:, 2])
    np.multiply(square, fraction, out=powers[:, 3])
    factors = ((WEIGHTS if kinds == 1 else FACTORS) @ powers).reshape(3, kinds, 4, -1)
    corners = steps @ cells
    if corners.size <= PART:
        return _Space(kinds, corners.size).contract(coefficients, corners, neighbours, factors)
    values = np.empty((3, kinds, corners.size))
    space = _Space(kinds, PART)
    for first in range(0, corners.size, PART):
        part = slice(first, first + PART)
        if corners[part].size < PART:
            space = _Space(kinds, corners[part].size)
        values[..., part] = space.contract(coefficients, corners[part], neighbours, factors[..., part])
    return values


class _Space:
    """Memory used for one part after the other: having it from the system anew costs more than the sums."""

    def __init__(self, kinds: int, points: int) -> None:
        self.plane = np.empty((kinds, 4, 4, points))
        self.weights = np.empty((kinds, 16, 4, points))
        self.rows = np.empty((64, points), dtype=np.int64)
        self.gathered = np.empty((3, 64, points))

    def contract(
        self, coefficients: FloatArray, corners: IntArray, neighbours: IntArray, factors: FloatArray
    ) -> FloatArray:
        """Sums of 64 coefficients times the products of the factors of the three axes."""
        first, second, third = factors
        kinds, _, points = first.shape
        np.multiply(first[:, :, None], second[:, None], out=self.plane)
        np.multiply(self.plane.reshape(kinds, 16, 1, points), third[:, None], out=self.weights)
        np.add(neighbours, corners, out=self.rows)
        coefficients.take(self.rows, axis=1, out=self.gathered, mode="clip")
        weights = self.weights.reshape(kinds, 64, points)
        values: FloatArray = np.einsum("dkp,ckp->cdp", weights, self.gathered)
        return values
