"""The greatest forces, slip and energy of each contact along a curve."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.frozen import Frozen

if TYPE_CHECKING:
    from fcm.results.result import Curve


class Greatest(Frozen):
    """Greatest contact loads of a curve, arrays (contact, 4): normal force, friction force, slip, energy.

    value; frequency [rad/s]; error: estimated, relative, NaN if unknown; stable: 1 where small disturbances
    die out, 0 where not, NaN if unknown.
    """

    value: FloatArray
    frequency: FloatArray
    error: FloatArray
    stable: FloatArray

    @staticmethod
    def none(contacts: int) -> Greatest:
        """The values for a curve without points: all NaN."""
        return Greatest(*np.full((4, contacts, 4), np.nan))


def greatest_of(curve: Curve, error: FloatArray | None = None) -> Greatest:
    """Greatest contact loads of a curve with all its points.

    error (contact, 4) replaces the errors of the points, if given.
    """
    contacts = curve.cycle.shape[1]
    if not np.isfinite(curve.frequency).any():
        return Greatest.none(contacts)
    cycle = np.where(np.isnan(curve.cycle), -np.inf, curve.cycle)
    top = cycle.argmax(axis=0)
    here = np.ogrid[:contacts, :4]
    value = curve.cycle[top, here[0], here[1]]
    there = np.isfinite(value)  # nothing is known of a contact that was not traced
    return Greatest(
        value=value,
        frequency=np.where(there, curve.frequency[top], np.nan),
        error=curve.cycle_error[top, here[0], here[1]] if error is None else error,
        stable=np.where(there, curve.stable[top], np.nan),
    )
