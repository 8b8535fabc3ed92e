"""Look-up: the three coefficients and the exact derivatives of their interpolant, anywhere."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.table import spline
from fcm.table.atlas import FloatArray
from fcm.table.locate import Resolution, locate
from fcm.table.part import Frame, Part

BLOCK = 4096  # points at a time, so that the intermediate arrays stay in the processor's cache
LARGEST, FARTHEST = 1e300, 2e300  # of b_bar, of n0_bar: an infinite preload or gap is as this one


class Table:
    """Fourier coefficients of the friction force by interpolation on the atlas; made by `open_table`.

    Attributes
    ----------
    resolution : tuple of int
        Nodes along u in separation, along u in slip, along x, along z.
    error : dict
        The absolute error [-] measured when the table was built, see `fcm.table.measure`.
    part : Part
        The nodes that the table has; of one for a certain scene, not all.
    outside : int
        Points looked up so far that these nodes do not answer for: they are from the closed form.

    Examples
    --------
    >>> from fcm.table import open_table
    >>> table = open_table()
    >>> F_b, F_s, F_c = table(0.5, 0.0, 0.0)
    >>> print(f"{F_s:.4f} {F_c:.4f}")
    0.5000 0.3183
    """

    def __init__(
        self,
        separation: FloatArray,
        slip: FloatArray,
        error: dict[str, Any] | None = None,
        part: Part | None = None,
    ) -> None:
        """From the reduced coefficients G of the two charts, shapes (3, n, nx, nz)."""
        _, nodes_1, nodes_x, nodes_z = separation.shape
        self.part = Part.all_of((nodes_1, slip.shape[1], nodes_x, nodes_z)) if part is None else part
        self.resolution: Resolution = self.part.resolution
        self.error = {} if error is None else error
        self.outside = 0
        self._frame = None if self.part.whole else Frame(self.part)
        free = (spline.FREE, spline.FREE)
        (nu_1, nu_2, nx, _), (_, of_u_1, of_u_2, of_x, _) = self.resolution, self.part
        charts = (
            (separation, (_ends(of_u_1, nu_1), free, free)),
            (slip, (_ends(of_u_2, nu_2), (_ends(of_x, nx)[0], spline.FREE), free)),
        )
        self._coefficients = spline.stack(*(spline.interpolate(*chart) for chart in charts if chart[0].size))
        self._strides, self._neighbours = spline.strides((nodes_x + 2, nodes_z + 2))

    def __call__(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """F_b, F_s, F_c [-] at n0_bar [-], b_bar >= 0 [-] and phi [rad], as `fcm.fourier_coefficients`.

        Raises
        ------
        ValueError
            If an element of b_bar is negative.
        """
        F = self._evaluate(n0_bar, b_bar, phi, 1)[:, 0]
        return F[0], F[1], F[2]

    def gradients(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """F, shape (3, ...), and dF, shape (3, 3, ...), laid out as by `fcm.contact.fourier_gradients`.

        dF are the derivatives of the interpolant itself, so Newton's method on it converges quadratically.
        Within about 1 / b_bar^2 of n0_bar = b_bar, for b_bar above 600, they do not approach those of F.
        """
        values = self._evaluate(n0_bar, b_bar, phi, 4)
        return values[:, 0], values[:, 1:]

    def _evaluate(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike, kinds: int
    ) -> FloatArray:
        """Value, or value and derivatives: shape (3, kinds, ...)."""
        n0, b, ph = (np.asarray(x, dtype=np.float64) for x in (n0_bar, b_bar, phi))
        if not n0.shape == b.shape == ph.shape:
            n0, b, ph = np.broadcast_arrays(n0, b, ph)
        shape = n0.shape
        if np.count_nonzero(b < 0.0):
            raise ValueError("b_bar is an amplitude and must not be negative; shift phi by pi instead")
        n0 = np.minimum(np.maximum(n0, -FARTHEST), FARTHEST).reshape(-1)
        b, ph = b.reshape(-1), ph.reshape(-1)
        known = np.isfinite(b) & np.isfinite(n0 + ph)
        b = np.minimum(b, LARGEST)
        if np.count_nonzero(known) == known.size:
            return self._blocks(n0, b, ph, kinds).reshape(3, kinds, *shape)
        values = np.full((3, kinds, n0.size), np.nan)
        values[:, :, known] = self._blocks(n0[known], b[known], ph[known], kinds)
        return values.reshape(3, kinds, *shape)

    def _blocks(self, n0: FloatArray, b: FloatArray, phi: FloatArray, kinds: int) -> FloatArray:
        if 0 < n0.size <= BLOCK:
            return self._block(n0, b, phi, kinds)
        values = np.empty((3, kinds, n0.size))
        for first in range(0, n0.size, BLOCK):
            part = slice(first, first + BLOCK)
            values[:, :, part] = self._block(n0[part], b[part], phi[part], kinds)
        return values

    def _block(self, n0: FloatArray, b: FloatArray, phi: FloatArray, kinds: int) -> FloatArray:
        place = locate(n0, b, phi, self.resolution, kinds > 1)
        q, outside = (place.q, None) if self._frame is None else self._frame.within(place)
        G = spline.evaluate(self._coefficients, q, self._strides, self._neighbours, kinds)
        values = np.empty_like(G)
        values[:, 0] = G[:, 0] * place.scale + place.base
        if kinds > 1:
            np.einsum("jkp,ckp->cjp", place.chain, G, out=values[:, 1:])
            values[0, 1:] += place.base_slopes
        values[0] *= place.sign
        if outside is not None and outside.any():
            values[:, :, outside] = self._exact(n0[outside], b[outside], phi[outside], kinds)
        return values

    def _exact(self, n0: FloatArray, b: FloatArray, phi: FloatArray, kinds: int) -> FloatArray:
        """What a part of a table does not answer for, from the closed form."""
        from fcm.contact.fourier import fourier_coefficients, fourier_gradients

        self.outside += n0.size
        if kinds == 1:
            return np.stack(fourier_coefficients(n0, b, phi))[:, None]
        F, dF = fourier_gradients(n0, b, phi)
        return np.concatenate((F[:, None], dF), axis=1)


def _ends(nodes: tuple[int, int], count: int) -> tuple[str, str]:
    """G is flat at the ends of an axis of so many nodes, not where a part of them is cut off."""
    first, end = nodes
    return spline.FLAT if first == 0 else spline.FREE, spline.FLAT if end == count else spline.FREE
