"""A note that asks about what a scene says and hardly means."""

from __future__ import annotations


class Question(str):
    """A note that asks whether what a scene says is meant; commands tell it as a warning.

    >>> Question("modal.damping: is 2 right?").startswith("modal")
    True
    """

    __slots__ = ()


class MissingModes(Question):
    """Says that modes within the range are not kept: how much their lack changes peaks is unknown."""

    __slots__ = ()
