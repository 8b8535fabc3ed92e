"""A note that asks about what a scene says and hardly means."""

from __future__ import annotations


class Question(str):
    """A note that asks whether what a scene says is meant; commands tell it as a warning.

    >>> Question("modal.damping: is 2 right?").startswith("modal")
    True
    """

    __slots__ = ()
