"""The script ``fcm``, and ``python -m fcm.cli`` where it is not installed.

Python turns Ctrl-C into an exception from its own first moment on, which nothing can catch until the program
is reached. So this module imports nothing, and the first thing that the program does needs no file: from then
on Ctrl-C ends it in silence, until there is someone to say so.
"""

from __future__ import annotations


def run() -> None:
    """The program, for which signals are interruptions from its first moment to its last."""
    import _signal  # type: ignore[import-not-found]  # built in

    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    from fcm import signals

    signals.take()
    from fcm.cli import terminal

    terminal.streams()
    from fcm.cli.commands import main

    main(prog_name="fcm")


if __name__ == "__main__":
    run()
