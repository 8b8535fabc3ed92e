"""Handles signals that end a program: Ctrl-C, SIGTERM and SIGHUP all count as an interruption.

While the program loads, there is nothing to save, and an interruption ends it at once with one line. While it
works, the interruption is a KeyboardInterrupt, so that finished work is written. After the work, signals are
ignored, and the interpreter shuts down with the exit code that was decided.

This module imports almost nothing, because the program imports it first.
"""

from __future__ import annotations

import os
import signal
import sys
import time

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import FrameType
    from typing import Any

NOT_COMPLETED = 3  # exit code
INTERRUPTED = "interrupted: the calculation was not completed"
ALL = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


class _Program:
    """State of the program that decides what an interruption does.

    Signals within `min_interval` [s] count as one: `timeout` sends two, a closing terminal even more. An
    interruption that could not be raised is repeated after `delay` [s].
    """

    min_interval = 1.0
    delay = 0.005

    def __init__(self) -> None:
        self.works, self.last = False, -self.min_interval
        self.shields, self.waits = 0, False  # number of active shields; whether an interruption waits
        self.imports = 0  # number of import frames when the work began
        self.deferred = self.insists = False  # deferred for an import; another signal came meanwhile
        self.notice = b""  # written at once, as the reaction to a signal may take a moment
        self.before: dict[int, Any] = {}

    def interrupted(self, _number: int, _frame: FrameType | None) -> None:
        if not self.works:
            self.leave()
        now = time.monotonic()
        if now - self.last >= self.min_interval:
            self.last = now
            self.insists = self.deferred
            try:
                os.write(2, self.notice)
            except OSError:  # standard error is closed
                self.notice = b""
            self.again(_number, _frame)

    def leave(self) -> None:
        try:
            os.write(2, f"fcm: {INTERRUPTED}\n".encode())
        finally:  # even if standard error is closed
            os._exit(NOT_COMPLETED)

    def again(self, _number: int, frame: FrameType | None) -> None:
        """Raises KeyboardInterrupt, or defers it while it could be lost, which lasts only moments.

        During an import, libraries convert or swallow the exception; a second interruption does not wait for
        the end of the import. Compiled code drops it while it records the origin of another exception.
        """
        if self.shields:
            self.waits = True
            return
        if self.insists:
            signal.setitimer(signal.ITIMER_REAL, 0.0)  # cancels the deferred interruption
        imports = not self.insists and _imports(frame) > self.imports
        self.deferred = (imports or _notes_an_origin(frame)) and _later()
        if not self.deferred:
            raise KeyboardInterrupt

    def lost(self, unraisable: Any) -> None:
        """Hook for exceptions that cannot be raised: repeats an interruption and ignores others."""
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            _later()


def _later() -> bool:
    """Repeats an interruption after a delay; False if the system has no timer."""
    if not hasattr(signal, "setitimer"):
        return False
    signal.setitimer(signal.ITIMER_REAL, _Program.delay)
    return True


def _imports(frame: FrameType | None) -> int:
    """Number of frames of the stack that belong to Python's import of a module."""
    count = 0
    while frame is not None:
        count += frame.f_code.co_filename == "<frozen importlib._bootstrap>"
        frame = frame.f_back
    return count


def _notes_an_origin(frame: FrameType | None) -> bool:
    """Whether a compiled module is creating a frame for a traceback.

    With the limited API of Python, Cython evaluates ``_getframe()`` for this, and clears exceptions raised in
    it.
    """
    return frame is not None and frame.f_code.co_names == ("_getframe",)


_program: _Program | None = None


def take() -> bool:
    """Handles signals as interruptions from now on; False if this is already so, or not the main thread.

    An ignored signal stays ignored, as `nohup` and the shell's `&` require.
    """
    global _program
    if _program is not None:
        return False
    program = _Program()
    try:
        for number in ALL:
            if signal.getsignal(number) is not signal.SIG_IGN:
                program.before[number] = signal.signal(number, program.interrupted)
        if hasattr(signal, "SIGALRM"):
            program.before[signal.SIGALRM] = signal.signal(signal.SIGALRM, program.again)
    except ValueError:  # not the main thread
        return False
    sys.unraisablehook = program.lost
    _program = program
    return True


def give_back() -> None:
    """Restores the signal handlers that `take` replaced."""
    global _program
    if _program is not None:
        for number, handler in _program.before.items():
            signal.signal(number, handler)
        sys.unraisablehook = sys.__unraisablehook__
        _program = None


def interrupt() -> None:
    """Interrupts the program from another thread, by a signal that it handles."""
    import _thread

    taken = () if _program is None else _program.before
    number = next((number for number in ALL if number in taken), signal.SIGINT)
    _thread.interrupt_main(number)


def works() -> None:
    """Declares that from now on there may be something to save."""
    if _program is not None:
        _program.imports = _imports(sys._getframe())
        _program.works = True


def announce(notice: str) -> None:
    """Sets a line that is written to standard error as soon as an interruption comes; "" for none."""
    if _program is not None:
        _program.notice = f"{notice}\n".encode() if notice else b""


def ends() -> None:
    """Ignores signals from now on: everything is saved, and the exit code is decided."""
    if _program is not None:
        for number in _program.before:
            signal.signal(number, signal.SIG_IGN)  # the interpreter would reset any other handler


def interrupted(error: BaseException) -> bool:
    """Whether an exception is an interruption, or was made from one by an interrupted import."""
    made = Exception if _program is not None and _program.insists else (ImportError, SystemError)
    seen: BaseException | None = error
    for _ in range(100):
        if not isinstance(seen, made):
            break
        seen = seen.__cause__ or seen.__context__
    return isinstance(seen, KeyboardInterrupt)


class undisturbed:  # noqa: N801
    """``with undisturbed():`` protects code that must not stop halfway; an interruption follows it."""

    def __enter__(self) -> None:
        if _program is not None:
            _program.shields += 1

    def __exit__(self, *_: object) -> None:
        if _program is not None:
            _program.shields -= 1
            if _program.waits and not _program.shields:
                _program.waits = False
                raise KeyboardInterrupt
