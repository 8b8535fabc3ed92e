"""``fcm respond --mode``: frequency and damping of a mode against its amplitude."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import click

from fcm.cli.columns import (
    BEYOND,
    NOT_COMPLETE,
    OF_OVERDAMPED,
    OVERDAMPED,
    aligned,
    not_complete,
    number,
    ranges,
    ratio,
    share_of,
    short,
    swept,
)
from fcm.cli.limits import SENTENCES
from fcm.rotational_dofs import dof_unit, greatest_first

OF_NO_USE = {  # options of no use with --mode, and the reasons
    "method": "modes are followed by harmonic balance",
    "table": "their forces are exact",
    "tolerance": "nothing is left out",
    "keep_all": "nothing is left out",
    "history_csv": "no schedule is simulated",
}


def check_options(
    mode: int | None,
    level: tuple[float, float] | None,
    at: tuple[float, ...] | None,
    force_levels: tuple[float, ...],
) -> None:
    """Raise a usage error if --mode lacks its span, or is combined with options of no use with it."""
    if mode is None and force_levels:
        raise click.UsageError("--force-level needs --mode: from a nonlinear mode it predicts the response.")
    if mode is None:
        return
    if level is None:
        raise click.UsageError(
            "--mode needs --level FROM:TO, the modal amplitudes over which it is followed."
        )
    if not level[0] > 0.0:
        raise click.UsageError(
            "--mode needs a --level that begins above 0, as 1e-5:1e-3: amplitudes are followed by their "
            "ratio."
        )
    if at is not None:
        raise click.UsageError("--at is of no use with --mode: a mode has a frequency of its own.")
    context = click.get_current_context()
    for name, why in OF_NO_USE.items():
        if context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
            (option,) = (param.opts[-1] for param in context.command.params if param.name == name)
            raise click.UsageError(f"{option} is of no use with --mode: {why}.")


def as_table(summary: Mapping[str, Any], names: list[str], unit: str) -> str:
    """Table with a line for each mode: its ends, greatest damping, and resonances with the scene's forces."""
    wide = _lines(summary, names, unit, ["points", "time [s]"])
    fits = max(map(len, wide.splitlines())) <= SENTENCES.width
    table = wide if fits else _lines(summary, names, unit, [])
    curves = summary["curves"]
    every = ((curve.get("mode") or {}).get("not_met", ()) for curve in curves)
    unmet = Counter(f"force level {one['level']:g}: {one['why']}" for found in every for one in found)
    of = f" of {len(curves)} curves" if len(curves) > 1 else ""
    told = [_of_dofs(summary), *(f"{what}, in {count}{of}" if of else what for what, count in unmet.items())]
    if any(" the modal amplitude " in what for what in unmet):
        told.append("a wider --level FROM:TO, which is of modal amplitudes, has these resonances")
    if any((curve.get("truncation_error") or 0.0) > 1.0 for curve in curves):
        told.append(f"{BEYOND} the error is more than the amplitude: give more by --harmonics")
    modes = [curve["mode"] for curve in curves if curve.get("mode")]
    if any(ratio(one["greatest_damping"]["damping"]).endswith(OVERDAMPED) for one in modes):
        told.append(OF_OVERDAMPED)
    told += not_complete(curves, names)
    lines = "\n".join([table, *filter(None, told)])
    return "\n\n".join(filter(None, [lines, _in_resonance(summary, names, unit)]))


def _lines(summary: Mapping[str, Any], names: list[str], unit: str, cost: list[str]) -> str:
    """The table; `cost` are the columns on the cost of a curve, if any."""
    broken = [""] if any(not curve["complete"] for curve in summary["curves"]) else []
    header = [*names, f"frequency {unit}", f"to {unit}", "damping", "to", "greatest", f"at {unit}",
              "harmonics", "error", *cost, f"resonances at {unit}", *broken]  # fmt: skip
    rows = []
    for curve in summary["curves"]:
        mode = curve.get("mode")
        state = [NOT_COMPLETE if not curve["complete"] else ""] if broken else []
        if mode is None:
            rows.append([*swept(curve), *["-"] * (len(header) - len(names) - len(broken)), *state])
            continue
        top = mode["greatest_damping"]
        rows.append(
            [
                *swept(curve),
                *map(number, mode["frequency"]),
                *map(ratio, mode["damping"]),
                ratio(top["damping"]),
                number(top["frequency"]),
                ranges(curve["harmonics"]),
                short(curve["truncation_error"]),
                *([str(curve["points"]), f"{curve['seconds']:.3f}"] if cost else []),
                "  ".join(
                    f"{number(one['frequency'])} (level {one['level']:g})" for one in mode["resonances"]
                )
                or "none",
                *state,
            ]
        )
    return aligned([header, *rows], left=1 + len(broken))


