"""``fcm respond --sensitivity``: the effect of the numbers of a scene on its peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from fcm.cli.messages import Messages
    from fcm.model.scene import Scene
    from fcm.response import Response


def check_options(wanted: bool, method: str, level: object, mode: int | None, peaks_only: bool) -> None:
    """Raise a usage error if --sensitivity is given without peaks of harmonic balance."""
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
    """Add the sensitivities of their peaks to the curves of a response; not after an interruption.

    Printed tables do not have them, so a message tells if no output has them.
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
