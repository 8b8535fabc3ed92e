"""The workers of a `dask.distributed` scheduler, as a place where batches are computed.

`distributed` is imported only here, and only when a cluster is requested; its logs and warnings are
suppressed. If a worker dies, the scheduler gives its batches to others. A worker with another fcm gets none.
"""

from __future__ import annotations

import logging
import pickle
import time
import warnings
from collections.abc import Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from typing import Any

from fcm.quoting import quoted
from fcm.run.executor_place import ExecutorPlace, Refused, identity, other_fcm, there
from fcm.run.options import RUN, RunOptions
from fcm.run.places import Factory, NotComputed, PlaceClosed
from fcm.run.scheduler_address import LATE, answering
from fcm.run.scheduler_address import within as _within
from fcm.run.tasks import Attempt, Compute
from fcm.signals import undisturbed

NOISY = r"(distributed|dask|tornado|asyncio)(\.|$)"  # modules


class ClusterError(Exception):
    """Raised when there is no cluster to compute on; the message says what is missing."""


@contextmanager
def connected(address: str, options: RunOptions = RUN) -> Iterator[Factory]:
    """Connect to the scheduler at an address such as ``tcp://127.0.0.1:8786``, for one or more sweeps.

    Raises
    ------
    ClusterError
        If `distributed` is not installed, or no scheduler with a worker of this fcm is found.
    """
    with _quiet():
        client = _client(address, options)
        try:
            workers = Workers(client, address, options)
            yield lambda compute, _count: Cluster(compute, workers)
        finally:
            with undisturbed(), suppress(Exception):
                client.close(timeout=options.leave_time)


@contextmanager
def _quiet() -> Iterator[None]:
    """Suppresses warnings and logs of distributed."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", module=NOISY)
            yield
    finally:
        logging.disable(before)


def _client(address: str, options: RunOptions) -> Any:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from distributed import Client
    except ImportError:
        raise ClusterError(
            "a cluster needs dask.distributed, which is not installed: pip install distributed"
        ) from None
    until = time.monotonic() + options.scheduler_answer
    fault = answering(address, until)
    if not fault:
        client, error = _within(lambda: _connected(Client, address, until - time.monotonic()), until)
        if error is None:
            return client
        fault = (
            f"it did not answer within {options.scheduler_answer:g} s"
            if error is LATE
            else _first_line(error)
        )
    raise ClusterError(
        f"no dask scheduler answers at {quoted(address)} ({fault}); it is started with: dask scheduler"
    ) from None


def _connected(client: Any, address: str, timeout: float) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of versions that differ: what matters is that it answers
        return client(address, timeout=timeout, set_as_default=False)


class Workers:
    """The workers that a scheduler has, and which of them have this fcm."""

    def __init__(self, client: Any, address: str, options: RunOptions = RUN) -> None:
        self.options = options
        self.client, self.address, self.lost = client, address, f"the scheduler at {address} was lost"
        self.threads: dict[str, int] = {}  # of the present workers, by address
        self.fits: dict[str, bool] = {}  # whether a worker has this fcm, for all that were asked
        self._looked, self._last = -options.worker_interval, time.monotonic()
        try:
            client.wait_for_workers(1, timeout=options.first_worker)
        except Exception:
            raise ClusterError(
                f"the scheduler at {address} has no workers; one is started with: dask worker {address}"
            ) from None
        self.poll()
        if not self.good:
            raise ClusterError(f"the scheduler at {address} has no worker with this fcm")

    @property
    def good(self) -> list[str]:
        """The addresses of the workers that have this fcm."""
        return [address for address in self.threads if self.fits[address]]

    @property
    def width(self) -> int:
        """Number of batches given to the workers at a time; 0 without a worker that has this fcm."""
        return self.options.batches_ahead * sum(self.threads[address] for address in self.good)

    def poll(self) -> None:
        """Looks for workers, and checks new ones; raises `PlaceClosed` if there has been none for long."""
        if (now := time.monotonic()) - self._looked < self.options.worker_interval:
            return
        self._looked = now
        with suppress(Exception):  # every batch reports the loss of the scheduler
            threads = self.client.nthreads(callback_timeout=self.options.scheduler_answer)
            self._ask([address for address in threads if address not in self.fits])
            self.threads = {address: count for address, count in threads.items() if address in self.fits}
        if self.good:
            self._last = now
        elif now - self._last > self.options.without_workers:
            raise PlaceClosed(
                f"the scheduler at {self.address} has had no worker with this fcm "
                f"for {self.options.without_workers:.0f} s"
            )

    def look_again(self) -> None:
        """Make the next poll look for workers at once, because a new one has come."""
        self._looked = -self.options.worker_interval

    def _ask(self, new: list[str]) -> None:
        """Ask new workers whether they have this fcm; a warning says why others are refused."""
        if not new:
            return
        asked_by = identity()
        answers = self.client.run(
            identity, workers=new, on_error="return", callback_timeout=self.options.scheduler_answer
        )
        for address, found in answers.items():
            self.fits[address] = found == asked_by
            if not self.fits[address]:
                none = f"it has no fcm ({_first_line(found)})"
                why = other_fcm(found, asked_by) if isinstance(found, tuple) else none
                warnings.warn(f"worker {address} is refused: {why}", stacklevel=2)


class Cluster(ExecutorPlace):
    """The workers of a scheduler that have this fcm."""

    def __init__(self, compute: Compute, workers: Workers) -> None:
        self.workers = workers
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of its size; it goes to each worker once
                work = workers.client.submit(pickle.loads, pickle.dumps(compute, protocol=5), pure=False)
            super().__init__(work, workers.client.get_executor(pure=False))
        except Exception as error:
            raise PlaceClosed(workers.lost) from error
        self.poll()

    def poll(self) -> None:
        self.workers.poll()
        self.width = self.workers.width

    def result(self, future: Future[Attempt]) -> Attempt:
        try:
            if isinstance(future.exception(), Refused):  # by a worker that has just come, or took over
                del self._sizes[future]
                self.workers.look_again()
                raise NotComputed
        except CancelledError:
            raise PlaceClosed(self.workers.lost) from None
        return super().result(future)

    def _given(self, compute: Any, task: bytes) -> Future[Attempt]:
        good, only = self.workers.good, {}
        if len(good) < len(self.workers.threads):
            only = {
                "workers": good,
                "allow_other_workers": True,
            }  # should they all die: it comes back from others
        future: Future[Attempt] = self.executor.submit(there, compute, task, self.asked_by, **only)
        return future

    def _not_back(self, error: Exception) -> str:
        if type(error).__name__ == "KilledWorker":
            return "every worker that began it ended unexpectedly, perhaps for want of memory"
        return super()._not_back(error)


def _first_line(error: object) -> str:
    return str(error).partition("\n")[0].rstrip(".: ") or type(error).__name__