def outside_range(summary: Mapping[str, Any]) -> str:
    """Caveat that a mode has no frequency within the scene's range, and may not be the one meant; or ''."""
    modes = [curve["mode"] for curve in summary["curves"] if curve.get("mode")]
    if not modes or "range" not in summary:
        return ""
    low, high = summary["range"]
    away = [one for one in modes if max(one["frequency"]) < low or min(one["frequency"]) > high]
    if not away:
        return ""
    unit, (first, last) = summary["frequency_unit"], sorted(away[0]["frequency"])
    on = f" on {len(away)} of {len(modes)} curves" if len(modes) > 1 else ""
    return (
        f"mode {away[0]['number']} goes from {first:.6g} to {last:.6g} {unit}{on}, outside the scene's range "
        f"of {low:.6g} to {high:.6g} {unit}: is another --mode meant?"
    )


def internal_resonance(summary: Mapping[str, Any]) -> str:
    """Caveat on modal amplitudes at which higher harmonics have much of a mode's power; or ''."""
    modes = [curve["mode"] for curve in summary["curves"] if curve.get("mode")]
    found = [mode for mode in modes if mode.get("internal_resonance")]
    if not found:
        return ""
    one = max((mode["internal_resonance"] for mode in found), key=lambda one: one["share"])
    unit, (low, high) = summary["frequency_unit"], one["modal_amplitude"]
    on = f" on {len(found)} of {len(modes)} curves" if len(modes) > 1 else ""
    slow, fast = (f"{value:.5g}" for value in one["frequency"])
    where = f"at {slow}" if slow == fast else f"between {slow} and {fast}"
    return (
        f"internal resonance{on}: {where} {unit} (modal amplitudes {low:.3g} to {high:.3g}) up to "
        f"{share_of(one['share'])} of the mode's power is in further harmonics, most in {one['harmonic']}. "
        "Its damping there may be off by a factor, as forces do no work on these harmonics. fcm respond "
        "without --mode has the response"
    )


def _in_resonance(summary: Mapping[str, Any], names: list[str], unit: str) -> str:
    """Table of resonances with the scene's forces: frequency, damping, amplitudes; empty if none."""
    dofs, length = _shown(summary), summary.get("units", {}).get("length", "")
    rows = [
        [
            *swept(curve),
            f"{one['level']:g}",
            number(one["frequency"]),
            f"{one['damping']:.4g}",
            number(one["modal_amplitude"]),
            *(number(one["amplitude"][dof]) for dof in dofs),
        ]
        for curve in summary["curves"]
        for one in (curve.get("mode") or {}).get("resonances", ())
    ]
    if not rows:
        return ""
    each = [f"{dof} [{own}]" if (own := dof_unit(dof, length)) else dof for dof in dofs]
    header = [*names, "level", f"at {unit}", "damping", "modal amplitude", *each]
    peakless = any(row[len(names) + 1] == "-" for row in rows)
    return (
        "in resonance with the scene's forces, times the level:\n"
        + aligned([header, *rows], left=0)
        + ("\n- no peak over the frequency: damped by more than 0.71" if peakless else "")
        + "\nthese are estimates, as if the mode alone answered; their error is not among those told. The "
        "more it is damped the worse they are: at 0.1 they may be double. fcm respond without --mode has "
        "the response"
    )


def _shown(summary: Mapping[str, Any]) -> list[str]:
    """The degrees of freedom that fit on a line: those that move most in the mode.

    They are among those that the scene asks for, if any.
    """
    first = next((curve["mode"] for curve in summary["curves"] if curve.get("mode")), None)
    if first is None:
        return []
    asked = summary.get("output", ())
    moved = {dof: value for dof, value in first["displacement"].items() if not asked or dof in asked}
    dofs = list(moved)
    return [dofs[d] for d in sorted(greatest_first(dofs, list(moved.values()))[: SENTENCES.named])]


def _of_dofs(summary: Mapping[str, Any]) -> str:
    """Remark on the displacements at a modal amplitude of 1, which help to choose its span; or ''."""
    first = next((curve["mode"] for curve in summary["curves"] if curve.get("mode")), None)
    if first is None:
        return ""
    moved, length = first["displacement"], summary.get("units", {}).get("length", "")
    each = (f"{dof} {moved[dof]:.4g} {dof_unit(dof, length)}".rstrip() for dof in _shown(summary))
    return f"a modal amplitude of 1 means, at the least that was followed: {', '.join(each)}"
