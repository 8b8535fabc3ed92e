"""Reasons for which a march from transition to transition stops."""

from __future__ import annotations

from enum import IntEnum


class Stopped(IntEnum):
    """Reason for which a march has stopped, and what lets it go on."""

    DONE = 0  # its time is over
    MISSING = 1  # the flow of a combination of states has to be made
    FULL = 2  # of segments: there have to be more, or there are too many
    UNDECIDED = 3  # no combination of states lasts
    PAUSED = 4  # for signals
    LONG = 5  # a segment has more steps than can be waited for
