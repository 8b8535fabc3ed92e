"""Caveats on complete curves, a sentence each: branches that may be missing, and doubtful results."""

from __future__ import annotations

import sys
from collections.abc import Collection, Mapping, Sequence
from math import inf, isclose
from typing import Any

from fcm.cli.columns import share_of
from fcm.cli.curves import shown_dofs
from fcm.cli.jump_table import resolution_of
from fcm.cli.limits import SENTENCES

_LINEAR = {  # keys of curves on which no contact changes its state: statement and remedy
    "all_stick": ("no contact slips or opens {}", "less preload or more force"),
    "all_open": ("no contact touches {}", "a smaller gap (a higher n_0) or more force"),
    "all_stick_or_open": (
        "each contact sticks, or is open, and none slips {}",
        "another preload or more force",
    ),
}
_CONSTANT = "No motion loads contacts with k_v = 0: give k_v > 0, or n_0 > 0 as a constant load"
_KEEPS = "a contact that never slips keeps a friction force that its past decides"
_BY_LEVEL = "--level 0:4 --at"  # follows the level of the forces, at a frequency


def short_of_accuracy(summary: Mapping[str, Any]) -> str:
    """How many curves miss the requested accuracy, and why the worst does; empty if none does."""
    short = [curve["short_of_accuracy"] for curve in summary["curves"] if curve.get("short_of_accuracy")]
    if tracked := summary.get("tracked", {}).get("short_of_accuracy"):
        return f"what is tracked misses the accuracy that was asked for. {tracked[:1].upper()}{tracked[1:]}"
    if not short:
        return ""
    curves, count = summary["curves"], len(summary["curves"])
    which = (
        "the curve misses" if count == 1 else f"{len(short)} of {count} curves miss{'es' * (len(short) == 1)}"
    )
    worst = max((one for one in curves if one.get("short_of_accuracy")), key=_greatest_error)
    given = _given(worst)
    why, of = worst["short_of_accuracy"], f"The worst, {given}: " if len(short) > 1 and given else ""
    return f"{which} the accuracy that was asked for. {of}{why[:1].upper()}{why[1:]}"


def _greatest_error(curve: Mapping[str, Any]) -> float:
    """The greatest error of the peaks of a curve; infinite if one is unknown."""
    errors = [one.get("error") for one in curve.get("peak", {}).values() if one and one.get("amplitude")]
    return max((inf if error is None else error for error in errors), default=0.0)


def linear(summary: Mapping[str, Any], constant: Collection[str] = ()) -> str:
    """Caveat that the response is linear because no contact ever changes its state; or ''.

    constant : names of the contacts that no motion loads, because their k_v is 0
    """
    curves = summary["curves"]
    found = {key for curve in curves for key in _LINEAR if curve.get(key)}
    if not curves or not all(any(curve.get(key) for key in _LINEAR) for curve in curves):
        return ""
    which = "on any curve" if len(curves) > 1 else "within the range"
    what, helps = _LINEAR[next(iter(found)) if len(found) == 1 else "all_stick_or_open"]
    held = next((curve["shakedown_at"] for curve in curves if "shakedown_at" in curve), None)
    if held is not None:
        return f"{what.format(which)}: the response is linear. {_shaken_down(summary, held)}"
    named = curves[0].get("contacts")
    if found == {"all_open"} and named and {*constant} >= named.keys():
        return f"{what.format(which)}: the response is linear. {_CONSTANT}"
    asked = ". Are gap and n_0 in the units of the structure?" if found == {"all_open"} else ""
    if all("mode" in curve for curve in curves):
        helps = "greater modal amplitudes, by --level,"
    used = _greatest_use(summary) if found == {"all_stick"} else ""
    return f"{what.format(which)}: the response is linear. {used}With {helps} it is not{asked}"


