"""Where batches are computed: in this process, in threads of it, or by an executor of the user's."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from typing import Protocol

from fcm.run.work import Attempt, Batch, Compute, Report, attempt


class Died(Exception):  # noqa: N818
    """The process that computed a batch has ended before its time."""


class Place(Protocol):
    """Somewhere to compute; a future of it may raise `Died`."""

    width: int  # batches that are given to it at a time

    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        """Begin to compute a batch; the report is called now and then, from whatever thread."""

    def stop(self) -> None:
        """Ask everybody to stop; their futures then have the part that is finished."""

    def close(self) -> None:
        """Leave nothing running."""


class Here:
    """This process, one batch after the other."""

    width = 1

    def __init__(self, compute: Compute) -> None:
        self.compute = compute

    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        future: Future[Attempt] = Future()
        future.set_result(attempt(self.compute, batch, report))
        return future

    def stop(self) -> None:
        pass

    def close(self) -> None:
        pass


class Threads:
    """Threads of this process, for a compute function that lets others run meanwhile."""

    def __init__(self, compute: Compute, count: int) -> None:
        self.compute, self.width = compute, count
        self._executor, self._stopped = ThreadPoolExecutor(count), threading.Event()

    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        return self._executor.submit(attempt, self.compute, batch, until(self._stopped, report))

    def stop(self) -> None:
        self._stopped.set()

    def close(self) -> None:
        self.stop()
        self._executor.shutdown(wait=True, cancel_futures=True)


class Elsewhere:
    """An executor of the user's, as of a cluster; its owner ends it."""

    width = 1_000_000  # it knows best how many it takes at a time

    def __init__(self, compute: Compute, executor: Executor) -> None:
        self.compute, self.executor = compute, executor
        self._futures: list[Future[Attempt]] = []

    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        future = self.executor.submit(attempt, self.compute, batch, Report(_nobody, report.saved))
        self._futures.append(future)
        return future

    def stop(self) -> None:
        for future in self._futures:
            future.cancel()

    def close(self) -> None:
        self.stop()


def until(stopped: threading.Event, report: Report) -> Report:
    """The report of work that is interrupted once the event is set."""

    def show(fraction: float, text: str) -> None:
        if stopped.is_set():
            raise KeyboardInterrupt
        report(fraction, text)

    return Report(show, report.saved, report.save)


def _nobody(_fraction: float, _text: str) -> None:
    pass


Factory = Callable[[Compute, int], Place]  # a place of so many workers
