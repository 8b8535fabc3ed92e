"""Writes files completely or not at all, and explains why a file cannot be read or written."""

from __future__ import annotations

import errno
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

MEASURED = (".csv", ".txt", ".dat", ".mat", ".npz", ".uff", ".unv")  # endings of measured points
NETCDF = "NetCDF:"  # beginning of the message of a RuntimeError from that library


NOT_THERE = "is not there"
_KINDS = (
    (stat.S_ISDIR, "is a folder"),
    (stat.S_ISFIFO, "is a pipe (fifo), not a file"),
    (stat.S_ISSOCK, "is a socket, not a file"),
    (stat.S_ISCHR, "is a device, not a file"),
    (stat.S_ISBLK, "is a device, not a file"),
)


def no_file(path: str | Path, wanted: str = "read") -> str:
    """Why a path is not a usable file: "is a folder", "cannot be read: ..."; '' for a file.

    >>> no_file("/")
    'is a folder'
    """
    try:
        mode = os.stat(path).st_mode  # noqa: PTH116  # pathlib hides what is wrong
    except (FileNotFoundError, NotADirectoryError, ValueError):  # ValueError: not a valid file name
        return NOT_THERE
    except OSError as error:
        if error.errno == errno.ELOOP:
            return "is a loop of symbolic links"
        return f"cannot be {wanted}: {error.strerror}"
    return next((what for kind, what in _KINDS if kind(mode)), "")


def real(path: str | Path) -> Path:
    """The path at which a file is or will be, with all symbolic links followed.

    Raises
    ------
    OSError
        If the links form a loop.
    """
    try:
        found = Path(path).resolve()
        os.lstat(found)  # newer Pythons resolve a loop to something in it
    except RuntimeError:
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path)) from None
    except FileNotFoundError:
        pass
    if found.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path))
    return found


def same_file(one: str | Path, other: str | Path) -> bool:
    """Whether two names refer to the same file, also by symbolic or hard links."""
    with suppress(OSError, ValueError):
        return Path(one).samefile(other)
    with suppress(OSError, ValueError):
        return real(one) == real(other)
    return False


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Yields a temporary name for writing; the file replaces ``path`` only after it is complete.

    Partial files of processes that were killed while writing are removed.

    Raises
    ------
    OSError
        If the file cannot be written; with its name, and the true reason if a library hides it.
    """
    target = real(path)
    partial = partial_of(target)
    remove_stale(target)
    try:
        yield partial
        partial.replace(target)
    except OSError as error:
        raise _unwritten(error, partial, path) from error
    except RuntimeError as error:
        if not str(error).startswith(NETCDF):
            raise
        raise _unwritten(error, partial, path) from error
    finally:
        partial.unlink(missing_ok=True)


def partial_of(target: Path) -> Path:
    """The temporary name under which this process writes a file, the longest name created next to it."""
    return target.with_name(f".{target.stem}.{os.getpid():08d}.partial{target.suffix}")


def remove_stale(target: Path) -> None:
    """Removes the partial files of a target from processes that have ended."""
    name = re.compile(rf"\.{re.escape(target.stem)}\.(\d+)\.partial{re.escape(target.suffix)}", re.DOTALL)
    with suppress(OSError):
        for entry in os.scandir(target.parent):
            found = name.fullmatch(entry.name)
            if found and not lives(int(found[1])):
                Path(entry.path).unlink(missing_ok=True)


def lives(process: int) -> bool:
    """Whether a process with this number exists."""
    try:
        os.kill(process, 0)
    except PermissionError:
        return True
    except (OSError, OverflowError):
        return False
    return True


def _unwritten(error: OSError | RuntimeError, partial: Path, path: str | Path) -> OSError:
    """The error for a file that could not be written; it names a full disk, which libraries misreport."""
    number = getattr(error, "errno", None) or errno.EIO
    found = _refusal(partial)
    if found is None:
        reason = getattr(error, "strerror", None) or f"it could not be written ({error})"
    else:
        number, reason = found, os.strerror(found)
    if number in (errno.ENOSPC, errno.EDQUOT):
        reason += f" (the disk of {partial.parent})"
    return OSError(number, reason, str(path))


def _refusal(partial: Path) -> int | None:
    """Error number of the system for writing more bytes than the file has; None if it succeeds."""
    size, block = 0, bytes(1 << 20)  # up to a megabyte more; if it succeeds, the disk is not the reason
    with suppress(OSError):
        size = partial.stat().st_size
        partial.unlink()
    try:
        with partial.open("wb") as file:
            for _ in range(size // len(block) + 1):
                file.write(block)
    except OSError as error:
        return error.errno
    return None
