"""Groups of curves traced on several cores, each in a process of its own with one thread."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from fcm.response.groups import Finished, Group, Shares, Work, lost_curve
from fcm.response.path import Progress
from fcm.response.result import Curve
from fcm.threads import one_in_children

POLL = 0.2  # [s] between two looks at the progress of the processes
DIED = "its process ended unexpectedly, perhaps for want of memory; try fewer --jobs"


def on_cores(work: Work, groups: dict[int, Group], jobs: int, progress: Progress | None) -> Finished:
    """Trace the groups in processes; those whose process dies are tried again, each in one of its own."""
    left = dict(groups)
    for number, curves in _in_pool(work, left, jobs, progress):
        if curves is not None:
            del left[number]
            yield number, curves
    for number, group in left.items():
        ((_, curves),) = _in_pool(work, {number: group}, 1, None)
        yield number, [lost_curve(scene, DIED) for scene in group] if curves is None else curves


def _in_pool(
    work: Work, groups: dict[int, Group], jobs: int, progress: Progress | None
) -> Iterator[tuple[int, list[Curve] | None]]:
    """The curves of each group as they are finished; None where the process died."""
    context = multiprocessing.get_context("spawn")
    share = Shares(groups, progress)
    array = context.Array("d", len(groups), lock=False)
    before = set(multiprocessing.active_children())
    with one_in_children():
        pool = ProcessPoolExecutor(min(jobs, len(groups)), context, _begin, (work, array))
        try:
            futures = {
                pool.submit(_trace, i, group): number for i, (number, group) in enumerate(groups.items())
            }
            for future in _as_completed(futures, share, array):
                yield futures[future], _result(future)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in set(multiprocessing.active_children()) - before:
                process.terminate()
            raise
        pool.shutdown()


def _result(future: Future[list[Curve]]) -> list[Curve] | None:
    try:
        return future.result()
    except BrokenProcessPool:
        return None


def _as_completed(futures: dict[Future[list[Curve]], int], share: Shares, array: Any) -> Iterator[Any]:
    """The futures as they end; in between the progress of all is shown."""
    waiting = set(futures)
    while waiting:
        done, waiting = wait(waiting, POLL, FIRST_COMPLETED)
        for number, value in zip(futures.values(), array, strict=True):
            share.set(number, value)
        yield from done


_work: Work
_shares: Any


def _begin(work: Work, shares: Any) -> None:
    """In a new process: an interruption is for the one that started it to handle."""
    global _work, _shares
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _work, _shares = work, shares


def _trace(index: int, group: Group) -> list[Curve]:
    def show(fraction: float, _text: str) -> None:
        _shares[index] = 0.999 * fraction

    curves = _work.curves(group, show)
    _shares[index] = 1.0
    return curves
