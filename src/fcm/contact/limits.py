"""Boundaries between the regimes of a contact (open, opening, slipping, sticking), over arrays."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.closed_form import Boundaries

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]


def regime_boundaries(n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike) -> FloatArray:
    """The boundary functions n0 + b, n0 - b and n0 - (ell_1 + ell_2) / 2, shape (3, ...).

    The arguments broadcast.

    >>> regime_boundaries(0.5, 0.25, 0.0).tolist()  # closed throughout, and slips
    [0.75, 0.25, -0.5]
    """
    functions: FloatArray = Boundaries().many(n0_bar, b_bar, phi, False)
    return functions


def slip_limit(b_bar: FloatArray, phi: npt.ArrayLike) -> FloatArray:
    """Least n0_bar at which a contact neither slips nor opens: (ell_1 + ell_2) / 2 of (25)."""
    limit: FloatArray = b_bar + np.maximum(-regime_boundaries(b_bar, b_bar, phi)[2], 0.0)
    return limit
