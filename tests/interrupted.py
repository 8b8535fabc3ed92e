"""Progress as calculations show it, that interrupts them as Ctrl-C does."""

from fcm.cli.messages import Messages
from fcm.cli.settings import Settings


class Interrupting(Messages):
    """Of a command: where its progress shows a text for the so-manieth time; settings are its own."""

    def __init__(self, text="", times=1, **settings):
        super().__init__(settings=Settings(**settings))
        self.text, self.left = text, times

    def progress(self, fraction, text=""):
        self.left -= self.text in text
        if self.left <= 0:
            raise KeyboardInterrupt


def interrupted_after(calls):
    """After so many parts that are finished; the steps within a part are said, too, and not counted."""
    left = iter(range(calls))

    def progress(_share, text):
        if "step " not in text and next(left, None) is None:
            raise KeyboardInterrupt

    return progress


def interrupted_beyond(limit):
    """Where the share that is done is beyond a limit."""

    def progress(share, _text):
        if share > limit:
            raise KeyboardInterrupt

    return progress
