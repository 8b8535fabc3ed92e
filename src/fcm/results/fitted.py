"""Result of a fit to measured data: numbers with errors, residuals of the data, and caveats."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Measured
from fcm.quoting import listed
from fcm.units import in_unit

_EACH = "are", "their standard errors are"
Pair = tuple[int, int, float]  # two numbers i, j that are determined only as i times j to the power p


def _told(one: str, other: str, power: float) -> str:
    """The combination of two numbers that the data determine.

    >>> _told("mu", "n_0", 1.0), _told("mu", "n_0", -1.0), _told("mu", "n_0", 0.52)
    ('mu * n_0', 'mu / n_0', 'mu * n_0^0.52')
    """
    written = f"{abs(power):.2g}"
    return f"{one} {'*' if power > 0.0 else '/'} {other}{'' if written == '1' else f'^{written}'}"


def misfit(data: Measured, residual: FloatArray, error: FloatArray) -> float:
    """Root mean square distance of the data, relative to the greatest amplitude.

    For a backbone it is that of the frequencies, relative to them. For the arrays see `FittedData`."""
    square = residual[:, 0] ** 2 if data.damping is not None else (residual**2).sum(axis=1)
    size = data.frequency if data.damping is not None else data.amplitude.max()
    return float(np.sqrt((square * (error[:, 0] / size) ** 2).mean()))


def _groups(pairs: tuple[Pair, ...]) -> list[list[Pair]]:
    """Pairs of numbers in connected groups; of each group only as many as determine all others.

    >>> _groups(((0, 1, 1.0), (0, 2, 1.0), (1, 2, -1.0), (3, 4, 1.0)))
    [[(0, 1, 1.0), (0, 2, 1.0)], [(3, 4, 1.0)]]
    """
    found: list[tuple[set[int], list[Pair]]] = []
    for pair in pairs:
        ends = set(pair[:2])
        touched = [one for one in found if one[0] & ends]
        if any(ends <= numbers for numbers, _ in touched):
            continue
        found = [one for one in found if one not in touched]
        numbers = ends.union(*(one for one, _ in touched))
        found.append((numbers, [*(each for _, own in touched for each in own), pair]))
    return [own for _, own in found]


class FittedData(Frozen):
    """A set of measured points compared with the fitted model.

    residual (point, component): model minus data at the nearest point, in units of the errors. error (point,
    component): errors of the amplitude, or of frequency and damping ratio of a backbone. modal_amplitude
    (point,): that of a backbone's points on the mode of the model, NaN where the mode does not reach them;
    None if no mode was followed.
    """

    measured: Measured
    residual: FloatArray
    error: FloatArray
    unreached: int  # points that the model's curve does not reach
    modal_amplitude: FloatArray | None = None
    least: float = 1e-8  # relative misfit below which it is rounding
    deviations: float = 3.0  # standard deviations from chance from which a misfit is systematic
    isolated: float = 8.0  # an outlier is so many times as far off as the median and the neighbours

    @property
    def misfit(self) -> float:
        """Relative root mean square distance of the data, see the function `misfit`."""
        return misfit(self.measured, self.residual, self.error)

    @property
    def damping_misfit(self) -> float:
        """Root mean square distance of a backbone's damping ratios, relative to the greatest; else NaN."""
        if self.measured.damping is None:
            return np.nan
        off = self.residual[:, 1] * self.error[:, 1] / self.measured.damping.max()
        return float(np.sqrt((off**2).mean()))

    @property
    def scatter(self) -> float:
        """The misfit by the differences of neighbours: all of it if the points' errors are independent."""
        square, difference = self._squares()
        return self.misfit * float(np.sqrt(0.5 * difference / square)) if square > 0.0 else 0.0

    @property
    def systematic(self) -> bool:
        """Whether neighbouring points deviate to the same side more often than by chance."""
        square, difference = self._squares()
        count = self.measured.points
        return (
            self.misfit > self.least and difference < (2.0 - self.deviations * 2.0 / np.sqrt(count)) * square
        )

    @property
    def outliers(self) -> list[int]:
        """Points that deviate far more than most, and than both neighbours, as by an error of measurement.

        A deficiency of the model shows at several neighbours.
        """
        off = np.linalg.norm(self.residual, axis=1)
        if off.size < 2 * self.isolated:
            return []
        along = self._along()
        ordered = np.concatenate(([0.0], off[along], [0.0]))
        beside = np.maximum(ordered[:-2], ordered[2:])
        limit = self.isolated * np.maximum(beside, max(float(np.median(off)), self.least))
        return sorted(along[off[along] > limit].tolist())

    def _along(self) -> npt.NDArray[np.intp]:
        """The points in order of their frequency, level by level; for a backbone in order of amplitude."""
        one = self.measured
        return np.lexsort((one.frequency, one.level)) if one.damping is None else np.argsort(one.amplitude)

    def _squares(self) -> tuple[float, float]:
        r"""Sums of r_i^2 and of (r_(i+1) - r_i)^2 over the points in order of their frequency or amplitude.

        For points with independent errors the ratio of the second to the first is 2, with the standard
        deviation 2 / sqrt(N). Source: von Neumann, "Distribution of the Ratio of the Mean Square Successive
        Difference to the Variance", Annals of Mathematical Statistics 12 (1941).
        """
        backbone = self.measured.damping is not None
        r = (self.residual if backbone else self.residual[:, 1:])[self._along()]
        return float((r**2).sum()), float((np.diff(r, axis=0) ** 2).sum())

    def summary(self) -> dict[str, Any]:
        """Entries for JSON.

        `error` holds the least and the greatest error of the points, relative as the misfit.
        """
        one = self.measured
        size = float((one.amplitude if one.damping is None else one.frequency).max())
        return {
            "file": one.file,
            "dof": one.dof or None,
            "kind": "response" if one.damping is None else "backbone",
            "level": [float(one.level.min()), float(one.level.max())],
            "points": one.points,
            "misfit": self.misfit,
            "error": [float(self.error[:, 0].min() / size), float(self.error[:, 0].max() / size)],
            "error_estimated": one.estimated is not None,
            "damping_misfit": self.damping_misfit,
            "scatter": self.scatter,
            "systematic": bool(self.systematic),
            "outliers": [1 + i for i in self.outliers],
            "unreached": self.unreached,
        }


