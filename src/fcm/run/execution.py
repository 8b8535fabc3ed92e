"""Options of how a calculation of many curves is run: its place, its checkpoint and its progress."""

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
    """Options of how a calculation is run; no result depends on them.

    Attributes
    ----------
    jobs : int
        Processes of this machine for groups of curves; 0 for one on each core.
    place : optional
        Place where curves are computed instead: `fcm.run.place_of` an executor, or
        `fcm.run.cluster.connected`.
    keep : Path or CheckpointFile, optional
        File for finished work. For a path, it exists only until the calculation is finished. The caller owns
        a checkpoint, and keeps it until the response is written.
    resume : bool
        Whether to take finished work from the file `keep`.
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
        """The caller's checkpoint, which stays open, or a new one for a path, which is closed at the end."""
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
        """Options of a part of the calculation, from one share of the progress to another."""
        return replace(self, progress=part(self.progress, begin, end))


IN_THIS_PROCESS = Execution()
