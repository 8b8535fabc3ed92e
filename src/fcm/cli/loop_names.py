"""Names of the parameters of drawn loops, in a picture and in a message, with known units."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from fcm.units import unit_of_number

if TYPE_CHECKING:
    from fcm.cli.loop_cases import Case, NormalCase

WIDE, NARROW, IN_A_ROW = 110, 50, 26  # characters of a title: two columns, one column, one loop of several
_SYMBOL = {
    "n0_bar": r"$\bar{n}_0$", "b_bar": r"$\bar{b}$", "mu": r"$\mu$", "k_u": "$k_u$", "k_v": "$k_v$",
    "n_0": "$n_0$", "a": "$a$", "b": "$b$",
}  # fmt: skip


class Harmonic(NamedTuple):
    """A harmonic of the motion beside the fundamental: amplitude sin(order theta + phase)."""

    motion: str  # u or v
    order: int
    amplitude: float
    phase: float  # [rad]

    def name(self, length: str) -> Name:
        """Name of the harmonic in a picture and in a message, with the unit of length if there is one."""
        phase = f"at {math.degrees(self.phase):.4g}°"
        plain = f"= {_with_unit(f'{self.amplitude:.4g}', length)} {phase}"
        drawn = plain.replace("-", "−").replace("$", r"\$")
        return Name(f"${self.motion}_{{{self.order}}}$ {drawn}", f"{self.motion}_{self.order} {plain}")


class Name(NamedTuple):
    """A parameter with its value, in a picture and in a message."""

    drawn: str
    plain: str
    in_message: bool = True


def titles(cases: Sequence[Case | NormalCase]) -> tuple[str, list[str]]:
    """Title of a picture, with what all loops share, and titles of the panels, with what differs."""
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
    """The names in lines of at most `most` characters, unless a name alone is longer."""
    lines: list[list[Name]] = []
    for name in (name for name in names if name.plain):
        if lines and sum(len(one.plain) + 2 for one in lines[-1]) + len(name.plain) <= most:
            lines[-1].append(name)
        else:
            lines.append([name])
    return [", ".join(one.drawn for one in line) for line in lines]


def named(key: str, value: float, unit: str = "") -> Name:
    number = f"{value:.4g}"
    drawn = f"{_SYMBOL[key]} = {number}".replace("-", "−")
    return Name(_with_unit(drawn, unit.replace("$", r"\$")), _with_unit(f"{key} = {number}", unit))


def _with_unit(text: str, unit: str) -> str:
    return f"{text} {unit}" if unit else text


def unit_of(key: str, units: tuple[str, str] | None) -> str:
    """Unit of a parameter of a contact, from units of length and force; empty without these."""
    length, force = units or ("", "")
    return length if key in ("a", "b") else unit_of_number(f"contact.{key}", length, force, "")


def phase_of(phi: float) -> Name:
    from fcm.plot.plane import phase_name

    drawn = phase_name(phi)
    return Name(drawn, drawn.replace(r"$\phi$", "phi"))
