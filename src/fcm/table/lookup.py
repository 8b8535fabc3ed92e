"""Look-up: the three coefficients and the exact derivatives of their interpolant, anywhere."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.table import atlas, spline
from fcm.table.atlas import FloatArray

BLOCK = 2048  # points at a time, so that the intermediate arrays stay in the processor's cache


class Table:
    """Fourier coefficients of the friction force by interpolation on the atlas; made by `open_table`.

    Attributes
    ----------
    resolution : tuple of int
        Nodes along u in separation, along u in slip, along x, along z.
    error : dict
        The absolute error [-] measured when the table was built, see `fcm.table.measure`.

    Examples
    --------
    >>> from fcm.table import open_table
    >>> table = open_table()
    >>> F_b, F_s, F_c = table(0.5, 0.0, 0.0)
    >>> print(f"{F_s:.4f} {F_c:.4f}")
    0.5000 0.3183
    """

    def __init__(
        self, separation: FloatArray, slip: FloatArray, error: dict[str, Any] | None = None
    ) -> None:
        """From the reduced coefficients G of the two charts, shapes (n, nx, nz, 3)."""
        self.resolution = (separation.shape[0], slip.shape[0], *separation.shape[1:3])
        self.error = {} if error is None else error
        flat, free = (spline.FLAT, spline.FLAT), (spline.FREE, spline.FREE)
        parts = (
            spline.interpolate(separation, (flat, free, free)),
            spline.interpolate(slip, (flat, (spline.FLAT, spline.FREE), free)),
        )
        shape = parts[0].shape[1:3]
        self._coefficients = np.concatenate([part.reshape(-1, 3) for part in parts])
        self._neighbours = spline.neighbours((0, *shape))
        self._strides = (shape[0] * shape[1], shape[1])
        self._slip_start = parts[0].shape[0]

    def __call__(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """F_b, F_s, F_c [-] at n0_bar [-], b_bar >= 0 [-], phi [rad]; arguments as `fcm.fourier_coefficients`.

        Raises
        ------
        ValueError
            If an element of b_bar is negative.
        """
        F, _ = self._evaluate(n0_bar, b_bar, phi, gradients=False)
        return F[0], F[1], F[2]

    def gradients(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """F, shape (3, ...), and dF, shape (3, 3, ...), laid out as by `fcm.contact.fourier_gradients`.

        dF are the derivatives of the interpolant itself, so Newton's method on it converges quadratically.
        """
        F, dF = self._evaluate(n0_bar, b_bar, phi, gradients=True)
        assert dF is not None
        return F, dF

    def _evaluate(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike, gradients: bool
    ) -> tuple[FloatArray, FloatArray | None]:
        arguments = np.broadcast_arrays(
            *(np.asarray(x, dtype=np.float64) for x in (n0_bar, b_bar, phi))
        )
        shape = arguments[0].shape
        n0, b, ph = (x.reshape(-1) for x in arguments)
        if (b < 0.0).any():
            raise ValueError("b_bar is an amplitude and must not be negative; shift phi by pi instead")
        n0 = np.minimum(np.maximum(n0, -1e300), 1e300)
        known = np.isfinite(n0 + b * 1e-10 + ph)
        if known.all():
            F, dF = self._blocks(n0, b, ph, gradients)
        else:
            F, dF = np.full((3, n0.size), np.nan), np.full((3, 3, n0.size), np.nan) if gradients else None
            F[:, known], part = self._blocks(n0[known], b[known], ph[known], gradients)
            if dF is not None:
                dF[:, :, known] = part
        return F.reshape(3, *shape), None if dF is None else dF.reshape(3, 3, *shape)

    def _blocks(
        self, n0: FloatArray, b: FloatArray, phi: FloatArray, gradients: bool
    ) -> tuple[FloatArray, FloatArray | None]:
        if n0.size <= BLOCK:
            return self._block(n0, b, phi, gradients)
        F = np.empty((3, n0.size))
        dF = np.empty((3, 3, n0.size)) if gradients else None
        for first in range(0, n0.size, BLOCK):
            part = slice(first, first + BLOCK)
            F[:, part], block = self._block(n0[part], b[part], phi[part], gradients)
            if dF is not None:
                dF[:, :, part] = block
        return F, dF

    def _block(
        self, n0: FloatArray, b: FloatArray, phi: FloatArray, gradients: bool
    ) -> tuple[FloatArray, FloatArray | None]:
        folded, sign = atlas.fold(phi)
        phase = atlas.Phase.of(folded)
        shape = atlas.geometry(b, phase)
        above = n0 - b
        opens = above < 0.0
        opened = n0 <= -b
        stuck = ~opens & (above >= shape.width)
        inside = ~(opened | stuck)

        # u, with the scale of G times du/dn0, du/db, du/dphi
        safe_b = np.maximum(b, 1e-300)
        bounded = np.minimum(np.maximum(n0, -safe_b), safe_b)
        below_1 = np.maximum((safe_b - bounded) / safe_b, atlas.NEAR)  # 1 - n0/b
        above_1 = np.maximum((safe_b + bounded) / safe_b, atlas.NEAR)
        root, other = np.sqrt(below_1), np.sqrt(above_1)
        u_1, u_delta, u_b = atlas.u_separation(2.0 * np.arctan2(root, other), b)
        safe_width = np.where(shape.width > 0.0, shape.width, 1.0)
        t = np.minimum(np.maximum(above / safe_width, atlas.NEAR), 1.0 - atlas.NEAR)
        u_2, u_t = atlas.u_slip(t)
        x, x_b, x_phi = atlas.x_variation(b, phase)
        z, z_phi = atlas.z_phase(folded)

        nodes_1, nodes_2, nodes_x, nodes_z = self.resolution
        last = np.where(opens, nodes_1 - 1.0, nodes_2 - 1.0)
        q = np.empty((3, n0.size))
        np.multiply(np.where(opens, u_1, u_2), last, out=q[0])
        np.multiply(x, nodes_x - 1.0, out=q[1])
        np.multiply(z, nodes_z - 1.0, out=q[2])
        cell = q.astype(np.int64)
        np.minimum(cell[0], last.astype(np.int64) - 1, out=cell[0])
        np.minimum(cell[1], nodes_x - 2, out=cell[1])
        np.minimum(cell[2], nodes_z - 2, out=cell[2])
        np.maximum(cell, 0, out=cell)
        q -= cell
        corner = (cell[0] + np.where(opens, 0, self._slip_start)) * self._strides[0] + cell[1] * self._strides[
            1
        ]
        rows = (corner + cell[2])[:, None] + self._neighbours
        G = spline.evaluate(self._coefficients, rows, q, gradients)

        layer = 1.0 / (1.0 + b)
        scale = np.where(opens, b * layer, shape.width) * inside
        reach = np.maximum(above, shape.width)
        low, high = shape.high - reach, reach - shape.low
        F = (G[:, 0, :] * scale[:, None]).T
        mean = np.minimum(np.maximum(0.0, low), np.maximum(high, low))
        F[0] += np.where(opens, 0.0, mean)
        F[1] += np.where(opens, 0.0, 1.0)
        F[0] *= sign
        if not gradients:
            return F, None

        ends = inside * last
        by_delta = u_delta * layer / (root * other) * ends
        cosine = 0.5 * (above_1 - below_1)
        width_b = 0.5 * (shape.ell_1_b + shape.ell_2_b) - 1.0
        width_phi = 0.5 * (shape.ell_1_phi + shape.ell_2_phi)
        u_t = u_t * ends
        J = np.zeros((n0.size, 3, 4))
        J[:, 0, 1] = np.where(opens, -by_delta, u_t)
        J[:, 1, 1] = np.where(opens, by_delta * cosine + u_b * b * layer * ends, -(1.0 + t * width_b) * u_t)
        J[:, 2, 1] = np.where(opens, 0.0, -t * width_phi * u_t)
        J[:, 1, 0] = np.where(opens, layer * layer, width_b) * inside
        J[:, 2, 0] = np.where(opens, 0.0, width_phi) * inside
        root_b = np.sqrt(np.maximum(b, 1e-14))
        J[:, 1, 2] = scale * x_b / root_b * (nodes_x - 1.0)
        J[:, 2, 2] = scale * x_phi * (nodes_x - 1.0)
        J[:, 2, 3] = scale * z_phi * (nodes_z - 1.0)
        dF = np.ascontiguousarray((J @ G).transpose(2, 1, 0))
        # the mean force of the contact that does not slip
        closed = ~opens
        edge = closed & inside
        is_low, is_high = closed & stuck & (mean > 0.0), closed & stuck & (mean < 0.0)
        weight_2 = is_low + 0.5 * edge
        weight_1 = is_high + 0.5 * edge
        dF[0, 0] += is_high * 1.0 - is_low
        dF[0, 1] += weight_2 * shape.ell_2_b - weight_1 * shape.ell_1_b
        dF[0, 2] += weight_2 * shape.ell_2_phi - weight_1 * shape.ell_1_phi
        dF[0] *= sign
        return F, dF
