"""What has been calculated with a system, in seconds of `cost_model`, and how much may be."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np


class WorkLimitError(Exception):
    """More was calculated than may be."""


class WorkCount:
    """Of a system and all that are made from it with other harmonics; poll is called now and then."""

    def __init__(self) -> None:
        self.seconds, self.limit = 0.0, np.inf
        self.poll: Callable[[], object] = int

    def add(self, seconds: float) -> None:
        """So much more; `WorkLimitError` where that is more than may be."""
        self.poll()
        self.seconds += seconds
        if self.seconds > self.limit:
            raise WorkLimitError

    @contextmanager
    def limited_to(self, seconds: float) -> Iterator[None]:
        """No more than this, with all that was calculated before."""
        before, self.limit = self.limit, min(self.limit, seconds)
        try:
            yield
        finally:
            self.limit = before
