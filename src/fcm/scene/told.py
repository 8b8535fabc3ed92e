"""Who is told what takes long or much room, before it is made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fcm.model.scene import Scene


@dataclass(frozen=True)
class Told:
    """What hears of a scene while it is read."""

    say: Callable[[str], None]  # a sentence
    curves: Callable[[Scene, int], None]  # the scene without its curves, and how many; may raise
