"""Mesh of a structure: places of its nodes, elements that join them, and named sets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]


class MeshError(ValueError):
    """Raised for a faulty mesh file; the message has a sentence for each fault, without the file's name."""

    def __init__(self, *faults: str) -> None:
        self.faults = faults
        super().__init__("; ".join(faults))


class Mesh(Frozen):
    """Nodes by the numbers that their program gives them.

    nodes (node,); xyz (node, 3), in the unit of the file. cells: meshio's name of each kind of element, and
    the indices of its nodes (element, node of an element). sets: the nodes of each set, by its name in
    capitals. lacking: unknown kinds of elements, which are left out.
    """

    nodes: tuple[int, ...]
    xyz: FloatArray
    cells: tuple[tuple[str, IntArray], ...] = ()
    sets: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    lacking: tuple[str, ...] = ()

    @cached_property
    def place(self) -> dict[int, int]:
        """The index of each node in `nodes`."""
        return {node: i for i, node in enumerate(self.nodes)}

    def at(self, nodes: tuple[int, ...]) -> FloatArray:
        """Coordinates (node, 3) of some nodes.

        >>> Mesh((7, 3), np.eye(3)[:2]).at((3,)).tolist()
        [[0.0, 1.0, 0.0]]
        """
        return self.xyz[[self.place[node] for node in nodes]]
