"""Files that are whole or not there, and what stands in the way of writing them."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

PROBE = 1 << 20  # bytes that have to fit beside a file that failed for its disk not to be the reason
NETCDF = "NetCDF:"  # how a RuntimeError begins that comes from that library


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """A name to write under; the file takes its place at ``path`` only when it is whole.

    What processes have left there that were killed while they wrote is removed.

    Raises
    ------
    OSError
        If it cannot be written: with the name of the file, and the true reason where a library hides it.
    """
    target = Path(path).resolve()
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
    """The name under which this process writes a file: the longest of all that are made beside it."""
    return target.with_name(f".{target.stem}.{os.getpid():08d}.partial{target.suffix}")


def remove_stale(target: Path) -> None:
    """Remove the partial files of processes that have ended."""
    name = re.compile(rf"\.{re.escape(target.stem)}\.(\d+)\.partial{re.escape(target.suffix)}", re.DOTALL)
    with suppress(OSError):
        for entry in os.scandir(target.parent):
            found = name.fullmatch(entry.name)
            if found and not lives(int(found[1])):
                Path(entry.path).unlink(missing_ok=True)


def lives(process: int) -> bool:
    """Whether there is a process of that number."""
    try:
        os.kill(process, 0)
    except PermissionError:
        return True
    except (OSError, OverflowError):
        return False
    return True


def _unwritten(error: OSError | RuntimeError, partial: Path, path: str | Path) -> OSError:
    """Why a file could not be written: a full disk is named, which libraries take for something else."""
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
    """What the system says to as many bytes as there are and some more; None if it takes them."""
    size = 0
    with suppress(OSError):
        size = partial.stat().st_size
        partial.unlink()
    try:
        with partial.open("wb") as file:
            for _ in range(size // PROBE + 1):
                file.write(bytes(PROBE))
    except OSError as error:
        return error.errno
    return None
