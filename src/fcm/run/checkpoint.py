"""Finished work of a run, in a file beside its output until that is written.

The file is opened in place, never emptied, and locked as long as its process lives, so that no second run
works on the same output. Every record says for itself of what it is (`fcm.run.records`).
"""

from __future__ import annotations

import errno
import os
import pickle
import platform
import stat
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from fcm.run.records import Record, packed, unpacked, whole
from fcm.signals import undisturbed

try:
    import fcntl
except ImportError:  # a system without them: two runs on one output are then not refused
    fcntl = None  # type: ignore[assignment]

TITLE = b"fcm unfinished 2, process "
LENGTH = 64  # bytes before the first record
MOST_ASIDE = 1000  # files moved aside for one output; then it is refused

_STATE = -1  # and less are the numbers of records with states of batch 0 and more

Fits = Callable[[int, Any], bool]  # whether results can be those of a batch


class CheckpointError(Exception):
    """The output cannot be worked on; the message says why."""


class Results:
    """Results of batches that are finished, and states of others, by their number; kept nowhere."""

    def __init__(self) -> None:
        self.finished: dict[int, list[Any]] = {}
        self.states: dict[int, list[Any]] = {}  # of an earlier run, in the order in which they were saved

    def add(self, number: int, results: list[Any]) -> None:
        """A batch is finished."""
        self.finished[number] = results

    def save(self, number: int, state: Any) -> None:
        """A batch has come so far."""


class Checkpoint:
    """The file of one output, and its lock.

    Parameters
    ----------
    path : Path
        The file; it is made if there is none.
    resume : bool
        Whether what it holds is continued; else it is moved aside.

    Raises
    ------
    CheckpointError
        If another run is at work on it, or it is no file of its own.
    OSError
        If it cannot be written.
    """

    def __init__(self, path: Path, resume: bool = False) -> None:
        self.path, self.failed, self.used, self.spent = path, False, False, False
        self._file = -1
        try:
            self._file = _locked(path)
            if os.fstat(self._file).st_size and (not resume or not self._known()):
                self._empty(
                    "without --resume it is not continued" if self._known() else "it is not of this fcm"
                )
            self._sign()
        except OSError as error:
            self.close()
            raise OSError(error.errno, error.strerror, str(path)) from None

    def results(self, mark: bytes, kinds: tuple[type, ...], fits: Fits) -> Results:
        """What is finished of the work with this fingerprint, and where more of it goes.

        A file that holds only other work is moved aside, with a warning.
        """
        found, others = _Kept(self, mark), 0
        for record in whole(self._file, os.fstat(self._file).st_size, LENGTH):
            if record.fingerprint != mark:
                others += 1
                continue
            results = unpacked(record.payload, kinds)
            if record.number < 0 and results is not None:
                found.states.setdefault(_STATE - record.number, []).append(results)
            elif results is not None and fits(record.number, results):
                found.finished[record.number] = results
        if others and not (found.finished or found.states) and not self.used:
            self._empty("it is of another scene, other options or another state of fcm")
            self._sign()
        self.used = True
        return found

    def append(self, mark: bytes, number: int, results: Any) -> None:
        """Keep what is finished; if that fails, say so once and go on."""
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

    def done(self) -> None:
        """The output is written: nothing is to be kept any more."""
        self.spent = True
        self.close()

    def close(self) -> None:
        """Let go of the file; one that holds nothing is removed."""
        if self._file < 0:
            return
        if (self.spent or self.empty) and _same(self._file, self.path):
            self.path.unlink(missing_ok=True)
        os.close(self._file)
        self._file = -1

    def __enter__(self) -> Checkpoint:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def empty(self) -> bool:
        """Whether it holds nothing that is whole."""
        return next(whole(self._file, os.fstat(self._file).st_size, LENGTH), None) is None

    def _known(self) -> bool:
        return os.pread(self._file, len(TITLE), 0) == TITLE

    def _sign(self) -> None:
        """Name the process that works; nothing after it is touched."""
        text = TITLE + f"{os.getpid()} on {platform.node()[:16]}".encode("ascii", "replace")
        os.pwrite(self._file, text.ljust(LENGTH - 1) + b"\n", 0)

    def _empty(self, reason: str) -> None:
        """Begin a new file; what the old one has goes aside, if it is anything."""
        if self._known() and self.empty:
            os.ftruncate(self._file, 0)
            return
        aside = _free(self.path)
        self.path.rename(aside)
        warnings.warn(f"{self.path}: {reason}; moved to {aside.name}", stacklevel=3)
        os.close(self._file)
        self._file = _locked(self.path)


class _Kept(Results):
    def __init__(self, checkpoint: Checkpoint, mark: bytes) -> None:
        super().__init__()
        self.checkpoint, self.mark = checkpoint, mark

    def add(self, number: int, results: list[Any]) -> None:
        super().add(number, results)
        self.checkpoint.append(self.mark, number, results)

    def save(self, number: int, state: Any) -> None:
        self.checkpoint.append(self.mark, _STATE - number, state)


def unfinished(output: Path) -> Path:
    """Where the work for an output is kept meanwhile."""
    return output.with_name(f"{output.name}.unfinished")


def _locked(path: Path) -> int:
    """The file, made if there is none, open and locked by this process."""
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    while True:
        try:
            file = os.open(path, flags | getattr(os, "O_CLOEXEC", 0), 0o666)
        except OSError as error:
            if error.errno in (errno.ELOOP, errno.EISDIR, errno.ENXIO):
                raise CheckpointError(f"{path}: {_NO_FILE}") from None
            raise
        try:
            if not stat.S_ISREG(os.fstat(file).st_mode):
                raise CheckpointError(f"{path}: {_NO_FILE}")
            _lock(file, path)
            if _same(file, path):  # and not removed by the one who had it, just before
                return file
        except BaseException:
            os.close(file)
            raise
        os.close(file)


_NO_FILE = "it is a link or no file, and finished work is kept under that name; remove it"


def _lock(file: int, path: Path) -> None:
    if fcntl is None:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno not in (errno.EACCES, errno.EAGAIN):
            return  # a file system without locks
        signed = os.pread(file, LENGTH, 0).removeprefix(TITLE).decode("ascii", "replace").strip()
        raise CheckpointError(
            f"{path.name.removesuffix('.unfinished')}: process {signed or 'another'} is at work on it; "
            "wait for it, end it, or write to another file"
        ) from None


def _same(file: int, path: Path) -> bool:
    with suppress(OSError):
        here = os.stat(path, follow_symlinks=False)  # noqa: PTH116
        return os.path.samestat(here, os.fstat(file))
    return False


def _write(file: int, data: bytes) -> None:
    """Write at the end, all of it."""
    os.lseek(file, 0, os.SEEK_END)
    view = memoryview(data)
    while view:
        view = view[os.write(file, view) :]


def _free(path: Path) -> Path:
    """A name beside it that nobody has."""
    for number in range(1, MOST_ASIDE):
        aside = path.with_name(f"{path.name}.{number}")
        if not os.path.lexists(aside):
            return aside
    raise CheckpointError(f"{path}: there are {MOST_ASIDE} of them already; remove some")
