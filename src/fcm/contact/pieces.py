"""The pieces of a loop, one for each state of its sequence: which an angle is in, and the friction there."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray


def piece_at(theta: FloatArray, angles: FloatArray, since: FloatArray) -> npt.NDArray[np.intp]:
    """Which piece each angle theta [rad] is in; `since` is where they begin, from the first on."""
    if since.size == 0:
        return np.zeros(theta.shape, dtype=np.intp)
    return np.asarray(np.searchsorted(since, np.mod(theta - angles[0], 2.0 * np.pi), side="right") - 1)


def friction(state: npt.NDArray[np.str_], stick: FloatArray, limit: FloatArray) -> FloatArray:
    """The friction force by the state: `stick` while it sticks, plus or minus the limit while it slips."""
    held = np.clip(stick, -limit, limit)  # at an event, a rounding error may put it past the limit
    return np.select([state == "E", state == "P", state == "N"], [held, limit, -limit], 0.0)
