"""``--time-limit``: a calculation that takes longer is interrupted, as by Ctrl-C."""

from __future__ import annotations

import threading
from types import TracebackType

import click

from fcm import signals
from fcm.cli.messages import Messages

ENDING = "fcm: ending, which may take some seconds"


def seconds(_ctx: click.Context, _param: click.Parameter, value: float | None) -> float | None:
    """The time of the option, which must be positive."""
    if value is not None and not 0.0 < value <= threading.TIMEOUT_MAX:
        raise click.BadParameter(f"{value:g} is not a number of seconds greater than 0.")
    return value


class TimeLimit:
    """``with TimeLimit(messages, 60.0):`` interrupts its block after so many seconds; None for no limit.

    Any interruption, by the limit or not, is reported at once.
    """

    def __init__(self, messages: Messages, limit: float | None) -> None:
        self.messages, self.limit, self.over = messages, limit, False
        self._lock, self._works = threading.Lock(), True
        self._timer = None if limit is None else threading.Timer(limit, self._end)

    def __enter__(self) -> TimeLimit:
        if self.messages.verbosity >= 0:
            signals.announce(ENDING)
        if self._timer is not None:
            self._timer.daemon = True
            self._timer.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, _value: BaseException | None, _trace: TracebackType | None
    ) -> None:
        with self._lock:
            self._works = False
        signals.announce("")
        if self._timer is not None:
            self._timer.cancel()
        if self.over:
            self.messages.clear()
            self.messages.warning(f"the time limit of {self.limit:g} s is over")

    def _end(self) -> None:
        with self._lock:
            if self._works:
                self.over = True
                signals.interrupt()
