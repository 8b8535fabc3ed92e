"""One sector of a ring beside the whole ring written out: python -m tests.benchmarks.ring [SECTORS]

Run times of curves of the bundled `bladed-disk` with its 24 shrouds, or so many, everything included, and how
far their peaks are apart. Both in one run: the sector before and after the ring, of which the better counts.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

import numpy as np
from tests.ring import rings

from fcm.model.scene import Scene
from fcm.response import Response, trace
from fcm.scene import scene_from_dict

PRELOAD, SECTORS = 20.0, 24
HARMONICS = [1], [1, 2, 3]


def timed(scene: Scene) -> tuple[float, Response]:
    begin = time.process_time()
    response = trace(scene)
    return time.process_time() - begin, response


def peak(response: Response, dof: str) -> np.ndarray:
    """Amplitude and frequency."""
    found = response.curves[0].peaks[dof]
    return np.array([found.amplitude, found.frequency])


def main(sectors: int = SECTORS, each: Sequence[list[int]] = HARMONICS) -> None:
    data = rings.scene_of("bladed-disk")
    del data["sweep"]
    data["cyclic"] = data["cyclic"] | {"sectors": sectors}
    data["contact"] = [one | {"n_0": PRELOAD} for one in data["contact"] if one["name"] == "shroud"]
    for harmonics in each:
        one = data | {"response": data["response"] | {"harmonics": harmonics}}
        sector, ring = scene_from_dict(one), scene_from_dict(rings.written_out(one))
        before, found = timed(sector)
        whole, expected = timed(ring)
        after, _ = timed(sector)
        seconds = min(before, after)
        apart = max(
            np.abs(peak(expected, f"tip_{k}") / peak(found, "tip") - 1.0).max() for k in range(sectors)
        )
        complete = all(response.curves[0].complete for response in (found, expected))
        print(
            f"harmonics {harmonics}: sector {seconds:.3f} s ({found.curves[0].points} points), "
            f"ring {whole:.2f} s ({expected.curves[0].points} points), 1/{whole / seconds:.0f}; "
            f"peaks apart by {apart:.1e}; both complete: {complete}"
        )


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
