"""``fcm respond --sensitivity``: what the numbers of a scene do to its peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from fcm.cli.messages import Messages
    from fcm.model.scene import Scene
    from fcm.response import Response


def check_options(wanted: bool, method: str, level: object, mode: int | None, peaks_only: bool) -> None:
    """A usage error if --sensitivity is given with what has no peaks of a balance."""
    if wanted and method == "exact":
        raise click.UsageError(
            "--sensitivity is of no use with --method exact: it is of the peaks of harmonic balance."
        )
    if wanted and (level is not None or mode is not None):
        option = "--level" if mode is None else "--mode"
        raise click.UsageError(f"--sensitivity is of no use with {option}: such a curve has no peaks.")
    if wanted and peaks_only:
        raise click.UsageError(
            "--sensitivity is of no use with --peaks-only: it is taken at points of the curves."
        )


def added(messages: Messages, response: Response, scene: Scene, shown: bool) -> None:
    """Give the curves of a response the sensitivities of their peaks; interrupted, no time is left for it.

    Tables have none, so it is said where nothing has them.
    """
    from fcm.response.sensitivity import add_sensitivities, remarks, without_sensitivities

    if response.interrupted:
        without_sensitivities(response.curves)
        return
    add_sensitivities(response, scene, messages.progress)
    messages.clear()
    for remark in remarks(response, scene):
        messages.info(remark)
    if not shown:
        messages.warning("the sensitivities are in no table: -o FILE writes them, and --json")
