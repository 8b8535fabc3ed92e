"""End of a run: turns every exception into one line on standard error and an exit code."""

from __future__ import annotations

import errno
import os
import sys
import traceback
import warnings
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TextIO

import click

from fcm import signals
from fcm.cli import terminal
from fcm.cli.limits import REQUESTS
from fcm.cli.messages import Messages

if TYPE_CHECKING:
    from pathlib import Path

DEFECT = 1  # of fcm
WRONG_INPUT = 2
NOT_COMPLETED = signals.NOT_COMPLETED

_EXIT_CODES = (
    ("fcm.scene", "SceneError", WRONG_INPUT),
    ("fcm.table", "TableError", WRONG_INPUT),
    ("fcm.plot.errors", "PlotError", WRONG_INPUT),
    ("fcm.response", "ResponseError", WRONG_INPUT),
    ("fcm.export.rows", "ExportError", WRONG_INPUT),
    ("fcm.run", "CheckpointError", WRONG_INPUT),
    ("fcm.run.cluster", "ClusterError", WRONG_INPUT),
    ("fcm.run", "PlaceClosed", NOT_COMPLETED),
)
_NO_MEMORY = "error: not enough memory to complete the calculation"
_NO_ROOM = ("failed to map", "cannot allocate memory", "failed to create thread")  # of the loader


def guarded(run: Callable[[click.Context], Any], ctx: click.Context) -> Any:
    """Call ``run(ctx)``; any exception ends the program with the documented exit code."""
    if ctx.parent is not None:  # a command of a command: the outer one watches
        return run(ctx)
    taken = signals.take()
    terminal.streams()
    try:
        return _watched(run, ctx)
    finally:
        if taken:
            signals.give_back()
            terminal.give_back()


def _watched(run: Callable[[click.Context], Any], ctx: click.Context) -> Any:
    messages = ctx.ensure_object(Messages)
    signals.works()
    try:
        _check_memory()
        with warnings.catch_warnings():
            warnings.showwarning = _shown_by(messages)
            result = run(ctx)
            sys.stdout.flush()
        signals.ends()
        return result
    except (click.ClickException, click.exceptions.Exit):
        messages.clear()
        signals.ends()
        raise
    except BrokenPipeError:
        _discard_output()
        ctx.exit(0)
    except (Exception, KeyboardInterrupt, click.Abort) as error:
        code, line = _exit_code_and_line(error)
        messages.error(line)
        if code == DEFECT and (messages.verbosity >= 1 or os.environ.get("FCM_DEBUG")):
            traceback.print_exception(error)
        signals.ends()
        ctx.exit(code)


def _check_memory() -> None:
    """Raise MemoryError if memory is so short that the libraries would crash while they are loaded."""
    try:
        import resource
    except ImportError:  # a system without limits
        return
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit != resource.RLIM_INFINITY and limit < REQUESTS.least_memory:
        raise MemoryError


def _exit_code_and_line(error: BaseException) -> tuple[int, str]:
    """The exit code of an exception, and the line that says what happened."""
    for module, name, code in _EXIT_CODES:
        kind = getattr(sys.modules.get(module), name, None)
        if kind is not None and isinstance(error, kind):
            return code, f"error: {error}"
    if isinstance(error, click.Abort) or signals.interrupted(error):
        return NOT_COMPLETED, signals.INTERRUPTED
    if isinstance(error, MemoryError) or getattr(error, "errno", 0) == errno.ENOMEM or _no_room(error):
        return NOT_COMPLETED, _NO_MEMORY
    if isinstance(error, OSError):
        _discard_output()
        return NOT_COMPLETED, f"error: {error.filename or 'output'}: {error.strerror or error}"
    return DEFECT, f"defect: {type(error).__name__}: {error} (-v shows where){outdated_kernels()}"


def outdated_kernels(package: Path | None = None) -> str:
    """Remedy if a kernel of the package (fcm by default) is not compiled, or older than its source; or ''."""
    from pathlib import Path

    package = package or Path(__file__).parents[1]
    compiled = sorted(package.rglob("*.abi3.*"))
    have = {kernel.with_name(kernel.name.split(".")[0] + ".py") for kernel in compiled}
    for source in sorted(package.rglob("*.py")) if compiled else ():
        if source not in have and "\nimport cython\n" in source.read_text(encoding="utf-8"):
            return f". {source.name} is not compiled, where others are: make kernels compiles it"
    for kernel in compiled:
        sources = [kernel.with_name(kernel.name.split(".")[0] + end) for end in (".py", ".pxd")]
        if any(one.exists() and one.stat().st_mtime > kernel.stat().st_mtime for one in sources):
            return f". {kernel.name} is older than its source: make kernels compiles it again"
    return ""


def _no_room(error: BaseException) -> bool:
    """Whether a library could not be loaded because memory was short."""
    return isinstance(error, ImportError) and any(text in str(error).lower() for text in _NO_ROOM)


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


def _discard_output() -> None:
    """Discard standard output after its reader is gone, so that the interpreter's last flush cannot fail."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
