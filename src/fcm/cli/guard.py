"""How a run ends: every exception becomes one line on standard error and an exit code."""

from __future__ import annotations

import io
import os
import sys
import traceback
import warnings
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TextIO

import click

from fcm.cli.messages import Messages

DEFECT = 1  # of fcm
WRONG_INPUT = 2
NOT_COMPLETED = 3

_EXIT_CODES = (
    ("fcm.scene", "SceneError", WRONG_INPUT),
    ("fcm.table", "TableError", WRONG_INPUT),
    ("fcm.plot", "PlotError", WRONG_INPUT),
    ("fcm.response", "ResponseError", WRONG_INPUT),
)


def guarded(run: Callable[[click.Context], Any], ctx: click.Context) -> Any:
    """``run(ctx)``; whatever it raises ends the program as the exit codes promise."""
    messages = ctx.ensure_object(Messages)
    _print_any_name()
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _shown_by(messages)
            return run(ctx)
    except (click.ClickException, click.exceptions.Exit):
        messages.clear()
        raise
    except BrokenPipeError:
        _discard_output()
        ctx.exit(0)
    except (Exception, KeyboardInterrupt, click.Abort) as error:
        code, line = _verdict(error)
        messages.error(line)
        if code == DEFECT and (messages.verbosity >= 1 or os.environ.get("FCM_DEBUG")):
            traceback.print_exception(error)
        ctx.exit(code)


def _verdict(error: BaseException) -> tuple[int, str]:
    """The exit code of an exception, and the line that says what happened."""
    for module, name, code in _EXIT_CODES:
        kind = getattr(sys.modules.get(module), name, None)
        if kind is not None and isinstance(error, kind):
            return code, f"error: {error}"
    if isinstance(error, KeyboardInterrupt | click.Abort):
        return NOT_COMPLETED, "interrupted: the calculation was not completed"
    if isinstance(error, MemoryError):
        return NOT_COMPLETED, "error: not enough memory to complete the calculation"
    if isinstance(error, OSError):
        _discard_output()
        return NOT_COMPLETED, f"error: {error.filename or 'output'}: {error.strerror or error}"
    return DEFECT, f"defect: {type(error).__name__}: {error} (-v shows where)"


def _shown_by(messages: Messages) -> Callable[..., None]:
    def show(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        messages.warning(str(message))
        messages.detail(f"  {category.__name__} at {filename}:{lineno}")

    return show


def _print_any_name() -> None:
    """Characters that the terminal does not have are escaped, not an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _discard_output() -> None:
    """Nobody reads standard output any more: let the interpreter's last flush go nowhere."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
