"""The schedule of a scene in ``fcm respond``: simulation, tables and cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from fcm.cli.columns import aligned, number, share_of, stopped_early, swept
from fcm.cli.limits import SENTENCES
from fcm.cli.messages import Messages
from fcm.rotational_dofs import MOST_DOFS

if TYPE_CHECKING:
    from fcm.model.scene import Scene
    from fcm.response import Response
    from fcm.run import CheckpointFile
    from fcm.time_domain import Histories

Summary = Mapping[str, Any]  # one of the summary's "histories"

_OF_CURVES = {  # options of no use without a range of frequencies
    "method": "--method", "table": "--table", "max_step": "--max-step", "jobs": "--jobs",
    "tolerance": "--leave-out-tolerance", "keep_all": "--keep-all",
}  # fmt: skip


def check_options(scene: Scene, history_csv: Path | None) -> None:
    """Raise a usage error for options on curves or on motion if the scene has no such result."""
    if history_csv is not None and not scene.schedule:
        raise click.UsageError(f"--history-csv is of no use: {scene.name} has no [[schedule]].")
    context = click.get_current_context()
    if scene.has_range or context.params.get("at"):
        return
    given = [
        option
        for name, option in _OF_CURVES.items()
        if name in context.params and context.get_parameter_source(name) is ParameterSource.COMMANDLINE
    ]
    if given:
        raise click.UsageError(
            f"{given[0]} is of no use: {scene.name} has a [[schedule]] and no [response], so no curve."
        )


def simulated(messages: Messages, scene: Scene, response: Response, keep: CheckpointFile | None) -> Histories:
    """Simulate the motion through the schedule, after the curves; an interruption keeps the curves."""
    from fcm.response import scheduled
    from fcm.run.progress import part
    from fcm.time_domain.histories import not_begun

    if response.interrupted:
        return not_begun(scene)
    try:
        shown = part(messages.progress, 0.5 if response.curves else 0.0, 1.0)
        found = scheduled.simulated(scene, shown, keep)
    except KeyboardInterrupt:
        if not response.curves:
            raise
        found = not_begun(scene)
    messages.clear()
    return found


def write_csv(response: Response, path: Path) -> None:
    """Write the motion as CSV."""
    from fcm.time_domain.history_output import write_csv

    if response.histories is not None:
        write_csv(response.histories, path)


_NOT_SETTLED = "settled, no: by this share the amplitudes still change, estimated. More cycles settle them"


def as_table(histories: Sequence[Summary], unit: str) -> str:
    """Table with a line for each phase of each curve: amplitudes, states, whether the motion has settled."""
    from fcm.plot.labels import short_names

    first = next((one["phases"][0] for one in histories if one["phases"]), None)
    if first is None:
        return "\n".join(dict.fromkeys(f"no cycle of the schedule: {one['reason']}" for one in histories))
    dofs, contacts = list(first["amplitude"])[:MOST_DOFS], list(first["regime"])[: SENTENCES.contacts]
    names = list(short_names(histories[0]["parameters"]).values())
    amplitudes = [f"amplitude {dof}" for dof in dofs]
    header = [*names, "phase", unit, "cycles", *amplitudes, "transitions", *contacts, "settled", ""]
    rows = [row for one in histories for row in _rows(one, dofs, contacts)]
    table = aligned([header, *rows], left=len(contacts) + 2)
    going = any(
        phase["unsettled"] is not None and not phase["settled"]
        for one in histories
        for phase in one["phases"]
    )
    return f"{table}\n{_NOT_SETTLED}" if going else table


def _rows(one: Summary, dofs: list[str], contacts: list[str]) -> list[list[str]]:
    rows = [
        [
            *swept(one),
            str(i),
            f"{phase['frequency']:.6g}",
            f"{phase['cycles']:g}",
            *(number(phase["amplitude"][dof]) for dof in dofs),
            str(phase["transitions"]),
            *(phase["regime"][contact] for contact in contacts),
            _settled(phase),
            "",
        ]
        for i, phase in enumerate(one["phases"], 1)
    ]
    rows = rows or [[*swept(one), *["-"] * (4 + len(dofs) + len(contacts) + 1), ""]]
    if not one["complete"]:
        rows[-1][-1] = f"NOT COMPLETE: {one['reason']}"
    return rows


def _settled(phase: Mapping[str, Any]) -> str:
    left = phase["unsettled"]
    return "yes" if phase["settled"] else "no" if left is None else f"no, by {share_of(left)}"


def cost_and_error(histories: Sequence[Summary]) -> str:
    """Lines on the cost and error of a simulation, and on the cycles that are kept."""
    cycles = sum(one["cycles"] for one in histories)
    transitions = sum(one["transitions"] for one in histories)
    every = histories[0]["cycles_per_sampled_cycle"]
    seconds = sum(one["seconds"] for one in histories)
    error = max(one["energy"]["error"] for one in histories)
    of = "every cycle" if every == 1 else f"every {every}th cycle"
    lines = [
        f"schedule: {cycles:g} cycles, {transitions} transitions in {seconds:.2f} s",
        f"largest relative error of the energy balance: {error:.1e}",
        f"kept: {histories[0]['samples_per_cycle']} displacements of {of}; extremes and mean of all cycles",
    ]
    if dropped := transitions - sum(one["transitions_with_times"] for one in histories):
        lines.append(f"not kept: the times of the last {dropped} transitions")
    return "\n".join(lines)


def incomplete(histories: Sequence[Summary]) -> str:
    """How many schedules stopped early; empty if none."""
    return stopped_early(sum(not one["complete"] for one in histories), len(histories), "schedule")
