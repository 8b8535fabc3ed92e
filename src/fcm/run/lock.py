"""A file for one process at a time: opened in place, and locked as long as its process lives."""

from __future__ import annotations

import errno
import os
import stat
from contextlib import suppress
from pathlib import Path

try:
    import fcntl
except ImportError:  # a system without them: two runs on one output are then not refused
    fcntl = None  # type: ignore[assignment]

TITLE = b"fcm unfinished 2, process "
LENGTH = 64  # bytes before the first record


class CheckpointError(Exception):
    """The output cannot be worked on; the message says why."""


def locked(path: Path) -> int:
    """Open the file, created if there is none, and lock it for this process; return its descriptor."""
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
            if same(file, path):  # not removed meanwhile by its last owner
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


def same(file: int, path: Path) -> bool:
    with suppress(OSError):
        here = os.stat(path, follow_symlinks=False)  # noqa: PTH116
        return os.path.samestat(here, os.fstat(file))
    return False
