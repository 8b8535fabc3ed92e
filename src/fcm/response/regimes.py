"""What each contact does over a cycle at a point of a response: the sequence of its states."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.contact.loop import sequences
from fcm.response.law import Law


def regimes(law: Law, x: FloatArray) -> npt.NDArray[np.str_]:
    """Sequences such as "SPEN", (point, contact), at x (point, contact, 5).

    A contact without friction has no loop: it is closed, "E", open, "S", or one after the other, "SE".
    """
    found = sequences(*law.arguments(x))
    smooth = np.broadcast_to(law.mu * law.k_u == 0.0, found.shape)
    if not smooth.any():
        return found
    load, variation = law.n_0 + law.k_v * x[..., 4], law.k_v * np.hypot(x[..., 2], x[..., 3])
    in_turn = np.abs(load) < variation
    return np.where(smooth, np.where(in_turn, "SE", np.where(load > 0.0, "E", "S")), found)
