"""The workers of a `dask.distributed` scheduler, as a place where batches are computed.

`distributed` is imported here only, and only when a cluster is asked for; what it logs and warns of is kept
from the user's terminal. A worker that dies has its batches done elsewhere by the scheduler; one that has
another fcm is given none.
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

from fcm.run.elsewhere import AHEAD, Elsewhere, Refused, identity, other_fcm, there
from fcm.run.places import Again, Factory, Gone
from fcm.run.work import Attempt, Compute
from fcm.signals import undisturbed

ANSWER = 10.0  # [s] in which a scheduler has to answer
FIRST = 30.0  # [s] in which its first worker has to come
ALONE = 60.0  # [s] for which it may be without workers in the middle of a run
LOOK = 2.0  # [s] between two looks at how many there are
LEAVE = 5.0  # [s] to part from it
NOISY = r"(distributed|dask|tornado|asyncio)(\.|$)"  # modules


class ClusterError(Exception):
    """There is no cluster to compute on; the message says what is missing."""


@contextmanager
def connected(address: str) -> Iterator[Factory]:
    """The cluster of the scheduler at an address, as ``tcp://127.0.0.1:8786``, for one or more sweeps.

    Raises
    ------
    ClusterError
        If `distributed` is not installed, or no scheduler with a worker of this fcm is found.
    """
    with _quiet():
        client = _client(address)
        try:
            workers = Workers(client, address)
            yield lambda compute, _count: Cluster(compute, workers)
        finally:
            with undisturbed(), suppress(Exception):
                client.close(timeout=LEAVE)


@contextmanager
def _quiet() -> Iterator[None]:
    """Nothing of what distributed has to say."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", module=NOISY)
            yield
    finally:
        logging.disable(before)


def _client(address: str) -> Any:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            import distributed
    except ImportError:
        raise ClusterError(
            "a cluster needs dask.distributed, which is not installed: pip install 'fcm[cluster]'"
        ) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of versions that differ: what matters is that it answers
            return distributed.Client(address, timeout=ANSWER, set_as_default=False)
    except Exception as error:  # of many kinds: no such host, no answer, an answer of something else
        raise ClusterError(
            f"no dask scheduler answers at {address!r} ({_first_line(error)}); "
            "it is started with: dask scheduler"
        ) from None


class Workers:
    """The workers that a scheduler has, and which of them are of this fcm."""

    def __init__(self, client: Any, address: str) -> None:
        self.client, self.address, self.lost = client, address, f"the scheduler at {address} was lost"
        self.refused: dict[str, str] = {}  # why, by address
        self._looked, self._alone = -LOOK, 0.0
        self.width = AHEAD
        try:
            client.wait_for_workers(1, timeout=FIRST)
        except Exception:
            raise ClusterError(
                f"the scheduler at {address} has no workers; one is started with: dask worker {address}"
            ) from None
        if not self.good():
            raise ClusterError(f"the scheduler at {address} has no worker with this fcm")

    def good(self) -> list[str]:
        """The addresses of those that have this fcm; of others a warning says why they are given nothing."""
        asked_by, good = identity(), []
        for address, found in self.client.run(identity, on_error="return").items():
            if found == asked_by:
                good.append(address)
            elif address not in self.refused:
                other = f"it has no fcm ({_first_line(found)})"
                self.refused[address] = other_fcm(found, asked_by) if isinstance(found, tuple) else other
                warnings.warn(f"worker {address} is refused: {self.refused[address]}", stacklevel=2)
        return good

    def look(self) -> None:
        """How many there are now; `Gone` if there have been none for long."""
        if (now := time.monotonic()) - self._looked < LOOK:
            return
        self._looked = now
        with suppress(Exception):  # that the scheduler is lost is told by every batch it has
            threads = self.client.nthreads(callback_timeout=LOOK)
            self.width = AHEAD * max(sum(threads.values()), 1)
            self._alone = 0.0 if threads else self._alone or now
        if self._alone and now - self._alone > ALONE:
            raise Gone(f"the scheduler at {self.address} has had no workers for {ALONE:.0f} s")


class Cluster(Elsewhere):
    """The workers of a scheduler that have this fcm."""

    def __init__(self, compute: Compute, workers: Workers) -> None:
        self.workers = workers
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of its size; it goes to each worker once
                work = workers.client.submit(pickle.loads, pickle.dumps(compute, protocol=5), pure=False)
            super().__init__(work, workers.client.get_executor(pure=False))
            self.good = workers.good() if workers.refused else []
        except Exception as error:
            raise Gone(workers.lost) from error
        self.look()

    def look(self) -> None:
        self.workers.look()
        self.width = self.workers.width

    def result(self, future: Future[Attempt]) -> Attempt:
        try:
            if isinstance(future.exception(), Refused):  # by a worker that has come meanwhile
                del self._sizes[future]
                self.good = self.workers.good()
                raise (
                    Again if self.good else Gone(f"no worker of {self.workers.address} has this fcm any more")
                )
        except CancelledError:
            raise Gone(self.workers.lost) from None
        return super().result(future)

    def _given(self, compute: Any, task: bytes) -> Future[Attempt]:
        only = {"workers": self.good, "allow_other_workers": True} if self.good else {}
        future: Future[Attempt] = self.executor.submit(there, compute, task, self.asked_by, **only)
        return future

    def _not_back(self, error: Exception) -> str:
        if type(error).__name__ == "KilledWorker":
            return "every worker that began it ended unexpectedly, perhaps for want of memory"
        return super()._not_back(error)


def _first_line(error: object) -> str:
    return str(error).partition("\n")[0].rstrip(".: ") or type(error).__name__