def _greatest_use(summary: Mapping[str, Any]) -> str:
    """Sentence on the sticking contact with the greatest ratio of friction to normal force; or ""."""
    found = [
        (loads["greatest_friction_force"]["greatest"], loads["greatest_normal_force"]["greatest"], name)
        for curve in summary["curves"]
        for name, loads in (curve.get("contacts") or {}).items()
    ]
    known = ((f, n, name) for f, n, name in found if f is not None and n is not None and n > 0.0)
    forces = [(f, n, name) for f, n, name in known if f > sys.float_info.epsilon * n]  # more than rounding
    if not forces:
        return ""
    friction, normal, name = max(forces, key=lambda one: one[0] / one[1])
    unit = summary.get("units", {}).get("force", "")
    sizes = (f"{one:.4g} {unit}".rstrip() for one in (friction, normal))
    return "Friction reaches {} beside a normal force of {} ({}). ".format(*sizes, name)


def never_closed(summary: Mapping[str, Any], constant: Collection[str] = ()) -> str:
    """Caveat on contacts that never touch on any curve, beside others that do; or ''.

    It is also empty if `linear` is not. Contacts with a constant load have another remedy.
    """
    curves = summary["curves"]
    if not curves or linear(summary) or not all(curve.get("contacts") for curve in curves):
        return ""
    loads = [
        {name: one["greatest_normal_force"] for name, one in curve["contacts"].items()} for curve in curves
    ]
    apart = [
        name for name in loads[0] if all(one[name]["greatest"] == one[name]["error"] == 0.0 for one in loads)
    ]
    if not apart:
        return ""
    which = "1 contact never touches" if len(apart) == 1 else f"{len(apart)} contacts never touch"
    where = "on any curve" if len(curves) > 1 else "within the range"
    more = f" and {len(apart) - SENTENCES.named} more" if len(apart) > SENTENCES.named else ""
    names = ", ".join(f'"{name}"' for name in apart[: SENTENCES.named]) + more
    unloaded = len({*apart} & {*constant})
    helps = ["A smaller gap (a higher n_0) or more force helps"] if unloaded < len(apart) else []
    helps += [_CONSTANT] if unloaded else []
    return f"{which} {where}: {names}. {'. '.join(helps)}"


def _shaken_down(summary: Mapping[str, Any], at: float) -> str:
    """Caveat that sticking contacts would slip from an unstressed start, so that other motions may exist."""
    unit = summary["frequency_unit"]
    how = _how(summary).replace("--at F", f"--at {at:.5g}")
    looks = f". {how} looks for them" if how else ""
    return (
        f"Contacts have shaken down: one that began unstressed would slip at {at:.5g} {unit}, and the "
        f"friction force that this leaves then holds it. Motions in which it slips on may exist, too{looks}"
    )


def branches_uncertain(summary: Mapping[str, Any]) -> str:
    """Caveat on frequencies where branches may be missing, because their search was cut short; or ''."""
    what = "other branches may be missing at {}: there the level of the forces was not followed to its end"
    helps = f"{_BY_LEVEL} {{}} looks there: amplitudes at the level 1 that the curve lacks are such a branch"
    return _may_be_missing(summary, "branches_unsure_at", what, helps)


def folds_uncertain(summary: Mapping[str, Any]) -> str:
    """Caveat on frequencies where folds of the level were not followed to their end; or ''.

    Branches may be missing there.
    """
    what = (
        "isolated branches may be missing {side} {}: from there a fold of the level of the forces was not "
        "followed to its end"
    )
    helps = f"{_BY_LEVEL} F, with F {{side}} {{}}"
    if how := _how(summary):
        helps += f", or a sweep up and down by {how.replace('--at F', '--at FROM:TO:COUNT')},"
    return _may_be_missing(summary, "folds_unsure_at", what, f"{helps} looks there")


