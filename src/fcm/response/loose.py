"""Points whose motion may be one of many: a contact that never slips may have any residual friction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.scene.model import Contact


def loose(contacts: Sequence[Contact], states: npt.NDArray[np.str_]) -> npt.NDArray[np.bool_]:
    """Of points with states (point, contact): whether a contact never slips beside one that feels it.

    Where all stick or stay open the motion is linear, and the same whatever the residual friction.

    >>> rough = Contact("c", np.ones(1), np.ones(1), mu=0.3, k_u=1.0, k_v=1.0, n_0=1.0)
    >>> loose([rough, rough], np.array([["E", "SEP"], ["E", "S"], ["EPEN", "SEP"]])).tolist()
    [True, False, False]
    """
    rough = np.array([contact.mu * contact.k_u > 0.0 for contact in contacts], dtype=np.bool_)
    stuck, changing = (states == "E") & rough, np.char.str_len(states) > 1
    found: npt.NDArray[np.bool_] = stuck.any(axis=1) & changing.any(axis=1)
    return found
