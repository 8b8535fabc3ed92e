"""Progress as calculations show it, that interrupts them as Ctrl-C does."""


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
