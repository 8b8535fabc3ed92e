"""The program ``fcm``: one file a command, each imported only when it is called.

Not even click is imported before it is needed: an interruption in the first moments would show where.
"""

from __future__ import annotations

from fcm.lazy_import import on_demand

TYPE_CHECKING = False
if TYPE_CHECKING:
    from fcm.cli.commands import COMMANDS, main

__all__ = ["COMMANDS", "main"]

__getattr__ = on_demand(__name__, dict.fromkeys(__all__, "commands"))
