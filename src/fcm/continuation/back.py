"""Back to an earlier point of a curve, where no step leads on from the last.

A step may end by chance at a solution beyond a corner from which nothing leads on; other steps may not.
"""

from __future__ import annotations

import numpy as np

from fcm.continuation.front import Front
from fcm.continuation.trail import Trail

BACK = (1, 8, 64)  # points by which a curve is taken back: one attempt each


def earlier(front: Front, trail: Trail, points: int) -> bool:
    """Whether the front is at the last plain point so many points back or more; the trail ends there then."""
    kept = trail.points()
    plain = np.flatnonzero(kept.mark[: max(trail.count - points, 0)] == 0)
    if not plain.size:
        return False
    i = int(plain[-1])
    front.problem.measure(kept.z[i])
    row = kept.direction[i] / np.asarray(front.problem.scale)
    if not front.begin(kept.z[i], row / np.linalg.norm(row)):
        return False
    if front.here.orientation != kept.rest[i, 0]:
        return False
    trail.cut(i + 1)
    return True