def of_more_harmonics(summary: Mapping[str, Any]) -> str:
    """Caveat that branches with more harmonics than given were not searched; '' if errors of peaks are small.

    Only curves of a balance over the frequency count.

    >>> peak = {"peak": {"u": {"amplitude": 1.0, "error": 0.012}}, "harmonics": [1]}
    >>> unknown = {"peak": {"u": {"amplitude": 1.0, "error": None}}, "harmonics": [1]}
    >>> for curves in ([peak], [unknown], [peak, unknown]):
    ...     print(of_more_harmonics({"curves": curves}).split(". ")[0])
    the harmonics are given, and errors of peaks are up to 1.2 %
    the harmonics are given, and errors of peaks are unknown
    the harmonics are given, and errors of peaks are up to 1.2 %, 1 of 2 unknown
    """
    from fcm.response.options import INPUT_LIMITS

    completed = _completed(summary)
    curves = [one for one in completed if "harmonics" in one and not {"mode", "level_folds"} & {*one}]
    shown = shown_dofs(summary) if curves else []
    highest = [curve["peak"].get(dof) or {} for curve in curves for dof in shown]
    lower = [one for curve in curves for dof in shown for one in curve.get("peaks", {}).get(dof, ())]
    errors = [peak.get("error") for peak in [*highest, *lower] if peak.get("amplitude")]
    if all(error is not None and error <= INPUT_LIMITS.accuracy for error in errors):
        return ""
    known = [error for error in errors if error is not None]
    unknown = len(errors) - len(known)
    most = f"up to {share_of(max(known))}" if known else "unknown"
    lacking = f", {unknown} of {len(errors)} unknown" if known and unknown else ""
    return (
        f"the harmonics are given, and errors of peaks are {most}{lacking}. Branches that only more "
        f"harmonics have were not looked for: --accuracy {INPUT_LIMITS.accuracy:g} looks for them, as far as "
        "its time goes"
    )


def large_errors(summary: Mapping[str, Any]) -> str:
    """Caveat on the widest range of points with large errors, on curves that reach their accuracy; or ''.

    Curves that miss it are left out, because the errors of their peaks tell as much.

    >>> curve = {"large_errors": [{"from": 59.5, "to": 60.6, "error": 0.286}], "parameters": {}}
    >>> print(large_errors({"curves": [curve], "frequency_unit": "Hz"}).split(". ")[0])
    errors of points are up to 29 % of the amplitude between 59.5 and 60.6 Hz
    >>> large_errors({"curves": [curve | {"short_of_accuracy": "it takes more"}]})
    ''
    """
    curves = summary["curves"]
    found = [curve for curve in curves if curve.get("large_errors") and not curve.get("short_of_accuracy")]
    if not found:
        return ""
    one, *more = found[0]["large_errors"]
    where = f"{_between(one['from'], one['to'])} {summary['frequency_unit']}"
    given = _given(found[0])
    which = f" ({given}; on {len(found)} of {len(curves)} curves)" if len(curves) > 1 and given else ""
    every = ". All of them: large_errors of --json" if more or len(found) > 1 else ""
    return (
        f"errors of points are up to {share_of(one['error'])} of the amplitude {where}{which}. The accuracy "
        "is of peaks and folds that the curve has: more harmonics may have others there. --harmonics, with "
        f"more than these, shows them{every}"
    )


def symmetry_lost(summary: Mapping[str, Any]) -> str:
    """Caveat on places where even harmonics left out break the symmetry of the motion; or ''."""
    what = (
        "unsymmetric branches may be missing at {}: there the motion loses its symmetry, by even harmonics "
        "that are not balanced"
    )
    return _may_be_missing(
        summary, "symmetry_lost_at", what, "--harmonics with even ones, as 1-4, finds them"
    )


def _may_be_missing(summary: Mapping[str, Any], key: str, what: str, helps: str) -> str:
    """Sentence `what` on missing branches and `helps` on remedies, with the first frequency; or ''."""
    curves, unit = summary["curves"], summary["frequency_unit"]
    uncertain_at = [curve for curve in curves if curve.get(key)]
    if not uncertain_at:
        return ""
    (first, *more), given = uncertain_at[0][key], _given(uncertain_at[0])
    at, side = f"{first:.5g}", _side(first, summary.get("range"))
    count = f"on {len(uncertain_at)} of {len(curves)} curves"
    which = f" ({given}; {count})" if len(curves) > 1 and given else f" ({count})" if len(curves) > 1 else ""
    every = f". All of them: {key} of --json" if len(uncertain_at) > 1 or more else ""
    return f"{what.format(f'{at} {unit}{which}', side=side)}. {helps.format(at, side=side)}{every}"


