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
    """The pairs of a contact: coordinates of both nodes (pair, 3), and of those without a partner.

    sets: names of the two sides; one where they touch the ground, none of a file of pairs. nodes: of each
    pair, one where it touches the ground.
    """

    name: str
    first: FloatArray
    second: FloatArray
    sets: tuple[str, ...] = ()
    alone: FloatArray = field(default_factory=_none)
    other_alone: FloatArray = field(default_factory=_none)
    plane: Plane | None = None
    nodes: tuple[tuple[str, ...], ...] = ()
