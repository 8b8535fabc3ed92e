"""Remarks of ``fcm respond`` before and after a calculation, and the exit code of an early stop."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import click

from fcm.cli import fit, nonlinear_mode, schedule, track
from fcm.cli.caveats import (
    branches_uncertain,
    folds_uncertain,
    kept_friction,
    large_errors,
    linear,
    mirrored,
    never_closed,
    not_confirmed,
    nothing_stable,
    of_more_harmonics,
    peaks_not_followed,
    searched_levels,
    short_of_accuracy,
    symmetry_lost,
    tracked_uncertain,
)
from fcm.cli.curves import all_lost_to_defects, cost_and_error, incomplete, of_table
from fcm.cli.guard import DEFECT, NOT_COMPLETED
from fcm.cli.limits import SENTENCES
from fcm.cli.messages import Messages
from fcm.cli.respond_options import Asked
from fcm.cli.verdict import lacks_modes, verdict

if TYPE_CHECKING:
    from fcm.model.scene import Scene


_TABLE = "the table: "  # begin of a remark on why no table is used
_NO_EFFECT = "(no effect)"  # end of a remark on parts whose omission has no effect


class Announced(NamedTuple):
    """What is known of a calculation before it begins."""

    resonant: bool  # whether a resonance is near the range of frequencies, as far as known
    harmonics_given: bool
    constant_loads: tuple[str, ...]  # names of contacts that no motion loads


def announce(messages: Messages, scene: Scene, asked: Asked) -> Announced:
    """Announce the calculation and doubts about it; its size without --verbose only if it is large."""
    from fcm.scene.listing import resonance_doubt
    from fcm.scene.rules import least_points
    from fcm.scene.unclosed_gaps import constant_loads

    in_steps = asked.at is None and asked.mode is None and scene.has_range
    caveat = resonance_doubt(scene) if in_steps else ""
    if caveat:
        messages.warning(caveat)
    first, count = scene.each_curve()[0], len(scene.each_curve())
    if first.loads and first.contacts:
        _say_rest(messages, first, " of the first curve" if count > 1 else "")
    method = asked.method if asked.mode is None else f"nonlinear mode {asked.mode}"
    messages.detail(f"{scene.title or scene.name}: curves to trace: {count}, method: {method}")
    if in_steps and (points := least_points(scene)) > SENTENCES.many_points:
        curves = f"{count} curve{'s' * (count > 1)}"
        messages.info(f"at least {points} points: {curves} in steps of {scene.max_step:g} at most")
    given = asked.harmonics is not None or (asked.accuracy is None and scene.harmonics is not None)
    return Announced(not caveat, given, constant_loads(scene))


def _say_rest(messages: Messages, scene: Scene, of: str) -> None:
    """Report which contacts the static loads of a curve close, to show wrong signs or too weak bolts."""
    from fcm.harmonic_balance.static_equilibrium import RestError, normal_forces_at_rest

    try:
        forces = normal_forces_at_rest(scene)
    except RestError:  # the curve reports it
        return
    closed, count, unit = int((forces > 0.0).sum()), forces.size, scene.units[1]
    under = f"under the static loads{of}"
    if not closed:
        messages.warning(
            f"{under} no contact is closed ({count} in all). Do they push the faces apart? "
            "A displacement along `normal` closes a contact"
        )
        return
    total = f"{forces.sum():.4g}{f' {unit}' if unit else ''}"
    messages.info(f"{under} {closed} of {count} contacts are closed; their normal forces sum to {total}")


def close(
    messages: Messages,
    result: dict[str, Any],
    defects: list[str],
    written: bool,
    announced: Announced,
    table_wanted: bool,
) -> None:
    """Print what the run left out, its cost and its error; set the exit code of an early stop.

    Remarks on a table are printed if the command line asks for one. A linear response is remarked on only if
    a resonance is near the range, because elsewhere it is expected.
    """
    for text in dict.fromkeys(defects):
        messages.detail(text)
    for text in result["left_out"]:
        wanted = table_wanted and text.startswith(_TABLE)
        say = messages.detail if text.endswith(_NO_EFFECT) and not wanted else messages.info
        say(f"left out: {text}")
    if result["curves"]:
        messages.info(cost_and_error(result))
        if text := of_table(result):
            (messages.info if table_wanted else messages.detail)(text)
    elif "tracked" in result:
        messages.info(track.cost(result))
    if levels := searched_levels(result):
        messages.detail(levels)
    remarks = [
        linear(result, announced.constant_loads) if announced.resonant else "",
        never_closed(result, announced.constant_loads),
        *(
            one(result)
            for one in (mirrored, kept_friction, nothing_stable, not_confirmed, peaks_not_followed)
        ),
        of_more_harmonics(result) if announced.harmonics_given else large_errors(result),
        folds_uncertain(result),
        track.lower_ended(result),
    ]
    of_doubt = (
        nonlinear_mode.outside_range,
        nonlinear_mode.internal_resonance,
        short_of_accuracy,
        branches_uncertain,
        symmetry_lost,
        tracked_uncertain,
    )
    warnings = [*(one(result) for one in of_doubt), *fit.caveats(result)]
    for text in filter(None, remarks):
        messages.info(text)
    for text in filter(None, warnings):
        messages.warning(text)
    histories = result.get("histories", [])
    if histories:
        messages.info(schedule.cost_and_error(histories))
    before = lacks_modes(result)  # announced before the calculation
    if line := verdict(result, before + sum(map(bool, [*remarks, *warnings]))):
        messages.info(line)
    if stopped := " and ".join(
        filter(
            None,
            (
                incomplete(result),
                track.incomplete(result),
                fit.incomplete(result),
                schedule.incomplete(histories),
            ),
        )
    ):
        done = "reported and written" if written else "reported"
        messages.error(f"error: {stopped}; what was traced is {done}")
        click.get_current_context().exit(DEFECT if all_lost_to_defects(result) else NOT_COMPLETED)
