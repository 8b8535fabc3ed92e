"""Compute batches at a place, keep each finished one, and lose nothing at an interruption."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Executor, Future, wait
from contextlib import suppress
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from typing import Any

from fcm.run.checkpoint_file import Results
from fcm.run.options import RUN
from fcm.run.places import Factory, NotComputed, Place, PlaceClosed, SerialPlace, WorkerDied
from fcm.run.progress import Bar
from fcm.run.tasks import Attempt, Batch, Compute, Lost, Progress, Report
from fcm.threads import one_here

DIED = "its process ended unexpectedly, perhaps for want of memory; try fewer --jobs"


@dataclass
class Outcome:
    """The results of each finished batch, with `Lost` in place of those that failed."""

    results: dict[int, list[Any]] = field(default_factory=dict)
    parts: dict[int, list[Any]] = field(default_factory=dict)  # of batches that were interrupted
    interrupted: bool = False
    lost: str = ""  # why the place took no more batches, if it did not

    def of(self, number: int) -> list[Any]:
        """Results of a batch, or its finished part."""
        return list(self.results.get(number, self.parts.get(number, ())))


def place_for(jobs: int) -> Factory:
    """Factory of the place for a number of cores of this machine."""
    if jobs == 1:
        return lambda compute, _count: SerialPlace(compute)
    from fcm.run.processes import Processes

    return lambda compute, count: Processes(compute, min(jobs, count))


def place_of(executor: Executor) -> Factory:
    """Factory of the place for an executor, which the caller shuts down."""
    from fcm.run.executor_place import ExecutorPlace

    return lambda compute, _count: ExecutorPlace(compute, executor)


def compute_batches(
    compute: Compute,
    batches: Sequence[Batch],
    at: Factory | None = None,
    kept: Results | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Compute all batches.

    Parameters
    ----------
    compute
        Computes a batch: one result for each item. It calls its report now and then, which may raise an
        interruption. It may then raise `Interrupted` with a part of its results, and save states from which
        it can continue. For processes all of these are pickled.
    batches
        Their results do not depend on the place and the order of computation.
    at
        Where to compute: `place_for(jobs)`, `place_of(executor)`, or a cluster (`fcm.run.cluster.connected`);
        by default this process.
    kept
        Finished results; every batch that is finished from now on is added.

    Raises
    ------
    KeyboardInterrupt
        If it is interrupted before any result is there; later, the finished results are returned.
    PlaceClosed
        If the place closes before any result is there; later, the finished results are returned.
    """
    with one_here():
        return _BatchRun(compute, batches, at or place_for(1), kept or Results(), progress).run()


class _BatchRun:
    def __init__(
        self,
        compute: Compute,
        batches: Sequence[Batch],
        at: Factory,
        kept: Results,
        progress: Progress | None,
    ) -> None:
        self.compute, self.batches, self.at, self.kept = compute, batches, at, kept
        self.outcome = Outcome(dict(kept.finished))
        self.bar = Bar([len(batch) for batch in batches], kept.finished, progress)
        self.waiting: dict[Future[Attempt], int] = {}
        self.done: SimpleQueue[Future[Attempt]] = SimpleQueue()  # futures of `waiting`, as they finish
        self.states: deque[tuple[int, Any]] = deque()  # not kept yet

    def run(self) -> Outcome:
        left = [number for number in range(len(self.batches)) if number not in self.outcome.results]
        died = self._at_once(left)
        for number in died:
            if not self.outcome.interrupted and self._at_once([number]):
                self.outcome.results[number] = [Lost(DIED) for _ in self.batches[number]]
        outcome = self.outcome
        if outcome.interrupted and not outcome.results and not any(outcome.parts.values()):
            raise PlaceClosed(outcome.lost) if outcome.lost else KeyboardInterrupt
        return outcome

    def _at_once(self, left: Sequence[int]) -> list[int]:
        """Compute batches at one place; return those whose process has died."""
        if not left:
            return []
        place, died = self.at(self.compute, len(left)), []
        self.waiting, self.done = {}, SimpleQueue()
        try:
            for number, done in self._computed(place, left):
                if done is None:
                    died.append(number)
                elif done.interrupted:
                    raise _Stopped(number, done.results)
                else:
                    self._finish(number, done.results)
        except KeyboardInterrupt as stop:
            self.outcome.interrupted = True
            if isinstance(stop, _Stopped):
                self.outcome.parts[stop.number] = stop.results
            self._hand_over(place)
        except PlaceClosed as gone:
            self.outcome.interrupted, self.outcome.lost = True, str(gone)
            self._hand_over(place)
        finally:
            place.close()
        return died

    def _computed(self, place: Place, left: Sequence[int]) -> Iterator[tuple[int, Attempt | None]]:
        todo = deque(left)
        while todo or self.waiting:
            while todo and len(self.waiting) < place.width:
                self._submit(place, todo.popleft())
            for future in self._arrived():
                number = self.waiting.pop(future)
                try:
                    found = _result(place, future)
                except NotComputed:
                    todo.appendleft(number)
                else:
                    yield number, found
            place.poll()
            self.bar.draw()

    def _submit(self, place: Place, number: int) -> None:
        at_once = isinstance(place, SerialPlace)
        saved, save = self.kept.states.get(number, ()), self._saver(number, at_once)
        future = place.submit(self.batches[number], Report(self.bar.of(number, at_once), saved, save))
        self.waiting[future] = number
        future.add_done_callback(self.done.put)

    def _arrived(self) -> list[Future[Attempt]]:
        """Wait briefly for finished futures and return them; keep the states saved meanwhile."""
        found = []
        try:
            found.append(self.done.get(timeout=RUN.poll))
            while True:
                found.append(self.done.get_nowait())
        except Empty:
            self._keep_states()
        return found

    def _saver(self, number: int, at_once: bool) -> Callable[[Any], None]:
        """Function that saves a state of a batch; unless `at_once`, it leaves this to the main thread."""
        if at_once:
            return lambda state: self.kept.save(number, state)
        return lambda state: self.states.append((number, state))

    def _keep_states(self) -> None:
        while self.states:
            self.kept.save(*self.states.popleft())

    def _finish(self, number: int, results: list[Any]) -> None:
        self._keep(number, results)
        self.bar.finish(number)

    def _keep(self, number: int, results: list[Any]) -> None:
        self.outcome.results[number] = results
        if not any(isinstance(one, Lost) for one in results):  # the next run tries lost results again
            self.kept.add(number, results)

    def _hand_over(self, place: Place) -> None:
        """Stop the place and collect what its batches have within the grace time.

        A second interruption ends the wait. Progress is no longer shown, because it may interrupt again.
        """
        place.stop()
        with suppress(KeyboardInterrupt):
            wait(self.waiting, RUN.grace_time)
        self._keep_states()
        for future in [one for one in self.waiting if one.done()]:
            number, found = self.waiting[future], None
            with suppress(NotComputed, PlaceClosed):
                found = _result(place, future)
            if found is not None and not found.interrupted:
                self._keep(number, found.results)
            elif found is not None:
                self.outcome.parts[number] = found.results


class _Stopped(KeyboardInterrupt):
    """A batch was interrupted where it was computed."""

    def __init__(self, number: int, results: list[Any]) -> None:
        super().__init__()
        self.number, self.results = number, results


def _result(place: Place, future: Future[Attempt]) -> Attempt | None:
    """Result of a batch; None if its process has died."""
    try:
        return place.result(future)
    except (WorkerDied, CancelledError):
        return None
