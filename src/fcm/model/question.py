"""Notes that question implausible values of a scene."""

from __future__ import annotations


class Question(str):
    """A note that asks whether a value of the scene is intended; commands print it as a warning.

    >>> Question("modal.damping: is 2 right?").startswith("modal")
    True
    """

    __slots__ = ()


class MissingModes(Question):
    """A note that modes within the frequency range are missing; their effect on peaks is unknown."""

    __slots__ = ()
