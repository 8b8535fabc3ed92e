"""The program ``fcm``: one file for each command, imported only when the command is called.

Even click is imported only on use: an interruption during its import would show a traceback.
"""

from __future__ import annotations

from fcm.lazy_import import on_demand

TYPE_CHECKING = False
if TYPE_CHECKING:
    from fcm.cli.commands import COMMANDS, main

__all__ = ["COMMANDS", "main"]

__getattr__ = on_demand(__name__, dict.fromkeys(__all__, "commands"))
