"""Files that a command writes, refused before the calculation if they cannot be written."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click


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


def _problem(path: Path, endings: tuple[str, ...]) -> str:
    if path.suffix.lower() not in endings:
        return f"the name has to end in {' or '.join(endings)}"
    if path.is_dir():
        return "it is a folder, not a file to write"
    if not path.parent.is_dir():
        return f"there is no folder {str(path.parent)!r}"
    str(path).encode()
    probe = path.with_name(f".{path.name}.{os.getpid()}")  # permissions alone know no read-only disk
    probe.touch(exist_ok=False)
    probe.unlink()
    return ""
