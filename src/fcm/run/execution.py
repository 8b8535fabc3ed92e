"""How a calculation of many curves is carried out: where, what is kept of it, who is told how far it is."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from fcm.frozen import Frozen
from fcm.run.checkpoint import Checkpoint
from fcm.run.places import Factory
from fcm.run.progress import part
from fcm.run.work import Progress


class Execution(Frozen):
    """No result depends on it.

    Attributes
    ----------
    jobs : int
        Processes of this machine for groups of curves; 0 for one on each core.
    place : optional
        Where they are computed instead: `fcm.run.place_of` an executor, or `fcm.run.cluster.connected`.
    keep : Path or Checkpoint, optional
        File for what is finished. Of a path it is there only while the calculation is not finished; a
        checkpoint is the caller's, to be kept until the response is written.
    resume : bool
        Take from that file what is finished already.
    progress : optional
        Called now and then with the finished fraction and a text.
    """

    jobs: int = 1
    place: Factory | None = None
    keep: Path | Checkpoint | None = None
    resume: bool = False
    progress: Progress | None = None

    @property
    def processes(self) -> int:
        """How many may be used of this machine."""
        return self.jobs or os.cpu_count() or 1

    @contextmanager
    def checkpoint(self) -> Iterator[Checkpoint | None]:
        """The checkpoint: the caller's, who knows when it is not needed any more, or one of its own."""
        if not isinstance(self.keep, Path):
            yield self.keep
            return
        with Checkpoint(self.keep, self.resume) as own:
            yield own

    def discard(self, checkpoint: Checkpoint | None) -> None:
        """Remove the file of a calculation that is finished, unless it is the caller's."""
        if isinstance(self.keep, Path) and checkpoint is not None:
            checkpoint.done()

    def stage(self, begin: float, end: float) -> Execution:
        """A part of the calculation, from one share of its progress to another."""
        return replace(self, progress=part(self.progress, begin, end))


IN_THIS_PROCESS = Execution()
