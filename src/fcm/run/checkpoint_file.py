"""Keep finished work of a run in a file beside its output, until the output is written.

A lock keeps a second run off the same output (`fcm.run.lock`). Files with work are never emptied. Every
record holds the fingerprint of its work (`fcm.run.records`).
"""

from __future__ import annotations

import os
import pickle
import platform
import stat
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fcm.files import real
from fcm.run.lock import LENGTH, TITLE, CheckpointError, locked, same
from fcm.run.options import RUN, RunOptions
from fcm.run.records import Record, packed, unpacked, whole
from fcm.signals import undisturbed

_STATE = -1  # number of a record with a state of batch 0; -2 for batch 1, and so on
_WRITTEN = bytes(32)  # instead of a fingerprint: the record has the points and the name of a written output

Fits = Callable[[int, Any], bool]  # whether results can be those of a batch


class Results:
    """Results of finished batches and states of others, by their number, in memory only."""

    def __init__(self) -> None:
        self.finished: dict[int, list[Any]] = {}
        self.states: dict[int, list[Any]] = {}  # of an earlier run, in the order in which they were saved

    def add(self, number: int, results: list[Any]) -> None:
        """Keeps the results of a finished batch."""
        self.finished[number] = results

    def save(self, number: int, state: Any) -> None:
        """Keep the state of an unfinished batch; this class keeps none."""


class CheckpointFile:
    """The file of one output, and its lock.

    Parameters
    ----------
    path : Path
        The file; it is created if there is none.
    resume : bool
        Whether to continue the work in it; otherwise it is moved aside.

    Raises
    ------
    CheckpointError
        If another run works on it, or the path is a link or no regular file.
    OSError
        If it cannot be written.
    """

    def __init__(self, path: Path, resume: bool = False, options: RunOptions = RUN) -> None:
        self.options = options
        self.path, self.failed, self.used, self.spent = path, False, False, False
        self.set_aside = False  # whether an older file was moved aside
        self._marks = {_WRITTEN}  # of all that this run has worked on
        self._file = -1
        try:
            self._file = locked(path)
            if os.fstat(self._file).st_size and (reason := self._not_continued(resume)):
                self._empty(reason)
            self._sign()
        except OSError as error:
            self.close()
            raise OSError(error.errno, error.strerror, str(path)) from None

    def results(self, mark: bytes, kinds: tuple[type, ...], fits: Fits) -> Results:
        """Saved results of the work with a fingerprint; those added later are appended to the file.

        A file that holds only other work is moved aside, with a warning.
        """
        found, others = _Kept(self, mark), 0
        for record in whole(self._file, os.fstat(self._file).st_size, LENGTH):
            if record.fingerprint != mark:
                others += record.fingerprint != _WRITTEN
                continue
            results = unpacked(record.payload, kinds)
            if record.number < 0 and results is not None:
                found.states.setdefault(_STATE - record.number, []).append(results)
            elif results is not None and fits(record.number, results):
                found.finished[record.number] = results
        if others and not (found.finished or found.states) and not self.used:
            self._empty("it is of another scene, other options or another version of fcm")
            self._sign()
        self.used = True
        self._marks.add(mark)
        return found

    def append(self, mark: bytes, number: int, results: Any) -> None:
        """Append results to the file; if that fails, warn once and go on."""
        if self.failed:
            return
        data = packed(Record(mark, number, pickle.dumps(results, protocol=5)))
        try:
            with undisturbed():
                _write(self._file, data)
        except OSError as error:
            self.failed = True
            warnings.warn(
                f"{self.path}: {error.strerror}; what is finished from now on is not kept until the end",
                stacklevel=2,
            )

    def written(self, output: Path) -> int | None:
        """Number of points of this work that an output has; None if it has none."""
        records = whole(self._file, os.fstat(self._file).st_size, LENGTH)
        notes = (one for one in records if one.fingerprint == _WRITTEN)
        own = [one.number for one in notes if unpacked(one.payload, ()) == output.name]
        return own[-1] if own else None

    def wrote(self, output: Path, points: int) -> None:
        """Record that an output is written, with its number of points of this work."""
        self.append(_WRITTEN, points, output.name)

    def done(self) -> list[Path]:
        """Remove the file after the output is written, and files moved aside that hold only this run's work.

        Returns the removed files that were moved aside; others may be somebody else's.
        """
        aside = [path for path in _aside(self.path, self.options.max_set_aside) if self._has(path)]
        for path in aside:
            path.unlink(missing_ok=True)
        self.spent = True
        self.close()
        return aside

    def _has(self, path: Path) -> bool:
        """Whether a file that was moved aside holds only work that this run has done."""
        try:
            file = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        except OSError:
            return False
        try:
            size = os.fstat(file).st_size if stat.S_ISREG(os.fstat(file).st_mode) else 0
            marks = {record.fingerprint for record in whole(file, size, LENGTH)}
            return bool(marks) and os.pread(file, len(TITLE), 0) == TITLE and marks <= self._marks
        finally:
            os.close(file)

    def close(self) -> None:
        """Close the file; remove it if it holds no work or is no longer needed."""
        if self._file < 0:
            return
        if (self.spent or not self.resumable) and same(self._file, self.path):
            self.path.unlink(missing_ok=True)
        os.close(self._file)
        self._file = -1

    def __enter__(self) -> CheckpointFile:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def resumable(self) -> bool:
        """Whether the file holds work, and not only records of written outputs."""
        records = whole(self._file, os.fstat(self._file).st_size, LENGTH)
        return any(record.fingerprint != _WRITTEN for record in records)

    def _known(self) -> bool:
        return os.pread(self._file, len(TITLE), 0) == TITLE

    def _not_continued(self, resume: bool) -> str:
        """Why the work in the file is not continued; empty if it is."""
        if not self._known():
            return "it is not of this fcm"
        if self._damaged():
            return "it is damaged: an unfinished run is there, and nothing of it can be read"
        return "" if resume else "without --resume it is not continued"

    def _damaged(self) -> bool:
        """Whether there is content without any whole record."""
        size = os.fstat(self._file).st_size
        return size > LENGTH and next(iter(whole(self._file, size, LENGTH)), None) is None

    def _sign(self) -> None:
        """Write the name of the working process at the start; the records stay."""
        text = TITLE + f"{os.getpid()} on {platform.node()[:16]}".encode("ascii", "replace")
        os.pwrite(self._file, text.ljust(LENGTH - 1) + b"\n", 0)

    def _empty(self, reason: str) -> None:
        """Begin a new file; the old one is moved aside unless it holds no work."""
        if self._known() and not self.resumable and not self._damaged():
            os.ftruncate(self._file, 0)
            return
        aside = _free(self.path, self.options.max_set_aside)
        self.path.rename(aside)
        warnings.warn(f"{self.path}: {reason}; moved to {aside.name}, and this run begins anew", stacklevel=3)
        os.close(self._file)
        self._file, self.set_aside = locked(self.path), True


