"""Output files of a command, checked for writing before the calculation."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from itertools import combinations
from pathlib import Path
from typing import Any

import click

from fcm.cli.options import FiniteRange
from fcm.cli.terminal import plain
from fcm.files import NOT_THERE, no_file, partial_of, real, same_file
from fcm.signals import undisturbed

_BEFORE = "fcm.cli.files.before"  # key of a click context: outputs that existed before the command


def output_option(*names: str, endings: tuple[str, ...], **attributes: Any) -> Callable[..., Any]:
    """An option for a file to write, checked while the command line is read."""

    def check(_ctx: click.Context, _param: click.Parameter, path: Path | None) -> Path | None:
        if path is not None:
            check_output(path, endings)
        return path

    return click.option(*names, type=click.Path(path_type=Path), metavar="FILE", callback=check, **attributes)


def check_output(path: Path, endings: tuple[str, ...]) -> None:
    """Raise a usage error unless the file has one of the endings, and its folder exists and is writable."""
    try:
        problem = _problem(path, endings)
    except UnicodeEncodeError:
        problem = "the name is not valid text"
    except OSError as error:
        problem = f"it cannot be written: {error.strerror}"
    if problem:
        raise click.BadParameter(f"{str(path)!r}: {problem}.")
    context = click.get_current_context(silent=True)
    if context is not None and path.exists():
        context.meta.setdefault(_BEFORE, set()).add(path)


def wrote(path: Path, since_then: bool = False) -> str:
    """Message that a file is written, and whether it replaced one from before the command.

    since_then: whether the replaced file is an earlier part of the same result.
    """
    context = click.get_current_context(silent=True)
    before = set() if context is None else context.meta.get(_BEFORE, set())
    return f"wrote {plain(path)}" + (" (replaced)" if path in before and not since_then else "")


def check_different(paths: dict[str, Path | None]) -> None:
    """Raise a usage error if two options name the same file to write, in whatever spelling."""
    given = [(option, path) for option, path in paths.items() if path is not None]
    for (other, first), (option, path) in combinations(given, 2):
        if same_file(first, path):
            raise click.UsageError(f"{other} and {option} name the same file, {str(path)!r}.")


def check_not_read(outputs: Mapping[str, Path | None], inputs: Iterable[str | Path | None]) -> None:
    """Raise a usage error if a file to write is also read, under whatever name."""
    read = [path for path in inputs if path is not None]
    for option, path in outputs.items():
        if path is not None and (one := next((one for one in read if same_file(path, one)), None)):
            also = "" if str(one) == str(path) else f", which is {str(one)!r}"
            raise click.UsageError(f"{option} would overwrite {str(path)!r}{also}, and that is read.")


@contextmanager
def alone(outputs: Iterable[Path | None]) -> Iterator[None]:
    """Context in which no other run writes these files; raises `CheckpointError` if one is at work."""
    from fcm.run import CheckpointFile
    from fcm.run.checkpoint_file import unfinished

    with ExitStack() as held:
        for path in filter(None, outputs):
            with undisturbed():
                held.enter_context(CheckpointFile(unfinished(path), resume=True))
        yield


def _problem(path: Path, endings: tuple[str, ...]) -> str:
    if path == Path():
        return "it is this folder, as an empty name is: name a file to write"
    if (what := no_file(path, "written")) == "is a folder":
        return "it is a folder, not a file to write"
    if path.suffix.lower() not in endings:
        return f"the name has to end in {' or '.join(endings)}"
    if what and what != NOT_THERE:
        return f"it {what}"
    if not path.parent.is_dir():
        if (what := no_file(path.parent)) == NOT_THERE:
            return f"there is no folder {str(path.parent)!r}"
        return f"{str(path.parent)!r} {what or 'is a file'}, and no folder"
    str(path).encode()
    _try(path)
    return ""


def _try(path: Path) -> None:
    """Create and remove the temporary file of a path: permissions alone do not show that writing works."""
    target = real(path)
    probe = partial_of(target)
    os.close(os.open(probe, os.O_CREAT | os.O_WRONLY))
    probe.unlink()


largest_file_option = click.option(
    "--largest-file", type=FiniteRange(min=0.0, min_open=True), default=1000.0, show_default=True,
    metavar="MB", help="Largest file of modes or matrices that is read, unpacked.",
    callback=lambda _ctx, _param, megabytes: round(megabytes * 1e6),
)  # fmt: skip
