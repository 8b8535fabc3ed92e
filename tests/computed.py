"""Places where the curves of a sweep are computed, in this process, that fail or are interrupted."""

from functools import partial

from fcm.run import Report, SerialPlace


def by(change):
    """A place (`fcm.run.Factory`) where change(compute, batch, report) computes a batch."""
    return lambda compute, _count: SerialPlace(partial(change, compute))


def nowhere(*_):
    """A place where nothing is to be computed."""
    raise AssertionError("nothing is to be computed")


class Interrupted:
    """A place where the next curve is interrupted after so many; `begun` counts them."""

    def __init__(self, after=10**6):
        self.after, self.begun = after, 0

    def __call__(self, compute, _count):
        return SerialPlace(partial(self._computed, compute))

    def _computed(self, compute, batch, report):
        def show(fraction, text):
            if not text:  # a curve begins
                self.begun += 1
                if self.begun > self.after:
                    raise KeyboardInterrupt
            report.show(fraction, text)

        return compute(batch, Report(show, report.saved, report.save))
