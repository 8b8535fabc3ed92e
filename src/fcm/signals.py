"""Signals that end a program: Ctrl-C, SIGTERM and SIGHUP are one thing, an interruption.

While the program loads, nothing is to be saved: it ends at once with one line. While it works, it is a
KeyboardInterrupt, so that finished work is written. When it has ended, only the interpreter is left to be
shut down: that goes on to the exit code that was decided.

This module imports next to nothing, for it is the first thing that the program does.
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

    Signals within `min_interval` [s] are one: `timeout` sends two, a terminal that closes even more. An
    interruption that nobody could raise is raised again after `delay` [s].
    """

    min_interval = 1.0
    delay = 0.005

    def __init__(self) -> None:
        self.works, self.last = False, -self.min_interval
        self.shields, self.waits = 0, False  # what must not be disturbed, and whether an interruption waits
        self.imports = 0  # that were under way when the work began
        self.deferred = self.insists = False  # until an import has ended; whether one more came meanwhile
        self.notice = b""  # said at once, as what follows may take a moment
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
            except OSError:  # be standard error closed
                self.notice = b""
            self.again(_number, _frame)

    def leave(self) -> None:
        try:
            os.write(2, f"fcm: {INTERRUPTED}\n".encode())
        finally:  # be standard error closed
            os._exit(NOT_COMPLETED)

    def again(self, _number: int, frame: FrameType | None) -> None:
        """Interrupt, but not where the exception could be lost; that is left within moments.

        In the middle of an import libraries make other errors of it, or swallow it; who interrupts once more
        does not wait for its end. Compiled code drops it while it notes where an exception came from.
        """
        if self.shields:
            self.waits = True
            return
        if self.insists:
            signal.setitimer(signal.ITIMER_REAL, 0.0)  # the one that was deferred does not come, too
        imports = not self.insists and _imports(frame) > self.imports
        self.deferred = (imports or _notes_an_origin(frame)) and _later()
        if not self.deferred:
            raise KeyboardInterrupt

    def lost(self, unraisable: Any) -> None:
        """An exception that nobody could catch: an interruption comes again, others concern nobody."""
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            _later()


def _later() -> bool:
    """Have an interruption come again, where the system has a timer."""
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
    """Whether a compiled module is making the frame that it shows in a traceback.

    Cython evaluates ``_getframe()`` for that, with the limited interface of Python, and clears what is raised
    in it.
    """
    return frame is not None and frame.f_code.co_names == ("_getframe",)


_program: _Program | None = None


def take() -> bool:
    """Take signals as interruptions; False if that is so already, or is not for this thread to do.

    A signal that is ignored stays so: `nohup` and the shell's `&` ask for it.
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
    """Leave the signals as they were found."""
    global _program
    if _program is not None:
        for number, handler in _program.before.items():
            signal.signal(number, handler)
        sys.unraisablehook = sys.__unraisablehook__
        _program = None


def interrupt() -> None:
    """Interrupt the program from another thread, by a signal that it takes."""
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
    """Ignores signals from now on: nothing is left to be saved, and the exit code is decided."""
    if _program is not None:
        for number in _program.before:
            signal.signal(number, signal.SIG_IGN)  # the interpreter itself would undo any other handler


def interrupted(error: BaseException) -> bool:
    """Whether an exception is an interruption, or what an import that was interrupted made of it."""
    made = Exception if _program is not None and _program.insists else (ImportError, SystemError)
    seen: BaseException | None = error
    for _ in range(100):
        if not isinstance(seen, made):
            break
        seen = seen.__cause__ or seen.__context__
    return isinstance(seen, KeyboardInterrupt)


class undisturbed:  # noqa: N801
    """``with undisturbed():`` what must not stop halfway; an interruption is raised after it."""

    def __enter__(self) -> None:
        if _program is not None:
            _program.shields += 1

    def __exit__(self, *_: object) -> None:
        if _program is not None:
            _program.shields -= 1
            if _program.waits and not _program.shields:
                _program.waits = False
                raise KeyboardInterrupt
