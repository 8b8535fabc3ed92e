"""Give batches to an executor of the user: processes, threads or machines.

The same fcm must be installed where it computes: another one refuses the batch.
"""

from __future__ import annotations

import pickle
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from pathlib import Path
from typing import Any

import fcm
from fcm.run.fingerprint import program
from fcm.run.options import RUN
from fcm.run.places import Place, PlaceClosed
from fcm.run.tasks import Attempt, Batch, Compute, Lost, Report, attempt
from fcm.threads import one_thread


class Refused(Exception):  # noqa: N818
    """Raised where a batch should have been computed: the fcm there is not that of the run."""


def identity() -> tuple[str, bytes]:
    """The version of this fcm, and the digest of its sources and of the versions of Python and libraries."""
    return fcm.__version__, program(Path(fcm.__file__).parent)


def there(compute: Compute, task: bytes, asked_by: tuple[str, bytes]) -> Attempt:
    """Compute a batch where the executor runs, with one thread of linear algebra.

    task : pickled batch and saved states, so that no executor looks into them.
    asked_by : `identity` of the fcm that needs the results; `Refused` if it differs here.
    """
    if (own := identity()) != asked_by:
        raise Refused(other_fcm(own, asked_by))
    batch, saved = pickle.loads(task)
    with one_thread():
        return attempt(compute, batch, Report(_nobody, saved))


def other_fcm(own: tuple[str, bytes], asked_by: tuple[str, bytes]) -> str:
    """Sentence on how another installation of fcm differs from this one."""
    if own[0] != asked_by[0]:
        return f"it has fcm {own[0]}, and this is fcm {asked_by[0]}"
    return f"its fcm {own[0]} has other sources, another Python, numpy or scipy than this one"


class ExecutorPlace(Place):
    """An executor of `concurrent.futures`, which its owner shuts down; begun work cannot be stopped."""

    def __init__(self, compute: Compute, executor: Executor) -> None:
        self.compute, self.executor, self.asked_by = compute, executor, identity()
        self.width = RUN.batches_ahead * (getattr(executor, "_max_workers", None) or RUN.unknown_workers)
        self._sizes: dict[Future[Attempt], int] = {}  # of the batches that are there

    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        task = pickle.dumps((batch, report.saved), protocol=5)
        try:
            future = self._given(self.compute, task)
        except Exception as error:  # it is broken, or was shut down
            raise PlaceClosed(_broken(error)) from error
        self._sizes[future] = len(batch)
        return future

    def result(self, future: Future[Attempt]) -> Attempt:
        size = self._sizes.pop(future)
        try:
            return future.result()
        except (BrokenExecutor, CancelledError) as error:
            raise PlaceClosed(_broken(error)) from error
        except Refused as refusal:
            raise PlaceClosed(f"a worker of the executor was refused: {refusal}") from None
        except Exception as error:  # `there` itself never raises: transport failed
            return Attempt([Lost(self._not_back(error))] * size)

    def stop(self) -> None:
        for future in self._sizes:
            future.cancel()

    def _given(self, compute: Any, task: bytes) -> Future[Attempt]:
        return self.executor.submit(there, compute, task, self.asked_by)

    def _not_back(self, error: Exception) -> str:
        return f"the executor did not compute it: {type(error).__name__}: {error}"


def _broken(error: BaseException) -> str:
    what = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return f"the executor computes nothing any more ({what})"


def _nobody(_fraction: float, _text: str) -> None:
    pass
