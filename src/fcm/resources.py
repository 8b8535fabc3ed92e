"""Available memory and disk space, and sizes and times in words for notices before a run."""

from __future__ import annotations

import shutil
from pathlib import Path

_UNITS = ((1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB"))


def size(bytes_taken: float) -> str:
    """A number of bytes in words, in the largest unit that gives at least 1.

    >>> size(2_340_000_000.0), size(512.0)
    ('2.3 GB', '1 kB')
    """
    scale, unit = next((one for one in _UNITS if bytes_taken >= one[0]), _UNITS[-1])
    number = max(bytes_taken / scale, 1.0)
    return f"{number:.2g} {unit}" if number < 10.0 else f"{number:.0f} {unit}"


def duration(seconds: float) -> str:
    """A time in words, in the largest unit that gives at least 2.

    >>> duration(9.2), duration(900.0), duration(3e5)
    ('9 s', '15 minutes', '83 hours')
    """
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} minutes" if seconds < 7200.0 else f"{seconds / 3600:.0f} hours"


def memory() -> float:
    """Bytes of memory that this process can still allocate; infinite if unknown."""
    found = [_available(), _left_of_limit()]
    return min(found)


def disk(folder: Path) -> float:
    """Bytes of free disk space for files in a folder; infinite if unknown."""
    try:
        return float(shutil.disk_usage(folder).free)
    except OSError:
        return float("inf")


def _available() -> float:
    """Bytes of memory available without swapping, within the limit of a container; infinite if unknown."""
    found = float("inf")
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                found = 1024.0 * float(line.split()[1])
        limit = Path("/sys/fs/cgroup/memory.max").read_text(encoding="ascii").strip()
        used = Path("/sys/fs/cgroup/memory.current").read_text(encoding="ascii").strip()
        if limit != "max":
            found = min(found, float(limit) - float(used))
    except (OSError, ValueError):
        pass
    return found


def _left_of_limit() -> float:
    """Bytes of address space left if `ulimit -v` limits it; else infinite."""
    try:
        import resource
    except ImportError:  # a system without limits
        return float("inf")
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit == resource.RLIM_INFINITY:
        return float("inf")
    try:
        taken = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    except (OSError, ValueError):
        return float(limit)
    return float(limit - taken)
