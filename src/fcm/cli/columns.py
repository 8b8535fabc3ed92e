"""Columns of a table on a terminal, and the text of their cells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fcm.cli.limits import SENTENCES
from fcm.cli.terminal import plain
from fcm.frozen import Frozen

UNSTABLE = "!"  # beside a peak where the motion is not stable
DOES_NOT_STAY = "unstable: with these harmonics the motion is not stable there, and leaves this peak"
EXACT_DOES_NOT_STAY = "unstable: the motion is not stable there, and leaves this peak"
UNKNOWN = "?"  # beside a motion of unknown stability
STABILITY_UNKNOWN = "stability is unknown there: "
HARMONICS_HELP = "more harmonics may show it"
STABILITY_NOT_YET_KNOWN = "stability is unknown there: the run was interrupted before"


def remedy_of_unknown_stability(summary: Mapping[str, Any]) -> str:
    """Remedy for unknown stability: more harmonics, or a hint on why none was looked for."""
    return 'none is looked for, "left out" says why' if summary.get("without_stability") else HARMONICS_HELP


def aligned(rows: Sequence[Sequence[str]], left: int) -> str:
    """Align the cells in columns: to the right, but the last ``left`` columns to the left."""
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


class DofTable(Frozen):
    """A table with some columns for each degree of freedom.

    The columns stand side by side if a line has room for all. Otherwise each degree of freedom has a line.

    left, right: heads of columns that a row has once. heads: of the columns of a degree of freedom, with {}
    for its name. rows: their cells, (left, one list for each degree of freedom, right).
    """

    left: list[str]
    dofs: list[str]
    heads: list[str]
    right: list[str]
    rows: list[tuple[list[str], list[list[str]], list[str]]]
    width: int = SENTENCES.width

    def text(self, last: int) -> str:
        """Text of the table, with its last `last` columns aligned to the left."""
        beside = self._beside(last)
        return beside if _width(beside) <= self.width else self._below(last)

    def _beside(self, last: int) -> str:
        shown = [
            (d, i)
            for d in range(len(self.dofs))
            for i in range(len(self.heads))
            if any(cells[d][i] != ABSENT for _, cells, _ in self.rows)
        ]
        heads = [self.heads[i].format(self.dofs[d]) for d, i in shown]
        lines = [
            [*left, *("" if cells[d][i] == ABSENT else cells[d][i] for d, i in shown), *right]
            for left, cells, right in self.rows
        ]
        return aligned([[*self.left, *heads, *self.right], *lines], last)

    def _below(self, last: int) -> str:
        shown = [
            i for i in range(len(self.heads)) if any(one[i] for _, cells, _ in self.rows for one in cells)
        ]
        heads = [self.heads[i].format("").replace("  ", " ").strip() for i in shown]
        lines = []
        for left, cells, right in self.rows:
            kept = [(dof, one) for dof, one in zip(self.dofs, cells, strict=True) if any(one)]
            for k, (dof, one) in enumerate(kept):
                own = ["" if one[i] == ABSENT else one[i] for i in shown]
                lines.append([*left, dof, *own, *(right if k == 0 else [""] * len(right))])
        if not self.right:
            # the lines of a row share nothing: sort by degree of freedom
            order = {dof: d for d, dof in enumerate(self.dofs)}
            first = {tuple(left): k for k, (left, _, _) in reversed(list(enumerate(self.rows)))}
            count = len(self.left)
            lines.sort(key=lambda line: (first[tuple(line[:count])], order[line[count]]))
        return aligned([[*self.left, "dof", *heads, *self.right], *lines], last)


def greatest_of(sizes: Sequence[float], curves: int) -> list[int]:
    """Indices, in order, of the greatest rows of a curve, as many as the table has room for.

    >>> greatest_of([3.0, 1.0, 2.0, 5.0], curves=30), len(greatest_of(range(40), curves=1))
    ([0, 2, 3], 12)
    """
    room = max(SENTENCES.of_each_curve, SENTENCES.lines // max(curves, 1))
    return sorted(sorted(range(len(sizes)), key=lambda i: -sizes[i])[:room])


ABSENT = "\0"  # a cell that does not exist, although others of its column do


def _width(text: str) -> int:
    return max(map(len, text.splitlines()))


OVERDAMPED = "+"  # beside a damping ratio by friction that is critical or more
OF_OVERDAMPED = (
    f"{OVERDAMPED} overdamped: the ratio is that of a linear damper with the same loss in a cycle of one "
    "amplitude. Nothing swings freely with it, and no resonance is seen: the response itself has the motion"
)


def ratio(value: float, digits: int = 4) -> str:
    """A damping ratio by friction, with a mark from critical damping on.

    >>> ratio(0.034081), ratio(18.517, 2)
    ('0.03408', '19+')
    """
    return f"{value:.{digits}g}{OVERDAMPED if value >= 1.0 else ''}"


NOT_COMPLETE = "NOT COMPLETE"
BEYOND = "> 100 %"  # an error greater than the quantity itself


def short(value: float | None) -> str:
    """A relative error, two digits, or a dash where it is not known.

    An error beyond 1 is no measure any more, so that its digits are left out.

    >>> short(0.0123), short(1.7), short(None)
    ('1.2e-02', '> 100 %', '-')
    """
    return "-" if value is None else BEYOND if value > 1.0 else f"{value:.1e}"


def most_of(errors: Sequence[float]) -> str:
    """How large errors are, for a sentence.

    >>> most_of([2e-4, 0.01]), most_of([2e-4, 1.7])
    ('at most 1.0e-02', 'up to more than 100 %')
    """
    worst = short(max(errors))
    return "up to more than 100 %" if worst == BEYOND else f"at most {worst}"


def share_of(change: float) -> str:
    """A share in percent, two digits; 0 below a thousandth of a percent, and no digits beyond ten times.

    >>> share_of(0.0234), share_of(1.306), share_of(1e-7), share_of(4200.0)
    ('2.3 %', '130 %', '0', '> 1000 %')
    """
    if change > 10.0:
        return "> 1000 %"
    return f"{float(f'{100.0 * change:.2g}'):g} %" if change >= 1e-5 else "0"


def ranges(harmonics: Sequence[int]) -> str:
    """Harmonics as a range from 1 on, and those beyond it.

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


def not_complete(curves: Sequence[Mapping[str, Any]], names: Sequence[str]) -> list[str]:
    """A line for each reason why curves are not complete, with the first such curve.

    >>> lost = [{"parameters": {"n_0": n}, "complete": False, "reason": "no point"} for n in (1.0, 2.0, 3.0)]
    >>> not_complete([*lost, lost[0] | {"reason": "interrupted"}, {"complete": True}], ["n_0"])
    ['n_0 = 1 and 2 more curves NOT COMPLETE: no point', 'n_0 = 1 NOT COMPLETE: interrupted']
    """
    reasons: dict[str, list[Mapping[str, Any]]] = {}
    for curve in curves:
        if not curve["complete"]:
            reasons.setdefault(curve.get("reason") or "it stopped early", []).append(curve)
    lines = []
    for reason, (first, *others) in reasons.items():
        given = ", ".join(f"{name} = {value}" for name, value in zip(names, swept(first), strict=True))
        more = f" and {len(others)} more curve{'s' * (len(others) > 1)}" if others else ""
        lines.append(f"{given}{more} {NOT_COMPLETE}: {reason}".lstrip())
    return lines


def swept(curve: Mapping[str, Any]) -> list[str]:
    """The values of the swept numbers of a curve of a summary."""
    return [f"{value:.6g}" for value in curve["parameters"].values()]
