"""Curves that stopped early: a cross where each ends, and why, above the axes."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.plot.style import LAYOUT
from fcm.plot.summary import summary_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = npt.NDArray[np.float64]
COLOUR = "#c03020"
NO_SPAN = (np.nan, np.nan)


class Unfinished(Frozen):
    """Reasons why curves of a file are unfinished, in their order."""

    reasons: tuple[str, ...] = ()  # (curve,) empty where a curve is whole
    span: tuple[float, float] = (
        NO_SPAN  # range sought, in the file's unit; NaN where the file does not say it
    )
    fit: str = ""  # why the numbers of a fit are not final; empty if they are, or there are none

    def reason(self, number: int) -> str:
        """Why a curve ends early; empty if it does not."""
        return self.reasons[number] if number < len(self.reasons) else ""


def unfinished_of(data: Any) -> Unfinished:
    """Unfinished parts of an open file; none for a file without `complete`."""
    if "complete" not in data.variables:
        return Unfinished()
    whole = np.atleast_1d(np.ma.filled(np.ma.asarray(data.variables["complete"][:], dtype=float), 1.0)) == 1.0
    found = summary_of(data)
    fit = _of_fit(found.get("fitted"))
    if whole.all():
        return Unfinished(("",) * whole.size, fit=fit)
    curves = found.get("curves") or [{}] * whole.size
    if not isinstance(curves, list) or not all(isinstance(one, dict) for one in curves):
        raise ValueError("its attribute summary is not of curves")
    reasons = [str(one.get("reason") or "stopped early") for one in curves] + [""] * whole.size
    span = found.get("range") or NO_SPAN
    return Unfinished(
        tuple("" if done else reason for done, reason in zip(whole.tolist(), reasons, strict=False)),
        (float(span[0]), float(span[1])),
        fit,
    )


def _of_fit(fitted: Any) -> str:
    """Why the numbers of a fit are not final.

    >>> _of_fit({"final": False}), _of_fit({"final": True, "settled": False}), _of_fit(None)
    ('interrupted: the numbers are the best so far', 'its search stopped before a minimum', '')
    """
    if not isinstance(fitted, dict):
        return ""
    if not fitted.get("final", True):
        return "interrupted: the numbers are the best so far"
    return "" if fitted.get("settled", True) else "its search stopped before a minimum"


def open_ends(x: FloatArray, y: FloatArray, span: tuple[float, float]) -> list[int]:
    """Ends of an unfinished curve: ends of branches neither at the span's ends nor on another branch.

    A closed branch has no end. Without a span only the last point of each branch is considered.

    >>> x = np.array([1.0, 1.5, np.nan, 3.0, 2.5])
    >>> open_ends(x, x, (1.0, 3.0)), open_ends(x, x, (np.nan, np.nan))
    ([1, 4], [1, 4])
    >>> open_ends(x, x, (1.0, 1.5))
    [3, 4]
    """
    there = np.isfinite(x) & np.isfinite(y)
    if not there.any():
        return []
    edges = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])))).reshape(-1, 2)
    width, height = float(np.ptp(x[there])) or 1.0, float(y[there].max()) or 1.0
    found, known = [], bool(np.isfinite(span[0]))
    for first, last in (edges - (0, 1)).tolist():
        for k in sorted({first, last}) if known else [last]:
            near = np.hypot((x - x[k]) / width, (y - y[k]) / height) < LAYOUT.same_end
            near[first : last + 1] = first != last and near[first + last - k]
            at_end = known and np.isclose(x[k], span, rtol=LAYOUT.same_end, atol=0.0).any()
            if not at_end and not near.any():
                found.append(k)
    return found


def mark_unfinished(axes: Axes, curves: Sequence[tuple[FloatArray, FloatArray]], told: Unfinished) -> None:
    """Draw a cross where each unfinished curve ends; the axis then covers the whole range sought."""
    for number, (x, y) in enumerate(curves):
        if told.reason(number) and (ends := open_ends(x, y, told.span)):
            axes.plot(
                x[ends],
                y[ends],
                "x",
                color=COLOUR,
                markersize=5.0,
                clip_on=False,
                zorder=5,
                label="_unfinished",
            )
    if any(told.reasons) and np.isfinite(told.span[0]):
        axes.update_datalim([(end, 0.0) for end in told.span], updatey=False)
        axes.autoscale_view()


def say_unfinished(axes: Axes, told: Unfinished) -> None:
    """Write above the axes that curves are unfinished, and why; nothing if all are complete."""
    if said := sentence(told):
        width = axes.get_figure().get_size_inches()[0] * LAYOUT.letters_of_inch  # type: ignore[union-attr]
        lines = textwrap.wrap(said, int(width), max_lines=LAYOUT.lines_above, placeholder=" ...")
        axes.set_title(
            "\n".join(lines), loc="left", fontsize=LAYOUT.small_text, color=COLOUR, parse_math=False
        )


def sentence(told: Unfinished) -> str:
    """Sentence that curves or a fit are unfinished, with the first curve's reason; empty if none is.

    >>> sentence(Unfinished(("", "")))
    ''
    >>> sentence(Unfinished(("stopped at 1.2 Hz: no further point could be found",)))
    'NOT COMPLETE: stopped at 1.2 Hz: no further point could be found'
    >>> sentence(Unfinished(("", "interrupted before it was traced", "")))
    'NOT COMPLETE: 1 of 3 curves; the first: interrupted before it was traced'
    >>> sentence(Unfinished(("",), fit="its search stopped before a minimum"))
    'FIT NOT COMPLETE: its search stopped before a minimum'
    """
    reasons, count = [one for one in told.reasons if one], len(told.reasons)
    said = [f"FIT NOT COMPLETE: {told.fit}"] if told.fit else []
    if reasons:
        which = "" if count == 1 else f"{len(reasons)} of {count} curves; the first: "
        said.append(f"NOT COMPLETE: {which}{reasons[0]}")
    return ". ".join(said)