def _of_outliers(part: FittedData) -> str:
    """Sentences on outliers."""
    numbers, points = [str(1 + i) for i in part.outliers], part.measured.points
    alone = (
        f"point {numbers[0]} of {points} stands alone"
        if len(numbers) == 1
        else f"points {listed(numbers)} of {points} stand alone"
    )
    return (
        f"{part.measured.file}: {alone}, at least {part.isolated:.0f} times as far from the curve as the "
        "neighbours. What was measured wrong may be left out: it moves the numbers, and all standard errors "
        "become larger by it"
    )


class FittedStart(Frozen):
    """Begin and end of one search."""

    begin: FloatArray
    end: FloatArray
    cost: float
    points: int  # number of points in the cost
    finished: bool  # whether it was fitted to all points
    harmonics: tuple[int, ...]


@dataclass
class Fitted:
    """Result of a fit: the numbers of a scene with which its model is nearest to measured data."""

    keys: tuple[str, ...]
    begin: FloatArray  # (number,) values in the scene
    values: FloatArray
    error: FloatArray  # (number,) standard error, infinite if there is none
    interval: FloatArray  # (number, 2), NaN for an end that the data do not determine
    confidence: float
    poor: float  # relative misfit from which the model does not fit the data
    correlation: FloatArray  # (number, number)
    without_effect: FloatArray  # (number,) 1 if the data do not depend on it
    undetermined: FloatArray  # (number,) 1 if its standard error is nearly as large as the number
    at_bound: FloatArray  # (number,) 1 if a bound limits it
    alike: tuple[Pair, ...]  # pairs of which only a product is determined
    data: list[FittedData]
    starts: list[FittedStart]
    harmonics: tuple[int, ...]
    advice: list[str] = field(default_factory=list)  # measurements that would determine more
    remedy: str = ""  # a change of the data with which the model would fit
    many: float = 10.0  # standard errors above this multiple of the number are not given in percent
    final: bool = True  # whether the search for the numbers is finished
    settled: bool = True  # whether it ended at a minimum
    interrupted: bool = False

    def problems(self) -> list[str]:
        """Sentences on why the numbers may be unreliable."""
        said = []
        if not self.final:
            said.append("the numbers are the best so far: their standard errors are not those of a minimum")
        elif not self.settled:
            said.append(
                "the search for the numbers stopped before a minimum, so that others may be nearer to the "
                "data. The standard errors are not those of a minimum. Write these numbers into the scene, "
                "and fit again from there"
            )
        for k, key in enumerate(self.keys):
            if self.without_effect[k]:
                said.append(f"{key} has no effect on these data: its value means nothing")
            if self.at_bound[k] and not self.without_effect[k]:
                said.append(
                    f"{key} lies at its bound, and would fit the data better beyond: give wider bounds"
                )
        if hardly := [
            k for k in range(len(self.keys)) if self.undetermined[k] and not self.without_effect[k]
        ]:
            each, error = ("is", "its standard error is") if len(hardly) == 1 else _EACH
            sizes = [self._relative(k) for k in hardly]
            errors = listed(sizes if len(set(sizes)) > 1 else sizes[:1])
            said.append(
                f"{listed([self.keys[k] for k in hardly])} {each} hardly determined by these data: "
                f"{error} {errors}"
            )
        for pairs in _groups(self.alike):
            among = dict.fromkeys(self.keys[k] for pair in pairs for k in pair[:2])
            told = listed([_told(self.keys[i], self.keys[j], power) for i, j, power in pairs])
            said.append(f"{listed(list(among))} cannot be distinguished: these data determine {told} alone")
        for part in self.data:
            if part.unreached:
                name = part.measured.file
                said.append(f"{name}: the model's curve does not come to {part.unreached} of its points")
            if part.outliers:
                said.append(_of_outliers(part))
            off = max(part.misfit, np.nan_to_num(part.damping_misfit))
            if off > self.poor:
                said.append(
                    f"{part.measured.file}: the model is off from these data by {100.0 * off:.0f} %. It "
                    "lacks something, which the confidence intervals do not include"
                )
            elif part.systematic:
                said.append(
                    f"{part.measured.file}: neighbouring points are off to the same side. Of the misfit, "
                    f"{100.0 * part.misfit:.2g} %, only {100.0 * part.scatter:.1g} % is scatter. The model "
                    "lacks something, as harmonics, or other numbers are nearer. The confidence intervals "
                    "do not include that"
                )
        return [*said, self.remedy] if self.remedy else said

    def _relative(self, k: int) -> str:
        """Standard error of a number relative to the number, as text."""
        size = self.error[k] / abs(self.values[k]) if self.values[k] else np.inf
        return f"{100.0 * size:.0f} %" if size < self.many else "many times as large"

    def summary(self) -> dict[str, Any]:
        """Entries of the fit for JSON."""
        numbers = {
            key: {
                "value": float(self.values[k]),
                "standard_error": float(self.error[k]),
                "interval": self.interval[k].tolist(),
                "start": float(self.begin[k]),
                "without_effect": bool(self.without_effect[k]),
                "untold": bool(self.undetermined[k] or self.without_effect[k]),
                "at_bound": bool(self.at_bound[k]),
            }
            for k, key in enumerate(self.keys)
        }
        return {
            "numbers": numbers,
            "confidence": self.confidence,
            "correlation": self.correlation.tolist(),
            "not_told_apart": [[self.keys[i], self.keys[j], power] for i, j, power in self.alike],
            "data": [one.summary() for one in self.data],
            "starts": [
                {
                    "begin": one.begin.tolist(),
                    "end": one.end.tolist(),
                    "cost": one.cost,
                    "points": one.points,
                    "finished": one.finished,
                    "harmonics": list(one.harmonics),
                }
                for one in self.starts
            ],
            "harmonics": list(self.harmonics),
            "problems": self.problems(),
            "advice": self.advice,
            "final": self.final,
            "settled": self.settled,
            "interrupted": self.interrupted,
        }


def frequencies(one: Measured, unit: str) -> FloatArray:
    """Frequencies of measured points, in a unit."""
    return in_unit(one.frequency, unit)
