"""``fcm respond SCENE --compare``: a scene by every method, error against run time."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.guard import NOT_COMPLETED
from fcm.cli.messages import Messages
from fcm.cli.report import aligned, number

if TYPE_CHECKING:
    from fcm.compare import Comparison
    from fcm.compare.methods import Run
    from fcm.scene.model import Scene

OF_NO_USE = {  # with --compare, and why
    "method": "it runs every method",
    "history_csv": "it simulates no schedule",
    "csv": "it has no curves to write; -o FILE.nc holds the errors",
    "jobs": "the methods are timed on one core",
    "resume": "it is not kept in between",
    "keep_all": "it runs every method with and without what is left out",
}
TITLES = {
    "peak": "peak",
    "peak_frequency": "its freq.",
    "fold": "folds",
    "points": "points",
    "curve": "curve",
}


def refuse_other_options() -> None:
    """A usage error if an option was given that has no meaning with --compare."""
    context = click.get_current_context()
    for param in context.command.params:
        given = context.get_parameter_source(param.name or "") is click.core.ParameterSource.COMMANDLINE
        if given and param.name in OF_NO_USE:
            raise click.UsageError(f"{param.opts[0]} is of no use with --compare: {OF_NO_USE[param.name]}.")


def write_comparison(
    messages: Messages, scene: Scene, table: str | None, tolerance: float, output: Path | None, to_json: bool
) -> None:
    """Compare, print, write."""
    if not scene.has_range:
        raise click.UsageError(f"--compare needs curves; {scene.name} has no [response] frequency.")
    from fcm.compare import compare
    from fcm.compare.output import summary, write_netcdf

    comparison = compare(scene, None if table is None else Path(table), messages.progress, tolerance)
    messages.clear()
    try:
        if output is not None:
            write_netcdf(comparison, output)
            messages.info(f"wrote {output}")
    finally:
        result = summary(comparison)
        click.echo(json.dumps(result, indent=2, allow_nan=False) if to_json else as_text(comparison))
    _close(messages, comparison)


def as_text(comparison: Comparison) -> str:
    """Tables of the methods, of what the errors consist of, of the peaks, and over the steps."""
    parts = [
        _reference(comparison),
        _methods(comparison),
        _contributions(comparison),
        _peaks(comparison),
        _steps(comparison),
    ]
    return "\n\n".join(part for part in parts if part)


def _against(comparison: Comparison) -> str:
    """The exact reference, where there is one for any curve."""
    exact = comparison.references["exact"]
    return "exact" if any(line.complete for line in exact.lines) else "closed form"


def _reference(comparison: Comparison) -> str:
    from fcm.compare.errors import MEASURES

    names = {"exact": "exact periodic motion", "closed form": "harmonic balance in closed form"}
    rows = [["errors of the references themselves", "max. step", *map(TITLES.get, MEASURES)]]
    for name, one in comparison.references.items():
        own = [max((e for e in one.own[measure] if e == e), default=None) for measure in MEASURES]
        cells = ["-" if value is None else f"{value:.0e}" for value in own]
        rows.append([names[name], f"{one.max_step:.3g}", *cells])
    return aligned(_to_the_left(rows), left=0)


def _methods(comparison: Comparison) -> str:
    from fcm.compare.errors import MEASURES

    against = _against(comparison)
    step = comparison.scene.each_curve()[0].max_step
    header = ["left out", "points", "solve [s]", "start [s]", "calls", "evaluations"]
    rows = [[f"against {against}", *header, *map(TITLES.get, MEASURES)]]
    for i, one in _in_order(comparison):
        if one.max_step != step or not one.corrected:
            continue
        start = comparison.startups.get(one.method)
        left_out = "no" if not one.left_out else "yes" if comparison.left_out else "nothing to"
        cells = [
            left_out,
            str(one.points),
            f"{one.seconds:.3f}",
            "-" if start is None else f"{start.total:.2f}",
        ]
        cells += ["-" if count is None else str(count) for count in (one.calls, one.evaluations)]
        shown = [str(comparison.shown(against, i, measure)) for measure in MEASURES]
        rows.append([one.method, *cells, *shown])
    return aligned(_to_the_left(rows), left=0)


def _in_order(comparison: Comparison) -> list[tuple[int, Run]]:
    """The runs with their numbers, a method's together, from long steps to short ones; exact last."""

    def place(pair: tuple[int, Run]) -> tuple[Any, ...]:
        _, one = pair
        return one.method == "exact", names.index(one.method), not one.corrected, -one.max_step, one.left_out

    names = list(comparison.startups) or sorted({one.method for one in comparison.runs})
    names += [one.method for one in comparison.runs]
    return sorted(enumerate(comparison.runs), key=place)


def _contributions(comparison: Comparison) -> str:
    from fcm.compare import contributions
    from fcm.compare.errors import MEASURES

    rows = [["what the error consists of", "against", *map(TITLES.get, MEASURES)]]
    for what, (against, found) in contributions(comparison).items():
        if found is not None:
            shown = [str(comparison.shown(against, found, measure)) for measure in MEASURES]
            rows.append([what, against, *shown])
    return aligned(_to_the_left(rows), left=0) if len(rows) > 1 else ""


def _peaks(comparison: Comparison) -> str:
    from fcm.compare.output import peaks
    from fcm.plot.labels import short_names

    found = peaks(comparison)
    if not found:
        return ""
    unit = comparison.scene.frequency_unit
    names = list(short_names(found[0]["parameters"]).values())
    heads = ["peak of", "exact", f"at {unit}", "harmonic", f"at {unit}", "error", "estimate"]
    rows = [[*names, *heads]]
    for one in found:
        swept = [f"{value:.6g}" for value in one["parameters"].values()]
        pairs = [
            number(one[kind][key]) for kind in ("exact", "harmonic") for key in ("amplitude", "frequency")
        ]
        estimate = one["truncation_error"]
        cells = [f"{one['error']:+.1e}", "-" if estimate is None else f"{estimate:.1e}"]
        rows.append([*swept, one["dof"], *pairs, *cells])
    return aligned(rows, left=0)


def _steps(comparison: Comparison) -> str:
    against = _against(comparison)
    rows = [["over the steps", "max. step", "points", "solve [s]", f"curve, {against}", "curve, closed form"]]
    for i, one in _in_order(comparison):
        if one.corrected and not one.left_out:
            continue
        name = one.method if one.corrected else f"{one.method}, as it is"
        shown = [str(comparison.shown(name_, i, "curve")) for name_ in (against, "closed form")]
        rows.append([name, f"{one.max_step:.4g}", str(one.points), f"{one.seconds:.3f}", *shown])
    return aligned(_to_the_left(rows), left=0)


def _to_the_left(rows: list[list[Any]]) -> list[list[str]]:
    """The first column filled up, so that it is aligned to the left among columns aligned to the right."""
    width = max(len(row[0]) for row in rows)
    return [[row[0].ljust(width), *row[1:]] for row in rows]


def _close(messages: Messages, comparison: Comparison) -> None:
    for text in comparison.left_out:
        messages.info(f"left out: {text}")
    for text in comparison.without_exact:
        messages.warning(f"no exact reference, compared with the closed form alone: {text}")
    own = comparison.references["exact"].own["peak"]
    known = max((e for e in own if e == e), default=None)
    error = "no exact reference" if known is None else f"the exact peaks are known to {known:.0e}"
    messages.info(f"{len(comparison.runs)} runs in {comparison.seconds:.1f} s; {error}")
    if comparison.interrupted:
        messages.error("error: interrupted; the runs that were finished are reported and written")
        click.get_current_context().exit(NOT_COMPLETED)
