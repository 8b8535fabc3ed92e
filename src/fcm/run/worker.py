"""A process that computes batches for another: ``python -m fcm.run.worker``.

It reads batches from standard input and writes results to standard output. The input ends when the process
that started it is gone, for whatever reason. The worker then ends at once, even in the middle of a batch.
"""

from __future__ import annotations

import os
import pickle
import sys
import threading
import time
from queue import SimpleQueue
from typing import BinaryIO

from fcm.run.message_frames import BATCH, PROGRESS, RESULT, SHARE, STATE, STOP, WORK, receive, send
from fcm.run.options import RUN
from fcm.run.places import until
from fcm.run.tasks import Lost, Report, attempt


def main() -> None:
    """Compute batches until the input ends."""
    results = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # prints of libraries must not mix with results
    tasks: SimpleQueue[bytes] = SimpleQueue()
    stopped = threading.Event()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, tasks, stopped), daemon=True).start()
    work = tasks.get()
    try:
        compute = pickle.loads(work)
    except Exception as error:
        compute = _Unknown(f"what is to be computed is not known in a process of its own: {error}")
    show = _Said(results)

    def save(state: object) -> None:
        _sent(results, STATE, pickle.dumps(state, protocol=5))

    while True:
        batch, saved = pickle.loads(tasks.get())
        done = attempt(compute, batch, until(stopped, Report(show, saved, save)))
        _sent(results, RESULT, pickle.dumps(done, protocol=5))


def _listen(stream: BinaryIO, tasks: SimpleQueue[bytes], stopped: threading.Event) -> None:
    while (frame := receive(stream)) is not None:
        kind, data = frame
        if kind in (WORK, BATCH):
            tasks.put(data)
        elif kind == STOP:
            stopped.set()
    os._exit(0)


class _Said:
    """Progress, sent at most once per `progress_interval`."""

    def __init__(self, results: BinaryIO) -> None:
        self.results, self.last = results, 0.0

    def __call__(self, fraction: float, _text: str) -> None:
        if (now := time.monotonic()) - self.last > RUN.progress_interval:
            self.last = now
            _sent(self.results, PROGRESS, SHARE.pack(fraction))


class _Unknown:
    """Stands for a function that cannot be loaded; raises when called."""

    def __init__(self, reason: str) -> None:
        self.reason = reason

    def __call__(self, batch: object, _progress: object) -> list[Lost]:
        raise RuntimeError(self.reason)


def _sent(results: BinaryIO, kind: bytes, data: bytes) -> None:
    try:
        send(results, kind, data)
    except OSError:
        os._exit(0)


if __name__ == "__main__":
    main()
