"""What has been calculated with a system, in seconds of `cost_model`, and how much may be."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np


class TooLongError(Exception):
    """More was calculated than may be."""


class Work:
    """Of a system and all that are made from it with other harmonics; poll is called now and then."""

    def __init__(self) -> None:
        self.seconds, self.most = 0.0, np.inf
        self.poll: Callable[[], object] = int

    def take(self, seconds: float) -> None:
        """So much more; `TooLongError` where that is more than may be."""
        self.poll()
        self.seconds += seconds
        if self.seconds > self.most:
            raise TooLongError

    @contextmanager
    def up_to(self, seconds: float) -> Iterator[None]:
        """No more than this, with all that was calculated before."""
        before, self.most = self.most, min(self.most, seconds)
        try:
            yield
        finally:
            self.most = before
