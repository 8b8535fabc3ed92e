"""Progress as calculations show it, that interrupts them as Ctrl-C does."""

from fcm.cli.messages import Messages
from fcm.cli.settings import Settings


class Interrupting(Messages):
    """Of a command: where its progress shows a text for the so-manieth time, from a fraction on.

    shown: all fractions and texts until then. Settings are the command's.
    """

    def __init__(self, text="", times=1, *, fraction=0.0, **settings):
        super().__init__(settings=Settings(**settings))
        self.text, self.left, self.fraction, self.shown = text, times, fraction, []

    def progress(self, fraction, text=""):
        self.shown.append((fraction, text))
        self.left -= self.text in text and fraction >= self.fraction
        if self.left <= 0:
            raise KeyboardInterrupt


def interrupted_after(calls):
    """After so many parts that are finished; steps within a part, and shares of it, are not counted."""
    left, last = iter(range(calls)), None

    def progress(_share, text):
        nonlocal last
        new, last = text != last, text
        if new and "step " not in text and next(left, None) is None:
            raise KeyboardInterrupt

    return progress


def interrupted_beyond(limit):
    """Where the share that is done is beyond a limit."""

    def progress(share, _text):
        if share > limit:
            raise KeyboardInterrupt

    return progress
