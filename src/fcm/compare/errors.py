"""Errors of a run against a reference, and errors of the reference itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from functools import cached_property

import numpy as np

from fcm.compare.distance import Shape, of_curve, of_points, resolution, size_of
from fcm.compare.lines import FloatArray, Line
from fcm.compare.options import COMPARE
from fcm.frozen import Frozen

MEASURES = ("peak", "peak_frequency", "fold", "points", "curve")
MEANINGS = {
    "peak": "amplitude of the peaks, relative",
    "peak_frequency": "frequency of the peaks, relative",
    "fold": "frequencies of the folds, relative; not a number where the numbers of folds differ",
    "points": "distance of the points from the reference curve",
    "curve": "distance of the curve, its points joined by straight lines, from the reference curve",
}
Errors = dict[str, FloatArray]  # of each measure: (curve,)


class Reference(Frozen):
    """Curves to compare others with, and their own error."""

    name: str
    max_step: float
    lines: Sequence[Line]
    own: Errors = field(default_factory=dict)

    @cached_property
    def sizes(self) -> list[FloatArray]:
        """Units of the amplitudes of each curve."""
        return [size_of(line) for line in self.lines]

    @cached_property
    def shapes(self) -> list[Shape]:
        """The curves, smooth between their points."""
        return [Shape(line, size, smooth=True) for line, size in zip(self.lines, self.sizes, strict=True)]

    def errors(self, lines: Sequence[Line]) -> Errors:
        """Errors of the curves of a run; not a number where this reference has no complete curve."""
        rows = [
            _errors(line, own, size, shape) if own.complete and line.points else [np.nan] * len(MEASURES)
            for line, own, size, shape in zip(lines, self.lines, self.sizes, self.shapes, strict=True)
        ]
        return dict(zip(MEASURES, np.array(rows).T, strict=True))


def reference(
    name: str, max_step: float, lines: Sequence[Line], coarser: Sequence[Line], closure: float
) -> Reference:
    """Make a reference whose own error is its difference from a run with longer steps.

    Its own error between points is the greatest distance of that run's points from it, or its `resolution`,
    if that is more. The points of that run lie on the same curve, at other places.

    closure : relative error of each point, the least own error.
    """
    bare = Reference(name, max_step, lines)
    own = bare.errors(coarser)
    resolved = np.array([resolution(line, size) for line, size in zip(lines, bare.sizes, strict=True)])
    own["points"] = own["curve"] = np.maximum(own["points"], resolved)
    return Reference(name, max_step, lines, {key: np.maximum(e, closure) for key, e in own.items()})


def _errors(line: Line, exact: Line, size: FloatArray, reference: Shape) -> list[float]:
    peaks = [(line.peaks[d], exact.peaks[d]) for d in exact.peaks]
    shape = Shape(line, size, smooth=False)
    return [
        max((_relative(one[0], other[0]) for one, other in peaks), default=0.0),
        max((_relative(one[1], other[1]) for one, other in peaks), default=0.0),
        _of_folds(line.folds, exact.folds),
        of_points(shape, reference),
        of_curve(shape, reference),
    ]


def _of_folds(found: Sequence[float], exact: Sequence[float]) -> float:
    if len(found) != len(exact) or not exact:
        return float("nan")
    return max(_relative(one, other) for one, other in zip(found, exact, strict=True))


def _relative(value: float, exact: float) -> float:
    return abs(value - exact) / (abs(exact) if exact else 1.0)


class Shown(Frozen):
    """An error as shown: a value, or an upper limit; both None if there is none."""

    value: float | None = None
    below: float | None = None

    def __str__(self) -> str:
        if self.value is not None:
            return f"{self.value:.1e}"
        return "-" if self.below is None else f"< {self.below:.0e}"


def worst(errors: FloatArray, own: FloatArray, margin: float = COMPARE.margin) -> Shown:
    """The greatest error of the curves; an upper limit if it is below `margin` times the reference's own."""
    known = np.isfinite(errors) & np.isfinite(own)
    if not known.any():
        return Shown()
    limit = margin * own[known]
    clear = errors[known] >= limit
    value = float(errors[known][clear].max(initial=0.0))
    below = float(limit[~clear].max(initial=0.0))
    return Shown(value=value) if value > 0.0 and value >= below else Shown(below=_up(below))


def _up(limit: float) -> float:
    """The limit rounded up to one digit."""
    if limit == 0.0:
        return 0.0
    power = 10.0 ** np.floor(np.log10(limit))
    return float(np.ceil(limit / power * (1.0 - 1e-12)) * power)
