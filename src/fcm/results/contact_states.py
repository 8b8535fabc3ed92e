"""State sequences of contacts over a cycle, reduced to one of four words."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

STATES = ("sticks", "slips", "slips and opens", "open")


def contact_states(sequences: Iterable[str]) -> npt.NDArray[np.intp]:
    """Indices into `STATES` of contacts with given state sequences, such as "SPEN".

    >>> contact_states(["E", "EPEN", "SEP", "S"]).tolist()
    [0, 1, 2, 3]
    """
    found = [
        3 if word == "S" else 2 if "S" in word else 1 if set(word) - set("E") else 0 for word in sequences
    ]
    return np.array(found, dtype=np.intp)
