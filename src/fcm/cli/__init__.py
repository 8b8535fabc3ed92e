"""The program ``fcm``: one file a command, each imported only when it is called.

Not even click is imported before it is needed: an interruption in the first moments would show where.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from fcm.cli.commands import COMMANDS, main

__all__ = ["COMMANDS", "main"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        from importlib import import_module

        return getattr(import_module("fcm.cli.commands"), name)
    raise AttributeError(f"module 'fcm.cli' has no attribute {name!r}")
