"""The script ``fcm``, and ``python -m fcm.cli`` where it is not installed."""

from __future__ import annotations

from fcm import signals


def run() -> None:
    """The program, for which signals are interruptions from its first moment to its last."""
    signals.take()
    from fcm.cli import terminal

    terminal.streams()
    from fcm.cli.commands import main

    main(prog_name="fcm")


if __name__ == "__main__":
    run()
