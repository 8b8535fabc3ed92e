"""Text tables of a comparison, from its summary, for a terminal and for a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fcm.compare.errors import MEASURES, Shown
from fcm.compare.methods import CLOSED_FORM, EXACT

TextTable = list[list[str]]  # the first is the header
Summary = Mapping[str, Any]
NAMES = {EXACT: "exact periodic motion", CLOSED_FORM: "harmonic balance, closed form"}
HEADS = ["peak", "its freq.", "folds", "points", "curve"]  # of MEASURES
MARKS = {True: "", False: "!", None: "?"}  # beside a peak: stable, unstable, stability unknown
SAID = {"!": "! unstable: the motion does not stay at this peak", "?": "? stability is unknown there"}
DIGITS = 6  # of amplitudes and frequencies


def every(summary: Summary) -> list[TextTable]:
    """All tables that have rows, in order."""
    makers = errors, contributions, peaks, costs, steps, references
    return [rows for rows in (maker(summary) for maker in makers) if len(rows) > 1]


def marked(summary: Summary) -> list[str]:
    """Explanations of the marks beside peaks that occur."""
    marks = {MARKS[one[kind]["stable"]] for one in summary["peaks"] for kind in ("exact", "harmonic")}
    return [text for mark, text in SAID.items() if mark in marks]


def references(summary: Summary) -> TextTable:
    """Table of the references and of their own errors."""
    rows = [["errors of the references themselves", "max. step", *HEADS]]
    for name, one in summary["references"].items():
        own = [one["own_error"][measure] for measure in MEASURES]
        cells = ["-" if value is None else f"{value:.0e}" for value in own]
        rows.append([NAMES[name], f"{one['max_step']:.3g}", *cells])
    return rows


def errors(summary: Summary) -> TextTable:
    """Table of the errors of each method with the scene's own steps."""
    against = main_reference(summary)
    rows = [[f"errors against {NAMES[against]}", "left out", *HEADS]]
    for one in _at_own_step(summary):
        rows.append([one["method"], _left_out(one, summary), *shown(one["against"][against])])
    return rows


def costs(summary: Summary) -> TextTable:
    """Table of the costs of each method with the scene's own steps."""
    header = ["left out", "points", "solve [s]", "CPU [s]", "start [s]", "table [s]", "evaluations"]
    rows = [["costs", *header]]
    for one in _at_own_step(summary):
        seconds = [f"{one[key]:.3f}" for key in ("seconds", "processor_seconds")]
        start = ["-" if one[key] is None else f"{one[key]:.2f}" for key in ("start_seconds", "table_seconds")]
        counts = [str(one["evaluations"])]
        rows.append([one["method"], _left_out(one, summary), str(one["points"]), *seconds, *start, *counts])
    return rows


def _at_own_step(summary: Summary) -> list[Summary]:
    """Runs with the scene's own step; without duplicates where nothing is left out."""
    own = [one for one in in_order(summary["runs"]) if one["max_step"] == summary["max_step"]]
    return [one for one in own if one["corrected"] and (one["left_out"] or summary["left_out"])]


def _left_out(one: Summary, summary: Summary) -> str:
    """Cell that says whether negligible parts were left out, or that there are none."""
    return "no" if not one["left_out"] else "yes" if summary["left_out"] else "nothing"


def contributions(summary: Summary) -> TextTable:
    """Table of the contributions to the error."""
    rows = [["what the error consists of", "against", *HEADS]]
    for what, one in summary["contributions"].items():
        rows.append([what, NAMES[one["against"]], *shown(one)])
    return rows


def peaks(summary: Summary) -> TextTable:
    """Table of the peaks: the true error of the single harmonic, and the estimated truncation error."""
    found = summary["peaks"]
    if not found:
        return []
    unit = summary["frequency_unit"]
    heads = ["exact", f"at {unit}", "harmonic", f"at {unit}", "error", "its freq.", "estimate"]
    rows = [["peak of", *found[0]["parameters"], *heads]]
    for one in found:
        swept = [f"{value:.6g}" for value in one["parameters"].values()]
        pairs = [
            cell
            for kind in ("exact", "harmonic")
            for cell in (
                f"{one[kind]['amplitude']:#.{DIGITS}g}{MARKS[one[kind]['stable']]}",
                f"{one[kind]['frequency']:#.{DIGITS}g}",
            )
        ]
        estimate = one["truncation_error"]
        cells = [f"{one['error']:+.1e}", f"{one['frequency_error']:+.1e}"]
        rows.append([one["dof"], *swept, *pairs, *cells, "-" if estimate is None else f"{estimate:.1e}"])
    return rows


def steps(summary: Summary) -> TextTable:
    """Table of each method over its longest step."""
    against = list(dict.fromkeys((main_reference(summary), CLOSED_FORM)))
    rows = [["over the steps", "max. step", "points", "CPU [s]", *(f"curve, {name}" for name in against)]]
    for one in in_order(summary["runs"]):
        if one["corrected"] and not one["left_out"]:
            continue  # its run with parts left out is listed
        name = one["method"] if one["corrected"] else f"{one['method']}, as it is"
        name += "" if one["complete"] else ", not complete"
        curve = MEASURES.index("curve")
        errors = [shown(one["against"][reference])[curve] for reference in against]
        seconds = f"{one['processor_seconds']:.3f}"
        rows.append([name, f"{one['max_step']:.4g}", str(one["points"]), seconds, *errors])
    return rows


def main_reference(summary: Summary) -> str:
    """The reference of the tables: exact if known for any curve, else the closed form."""
    return EXACT if summary["references"][EXACT]["own_error"]["peak"] is not None else CLOSED_FORM


def in_order(runs: Sequence[Summary]) -> list[Summary]:
    """Runs sorted by method, from long steps to short ones; exact last."""
    names = ["default table", "fast table", *sorted({one["method"] for one in runs}), CLOSED_FORM]

    def place(one: Summary) -> tuple[Any, ...]:
        name = one["method"]
        return name == EXACT, name == CLOSED_FORM, names.index(name), not one["corrected"], -one["max_step"]

    return sorted(runs, key=place)


def shown(one: Summary) -> list[str]:
    """Cells of the errors, or of their upper limits."""
    return [str(Shown(one["errors"][measure], one["below"].get(measure))) for measure in MEASURES]
