"""What a command says beside its result: messages, warnings and progress, all on standard error."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, field

import click

_REDRAW = 0.1  # [s] shortest time between two drawings of the progress line
_BAR = 24  # characters of the progress bar


@dataclass
class Messages:
    """``verbosity``: -1 errors only, 0 as usual, 1 and more with details."""

    verbosity: int = 0
    _drawn: float = field(default=0.0, repr=False)
    _width: int = field(default=0, repr=False)

    def error(self, text: str) -> None:
        self._say(f"fcm: {text}")

    def warning(self, text: str) -> None:
        if self.verbosity >= 0:
            self._say(f"fcm: warning: {text}")

    def info(self, text: str) -> None:
        if self.verbosity >= 0:
            self._say(text)

    def detail(self, text: str) -> None:
        if self.verbosity >= 1:
            self._say(text)

    def progress(self, fraction: float, text: str = "") -> None:
        """Redraw the progress line, on a terminal only and not too often."""
        now = time.monotonic()
        if self.verbosity < 0 or now - self._drawn < _REDRAW or not sys.stderr.isatty():
            return
        full = round(_BAR * min(max(fraction, 0.0), 1.0))
        line = f"[{'#' * full}{'.' * (_BAR - full)}] {100 * fraction:3.0f} %  {text}"
        click.echo("\r" + line.ljust(self._width), err=True, nl=False)
        self._drawn, self._width = now, len(line)

    def _say(self, text: str) -> None:
        self.clear()
        click.echo(text, err=True)

    def clear(self) -> None:
        """Take the progress line away."""
        if self._width:
            click.echo("\r" + " " * self._width + "\r", err=True, nl=False)
            self._width = 0


pass_messages = click.make_pass_decorator(Messages, ensure=True)
