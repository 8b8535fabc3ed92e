"""What ``fcm respond`` says about scenes without one: every key of them, and one to begin with."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

import click

from fcm.cli.columns import aligned


def _printed(text: str) -> None:
    click.echo(text)
    click.get_current_context().exit()


def _keys(_ctx: click.Context, _param: click.Parameter, wanted: bool) -> None:
    if wanted:
        from fcm.scene.keys import as_lines

        _printed(
            aligned([["key", "what it may be", "without it", "meaning"], *map(list, as_lines())], left=4)
        )


def _template(_ctx: click.Context, _param: click.Parameter, wanted: bool) -> None:
    if wanted:
        _printed((files("fcm") / "scene" / "template.toml").read_text("utf-8").rstrip("\n"))


def about_scenes(command: Any) -> Any:
    """The options --keys and --template."""
    keys = click.option(
        "--keys", is_flag=True, is_eager=True, expose_value=False, callback=_keys,
        help="Print every key of a scene and end.",
    )  # fmt: skip
    template = click.option(
        "--template", is_flag=True, is_eager=True, expose_value=False, callback=_template,
        help="Print a commented scene with every key and end.",
    )  # fmt: skip
    return keys(template(command))
