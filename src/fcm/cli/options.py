"""The options ``-v`` and ``-q`` of every command, and a type for finite numbers."""

from __future__ import annotations

import math
from typing import Any

import click
from click.shell_completion import CompletionItem

from fcm.cli.messages import Messages


class FiniteRange(click.FloatRange):
    """A `click.FloatRange` that refuses inf and nan, which passes every range of click."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number, or a usage error."""
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number.", param, ctx)
        return number


def _louder(ctx: click.Context, _param: click.Parameter, count: int) -> None:
    ctx.ensure_object(Messages).verbosity += count


def _quieter(ctx: click.Context, _param: click.Parameter, quiet: bool) -> None:
    if quiet:
        ctx.ensure_object(Messages).verbosity = -1


def add_verbosity(command: click.Command) -> None:
    """Give a command the options ``-v`` and ``-q``, unless it has options of these names."""
    taken = {name for param in command.params for name in param.opts}
    options = (
        click.Option(
            ["-v", "--verbose"], count=True, expose_value=False, callback=_louder,
            help="Details, and the traceback of a defect.",
        ),
        click.Option(
            ["-q", "--quiet"], is_flag=True, expose_value=False, callback=_quieter, help="Only errors.",
        ),
    )  # fmt: skip
    command.params += [option for option in options if not taken & set(option.opts)]


def complete_scene(_ctx: click.Context, _param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Completions: names of bundled scenes that begin so, and names of files by the shell."""
    from fcm.scene import bundled_scenes

    names = [CompletionItem(name) for name in bundled_scenes() if name.startswith(incomplete)]
    return [*names, CompletionItem(incomplete, type="file")]


scene_argument = click.argument("scene", metavar="SCENE", shell_complete=complete_scene)