def _side(at: float, span: Sequence[float] | None) -> str:
    """Side of a frequency on which the rest of the range lies, if it is an end of the range.

    >>> _side(40.0, (40.0, 90.0)), _side(90.0, (40.0, 90.0)), _side(50.0, (40.0, 90.0)), _side(50.0, None)
    ('above', 'below', 'beyond', 'beyond')
    """
    low, high = span or (-inf, inf)
    near = SENTENCES.resolution * (high - low) if span else 0.0
    return "above" if at - low <= near else "below" if high - at <= near else "beyond"


def _given(curve: Mapping[str, Any]) -> str:
    """The swept values of a curve, as text."""
    return ", ".join(f"{key} = {value:.6g}" for key, value in curve.get("parameters", {}).items())


def not_confirmed(summary: Mapping[str, Any]) -> str:
    """Caveat on the number of points whose stability many contacts leave unconfirmed; or ''."""
    count = sum(curve.get("stability_not_confirmed", 0) for curve in summary["curves"])
    if not count:
        return ""
    from fcm.stability.options import STABILITY  # numerics, which the help does not import

    most = f"{100.0 * STABILITY.confirmation.max_fraction_of_many:.0f} %"
    return (
        f"at {count} points stability is unknown. With many contacts a motion with more harmonics takes "
        f"long, so it was looked for at {most} of the points at most. More --harmonics, or a narrower range, "
        "leave fewer points unknown"
    )


def mirrored(summary: Mapping[str, Any]) -> str:
    """Remark on the number of branches whose mirror images are not traced; or ''."""
    count = sum(curve.get("mirrored_branches", 0) for curve in summary["curves"])
    if not count:
        return ""
    one, other = ("branch", "its mirror image") if count == 1 else ("branches", "their mirror images")
    verb = "is" if count == 1 else "are"
    return f"{count} {one} of unsymmetric motions: {other}, of the same amplitudes, {verb} not traced"


def searched_levels(summary: Mapping[str, Any]) -> str:
    """Remark on the force levels between which isolated branches were searched; or ''."""
    found = [curve["levels_looked_at"] for curve in summary["curves"] if "levels_looked_at" in curve]
    if not found:
        return ""
    low, high = found[0]
    return f"isolated branches: the folds of the level of the forces were followed from {low:g} to {high:g}"


def tracked_uncertain(summary: Mapping[str, Any]) -> str:
    """Caveat on curves from which tracking began where branches may be missing; or ''."""
    tracked = summary.get("tracked", {})
    uncertain_at = tracked.get("branches_unsure_at")
    if not uncertain_at:
        return ""
    number, frequency = uncertain_at[0]
    at = f"with {tracked['over']} = {number:.6g} at {frequency:.5g} {summary['frequency_unit']}"
    why = "the level of the forces, or a fold of it, was not followed to its end"
    helps = f"A scene with that number, by {_BY_LEVEL} {frequency:.5g}, looks there"
    return f"other tracked curves may be missing: {at} {why}. {helps}"


def peaks_not_followed(summary: Mapping[str, Any]) -> str:
    """Caveat on the ends of the optimum's range of its number to which no peak was followed; or ''.

    A peak that is lower than another peak to be minimised need not be followed.
    """
    tracked = summary.get("tracked", {})
    if tracked.get("what") != "optimum" or not tracked["over"]:  # of several numbers there is no one range
        return ""
    reach: dict[str, tuple[list[str], list[float]]] = {}
    for one in tracked["curves"]:
        whats, numbers = reach.setdefault(_given(one), ([], []))
        whats.append(one["what"])
        numbers += one["number"]
    (low, high), key = tracked["span"], tracked["over"]
    for given, (whats, numbers) in reach.items():
        beyond = (
            [f"below {min(numbers):.6g}"] if min(numbers) > low and not isclose(min(numbers), low) else []
        )
        beyond += (
            [f"above {max(numbers):.6g}"] if max(numbers) < high and not isclose(max(numbers), high) else []
        )
        if beyond:
            swept, what = f" ({given})" if given else "", " or ".join(dict.fromkeys(whats))
            return (
                f"no {what} was followed with {key} {' and '.join(beyond)}{swept}. Within the range of "
                "frequencies there is none, or it was lost: a wider [response] frequency may have it"
            )
    return ""


