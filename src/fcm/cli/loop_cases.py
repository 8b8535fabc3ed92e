"""The loops that ``fcm plot loop`` draws: of parameters, or of points of a response; names and numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from fcm.cli.drawing import shorten

if TYPE_CHECKING:
    from fcm.contact import Loop
    from fcm.plot.loop_file import LoopPoint

WIDE, NARROW, IN_A_ROW = 110, 50, 26  # characters of a title: of two columns, of one, of one loop of several
LONGEST = 24  # characters of a contact's name
_SYMBOL = {
    "n0_bar": r"$\bar{n}_0$", "b_bar": r"$\bar{b}$", "mu": r"$\mu$", "k_u": "$k_u$", "k_v": "$k_v$",
    "n_0": "$n_0$", "a": "$a$", "b": "$b$",
}  # fmt: skip


class Name(NamedTuple):
    """A parameter with its value, in a picture and in a message."""

    drawn: str
    plain: str


@dataclass(frozen=True)
class Case:
    """A loop; its parameters as they are named in a picture, and what else is to be said of it."""

    loop: Loop
    names: tuple[Name, ...]  # one for each parameter, the same in every case
    note: str = ""
    amplitude: float = 1.0  # a
    force: float = 1.0  # k_u a
    facts: dict[str, Any] = field(default_factory=dict)  # for --json

    def record(self, from_greatest: bool) -> dict[str, Any]:
        """What ``--json`` prints of the loop; displacements and forces are divided by a and k_u a."""
        from fcm.contact import fourier_coefficients
        from fcm.contact.sampled import shown_degrees, transitions

        loop = self.loop
        coefficients = fourier_coefficients(loop.n0_bar, loop.b_bar, loop.phi)
        return {
            **self.facts,
            "n0_bar": loop.n0_bar,
            "b_bar": loop.b_bar,
            "phi": loop.phi,
            "sequence": loop.sequence,
            "transitions": [
                {
                    "from": one.states[0],
                    "to": one.states[1],
                    "degrees": shown_degrees(one.theta, from_greatest),
                    "displacement": one.displacement,
                    "force": one.force,
                }
                for one in transitions(loop)
            ],
            **{name: float(F) for name, F in zip(("F_b", "F_s", "F_c"), coefficients, strict=True)},
        }


def of_ratios(n0_bars: Iterable[float], b_bars: Iterable[float], phases: Iterable[float]) -> list[Case]:
    """Every combination of dimensionless parameters."""
    from fcm.contact import hysteresis_loop

    cases = []
    for n0_bar, b_bar, phi in product(n0_bars, b_bars, phases):
        names = (_named("n0_bar", n0_bar), _named("b_bar", b_bar), _phase(phi))
        cases.append(Case(hysteresis_loop(n0_bar, b_bar, phi), names))
    return cases


def of_contact(values: dict[str, Sequence[float]], phases: Iterable[float]) -> list[Case]:
    """Every combination of mu, k_u, k_v, n_0, a, b and phase of one contact."""
    from fcm.contact import hysteresis_loop

    cases = []
    for *numbers, phi in product(*values.values(), phases):
        one = dict(zip(values, numbers, strict=True))
        force = one["k_u"] * one["a"]
        n0_bar, b_bar = (
            one["mu"] * load / force if force else math.inf for load in (one["n_0"], one["k_v"] * one["b"])
        )
        if not (math.isfinite(n0_bar) and math.isfinite(b_bar)):
            raise click.UsageError(
                f"mu n_0 / (k_u a) = {n0_bar:g} and mu k_v b / (k_u a) = {b_bar:g} have to be finite."
            )
        names = (*(_named(key, value) for key, value in one.items()), _phase(phi))
        cases.append(
            Case(hysteresis_loop(n0_bar, b_bar, phi), names, amplitude=one["a"], force=force, facts=one)
        )
    return cases


def of_file(
    path: Path,
    curves: Sequence[int | None],
    contact: str | None,
    at: Sequence[float | None],
    solution: int | None,
) -> list[Case]:
    """The loops of a contact on curves of a response file, at frequencies."""
    from fcm.plot.loop_file import points_at, read_loops

    file = read_loops(path)
    cases = []
    for curve, frequency in product(curves, at):
        points = points_at(file, curve, contact, frequency)
        if solution is not None and solution > len(points):
            raise click.UsageError(f"--solution {solution}: there are {len(points)} at this frequency.")
        for point in points if solution is None else points[solution - 1 : solution]:
            cases.append(_at_point(point, file.unit))
    return cases


def _at_point(point: LoopPoint, unit: str) -> Case:
    from fcm.contact import hysteresis_loop
    from fcm.plot.labels import curve_label

    symbol = "$f$" if unit == "Hz" else r"$\omega$"
    at = f"{point.frequency:.5g} {unit}"
    swept = ", ".join(f"{key} = {value:g}" for key, value in point.parameters.items())
    names = (
        Name(shorten(point.contact, LONGEST).replace("$", r"\$"), point.contact),
        Name(curve_label(point.parameters), swept),
        Name(f"{symbol} = {at}", at),
    )
    several = f"{point.solution} of {point.solutions}, " if point.solutions > 1 else ""
    stable = {True: "stable", False: "unstable", None: ""}[point.stable]
    facts = {
        "curve": point.curve, "parameters": point.parameters, "contact": point.contact,
        "frequency": point.frequency, "solution": point.solution, "solutions": point.solutions,
        "stable": point.stable, "a": point.amplitude, "k_u a": point.force,
    }  # fmt: skip
    loop = hysteresis_loop(point.n0_bar, point.b_bar, point.phi)
    return Case(loop, names, (several + stable).strip(", "), point.amplitude, point.force, facts)


def titles(cases: Sequence[Case]) -> tuple[str, list[str]]:
    """What all loops share, for the picture; what tells each from the others, for its panel."""
    columns = list(zip(*(case.names for case in cases), strict=True))
    shared = {column[0] for column in columns if len(set(column)) == 1}
    several = len(cases) > 1
    common = _lines([column[0] for column in columns if column[0] in shared], WIDE if several else NARROW)
    panels = []
    for case in cases:
        own = [name for name in case.names if name not in shared]
        lines = _lines([*own, Name(case.note, case.note)], IN_A_ROW if several else NARROW)
        panels.append("\n".join([*lines, case.loop.sequence]))
    return "\n".join(common), panels


def _lines(names: Iterable[Name], most: int) -> list[str]:
    """The names in lines of at most so many characters, if each is short enough."""
    lines: list[list[Name]] = []
    for name in (name for name in names if name.plain):
        if lines and sum(len(one.plain) + 2 for one in lines[-1]) + len(name.plain) <= most:
            lines[-1].append(name)
        else:
            lines.append([name])
    return [", ".join(one.drawn for one in line) for line in lines]


def _named(key: str, value: float) -> Name:
    number = f"{value:.4g}"
    return Name(f"{_SYMBOL[key]} = {number}".replace("-", "−"), f"{key} = {number}")


def _phase(phi: float) -> Name:
    from fcm.plot.plane import phase_name

    drawn = phase_name(phi)
    return Name(drawn, drawn.replace(r"$\phi$", "phi"))
