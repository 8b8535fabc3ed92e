"""Rows of a least-squares problem: residuals of measured points, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray


class ResidualRows(Frozen):
    """Residuals of measured points and their derivatives by the numbers.

    residual: (point, component) in units of the errors. rates: (point, component, number). unreached:
    (point,) whether the model's curve does not reach the point, so that the end of the curve is used.
    independent: number of independent residuals; those of a response are normal to its curve.
    """

    residual: FloatArray
    rates: FloatArray
    unreached: FloatArray
    independent: int

    @property
    def cost(self) -> float:
        return 0.5 * float((self.residual**2).sum())


def joined(parts: Sequence[ResidualRows]) -> ResidualRows:
    """The rows of several data sets in one; missing components are 0."""
    most = max(part.residual.shape[1] for part in parts)

    def wide(values: FloatArray) -> FloatArray:
        missing = [(0, 0)] * values.ndim
        missing[1] = (0, most - values.shape[1])
        return np.pad(values, missing)

    return ResidualRows(
        np.concatenate([wide(part.residual) for part in parts]),
        np.concatenate([wide(part.rates) for part in parts]),
        np.concatenate([part.unreached for part in parts]),
        sum(part.independent for part in parts),
    )
