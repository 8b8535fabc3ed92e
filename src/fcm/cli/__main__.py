"""The script ``fcm``, and ``python -m fcm.cli`` where it is not installed.

Python turns Ctrl-C into an exception from its own first moment on, which nothing can catch until the program
is reached. So this module imports nothing, and the first thing that the program does needs no file: from then
on Ctrl-C ends it in silence, until there is someone to say so.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable

    from fcm.cli.messages import Messages

YOUNG = 100_000  # objects between two looks for garbage: of what is loaded, some 70 000, nothing is


def run(messages: Callable[[], Messages] | None = None) -> None:
    """The program, for which signals are interruptions from its first moment to its last.

    messages: makes what it says beside its results, with settings of its own (`fcm.cli.settings`), once
    signals are heeded.
    """
    import _signal  # type: ignore[import-not-found]  # built in

    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    from fcm import signals

    signals.take()
    from fcm.cli import terminal

    terminal.streams()
    import gc

    gc.set_threshold(YOUNG)
    from fcm.cli.commands import main

    try:
        main(prog_name="fcm", obj=None if messages is None else messages())
    except SystemExit as end:
        if isinstance(end.code, int):
            _leave(end.code)
        raise


def _leave(code: int) -> None:
    """End the process, unless something is left to be done that only the interpreter does.

    To take apart what numpy, scipy and HDF5 have built would cost 40 ms, and serve nobody.
    """
    import atexit
    import os
    import sys
    import threading

    if threading.active_count() > 1:
        return
    atexit._run_exitfuncs()
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except (OSError, ValueError):  # the interpreter says so
        return
    os._exit(code)


if __name__ == "__main__":
    run()
