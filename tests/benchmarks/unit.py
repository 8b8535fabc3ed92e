"""The unit of run times: what `numpy.sin` takes for one of many random angles."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

SINE = 0.01  # [us] a value, of the machine to which times are scaled
# in no order: for ordered angles the processor foresees the branches, and takes less than half the time
ANGLES = np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, 200_000)


def seconds(call: Callable[[], object]) -> float:
    """Of processor time."""
    begin = time.process_time()
    call()
    return time.process_time() - begin


def sine() -> float:
    """Seconds of a value: the least of a few, as the first after other work may take half as long again."""
    return min(seconds(lambda: np.sin(ANGLES)) for _ in range(5)) / ANGLES.size
