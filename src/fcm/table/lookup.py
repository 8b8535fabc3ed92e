"""Look-up of the three coefficients, and of the exact derivatives of their interpolant, at any point."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.table import spline
from fcm.table.atlas import FloatArray
from fcm.table.partial_table import TablePart, frame
from fcm.table.tabulated import Cubic, Resolution, Tabulated

Coefficients = npt.NDArray[np.float32]


class Table:
    """Fourier coefficients of the friction force by interpolation on the atlas; made by `open_table`.

    Attributes
    ----------
    resolution : tuple of int
        Nodes along u in separation, along u in slip, along x, along z.
    error : dict
        The absolute error [-] measured when the table was built, see `fcm.table.error`.
    part : TablePart
        The nodes of the table; a table for one scene has only a part of them.
    outside : int
        Number of points looked up so far outside the part, for which the closed form was evaluated.

    Examples
    --------
    >>> from fcm.table import open_table
    >>> table = open_table()
    >>> F_b, F_s, F_c = table(0.5, 0.0, 0.0)
    >>> print(f"{F_s:.4f} {F_c:.4f}")
    0.5000 0.3183
    """

    coefficients: Coefficients  # of the splines, see `spline.stack`

    def __init__(
        self,
        separation: FloatArray,
        slip: FloatArray,
        error: dict[str, Any] | None = None,
        part: TablePart | None = None,
    ) -> None:
        """Make a table from reduced coefficients G of the two charts, shapes (3, n, nx, nz)."""
        _, nodes_1, nodes_x, nodes_z = separation.shape
        self.part = TablePart.all_of((nodes_1, slip.shape[1], nodes_x, nodes_z)) if part is None else part
        self.resolution: Resolution = self.part.resolution
        self.error = {} if error is None else error
        self.outside = 0
        free = (spline.FREE, spline.FREE)
        (nu_1, nu_2, nx, _), (_, of_u_1, of_u_2, of_x, _) = self.resolution, self.part
        charts = (
            (separation, (_ends(of_u_1, nu_1), free, free)),
            (slip, (_ends(of_u_2, nu_2), (_ends(of_x, nx)[0], spline.FREE), free)),
        )
        self.coefficients = spline.stack(*(spline.interpolate(*chart) for chart in charts if chart[0].size))
        self._cubic, self._frame = Cubic(self.coefficients), frame(self.part)

    @classmethod
    def of_splines(cls, coefficients: Coefficients, error: dict[str, Any], part: TablePart) -> Table:
        """Make a table from the spline coefficients and attributes of another."""
        table = cls.__new__(cls)
        table.__setstate__(
            {
                "coefficients": coefficients,
                "error": error,
                "part": part,
                "resolution": part.resolution,
                "outside": 0,
            }
        )
        return table

    def __call__(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """F_b, F_s, F_c [-] at n0_bar [-], b_bar >= 0 [-] and phi [rad], as `fcm.fourier_coefficients`.

        Raises
        ------
        ValueError
            If an element of b_bar is negative.
        """
        F_b, F_s, F_c = self._many(n0_bar, b_bar, phi, False)
        return F_b, F_s, F_c

    def gradients(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """F, shape (3, ...), and dF, shape (3, 3, ...), laid out as by `fcm.contact.fourier_gradients`.

        dF are the derivatives of the interpolant itself, so Newton's method on it converges quadratically.
        Within about 1 / b_bar^2 of n0_bar = b_bar, for b_bar above 600, they do not approach those of F.
        """
        numbers = self._many(n0_bar, b_bar, phi, True)
        return numbers[:3], numbers[3:].reshape(3, 3, *numbers.shape[1:])

    def __getstate__(self) -> dict[str, Any]:
        """State for another process: only the arrays, from which the rest is made again."""
        return {name: value for name, value in vars(self).items() if name not in ("_cubic", "_frame")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._cubic, self._frame = Cubic(self.coefficients), frame(self.part)

    def law(self) -> Tabulated:
        """The table as a coefficient law for one thread."""
        return Tabulated(self._cubic, self.resolution, self._frame)

    def _many(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike, gradient: bool
    ) -> FloatArray:
        law = self.law()
        numbers: FloatArray = law.many(n0_bar, b_bar, phi, gradient)
        self.outside += law.outside
        return numbers


def _ends(nodes: tuple[int, int], count: int) -> tuple[str, str]:
    """End conditions of an axis with `count` nodes: flat at its ends, but free where nodes are cut off."""
    first, end = nodes
    return spline.FLAT if first == 0 else spline.FREE, spline.FLAT if end == count else spline.FREE
