"""Reasons why a march from transition to transition stops."""

from __future__ import annotations

from enum import IntEnum


class Stopped(IntEnum):
    """Reason why a march has stopped, and what lets it continue."""

    DONE = 0  # its time is over
    MISSING = 1  # the flow of a combination of states has to be made
    FULL = 2  # the segments need more room, or are too many
    UNDECIDED = 3  # no combination of states lasts
    PAUSED = 4  # to let signals be handled
    LONG = 5  # a segment has too many steps
