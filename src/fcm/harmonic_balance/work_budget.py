"""Count and limit of the work done with a system, in seconds of `cost_model`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np


class WorkLimitError(Exception):
    """The work of a system has exceeded its limit."""


class WorkCount:
    """Work of a system and of all systems made from it.

    poll is called regularly during the work; tell is called with a description of the present task.
    """

    def __init__(self) -> None:
        self.seconds, self.limit = 0.0, np.inf
        self.poll: Callable[[], object] = int
        self.tell: Callable[[str], object] = str

    def add(self, seconds: float) -> None:
        """Add seconds of work; raise `WorkLimitError` if the total exceeds the limit."""
        self.poll()
        self.seconds += seconds
        if self.seconds > self.limit:
            raise WorkLimitError

    @contextmanager
    def limited_to(self, seconds: float) -> Iterator[None]:
        """Context in which the total work, with that done before, may not exceed a limit."""
        before, self.limit = self.limit, min(self.limit, seconds)
        try:
            yield
        finally:
            self.limit = before
