"""Columns of a table on a terminal, and what stands in their cells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fcm.cli.terminal import plain

UNSTABLE = "!"  # beside a peak where the motion is not stable
DOES_NOT_STAY = (
    "unstable: with these harmonics the motion is not stable there, and does not stay at this peak"
)
UNKNOWN = "?"  # beside that of which it is not told whether it is stable


def aligned(rows: Sequence[Sequence[str]], left: int) -> str:
    """Columns of equal width: numbers to the right, the last ``left`` to the left."""
    rows = [[plain(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    right = len(widths) - left
    lines = (
        "  ".join(
            cell.rjust(width) if i < right else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in rows
    )
    return "\n".join(line.rstrip() for line in lines)


BEYOND = "> 100 %"  # an error that is greater than what it is the error of


def short(value: float | None) -> str:
    """A relative error, two digits, or a dash where it is not known.

    Beyond 1 it is no measure any more, and its digits tell nothing.

    >>> short(0.0123), short(1.7), short(None)
    ('1.2e-02', '> 100 %', '-')
    """
    return "-" if value is None else BEYOND if value > 1.0 else f"{value:.1e}"


def share_of(change: float) -> str:
    """A share in percent, two digits; 0 below a thousandth of a percent.

    >>> share_of(0.0234), share_of(1.306), share_of(1e-7)
    ('2.3 %', '130 %', '0')
    """
    return f"{float(f'{100.0 * change:.2g}'):g} %" if change >= 1e-5 else "0"


def ranges(harmonics: Sequence[int]) -> str:
    """Harmonics as a range and those beyond it.

    >>> ranges([1]), ranges([1, 2, 3]), ranges([1, 2, 3, 9])
    ('1', '1-3', '1-3,9')
    """
    last = next(i for i in range(len(harmonics), 0, -1) if list(harmonics[:i]) == list(range(1, i + 1)))
    first = "1" if last == 1 else f"1-{last}"
    return ",".join([first, *(str(h) for h in harmonics[last:])])


def stopped_early(stopped: int, count: int, what: str = "curve") -> str:
    """How many of a run stopped early; empty if none.

    >>> stopped_early(1, 1), stopped_early(1, 20), stopped_early(2, 20, "schedule"), stopped_early(0, 3)
    ('the curve stopped early', '1 of 20 curves stopped early', '2 of 20 schedules stopped early', '')
    """
    if not stopped:
        return ""
    return f"the {what} stopped early" if count == 1 else f"{stopped} of {count} {what}s stopped early"


def number(value: float | None) -> str:
    """Six digits, or a dash for a number that does not exist."""
    return "-" if value is None else f"{value:#.6g}"


def swept(curve: Mapping[str, Any]) -> list[str]:
    """The values of the swept numbers of a curve of a summary."""
    return [f"{value:.6g}" for value in curve["parameters"].values()]
