"""Messages, warnings and progress of a command beside its result, all on standard error."""

from __future__ import annotations

import sys
from contextlib import suppress
from dataclasses import dataclass, field

import click

from fcm.cli.settings import SETTINGS, Settings
from fcm.model.question import Question
from fcm.resources import duration


@dataclass
class Messages:
    """Messages of a command, with the settings of the whole run.

    verbosity: -1 errors only, 0 as usual, 1 and more with details.
    """

    verbosity: int = 0
    settings: Settings = SETTINGS
    _drawn: float = field(default=0.0, repr=False)
    _width: int = field(default=0, repr=False)
    _share: float = field(default=0.0, repr=False)
    _curves: int = field(default=0, repr=False)  # expected curves; 0 after their time is printed
    _begun: float = field(default=0.0, repr=False)
    _waited: tuple[float, float] | None = field(default=None, repr=False)  # since when, and for how long [s]

    def error(self, text: str) -> None:
        self._say(f"fcm: {text}")

    def warning(self, text: str) -> None:
        if self.verbosity >= 0:
            self._say(f"fcm: warning: {text}")

    def note(self, text: str) -> None:
        """Print a note on how a scene was read; a `Question`, a doubt about its meaning, is a warning."""
        if isinstance(text, Question):
            self.warning(text)
        else:
            self.info(text)

    def info(self, text: str) -> None:
        if self.verbosity >= 0:
            self._say(text)

    def detail(self, text: str) -> None:
        if self.verbosity >= 1:
            self._say(text)

    def expect(self, curves: int) -> None:
        """Prepare for a number of curves; after the work of one curve, the time of all is printed once."""
        self._curves, self._begun = curves if curves > 1 else 0, self.settings.clock()

    def progress(self, fraction: float, text: str = "") -> None:
        """Redraw the progress line, not too often; it never goes back.

        Without a terminal, lines are printed, each after twice the time of the one before.
        """
        now, remarks = self.settings.clock(), self.settings.remarks
        self._share = min(max(fraction, self._share), 1.0)
        if self._share * self._curves >= 1.0 and now - self._begun >= remarks.time_shown:
            self._say_time(now - self._begun)
        if self.verbosity < 0:
            return
        if not sys.stderr.isatty():
            return self._say_progress(now, text)
        if now - self._drawn < remarks.redraw:
            return
        full = int(remarks.bar * self._share)
        line = f"[{'#' * full}{'.' * (remarks.bar - full)}] {int(100 * self._share):3d} %  {text}"
        self._draw(line.ljust(self._width))
        self._drawn, self._width = now, len(line)

    def _say_progress(self, now: float, text: str) -> None:
        """Print the progress as a line of its own, after twice the time of the one before."""
        if self._waited is None:
            self._waited = now, self.settings.remarks.first_line
        since, wait = self._waited
        if now - since >= wait:
            self._waited = since, 2.0 * wait
            self.info(f"{int(100 * self._share)} % after {duration(now - since)}: {text}".rstrip(": "))

    def _say_time(self, taken: float) -> None:
        """Print how long all curves take, if that is long."""
        curves, self._curves = self._curves, 0
        every = taken / self._share
        if every > self.settings.remarks.long_run and self._share < 1.0:
            done = f"{100 * self._share:.2g} %"
            self.info(f"{curves} curves take about {duration(every)}: {done} of them took {duration(taken)}")

    def _say(self, text: str) -> None:
        self.clear()
        with suppress(OSError):  # a closed terminal does not stop the calculation
            click.echo(text, err=True)

    def clear(self) -> None:
        """Remove the progress line."""
        if self._width:
            self._draw(" " * self._width)
            self._draw("")
            self._width = 0

    def _draw(self, line: str) -> None:
        with suppress(OSError):
            getattr(sys.stderr, "redraw", sys.stderr.write)(line)


pass_messages = click.make_pass_decorator(Messages, ensure=True)
