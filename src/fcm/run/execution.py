"""Options on how a calculation of many curves is run: where, what is kept of it, and its progress."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from fcm.frozen import Frozen
from fcm.run.checkpoint_file import CheckpointFile
from fcm.run.places import Factory
from fcm.run.progress import part
from fcm.run.tasks import Progress


class Execution(Frozen):
    """Options on how a calculation is run; no result depends on them.

    Attributes
    ----------
    jobs : int
        Processes of this machine for groups of curves; 0 for one on each core.
    place : optional
        Place where curves are computed instead: `fcm.run.place_of` an executor, or
        `fcm.run.cluster.connected`.
    keep : Path or CheckpointFile, optional
        File for what is finished. Of a path it is there only while the calculation is not finished; a
        checkpoint is the caller's, to be kept until the response is written.
    resume : bool
        Whether what is finished already is taken from the file `keep`.
    progress : optional
        Function that is called now and then with the finished fraction and a text.
    """

    jobs: int = 1
    place: Factory | None = None
    keep: Path | CheckpointFile | None = None
    resume: bool = False
    progress: Progress | None = None

    @property
    def processes(self) -> int:
        """Number of processes that may be used on this machine."""
        return self.jobs or os.cpu_count() or 1

    @contextmanager
    def checkpoint(self) -> Iterator[CheckpointFile | None]:
        """The checkpoint: the caller's, who knows when it is not needed any more, or one of its own."""
        if not isinstance(self.keep, Path):
            yield self.keep
            return
        with CheckpointFile(self.keep, self.resume) as own:
            yield own

    def discard(self, checkpoint: CheckpointFile | None) -> None:
        """Remove the file of a calculation that is finished, unless it is the caller's."""
        if isinstance(self.keep, Path) and checkpoint is not None:
            checkpoint.done()

    def stage(self, begin: float, end: float) -> Execution:
        """A part of the calculation, from one share of its progress to another."""
        return replace(self, progress=part(self.progress, begin, end))


IN_THIS_PROCESS = Execution()
