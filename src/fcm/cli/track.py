"""``--track``, and scenes with an [optimum]: checks of the options, and text output."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.columns import (
    DOES_NOT_STAY,
    HARMONICS_HELP,
    STABILITY_UNKNOWN,
    UNKNOWN,
    UNSTABLE,
    aligned,
    most_of,
    share_of,
    short,
    stopped_early,
    swept,
)
from fcm.cli.curves import nowhere_stable
from fcm.cli.limits import SENTENCES
from fcm.cli.messages import Messages
from fcm.cli.terminal import plain

if TYPE_CHECKING:
    from fcm.model.scene import Scene
    from fcm.response import Response
    from fcm.response.track import TrackRequest
    from fcm.run import Execution

WHAT = ("folds", "peaks", "slip", "separation", "closing")
_SAID = {
    UNSTABLE: f"\n{UNSTABLE} {DOES_NOT_STAY}",
    UNKNOWN: f"\n{UNKNOWN} {STABILITY_UNKNOWN}{HARMONICS_HELP}",
}
OF_NO_USE = {  # options of no use with --track, and the reasons
    "level": "give --over level instead",
    "at": "every frequency of the range is looked at",
    "table": "its points are exact",
    "tolerance": "it leaves nothing out",
    "keep_all": "it leaves nothing out anyway",
    "history_csv": "no motion is simulated",
    "peaks_only": "the points of the curves are what is asked for",
    "sensitivity": "the curve itself is that of one number; run without --track for the rates by all",
}


def _only_one(context: click.Context, parameter: click.Parameter, given: tuple[str, ...]) -> str | None:
    """Callback that refuses a repeated option; click would silently take the last value."""
    if len(given) > 1:
        all_of = ", ".join(map(plain, given))
        what = {"track": "points of one kind", "over": "them in one number"}[str(parameter.name)]
        raise click.UsageError(
            f"{parameter.opts[0]} is given {len(given)} times ({all_of}): one run follows {what}; "
            "make a run for each.",
            context,
        )
    return given[0] if given else None


def track_options(command: Any) -> Any:
    """Decorator that adds the options of tracking."""
    options: list[Callable[[Any], Any]] = [
        click.option(
            "--track", type=click.Choice(WHAT), multiple=True, callback=_only_one,
            help="Follow these points of the response as curves in the number --over: folds (jumps), "
            "peaks, onset of slip, of separation, of contact at all.",
        ),
        click.option(
            "--over", metavar="KEY", multiple=True, callback=_only_one,
            help="With --track: the number, as contact.NAME.n_0 or level.",
        ),
        click.option("--from", "low", type=float, metavar="X", help="Where that number begins, for --track."),
        click.option("--to", "high", type=float, metavar="X", help="Where that number ends, for --track."),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def check_options(
    track: str | None, over: str | None, low: float | None, high: float | None, method: str
) -> None:
    """Raise a usage error if only some of these options are given, or others of no use with them."""
    rest = {"--over": over, "--from": low, "--to": high}
    if track is None:
        given = [name for name, value in rest.items() if value is not None]
        if given:
            raise click.UsageError(f"{given[0]} needs --track, what is to be followed.")
        return
    missing = [name for name, value in rest.items() if value is None]
    if missing:
        raise click.UsageError(f"--track needs {', '.join(missing)}.")
    if method == "exact":
        raise click.UsageError(
            "--track is of no use with --method exact: it follows solutions of harmonic balance."
        )
    context = click.get_current_context()
    for name, why in OF_NO_USE.items():
        if context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
            (option,) = (param.opts[0] for param in context.command.params if param.name == name)
            raise click.UsageError(f"{option} is of no use with --track: {why}.")


def tracked(
    messages: Messages, scene: Scene, asked: TrackRequest, execution: Execution, options: dict[str, Any]
) -> Response:
    """Track the requested curves."""
    from fcm.response.track import SpanError, track

    try:
        response = track(scene, asked, execution, **options)
    except SpanError as error:
        raise error.named("--from", "--to") from None
    messages.clear()
    return response


def optimised(
    messages: Messages, scene: Scene, method: Any, execution: Execution, options: dict[str, Any]
) -> Response:
    """The optimum of a scene, and the response with it."""
    from fcm.response.optimum import optimise

    response = optimise(scene, method, execution, **options)
    messages.clear()
    return response


def check_scene(scene: Scene, method: str, other: bool) -> None:
    """Raise a usage error if an option is of no use with an [optimum]."""
    if method == "exact":
        raise click.UsageError(
            "--method exact is of no use with [optimum]: its peaks are followed by harmonic balance."
        )
    if scene.schedule or other:
        what = "[[schedule]]" if scene.schedule else "--level"
        raise click.UsageError(
            f"{what} is of no use with [optimum]: it is for numbers that are chosen already."
        )


def as_table(result: Mapping[str, Any], unit: str) -> str:
    """A line for each optimum, one for each tracked curve, and one for each place where a number turns."""
    optima = result.get("optimum", [])
    there = result.get("curves", ())
    curves = there if len(there) == len(optima) else [{}] * len(optima)  # none after an interruption
    parts = [_optimum(one, curve, unit) for one, curve in zip(optima, curves, strict=True)]
    tracked = result["tracked"]
    if tracked["what"] != "optimum":
        parts += [one(tracked, unit) for one in (_curves, _turns, _unstable, _errors)]
    return "\n\n".join(filter(None, parts))


def _optimum(one: Mapping[str, Any], curve: Mapping[str, Any], unit: str) -> str:
    """Sentence on the least value, its place, and its certainty."""
    where = ", ".join(f"{plain(key)} = {value:.6g}" for key, value in one["values"].items())
    swept = ", ".join(f"{plain(key)} = {value:g}" for key, value in one["parameters"].items())
    kind = {
        "smooth": "", "kink": ", where peaks are equal", "corner": _at_corner(one, unit),
        "end": _where_higher_ends(one, unit),
        "bound": ", at a bound: beyond it there may be less", "flat": "",
        "trials": "", "unfinished": ", the least so far: the search was interrupted",
    }[one["kind"]]  # fmt: skip
    if one["between"]:
        ends = "{:.6g} and {:.6g}".format(*one["between"])
        kind += f"; known by trials alone, between {ends}, as not all peaks could be followed"
    elif one["kind"] == "trials":  # of several numbers
        kind = "; along each number known by trials alone, as not all peaks could be followed"
    at = " and ".join(
        f"{plain(place['dof'])} at {place['frequency']:.6g} {unit}{_mark(place)}" for place in one["at"]
    )
    said = "".join(text for mark, text in _SAID.items() if mark in map(_mark, one["at"]))
    least = (
        f"least {' and '.join(map(plain, one['minimise']))}: {one['value']:.6g}{_stays(one, curve)} "
        f"({_error(one)}{_ranges(one)})"
    )
    where = f"{least} with {where}{kind}{_flat(one)}{_higher(one)}"
    return (
        f"{where}\n{at}{f'; {swept}' if swept else ''}{said}{_nearly(one)}{_tried(one)}"
        f"{_lacking(one, curve)}{_higher_at_edge(one, curve, unit)}{_unstable_elsewhere(one)}"
    )


def _lacking(one: Mapping[str, Any], curve: Mapping[str, Any]) -> str:
    """Remark that the response at the optimum, traced on its own, lacks the least peak; or ''."""
    dofs = {name.partition(".")[2] for name in one["minimise"]}
    told = [curve.get("peak", {}).get(dof) or {} for dof in dofs]
    greatest = max((peak.get("amplitude") or 0.0 for peak in told), default=0.0)
    if not curve.get("complete") or greatest >= one["value"] * (1.0 - SENTENCES.lacking):
        return ""
    return (
        f"\nthe response below, traced alone, has {greatest:.6g} at most: this peak is on a branch that the "
        "search found from other numbers. More --harmonics may not have it"
    )


def _higher_at_edge(one: Mapping[str, Any], curve: Mapping[str, Any], unit: str) -> str:
    """Remark that the response is higher at an end of the range, which is not counted as a peak; or ''."""
    dofs = [name.removeprefix("peak.") for name in one["minimise"] if name.startswith("peak.")]
    ends = [(dof, curve.get("peak", {}).get(dof) or {}) for dof in dofs]
    higher = [
        f"{plain(dof)} is {end['amplitude']:.6g} at {end['frequency']:.6g} {unit}, an end of the range, "
        f'which is higher: minimise = "greatest.{plain(dof)}" counts that. A wider range has its peak'
        for dof, end in ends
        if end.get("at_edge") and end["amplitude"] > one["value"]
    ]
    return "".join(f"\n{text}" for text in higher)


def _unstable_elsewhere(one: Mapping[str, Any]) -> str:
    """Remark that with other numbers the greatest peak is unstable, so that others may be lower; or ''."""
    if not (ranges := one.get("unstable_peaks")):
        return ""
    key = plain(next(iter(one["values"])))
    where = " and ".join(f"from {there['from']:.4g} to {there['to']:.4g}" for there in ranges)
    greatest = max(there["greatest"] for there in ranges)
    return (
        f"\nwith {key} {where} the greatest peak, up to {greatest:.4g}, is unstable, so that no motion stays "
        f"there. What stays may be lower than the least above: a [sweep] of {key} there shows it"
    )


def _nearly(one: Mapping[str, Any]) -> str:
    """Remark on how sharp the optimum is: the numbers with which the peak is hardly greater; or ''."""
    if (near := one.get("nearly_least")) is None or one["kind"] == "unfinished":
        return ""
    low, high = (
        f"{near[end]:.5g}{'' if near[f'{end}_known'] else ' (followed no further)'}"
        for end in ("low", "high")
    )
    key = plain(next(iter(one["values"])))
    said = f"\nat most {100.0 * near['share']:g} % more with {key} from {low} to {high}"
    for number_of, times in near.get("higher", ()):
        side = "below" if number_of < one["values"][next(iter(one["values"]))] else "above"
        said += (
            f"\n{side}, at {key} = {number_of:.5g}, a peak ends that is {times:.3g} times as high: keep away"
        )
    return said


def _tried(one: Mapping[str, Any]) -> str:
    """Remark on an optimum by trials: the peaks at neighbouring values; or ''."""
    if not one["tried"]:
        return ""
    (best,) = one["values"].values()
    below = [pair for pair in one["tried"] if pair[0] < best][-SENTENCES.tried :]
    above = [pair for pair in one["tried"] if pair[0] > best][: SENTENCES.tried]
    peaks = ", ".join(f"{value:.4g} with {number:.5g}" for number, value in below + above)
    error, known = one["end_error"], ""
    if error is None:
        known = ". The error of a higher one of these is unknown: more --harmonics may not have it"
    elif error > SENTENCES.doubtful_error:
        known = f". A higher one of these may err by {short(error)}"
    return f"\ntried beside it: {peaks}. Between two of these the peak is unknown{known}"


def _at_corner(one: Mapping[str, Any], unit: str) -> str:
    """Clause that the peak has a corner at the optimum, or leaves the range of frequencies there."""
    if (at := one["leaves_range"]) is None:
        return ", at a corner: on both sides the peak rises at once"
    return (
        f", where the peak leaves the range of frequencies at {at:.6g} {unit}: with other numbers there is "
        "none within it, so take a wider one"
    )


def _where_higher_ends(one: Mapping[str, Any], unit: str) -> str:
    """Clause that a higher peak ends there, why, and how accurately the number is known; or ''."""
    if one["kind"] != "end":
        return ""
    if (at := one["leaves_range"]) is not None:
        return (
            f", where a higher peak leaves the range of frequencies at {at:.6g} {unit}: beyond the range it "
            "goes on, so take a wider one"
        )
    why = ", where a higher peak ends: on one side the peak jumps up, so keep a margin"
    told = one["end_error"] is not None
    error = f"off by {short(one['end_error'])}, relative, estimated" if told else "off by an unknown amount"
    return f"{why} (that end is {error})"


def _error(one: Mapping[str, Any]) -> str:
    """Clause on the error of the least peak; for equal peaks, the greatest error."""
    count = len(one["at"])
    of = f", the greatest of {count} equal peaks" if count > 1 and one["error"] else ""
    large = one["error"] is not None and one["error"] > SENTENCES.doubtful_error
    return f"error {short(one['error'])}{of}{', too large to rely on' if large else ''}"


def _higher(one: Mapping[str, Any]) -> str:
    """Warning that this is not the least, because the response has a higher peak not followed; or ''."""
    if (higher := one["higher"]) is None:
        return ""
    what = f"a higher {plain(higher['what'])}, {higher['value']:.6g}, on a branch that the search has not"
    helps = "A [sweep] of the number, or more --harmonics, shows how it goes on"
    return f" - NOT THE LEAST: the response there has {what}. {helps}"


def _flat(one: Mapping[str, Any]) -> str:
    """Clause on numbers on which the least peak does not depend, with their ranges; or ''."""
    found = [f"{plain(key)} from {low:.6g} to {high:.6g}" for key, (low, high) in one["flat"].items()]
    return f"; it does not depend on {', nor on '.join(found)}" if found else ""


def _stays(one: Mapping[str, Any], curve: Mapping[str, Any]) -> str:
    """Clause if the least peak is unstable or of unknown stability; or ''.

    curve: the response at the optimum.
    """
    found = [place["stable"] for place in one["at"]]
    lost = [place for place in one["at"] if place["stable"] is not True and nowhere_stable(curve, place)]
    if lost:
        return ", at which no stable motion was found"
    return ", unstable" if False in found else ", stability unknown" if None in found else ""


def _ranges(one: Mapping[str, Any]) -> str:
    """Clause if residual friction may change the least peak, or if that is unknown; or ''."""
    found = [place["residual_change"] for place in one["at"]]
    if one["kind"] == "unfinished" or not found:
        return ""
    share = "unknown" if None in found else share_of(max(found))
    return "" if share == "0" else f", residual friction {share}"


def _mark(place: Mapping[str, Any]) -> str:
    """Mark of a peak that is unstable, or not known to be stable."""
    return {True: "", False: UNSTABLE, None: UNKNOWN}[place["stable"]]


def _curves(tracked: Mapping[str, Any], unit: str) -> str:
    over = plain(tracked["over"])
    if not tracked["curves"]:
        low, high = tracked["span"]
        return f"no {tracked['what']} with {over} from {low:g} to {high:g}"
    rows = [[*_swept(tracked), "what", "points", f"{over} from", "to", f"{unit} from", "to", ""]]
    for curve in tracked["curves"]:
        ends = [f"{value:.6g}" for value in (*curve["number"], *curve["frequency"])]
        what = [plain(curve["what"]), str(curve["points"])]
        rows.append([*swept(curve), *what, *ends, curve.get("reason", "")])
    return aligned(rows, left=1)


def _swept(tracked: Mapping[str, Any]) -> list[str]:
    """The names of the further swept numbers."""
    from fcm.plot.labels import short_names

    return list(short_names(tracked["curves"][0]["parameters"]).values()) if tracked["curves"] else []


def _turns(tracked: Mapping[str, Any], unit: str) -> str:
    """Table of the turns of tracked curves, where windows of several solutions open and close."""
    rows = [[*_swept(tracked), f"turns at {plain(tracked['over'])}", unit, "kind"]]
    for curve in tracked["curves"]:
        for turn in curve["turns"]:
            where = [f"{turn['number']:.8g}", f"{turn['frequency']:.8g}"]
            rows.append([*swept(curve), *where, turn["kind"]])
    return aligned(rows, left=1) if len(rows) > 1 else ""


def _unstable(tracked: Mapping[str, Any], unit: str) -> str:
    """Table of ranges of the number in which the tracked motion is unstable, or may be."""
    over = plain(tracked["over"])
    rows = [[*_swept(tracked), "what", f"{over} from", "to", f"{unit} from", "to", "motion"]]
    for curve in tracked["curves"]:
        for key, said in (("not_stable", "not stable"), ("stability_untold", "stability unknown")):
            for one in curve.get(key, ()):
                ends = [f"{value:.6g}" for key in ("number", "frequency") for value in one[key]]
                if ends[0] == ends[1] and ends[2] == ends[3]:  # at one place: too short to be seen
                    ends[1] = ends[3] = ""
                rows.append([*swept(curve), plain(curve["what"]), *ends, said])
    unknown = any(curve.get("stability_untold") for curve in tracked["curves"])
    helps = "; more harmonics may show it" if unknown else ""
    title = f"where no motion is stable, or stability is unknown{helps}:"
    return f"{title}\n{aligned(rows, left=1)}" if len(rows) > 1 else ""


def _errors(tracked: Mapping[str, Any], unit: str) -> str:
    """Table of the estimated effects of the harmonics left out; at turns on the number as well."""
    turned = any("error_of_number" in one for curve in tracked["curves"] for one in curve["errors"])
    number = ["of the number"] if turned else []
    rows = [[*_swept(tracked), "what", f"at {plain(tracked['over'])}", unit, "error", *number, "place"]]
    for curve in tracked["curves"]:
        for one in curve["errors"]:
            told = one["error"] is not None
            error = short(one["error"]) if told else "unknown"
            of_number = short(one["error_of_number"]) if told and "error_of_number" in one else ""
            where = [f"{one[key]:.6g}" for key in ("number", "frequency")]
            errors = [error, of_number] if turned else [error]
            rows.append([*swept(curve), plain(curve["what"]), *where, *errors, one["place"]])
    of = "amplitudes" if tracked["what"] == "peaks" else "frequencies"
    title = f"relative error of the {of} by the harmonics left out, estimated:"
    return f"{title}\n{aligned(rows, left=1)}" if len(rows) > 1 else ""


def cost(result: Mapping[str, Any]) -> str:
    """Sentence on the time of a run that has traced no response curve."""
    from fcm.scene.errors import counted

    seconds = f"{result['seconds']:.2f} s"
    if result["tracked"]["what"] == "optimum":
        return f"the optimum was sought for {seconds}"
    return f"{counted(len(result['tracked']['curves']), 'tracked curve')} in {seconds}"


def lower_ended(result: Mapping[str, Any]) -> str:
    """Remark on curves of lower peaks that end early, while those of greater peaks are complete; or ''."""
    tracked = result.get("tracked", {})
    lower = [curve for curve in tracked.get("curves", ()) if curve.get("lower")]
    if not lower:
        return ""
    one, *others = lower
    more = f", as {len(others)} more do{'es' * (len(others) == 1)}" if others else ""
    where = "{:.6g} to {:.6g}".format(*one["number"])
    return (
        f"a lower {plain(one['what'])} was followed with {plain(tracked['over'])} from {where} alone{more}. "
        "Greater ones, which are complete, lie above it"
    )


def in_short(result: Mapping[str, Any]) -> list[str]:
    """Parts of a line on tracked curves: whether they are complete and stable, and how large errors are."""
    tracked = result.get("tracked")
    if tracked is None or tracked["what"] == "optimum":
        return []
    curves = tracked["curves"]
    stopped = sum(not curve["complete"] and not curve.get("lower") for curve in curves)
    ends = stopped_early(stopped, len(curves), "tracked curve") or "not complete" * bool(tracked["problems"])
    if not curves:
        return [ends or "complete", "nothing to follow was found"]
    kinds = {"unstable": "not_stable", "of unknown stability": "stability_untold"}
    counts = {what: sum(bool(curve.get(key)) for curve in curves) for what, key in kinds.items()}
    told = [f"{count} {what} in part" for what, count in counts.items() if count]
    which = f"of {len(curves)} tracked curve{'s' * (len(curves) > 1)}"
    stable = ", ".join([which, *told]) if told else "every motion tracked is stable"
    stable = "" if tracked["what"] == "folds" else stable  # at folds stability changes
    every = [one for curve in curves for one in curve["errors"]]
    errors = [one["error"] for one in every if one["error"] is not None]
    of = "amplitudes" if tracked["what"] == "peaks" else "frequencies"
    unknown = f" at {len(errors)} of {len(every)} places, elsewhere unknown" * (len(errors) < len(every))
    most = f"are {most_of(errors)}{unknown}" if errors else "are unknown"
    turns = [number for one in every if (number := one.get("error_of_number")) is not None]
    of_turns = f", of the number at turns {most_of(turns)}" if turns else ""
    unsure = ", but others may be missing" * bool(tracked.get("branches_unsure_at"))
    return [f"{ends or 'complete'}{unsure}", *filter(None, [stable]), f"errors of {of} {most}{of_turns}"]


def incomplete(result: Mapping[str, Any]) -> str:
    """Sentence on what is missing of the tracked curves; empty if nothing is."""
    from fcm.scene.address import LEVEL

    tracked = result.get("tracked")
    if tracked is None or tracked["complete"]:
        return ""
    stopped = sum(not curve["complete"] and not curve.get("lower") for curve in tracked["curves"])
    said = [stopped_early(stopped, len(tracked["curves"]), "tracked curve")] if stopped else []
    problems = tracked["problems"]
    if stopped and not problems and tracked["what"] != "optimum" and tracked["over"] != LEVEL:
        said[-1] += f": a [sweep] of {tracked['over']} shows the response beyond these places"
    more = [f"and so {len(problems) - SENTENCES.problems} more"] if len(problems) > SENTENCES.problems else []
    return "; ".join([*said, *problems[: SENTENCES.problems], *more])
