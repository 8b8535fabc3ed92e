"""Places where batches are computed: their interface, and the place in this process."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from concurrent.futures import Future

from fcm.run.tasks import Attempt, Batch, Compute, Report, attempt


class WorkerDied(Exception):  # noqa: N818
    """The process that computed a batch has ended before its time."""


class NotComputed(Exception):  # noqa: N818
    """A batch has not been computed, and must be submitted again."""


class PlaceClosed(Exception):  # noqa: N818
    """The place takes no batch any more; the message says why."""


Gone = PlaceClosed  # its name until version 0.2


class Place(ABC):
    """A place that computes: it takes batches, returns results as they come, and can stop the rest."""

    width = 1  # batches that are given to it at a time

    @abstractmethod
    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        """Begin to compute a batch; any thread may call the report now and then."""

    def result(self, future: Future[Attempt]) -> Attempt:
        """Result of a batch whose future is done; raises `WorkerDied`, `NotComputed` or `PlaceClosed`."""
        return future.result()

    def poll(self) -> None:  # noqa: B027
        """Checks the place now and then; raises `PlaceClosed` when it is gone."""

    def stop(self) -> None:  # noqa: B027
        """Ask running batches to stop; their futures then have the finished part."""

    def close(self) -> None:
        """Stops the place, and leaves nothing running."""
        self.stop()


class SerialPlace(Place):
    """Place that computes in this process, one batch after the other."""

    def __init__(self, compute: Compute) -> None:
        self.compute = compute

    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        future: Future[Attempt] = Future()
        future.set_result(attempt(self.compute, batch, report))
        return future


def until(stopped: threading.Event, report: Report) -> Report:
    """A report that raises KeyboardInterrupt once the event is set."""

    def show(fraction: float, text: str) -> None:
        if stopped.is_set():
            raise KeyboardInterrupt
        report(fraction, text)

    return Report(show, report.saved, report.save)


Factory = Callable[[Compute, int], Place]  # a place of so many workers
