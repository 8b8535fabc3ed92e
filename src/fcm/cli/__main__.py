"""The script ``fcm``, and ``python -m fcm.cli`` where it is not installed.

From its start, Python turns Ctrl-C into an exception that nothing can catch before the program is reached.
So this module imports nothing, and the first step of the program reads no file. After that step Ctrl-C ends
the program silently, until the program can print a message.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable

    from fcm.cli.messages import Messages

YOUNG = 100_000  # objects between two garbage collections; the 70 000 loaded ones hold no garbage


def run(messages: Callable[[], Messages] | None = None) -> None:
    """Run the program, with signals as interruptions from its first moment to its last.

    messages: creates the `Messages`, with settings of its own (`fcm.cli.settings`), once signals are handled.
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
    """End the process at once, unless the interpreter still has work to do.

    The regular end would spend 40 ms to dismantle numpy, scipy and HDF5, to no use.
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
    except (OSError, ValueError):  # the interpreter reports it
        return
    os._exit(code)


if __name__ == "__main__":
    run()
