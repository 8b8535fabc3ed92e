"""SCENE on the command line: a file or the name of a bundled scene, which a shell completes."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem


class SceneName(click.ParamType):
    """A string, checked when the scene is loaded; completed to names of bundled scenes and of files."""

    name = "scene"

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        from fcm.scene import bundled_scenes

        names = [CompletionItem(name) for name in bundled_scenes() if name.startswith(incomplete)]
        return [*names, CompletionItem(incomplete, type="file")]


scene_argument = click.argument("scene", metavar="SCENE", type=SceneName())
