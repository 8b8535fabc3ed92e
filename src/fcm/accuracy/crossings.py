r"""Where amplitudes of a curve and its partner cross: their difference vanishes there, the error does not.

What is left is by how much the partner is off itself. So it has a partner of its own at these few points, and
the error is at least

    |a_second - a_partner| / a

as far as the greatest differences to either side.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import PairOptions
from fcm.accuracy.partner_curve import PartnerCurve
from fcm.model.scene import FloatArray

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Crossing:
    """A degree of freedom, the point next to where it crosses, the points of the greatest differences before
    and behind, and the smaller of these differences: what the crossing hides."""

    dof: int
    point: int
    before: int
    behind: int
    hidden: float


def crossings(shift: FloatArray, counts: Mask, options: PairOptions) -> list[Crossing]:
    """Those of differences (point, dof), where these count (point, dof) and are known, that hide most.

    Examples
    --------
    >>> shift = np.array([[0.1], [0.2], [0.05], [-0.1], [-0.3], [-0.2]])
    >>> crossings(shift, np.full((6, 1), True), PairOptions())
    [Crossing(dof=0, point=2, before=1, behind=4, hidden=0.2)]
    """
    found = list[Crossing]()
    for d in range(shift.shape[1]):
        rows = np.flatnonzero(np.isfinite(shift[:, d]) & counts[:, d])
        value = shift[rows, d]
        changes = np.flatnonzero(value[:-1] * value[1:] < 0.0)
        ends = np.concatenate(([0], changes + 1, [len(rows)]))
        tops = [a + int(np.abs(value[a:b]).argmax()) for a, b in pairwise(ends.tolist()) if b > a]
        for k, change in enumerate(changes.tolist()):
            before, behind = tops[k], tops[k + 1]
            hidden = float(min(abs(value[before]), abs(value[behind])))
            point = change + int(abs(value[change + 1]) < abs(value[change]))
            if hidden > options.min_hidden:
                found.append(Crossing(d, int(rows[point]), int(rows[before]), int(rows[behind]), hidden))
    return sorted(found, key=lambda one: -one.hidden)


def with_crossings(partner: PartnerCurve, shift: FloatArray, error: FloatArray) -> FloatArray:
    """Errors (point, dof) in units of the partner's curve, of differences (point, dof) at the same frequency:
    beside crossings at least what the partner itself is off by there."""
    counts = (partner.amplitude >= partner.unit) & ~partner.linear[:, None]
    raised, known, options = error.copy(), dict[int, FloatArray | None](), partner.options
    for one in crossings(shift, counts, options):
        place = next((k for k in known if abs(k - one.point) <= options.crossing_spacing), one.point)
        if place not in known:
            if len(known) == options.max_crossings:
                continue
            known[place] = partner.own_error(place)
        off = known[place]
        if off is not None:
            rows = slice(one.before, one.behind + 1)
            raised[rows, one.dof] = np.maximum(raised[rows, one.dof], off[one.dof])  # NaN stays
    return raised
