"""Files that a command writes, refused before the calculation if they cannot be written."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from fcm.cli.options import FiniteRange
from fcm.files import partial_of


def output_option(*names: str, endings: tuple[str, ...], **attributes: Any) -> Callable[..., Any]:
    """An option for a file to write, checked while the command line is read."""

    def check(_ctx: click.Context, _param: click.Parameter, path: Path | None) -> Path | None:
        if path is not None:
            check_output(path, endings)
        return path

    return click.option(*names, type=click.Path(path_type=Path), metavar="FILE", callback=check, **attributes)


def check_output(path: Path, endings: tuple[str, ...]) -> None:
    """A file with one of the endings, in a folder that exists and can be written; or a usage error."""
    try:
        problem = _problem(path, endings)
    except UnicodeEncodeError:
        problem = "the name is not valid text"
    except OSError as error:
        problem = f"it cannot be written: {error.strerror}"
    if problem:
        raise click.BadParameter(f"{str(path)!r}: {problem}.")


def check_different(paths: dict[str, Path | None]) -> None:
    """A usage error if two options name the same file to write, in whatever spelling."""
    seen: dict[Path, str] = {}
    for option, path in paths.items():
        if path is None:
            continue
        if (other := seen.setdefault(path.resolve(), option)) != option:
            raise click.UsageError(f"{other} and {option} name the same file, {str(path)!r}.")


def _problem(path: Path, endings: tuple[str, ...]) -> str:
    if path.is_dir():
        return "it is a folder, not a file to write"
    if path.suffix.lower() not in endings:
        return f"the name has to end in {' or '.join(endings)}"
    if path.exists() and not path.is_file():
        return "it is no file that could be replaced"
    if not path.parent.is_dir():
        if path.parent.exists():
            return f"{str(path.parent)!r} is a file, and no folder"
        return f"there is no folder {str(path.parent)!r}"
    str(path).encode()
    _try(path)
    return ""


def _try(path: Path) -> None:
    """Make what is written meanwhile, for permissions alone know no read-only disk and no longest name."""
    target = path.resolve()
    probe = partial_of(target)
    os.close(os.open(probe, os.O_CREAT | os.O_WRONLY))
    probe.unlink()


largest_file_option = click.option(
    "--largest-file", type=FiniteRange(min=0.0, min_open=True), default=1000.0, show_default=True,
    metavar="MB", help="Largest file of modes or matrices that is read, unpacked.",
    callback=lambda _ctx, _param, megabytes: round(megabytes * 1e6),
)  # fmt: skip
