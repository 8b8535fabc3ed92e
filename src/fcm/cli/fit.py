"""Scenes with a [fit]: checks of the options, and text output of the fitted numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.columns import aligned, ranges
from fcm.cli.messages import Messages
from fcm.cli.terminal import plain

if TYPE_CHECKING:
    from fcm.cli.respond_options import Asked
    from fcm.model.scene import Scene
    from fcm.response import Response
    from fcm.run import Execution


def check_scene(scene: Scene, asked: Asked) -> None:
    """Raise a usage error if an option is of no use with a [fit]."""
    if asked.method == "exact":
        raise click.UsageError(
            "--method exact is of no use with [fit]: numbers are fitted by harmonic balance."
        )
    given = {
        "--track": asked.track, "--mode": asked.mode, "--level": asked.level, "--at": asked.at,
        "--sensitivity": asked.sensitivity,
    }  # fmt: skip
    for option, value in given.items():
        if value:
            raise click.UsageError(
                f"{option} is of no use with [fit]: it is for numbers that are chosen already."
            )


def fitted(
    messages: Messages, scene: Scene, method: str, execution: Execution, options: dict[str, Any]
) -> Response:
    """The fit of a scene, and the response with its numbers."""
    from fcm.response.fit import fit

    response = fit(scene, method, execution, **options)
    messages.clear()
    return response


def as_table(result: Mapping[str, Any]) -> str:
    """Tables of the fitted numbers, then of the data."""
    from fcm.plot.labels import with_mode
    from fcm.units import unit_of_number

    found, units = result["fitted"], result.get("units", {})
    given = units.get("length", ""), units.get("force", ""), result.get("frequency_unit", "")
    percent = f"{100.0 * found['confidence']:g} % interval"
    rows = [["value", "standard error", percent, "began at", "fitted"]]
    for key, one in found["numbers"].items():
        told = one["standard_error"] is not None
        within = _interval(*one["interval"])
        error = f"{one['standard_error']:.2g}" if told else "-"
        unit = unit_of_number(key, *given)
        name = f"{with_mode(key)} [{unit}]" if unit else with_mode(key)
        rows.append([f"{one['value']:.6g}", error, within, f"{one['start']:.6g}", plain(name)])
    data = [["points", "misfit", "of damping", "level", "data"]]
    for one in found["data"]:
        low, high = one["level"]
        level = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
        level = "-" if one["kind"] == "backbone" else level
        damping = "-" if one["damping_misfit"] is None else f"{100.0 * one['damping_misfit']:.2g} %"
        data.append(
            [
                str(one["points"]),
                f"{100.0 * one['misfit']:.2g} %",
                damping,
                level,
                plain(f"{one['file']} {one['dof'] or ''}"),
            ]
        )
    note = (
        "misfit: root mean square distance of the points from the curve, as a share of the greatest "
        "amplitude. Of a backbone it is a share of the frequencies"
    )
    if scales := [_scale(one) for one in found["data"] if one["error_estimated"]]:
        note += f"\nerrors of the points, estimated, as such a share: {', '.join(dict.fromkeys(scales))}"
    said = f"harmonics of the fit: {ranges(found['harmonics'])}"
    return f"{aligned(rows, left=1)}\n\n{aligned(data, left=1)}\n{note}\n\n{_searches(found)}\n{said}"


def _interval(low: float | None, high: float | None) -> str:
    """An interval; None for an end that the data do not determine within the number's bounds.

    >>> _interval(0.36992, 0.37045), _interval(None, 0.5), _interval(2.0, None), _interval(None, None)
    ('0.36992 to 0.37045', 'up to 0.5', 'from 2', 'not determined')
    """
    if low is None and high is None:
        return "not determined"
    if low is None or high is None:
        return f"up to {high:.5g}" if low is None else f"from {low:.5g}"
    return f"{low:.5g} to {high:.5g}"


def _scale(data: Mapping[str, Any]) -> str:
    """Errors of the points of a response, or of a backbone's frequencies, in percent."""
    low, high = (f"{100.0 * end:.2g} %" for end in data["error"])
    return low if low == high else f"{low} to {high}"


def _searches(found: Mapping[str, Any]) -> str:
    """Table of the end of each search."""
    from fcm.plot.labels import with_mode

    rows = [["search", "points", "cost", *(plain(with_mode(key)) for key in found["numbers"]), "harmonics"]]
    every = sum(one["points"] for one in found["data"])
    for k, one in enumerate(found["starts"], 1):
        ends = [f"{value:.6g}" for value in one["end"]]
        points = "all" if one["finished"] else f"{one['points']} of {every}, rough"
        rows.append([str(k), points, f"{one['cost']:.3g}", *ends, ranges(one["harmonics"])])
    note = (
        "cost: half the sum of the squares of the distances in units of the errors; of all points with those "
        "at the numbers found"
    )
    if not all(one["finished"] for one in found["starts"]):
        note += (
            ". Rough searches choose where to begin with all. Their costs are with greater errors, and not "
            "comparable with those of all"
        )
    return f"{aligned(rows, left=1)}\n{note}"


def caveats(result: Mapping[str, Any]) -> list[str]:
    """Caveats on undetermined numbers, and advice on what would determine them."""
    found = result.get("fitted")
    return [] if found is None else [*found["problems"], *found["advice"]]


def incomplete(result: Mapping[str, Any]) -> str:
    """Line that the fit was interrupted, before or after its numbers were found; empty if it was not."""
    found = result.get("fitted")
    if found is None or not found["interrupted"]:
        return ""
    if found["final"]:
        return "interrupted before the response with the numbers found was traced"
    return "interrupted before the numbers were found: those shown are the best so far"