class _Kept(Results):
    def __init__(self, checkpoint: CheckpointFile, mark: bytes) -> None:
        super().__init__()
        self.checkpoint, self.mark = checkpoint, mark

    def add(self, number: int, results: list[Any]) -> None:
        super().add(number, results)
        self.checkpoint.append(self.mark, number, results)

    def save(self, number: int, state: Any) -> None:
        self.checkpoint.append(self.mark, _STATE - number, state)


def unfinished(output: Path) -> Path:
    """Path of the file for unfinished work on an output: beside the output, with links resolved."""
    place = real(output) if output.is_symlink() else output
    return place.with_name(f"{place.name}.unfinished")


def _write(file: int, data: bytes) -> None:
    """Write all data at the end of the file."""
    os.lseek(file, 0, os.SEEK_END)
    view = memoryview(data)
    while view:
        view = view[os.write(file, view) :]


def _aside(path: Path, most: int) -> list[Path]:
    """The `most` - 1 paths to which a file may be moved aside."""
    return [path.with_name(f"{path.name}.{number}") for number in range(1, most)]


def _free(path: Path, most: int) -> Path:
    """The first of these paths that does not exist; CheckpointError if all do."""
    for aside in _aside(path, most):
        if not os.path.lexists(aside):
            return aside
    raise CheckpointError(f"{path}: there are {most} of them already; remove some")
