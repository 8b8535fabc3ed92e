"""SCENE on the command line: a file or the name of a bundled scene, which a shell completes."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem


def complete_scene(_ctx: click.Context, _param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Names of bundled scenes that begin so, and that the shell completes names of files, too."""
    from fcm.scene import bundled_scenes

    names = [CompletionItem(name) for name in bundled_scenes() if name.startswith(incomplete)]
    return [*names, CompletionItem(incomplete, type="file")]


scene_argument = click.argument("scene", metavar="SCENE", shell_complete=complete_scene)
