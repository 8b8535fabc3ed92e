"""Announces, while a scene is read, what takes much time or memory."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from fcm import resources
from fcm.frozen import Frozen
from fcm.scene.options import MESSAGES, MessageOptions

if TYPE_CHECKING:
    from fcm.model.scene import Scene


def _ignored(*_: object) -> None:
    """Ignores a notice."""


class SizeNotices(Frozen):
    """Callbacks that receive information about the size of a scene while it is read.

    Attributes
    ----------
    say : callable
        Takes a sentence.
    curves : callable
        Takes the scene without its curves, and the number of curves; may raise.
    memory : callable
        Returns the free memory [byte]; a scene that needs more is a mistake.
    options : MessageOptions
        Limits above which there is a notice.
    """

    say: Callable[[str], None] = _ignored
    curves: Callable[[Scene, int], None] = _ignored
    memory: Callable[[], float] = resources.memory
    options: MessageOptions = MESSAGES