def nothing_stable(summary: Mapping[str, Any]) -> str:
    """Caveat on the widest frequency range without a stable motion; or ''."""
    curves, unit, least = summary["curves"], summary["frequency_unit"], resolution_of(summary)
    every = {i: curve["no_stable_motion"] for i, curve in enumerate(curves) if curve.get("no_stable_motion")}
    wide = {i: seen for i, found in every.items() if (seen := [x for x in found if x[1] - x[0] >= least])}
    narrow = sum(map(len, every.values())) - sum(map(len, wide.values()))
    hooks = f"{narrow} range{'s' * (narrow > 1)} narrower than {least:.2g} {unit}"
    if not wide:
        return f"no stable motion was found in {hooks}, too narrow to be seen in a sweep" if narrow else ""
    found, shown = [curves[i] for i in wide], next(iter(wide.values()))
    widest = sorted(_widest_first(shown)[: SENTENCES.stretches])
    others = len(shown) - len(widest)
    more = f" and in {others} narrower range{'s' * (others > 1)}" if others else ""
    more += f" and in {hooks}" if narrow else ""
    *before, last = (_between(*ends) for ends in widest)
    ways = f"{', '.join(before)}{', ' if more else ' and '}{last}" if before else last
    which = f" ({_given(found[0])}; on {len(found)} of {len(curves)} curves)" if len(curves) > 1 else ""
    other = ", or has another residual friction" if found[0].get("may_not_be_unique") else ""
    if not other and found[0].get("may_wedge"):
        other = ", or sticks by friction that slip has left, as friction may press its contacts together"
    shows = f"{how} shows the motion there" if (how := _how(summary)) else "More harmonics may find one"
    return (
        f"no stable motion was found {ways} {unit}{more}{which}, so no steady amplitude is known there. The "
        f"motion repeats after several periods or never, or is on a branch that was not found{other}."
        f"{_not_searched(found[0])} {shows}"
    )


def _between(low: float, high: float) -> str:
    """Clause on a place: between two frequencies, or at one.

    >>> _between(1.0, 1.5), _between(1.5, 1.5 + 1e-9)
    ('between 1 and 1.5', 'at 1.5')
    """
    ends = f"{low:.6g}", f"{high:.6g}"
    return f"at {low:.6g}" if ends[0] == ends[1] else f"between {' and '.join(ends)}"


def _widest_first(stretches: list[list[float]]) -> list[list[float]]:
    return sorted(stretches, key=lambda ends: ends[0] - ends[1])


def _not_searched(curve: Mapping[str, Any]) -> str:
    """Clause on the stretches without a stable motion in which no branch was searched; or ''."""
    missing = _widest_first(curve.get("no_stable_motion_not_looked_at", []))
    if not missing:
        return ""
    widest, count = _between(*missing[0]), len(missing)
    where = widest if count == 1 else f"in {count} of these ranges, the widest {widest}"
    return f" No branch was looked for {where}."


def kept_friction(summary: Mapping[str, Any]) -> str:
    """Caveat on the effect of the residual friction of contacts that never slip; or ''."""
    of_peaks, elsewhere = residual_friction(summary), maybe_not_unique(summary)
    if of_peaks and elsewhere:
        return f"{of_peaks}. {elsewhere[:1].upper()}{elsewhere[1:]}"
    if of_peaks:
        how = _how(summary)
        return f"{of_peaks}: {how} computes how far the motions range" if how else of_peaks
    return f"{_KEEPS}: {elsewhere}" if elsewhere else ""


