"""A part of a table: the nodes around the points of the atlas that a calculation has looked up.

Splines through a part differ from those through all nodes only near its cut sides: the difference falls by a
factor of 0.27 with every node. So a part has `NODE_OPTIONS.guard` more nodes than it answers for.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.table import atlas
from fcm.table.atlas import FloatArray
from fcm.table.options import NODE_OPTIONS
from fcm.table.tabulated import NODES_BETWEEN, Frame, Resolution, locate

Range = tuple[int, int]  # the first node, and one past the last; empty if they are the same


class TablePart(NamedTuple):
    """Nodes that a table has, of all those of its resolution."""

    resolution: Resolution
    separation: Range
    slip: Range
    variation: Range
    phase: Range

    @classmethod
    def all_of(cls, resolution: Resolution) -> TablePart:
        """The part that has every node of a resolution."""
        nu_1, nu_2, nx, nz = resolution
        return cls(resolution, (0, nu_1), (0, nu_2), (0, nx), (0, nz))

    @property
    def whole(self) -> bool:
        """Whether the part has every node."""
        return self == TablePart.all_of(self.resolution)

    @property
    def nodes(self) -> int:
        """Number of nodes in both charts."""
        levels, nx, nz = (int(np.diff(r).sum()) for r in (self[1:3], self.variation, self.phase))
        return levels * nx * nz

    def sample(self, count: int, seed: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Points n0_bar, b_bar, phi for which the part answers, uniform in the coordinates of the charts."""
        random = np.random.default_rng(seed)
        _, _, nx, nz = self.resolution
        x, z = (_uniform(random, count, *axis) for axis in ((self.variation, nx), (self.phase, nz)))
        phi = atlas.phi_phase(z)
        b = atlas.b_variation(x, phi)
        lengths = np.array([max(0, end - first) for first, end in self[1:3]])
        slips = random.random(count) * lengths.sum() >= lengths[0]
        u_1 = _uniform(random, count, self.separation, self.resolution[0])
        u_2 = _uniform(random, count, self.slip, self.resolution[1])
        width = atlas.geometry(b, phi).width
        opened = b * np.cos(atlas.delta_separation(u_1, b))
        return np.where(slips, b + atlas.t_slip(u_2) * width, opened), b, phi


def frame(part: TablePart) -> Frame | None:
    """Ranges of the nodes of a part, in each chart along each axis; None if it has all nodes."""
    if part.whole:
        return None
    nu_1, nu_2, nx, nz = part.resolution
    first, end = part.separation
    slip_at = end - first - 1 + NODES_BETWEEN if end > first else 0  # in the stacked coefficients
    ranges = [
        [(nodes, count), (part.variation, nx), (part.phase, nz)]
        for nodes, count in ((part.separation, nu_1), (part.slip, nu_2))
    ]
    answered = np.array([[_answered(*axis) for axis in chart] for chart in ranges], dtype=np.float64)
    skipped = np.array([[nodes[0] for nodes, _ in chart] for chart in ranges])
    here = np.array(((0.0, 0.0, 0.0), (slip_at, 0.0, 0.0))) - skipped
    return Frame(answered[..., 0].copy(), answered[..., 1].copy(), here)


def _answered(nodes: Range, count: int) -> tuple[int, int]:
    """The first and last node, of `count` in all, for which the part answers: without guards at cut sides."""
    first, end = nodes
    if first == end:
        return 0, -1
    return first + NODE_OPTIONS.guard * (first > 0), end - 1 - NODE_OPTIONS.guard * (end < count)


def _uniform(random: np.random.Generator, count: int, nodes: Range, of: int) -> FloatArray:
    low, high = _answered(nodes, of)
    return random.uniform(low, max(low, high), count) / (of - 1)


class ChartRanges:
    """Records the ranges of the charts in which a table is evaluated."""

    def __init__(self, resolution: Resolution) -> None:
        self.resolution = resolution
        self._low, self._high = np.full((2, 3), np.inf), np.full((2, 3), -np.inf)

    def note(self, n0: FloatArray, b: FloatArray, phi: FloatArray) -> None:
        """Record look-ups at points (point,)."""
        place = locate(np.stack((n0, b, phi)), self.resolution)
        first_slip = self.resolution[0] - 1 + NODES_BETWEEN
        slips = place.q[0] > first_slip - 1
        for chart, chosen in enumerate((~slips, slips)):
            q = place.q[:, chosen & (place.scale != 0.0)]
            q[0] -= chart * first_slip
            self._low[chart] = np.minimum(self._low[chart], q.min(axis=1, initial=np.inf))
            self._high[chart] = np.maximum(self._high[chart], q.max(axis=1, initial=-np.inf))

    def part(self) -> TablePart | None:
        """The nodes that are needed to answer the same look-ups again; None if none are needed."""
        if not np.isfinite(self._low).any():
            return None
        nu_1, nu_2, nx, nz = self.resolution
        low, high = self._low.min(axis=0), self._high.max(axis=0)
        return TablePart(
            self.resolution,
            _around(self._low[0, 0], self._high[0, 0], nu_1),
            _around(self._low[1, 0], self._high[1, 0], nu_2),
            _around(low[1], high[1], nx),
            _around(low[2], high[2], nz),
        )


def _around(low: float, high: float, count: int) -> Range:
    """Nodes of an axis around an interval, including margin and guards."""
    if low > high:
        return 0, 0
    more = NODE_OPTIONS.margin + NODE_OPTIONS.guard
    return max(0, int(np.floor(low)) - more), min(count, int(np.ceil(high)) + more + 1)
