"""Work on many cases, each in a process of its own that is ended when it takes too much processor time."""

from __future__ import annotations

import multiprocessing
import resource
import sys
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import Connection, wait
from typing import TypeVar

from fcm.threads import one_here

Case = TypeVar("Case")
Result = TypeVar("Result")


def in_time(
    work: Callable[[Case], Result], cases: Iterable[Case], seconds: int, at_once: int = 1
) -> Iterator[tuple[Case, Result | None]]:
    """Each case with its result, as they end; None where it took more processor time, or failed."""
    context = multiprocessing.get_context("fork")
    waiting = list(cases)[::-1]
    count, done = len(waiting), 0
    running: dict[Connection, Case] = {}
    while waiting or running:
        while waiting and len(running) < at_once:
            case = waiting.pop()
            receive, send = context.Pipe(duplex=False)
            context.Process(target=_send, args=(work, case, seconds, send), daemon=True).start()
            send.close()
            running[receive] = case
        for ready in wait(list(running)):
            assert isinstance(ready, Connection)
            case, result = running.pop(ready), _received(ready)
            done += 1
            print(f"\r{done} of {count}", end="", file=sys.stderr, flush=True)
            yield case, result
    print(file=sys.stderr)


def _send(work: Callable[[Case], Result], case: Case, seconds: int, send: Connection) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    with one_here():  # further threads of the linear algebra wait, and use up the time
        send.send(work(case))


def _received(receive: Connection) -> Result | None:
    try:
        result: Result = receive.recv()
    except EOFError:  # it was ended, or ended with an error, which it has told
        return None
    return result
