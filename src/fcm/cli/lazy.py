"""A click group that imports a command only when it is called, so that ``fcm --help`` is fast."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import click

from fcm.cli.double_quotes import double_quotes
from fcm.cli.guard import guarded
from fcm.cli.options import add_verbosity


class LazyGroup(click.Group):
    """A group of commands that are imported on use.

    ``lazy`` maps the name of a command to (``"module:attribute"``, its line of help). ``instead`` maps names
    of commands that do not exist to what does the task.
    """

    def __init__(
        self,
        *args: Any,
        lazy: Mapping[str, tuple[str, str]],
        instead: Mapping[str, str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(*args, **kwargs)
        self._lazy, self._instead = lazy, instead or {}
        add_verbosity(self)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if not ctx.resilient_parsing and args[0] in self._instead:
            ctx.fail(f"No such command {args[0]!r}: it is {self._instead[args[0]]}.")
        if not ctx.resilient_parsing and args[0] not in self._lazy and args[0][:1].isalpha():
            from fcm.scene.errors import suggestion

            hint = suggestion(args[0], self._lazy) or f"; there are {', '.join(self._lazy)}"
            ctx.fail(f"No such command {args[0]!r}{hint}")
        return super().resolve_command(ctx, args)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self._lazy)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self._lazy:
            return None
        module, _, attribute = self._lazy[cmd_name][0].partition(":")
        command: click.Command = getattr(import_module(module), attribute)
        add_verbosity(command)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, line) for name, (_, line) in self._lazy.items()])

    def make_context(self, *args: Any, **kwargs: Any) -> click.Context:
        with double_quotes():
            return super().make_context(*args, **kwargs)

    def invoke(self, ctx: click.Context) -> Any:
        with double_quotes():
            return guarded(super().invoke, ctx)
