"""At how many points of random scenes the error is known.

usage: python tests/response/random_points.py [COUNT [HARMONICS]]

With the default accuracy, or with so many harmonics. A point counts where the errors of all its degrees of
freedom are known, as ``fcm respond`` writes them. Part of ``make study``.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fcm.response import trace

if __package__:
    from .in_time import in_time
    from .random_scenes import random_scene
else:  # run as a program
    from in_time import in_time
    from random_scenes import random_scene

SECONDS = 60  # of a processor, for a scene


class Known(NamedTuple):
    """Points of a scene's curve, and at how many of them the error is known."""

    points: int
    known: int


def known(seed: int, harmonics: int = 0) -> Known:
    given = tuple(range(1, harmonics + 1)) or None
    (curve,) = trace(replace(random_scene(seed), harmonics=given)).curves
    return Known(curve.points, int(np.isfinite(curve.error).all(axis=1).sum()))


def main(count: int = 20, harmonics: int = 0, at_once: int = 2) -> None:
    late, found = [], []
    for seed, one in in_time(lambda seed: known(seed, harmonics), range(count), SECONDS, at_once):
        if one is None:
            late.append(seed)
        else:
            found.append(one)
    points, counted = np.array(found).sum(axis=0)
    whole = sum(one.known == one.points for one in found)
    how = f"harmonics up to {harmonics}" if harmonics else "the default accuracy"
    print(f"Errors of points of {count} random scenes with {how}:")
    print(f"known at {counted} of {points} points, {counted / points:.0%}; at all points of {whole} scenes")
    print(f"not done within {SECONDS} s of a processor, or failed: {len(late)}:", sorted(late))


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
