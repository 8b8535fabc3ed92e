"""A long calculation that reports, if interrupted, what remains of it."""

from __future__ import annotations

from collections.abc import Callable

import click

from fcm.cli.guard import NOT_COMPLETED
from fcm.cli.messages import Messages


class Interruptible:
    """Progress of a calculation; an interruption reports the share done and what remains."""

    def __init__(self, messages: Messages, remains: str) -> None:
        self.messages, self.remains, self.share = messages, remains, 0.0

    def __enter__(self) -> Callable[[float, str], None]:
        return self._progress

    def _progress(self, share: float, what: str) -> None:
        self.share = share
        self.messages.progress(share, what)

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self.messages.clear()
        if kind is not None and issubclass(kind, KeyboardInterrupt):
            self.messages.error(f"interrupted at {100 * self.share:.0f} %: {self.remains}")
            click.get_current_context().exit(NOT_COMPLETED)
