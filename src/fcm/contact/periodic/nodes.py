"""Kernel: the angles at which a motion is sampled first, and its harmonics there."""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

# Nodes lie beside the multiples of pi / 2, where symmetric motions have their events.
FIRST_NODE = cython.declare(cython.double, 0.1171)
NODES_PER_HARMONIC = cython.declare(cython.int, 4)  # at first: where that proves nothing it is halved
TWO_PI = cython.declare(cython.double, 6.283185307179586)


@cython.cclass
class Nodes:
    """`nodes` angles, first + j * step: few for a fundamental alone, and many for all harmonics.

    node_cos, node_sin (node, harmonic): the harmonics at the few, then at the many; those that are taken
    stand from `before` on.
    """

    def __init__(self, harmonics: list[int]) -> None:
        self.highest = max(harmonics, default=0)
        self.few, self.many = NODES_PER_HARMONIC + 1, NODES_PER_HARMONIC * max(self.highest, 1) + 1
        both = _waves(self.few, harmonics), _waves(self.many, harmonics)
        self.node_cos, self.node_sin = (np.concatenate(waves) for waves in zip(*both, strict=True))
        self.fundamental = harmonics[:1] == [1]
        self.take_nodes(len(harmonics))

    def take_nodes(self, moving: cython.int) -> None:
        """Those of a motion of so many harmonics, the first."""
        self.alone = moving <= 1 and self.fundamental
        self.nodes = self.few if self.alone else self.many
        self.before = 0 if self.alone else self.few
        self.step = TWO_PI / self.nodes
        self.first = FIRST_NODE * self.step


def _waves(count: int, harmonics: list[int]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Cosines and sines (node, harmonic) at so many nodes."""
    nodes = 2.0 * np.pi / count * (FIRST_NODE + np.arange(count))
    angle = np.outer(nodes, np.array(harmonics, dtype=np.float64))
    return np.cos(angle), np.sin(angle)
