"""What a page says of its own making: the program, the machine, the commit."""

from __future__ import annotations

import os
import platform
from importlib.metadata import version
from pathlib import Path

import fcm

from ..program import ended

_PACKAGES = ("numpy", "scipy", "matplotlib", "netCDF4", "xarray")


def facts() -> list[tuple[str, str]]:
    """Name and value of each fact; the commit only where there is a repository."""
    found = [
        ("fcm", f"{fcm.__version__}{_commit()}"),
        ("Python", f"{platform.python_version()}, {platform.system()} {platform.machine()}"),
        ("processor", f"{_processor()}, {os.cpu_count()} cores"),
        ("packages", ", ".join(f"{name} {version(name)}" for name in _PACKAGES)),
    ]
    return found


def _commit() -> str:
    """The commit of the repository that holds this file, and whether its files are as committed."""
    folder = Path(__file__).parent

    def git(*args: str) -> str:
        done = ended("git", *args, cwd=folder)
        return done.out.strip() if done.code == 0 else ""

    try:
        commit = git("rev-parse", "--short", "HEAD")
        changed = git("status", "--porcelain", "--untracked-files=no")
    except OSError:  # no git
        return ""
    return f", commit {commit}{' with changes' if changed else ''}" if commit else ""


def _processor() -> str:
    """The processor's name as Linux tells it, else its kind."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