def maybe_not_unique(summary: Mapping[str, Any]) -> str:
    """Caveat on points where the motion may be one of many, and how to find the others; or ''."""
    followed = [*_completed(summary), *summary.get("tracked", {}).get("curves", ())]
    shown = shown_dofs(summary) if summary["curves"] and "peak" in summary["curves"][0] else []
    one_of_many = [
        curve for curve in followed if curve.get("may_not_be_unique") and not _range_is_known(curve, shown)
    ]
    count = sum(curve["may_not_be_unique"] for curve in one_of_many)
    if not count:
        return ""
    how, of_levels = _how(summary), any("level_folds" in curve for curve in summary["curves"])
    points = f"{count} point{'s' * (count > 1)}"
    tells = f"By how much {_not_estimated(one_of_many, shown)} may differ was not estimated"
    if how:
        tells += f": {how}{', at the level 1,' if of_levels else ''} computes how far the motions range"
    elif any("mode" in curve for curve in summary["curves"]):
        tells += ": a run without --mode estimates it at peaks"
    return f"at {points} the motion may be one of many. {tells}"


def _not_estimated(curves: Sequence[Mapping[str, Any]], shown: Sequence[str]) -> str:
    """Text on the amplitudes of unknown range: some peaks if others are known, else all amplitudes."""
    from fcm.scene.errors import several

    peaks = [(dof, one) for curve in curves for dof, one in curve.get("peak", {}).items() if one]
    known = {dof for dof, one in peaks if dof in shown and one.get("residual_change") is not None}
    unknown = {dof for dof, one in peaks if dof in shown and one.get("residual_change") is None}
    if not known or not unknown or any("level_folds" in curve for curve in curves):
        return "amplitudes"
    return f"the peak{'s' * (len(unknown) > 1)} of {several([dof for dof in shown if dof in unknown])}"


def _completed(summary: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The curves that were not interrupted before the search."""
    return [curve for curve in summary["curves"] if curve.get("cause") != "interrupted"]


def _range_is_known(curve: Mapping[str, Any], shown: Sequence[str]) -> bool:
    """Whether the change by residual friction is known for every shown peak; False for curves over levels."""
    if "level_folds" in curve:
        return False
    peaks = [one for dof, one in curve.get("peak", {}).items() if one and dof in shown]
    return bool(peaks) and all(one.get("residual_change") is not None for one in peaks)


def residual_friction(summary: Mapping[str, Any]) -> str:
    """Caveat on how far peaks may change with the residual friction of contacts that never slip; or ''."""
    open_to_past = [one for one in _completed(summary) if one.get("may_not_be_unique")]
    if not any("peak" in one for one in open_to_past):
        return ""
    shown = shown_dofs(summary)  # one that hardly moves may have any relative change
    curves = [one for one in open_to_past if _range_is_known(one, shown)]
    if not curves:
        return ""
    peaks = [curve["peak"].get(dof) for curve in curves for dof in shown]
    worst = max((one["residual_change"] for one in peaks if one), default=0.0)
    share = share_of(worst)
    every = len(open_to_past)
    where = (
        f"on {len(curves)} of {every} curves " if len(curves) < every else ""
    )  # of the others it is unknown
    if share == "0" and any("shakedown_at" in one for one in curves):
        return ""
    if share == "0":
        told = "it changes none of the greatest peaks. Lower peaks and other points may change"
    else:
        told = f"it may change a greatest peak by up to {share} of it, estimated. "
        told += "Lower peaks and other points may change, too"
    return f"{_KEEPS}: {where}{told}"


def _how(summary: Mapping[str, Any]) -> str:
    """Hint on the option that computes the exact motion at a frequency F.

    It is empty if there is no exact motion, as for a nonlinear mode, which has no forces, or if it takes
    long, as with many contacts.
    """
    from fcm.model.scene import InTime
    from fcm.response.options import SENTENCES as OF_RESPONSE

    if any(
        "mode" in curve or len(curve.get("contacts", ())) > OF_RESPONSE.contacts_in_time
        for curve in summary["curves"]
    ):
        return ""
    if InTime(summary["exact_motion"]) is not InTime.COMPUTED:
        return ""
    return "--at F" if summary["method"] == "exact" else "--method exact --at F"
