"""Files that a command writes: refused before the calculation, whole or not there after it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
    folder = path.parent
    if path.is_dir():
        problem = "it is a folder, not a file to write"
    elif path.suffix.lower() not in endings:
        problem = f"the name has to end in {' or '.join(endings)}"
    elif not folder.is_dir():
        problem = f"there is no folder '{folder}'"
    elif not os.access(folder, os.W_OK | os.X_OK):
        problem = f"the folder '{folder}' cannot be written"
    else:
        return
    raise click.BadParameter(f"'{path}': {problem}.")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A name to write under; the file takes its place at ``path`` only when it is whole."""
    target = path.resolve()
    partial = target.with_name(f".{target.stem}.{os.getpid()}.partial{target.suffix}")
    try:
        yield partial
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)
