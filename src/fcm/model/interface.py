"""Places of the node pairs of a contact, for pictures."""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen

if TYPE_CHECKING:
    from fcm.mesh.pairing import Plane

FloatArray = npt.NDArray[np.float64]


def _none() -> FloatArray:
    return np.zeros((0, 3))


class Interface(Frozen):
    """The node pairs of a contact: coordinates (node, 3) of both sides, and of nodes without a partner.

    first, second: the two nodes of each pair. alone, other_alone: unpaired nodes of either side. sets: names
    of the node sets of both sides: one for a contact with the ground, none for a file of pairs. nodes: names
    of the nodes of each pair: one for a contact with the ground.
    """

    name: str
    first: FloatArray
    second: FloatArray
    sets: tuple[str, ...] = ()
    alone: FloatArray = field(default_factory=_none)
    other_alone: FloatArray = field(default_factory=_none)
    plane: Plane | None = None
    nodes: tuple[tuple[str, ...], ...] = ()
