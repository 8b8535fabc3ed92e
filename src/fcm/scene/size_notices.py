"""Notices of what takes long or much room, before it is made."""

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
    """Callbacks that are told about the size of a scene while it is read.

    Attributes
    ----------
    say : callable
        Takes a sentence.
    curves : callable
        Takes the scene without its curves, and how many there are; may raise.
    memory : callable
        [byte] that can still be taken: a scene that takes more is a mistake.
    options : MessageOptions
        From when on something is said.
    """

    say: Callable[[str], None] = _ignored
    curves: Callable[[Scene, int], None] = _ignored
    memory: Callable[[], float] = resources.memory
    options: MessageOptions = MESSAGES
