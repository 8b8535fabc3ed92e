"""One line on a response: whether it is complete, its peaks stable, and how large their errors are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fcm.cli import schedule, track
from fcm.cli.columns import most_of, short
from fcm.cli.curves import incomplete, shown_dofs, visited_frequencies
from fcm.cli.limits import SENTENCES
from fcm.model.question import MissingModes

_UNSURE = ("folds_unsure_at", "branches_unsure_at", "symmetry_lost_at")  # of curves


def verdict(summary: Mapping[str, Any], remarks: int) -> str:
    """Line on the peaks shown in the tables, and the number of remarks above it; empty for a schedule only.

    For nonlinear modes, which have no peaks, it is on the errors of amplitudes along them.

    Examples
    --------
    >>> peak = {"amplitude": 1.0, "error": 2e-4, "stable": True}
    >>> curve = {"complete": True, "points": 9, "parameters": {}, "peak": {"u": peak}}
    >>> verdict({"curves": [curve]}, 0)
    'result: complete; every peak shown is stable; errors of peaks are at most 2.0e-04'
    >>> verdict({"curves": [curve | {"folds_unsure_at": [1.0]}]}, 1).split(";")[0]
    'result: complete, but branches may be missing'
    >>> doubtful = curve | {"peak": {"u": peak | {"error": 0.4}}}
    >>> verdict({"curves": [doubtful]}, 0).split(";")[0]
    'result: complete, but not to be relied on: peaks err too much'
    >>> verdict({"curves": [curve], "histories": [{"complete": False}]}, 0).split(";")[0]
    'result: the schedule stopped early'
    >>> other = curve | {"complete": False, "peak": {"u": peak | {"stable": None, "error": None}}}
    >>> verdict({"curves": [curve, other]}, 2)  # doctest: +NORMALIZE_WHITESPACE
    'result: 1 of 2 curves stopped early; of 2 peaks shown, 1 of unknown stability;
    errors of peaks are at most 2.0e-04, 1 unknown; 2 remarks on it above'
    """
    curves: Sequence[Mapping[str, Any]] = summary["curves"]
    tracked = track.in_short(summary)
    if not curves and not tracked:
        return ""
    unsure = any(curve.get(key) for curve in curves for key in _UNSURE)
    ends = incomplete(summary), schedule.incomplete(summary.get("histories", []))
    but = ["branches may be missing"] * unsure + _of_doubtful(curves, shown_dofs(summary) if curves else [])
    parts = [" and ".join(filter(None, ends)) or "complete"]
    if but:
        parts[0] += f", but {', and '.join(but)}"
    if tracked:
        parts = tracked
    elif any("mode" in curve for curve in curves):
        parts.append(_of_modes(curves))
    elif peaks := _shown(summary):
        visited = visited_frequencies(curves)
        parts += [f"greatest of {visited}, and no peak"] if visited else []
        what = "motion" if visited else "peak"
        parts += [_of_stability(peaks, what), _of_errors(summary, peaks)]
    elif any(curve["points"] for curve in curves):
        parts.append("nothing moves")
    if any(one["kind"] == "bound" for one in summary.get("optimum", ())):
        parts.append("the optimum is at a bound")
    if remarks:
        parts.append(f"{remarks} remark{'s' * (remarks > 1)} on it above")
    return f"result: {'; '.join(parts)}"


def _of_doubtful(curves: Sequence[Mapping[str, Any]], dofs: Sequence[str]) -> list[str]:
    """Clause on curves whose greatest peaks have errors too large to rely on; none if there are none."""
    errors = [[(curve["peak"].get(dof) or {}).get("error") or 0.0 for dof in dofs] for curve in curves]
    doubtful = sum(max(every, default=0.0) > SENTENCES.unreliable_error for every in errors)
    if not doubtful:
        return []
    of = f" of {doubtful} of {len(curves)} curves" if len(curves) > 1 else ""
    return [f"not to be relied on: peaks{of} err too much"]


def _shown(summary: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Peaks of the degrees of freedom that the tables show, those at rest left out."""
    found, dofs = [], shown_dofs(summary)
    for curve in summary["curves"]:
        for dof in dofs:
            highest = [curve["peak"].get(dof) or {}]
            found += [one for one in curve.get("peaks", {}).get(dof) or highest if one.get("amplitude")]
    return found


def _of_stability(peaks: Sequence[Mapping[str, Any]], what: str = "peak") -> str:
    """Part of the line on the stability of peaks and on their places."""
    counts = {
        "unstable": sum(one.get("stable", True) is False for one in peaks),
        "of unknown stability": sum(one.get("stable", True) is None for one in peaks),
    }
    places = {
        "on an isolated branch": sum(bool(one.get("on_isolated_branch")) for one in peaks),
        "at an end of the range": sum(bool(one.get("at_edge")) for one in peaks),
    }
    told = [f"{count} {which}" for which, count in (counts | places).items() if count]
    if not any(counts.values()):
        return ", ".join([f"every {what} shown is stable", *told])
    return ", ".join([f"of {len(peaks)} {what}{'s' * (len(peaks) > 1)} shown", *told])


def _of_modes(curves: Sequence[Mapping[str, Any]]) -> str:
    """Part of the line on the errors of amplitudes along nonlinear modes, where these are known."""
    followed = [one for one in curves if one.get("mode")]
    told = [one["truncation_error"] for one in followed if one["truncation_error"] is not None]
    points = sum(one["points"] for one in followed)
    unknown = points - sum(one["mode"]["error_known"]["points"] for one in followed)
    if not told:
        return "errors of amplitudes are unknown"
    of = f", unknown at {unknown} of {points} points" if unknown else ""
    return f"errors of amplitudes are {most_of(told)}{of}"


def _of_errors(summary: Mapping[str, Any], peaks: Sequence[Mapping[str, Any]]) -> str:
    """Part of the line on the errors of peaks; for exact motions, on the closure error of their periods."""
    if summary.get("method") == "exact":
        closure = [one["closure_error"] for one in summary["curves"] if one.get("closure_error") is not None]
        closes = f"periods close to {short(max(closure))}" if closure else "errors unknown"
        return f"{closes}{', errors by modes left out are unknown' * lacks_modes(summary)}"
    told = [one["error"] for one in peaks if one.get("error") is not None]
    if not told:
        return "errors of peaks are unknown"
    unknown = len(peaks) - len(told)
    but = " by harmonics left out, unknown by modes left out" * lacks_modes(summary)
    return f"errors of peaks are {most_of(told)}{but}{f', {unknown} unknown' * bool(unknown)}"


def lacks_modes(summary: Mapping[str, Any]) -> bool:
    """Whether modes within the range are not kept, so that peaks err by more than is estimated."""
    return any(isinstance(note, MissingModes) for note in summary.get("notes", ()))
