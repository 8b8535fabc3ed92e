"""Processes on this machine that compute one batch at a time each; if one dies, the others go on.

A worker is a separate program, not a copy of this one. It does not import the caller's main module, prints
nothing and takes no signal. It ends when this process does, even by ``kill -9`` (see `fcm.run.worker`).
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from typing import BinaryIO, cast

from fcm import signals
from fcm.run.message_frames import BATCH, PROGRESS, SHARE, STATE, STOP, WORK, receive, send
from fcm.run.places import Place, WorkerDied
from fcm.run.tasks import Attempt, Batch, Compute, Report
from fcm.threads import one_each


class Processes(Place):
    """Place of several processes, each started when it is first needed."""

    def __init__(self, compute: Compute, count: int) -> None:
        self.width = count
        self._work = pickle.dumps(compute, protocol=5)
        self._idle: list[_Worker] = []
        self._busy: set[_Worker] = set()
        self._lock, self._closed = threading.Lock(), False
        self._threads = ThreadPoolExecutor(count, initializer=_take_no_signal)

    def submit(self, batch: Batch, report: Report) -> Future[Attempt]:
        return self._threads.submit(self._compute, batch, report)

    def stop(self) -> None:
        with self._lock:
            for worker in self._busy:
                worker.send(STOP)

    def close(self) -> None:
        with signals.undisturbed():
            with self._lock:
                self._closed = True
                workers = [*self._idle, *self._busy]
            for worker in workers:
                worker.end()
            self._threads.shutdown(wait=True, cancel_futures=True)
            for worker in workers:
                worker.release()

    def _compute(self, batch: Batch, report: Report) -> Attempt:
        """Let a worker compute one batch; runs in a thread of this process."""
        worker = self._taken()
        try:
            done = worker.compute(batch, report)
        finally:
            with self._lock:
                self._busy.discard(worker)
        if done is None:
            worker.end()
            worker.release()
            raise WorkerDied
        with self._lock:
            self._idle.append(worker)
        return done

    def _taken(self) -> _Worker:
        with self._lock:
            if self._closed:
                raise WorkerDied
            worker = self._idle.pop() if self._idle else _Worker(self._work)
            self._busy.add(worker)
        return worker


class _Worker:
    def __init__(self, work: bytes) -> None:
        folders = os.pathsep.join(folder or os.getcwd() for folder in sys.path)  # noqa: PTH109
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", "fcm.run.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, **one_each(), "PYTHONPATH": folders},
        )
        self._sending = threading.Lock()
        self.send(WORK, work)

    def send(self, kind: bytes, data: bytes = b"") -> None:
        with self._sending, suppress(OSError, ValueError):  # `receive` reports a dead worker
            send(cast("BinaryIO", self.process.stdin), kind, data)

    def compute(self, batch: Batch, report: Report) -> Attempt | None:
        """The results of a batch; None if the process has ended."""
        self.send(BATCH, pickle.dumps((batch, report.saved), protocol=5))
        while (frame := receive(cast("BinaryIO", self.process.stdout))) is not None:
            kind, data = frame
            if kind == PROGRESS:
                report(SHARE.unpack(data)[0], "")
            elif kind == STATE:
                report.save(pickle.loads(data))
            else:
                done: Attempt = pickle.loads(data)
                return done
        return None

    def end(self) -> None:
        """Kills the process of the worker."""
        self.process.kill()
        self.process.wait()

    def release(self) -> None:
        """Closes the streams to and from a worker."""
        for stream in (self.process.stdin, self.process.stdout):
            with suppress(OSError):
                cast("BinaryIO", stream).close()


def _take_no_signal() -> None:
    """Block all signals in this thread; workers inherit this, so that only the main process gets signals."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, signals.ALL)
