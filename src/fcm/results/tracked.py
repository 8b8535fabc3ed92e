"""Results of tracking: special points of a response as curves over a number of its scene, and optima."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.units import in_unit


class TrackedError(Frozen):
    """Estimated effect of the harmonics left out at a point of a tracked curve; NaN if unknown.

    relative is the relative error of the amplitude of a peak, otherwise of the frequency. number, only at a
    turn, is the error of the number there.
    """

    point: int
    place: str  # "end", "cusp", "least", ...; several with commas
    relative: float
    number: float = np.nan


class TrackedCurve(Frozen):
    """One tracked curve, points in the order along it; frequencies in rad/s."""

    parameters: dict[str, float]  # swept values of the scene's curve to which it belongs
    what: str  # "fold", "peak of u", "slip of shroud", ...
    number: FloatArray  # (point,)
    frequency: FloatArray  # (point,)
    amplitude: FloatArray  # (point, dof)
    corner: npt.NDArray[np.str_]  # (point,) which corner the point is, if it is one
    turn: npt.NDArray[np.bool_]  # (point,) where the number turns back
    trough: npt.NDArray[np.bool_]  # (point,) where a tracked peak is a minimum of amplitude
    stable: FloatArray  # (point,) 1 where the motion is stable, 0 where not, NaN if unknown
    closings: tuple[tuple[int, str], ...]  # points where it turns, and their kind
    complete: bool
    reason: str
    errors: tuple[TrackedError, ...] = ()
    undetermined: int = 0  # points where a contact never slips and another may feel it

    def summary(self, unit: str) -> dict[str, Any]:
        """Entries of the tracked curve for JSON."""
        return {
            "parameters": self.parameters,
            "what": self.what,
            "points": int(self.number.size),
            "number": [float(self.number.min()), float(self.number.max())],
            "frequency": in_unit([self.frequency.min(), self.frequency.max()], unit).tolist(),
            "turns": [
                {
                    "number": float(self.number[i]),
                    "frequency": float(in_unit(self.frequency[i], unit)),
                    "kind": kind,
                }
                for i, kind in self.closings
            ],
            "errors": [
                {
                    "place": one.place,
                    "number": float(self.number[one.point]),
                    "frequency": float(in_unit(self.frequency[one.point], unit)),
                    "error": one.relative,
                    "of": "amplitude" if self.what.startswith("peak of ") else "frequency",
                    **({"error_of_number": one.number} if self.turn[one.point] else {}),
                }
                for one in self.errors
            ],
            **self._stability(unit),
            **({"may_not_be_unique": self.undetermined} if self.undetermined else {}),
            "complete": self.complete,
            **({} if self.complete else {"reason": self.reason}),
        }

    def _stability(self, unit: str) -> dict[str, Any]:
        """Stretches of the curve with unstable motions, or with unknown stability; without troughs."""
        fields = {"not_stable": self.stable == 0.0, "stability_untold": np.isnan(self.stable)}
        out = {}
        for name, where in fields.items():
            edges = np.flatnonzero(np.diff(where & ~self.trough, prepend=False, append=False))
            stretches = [slice(*ends) for ends in edges.reshape(-1, 2).tolist()]
            out[name] = [
                {
                    "number": [float(self.number[there].min()), float(self.number[there].max())],
                    "frequency": in_unit(np.sort(self.frequency[there])[[0, -1]], unit).tolist(),
                }
                for there in stretches
            ]
        return {name: found for name, found in out.items() if found}


class NearlyLeast(Frozen):
    """Values of a number with which the greatest peak exceeds the least one by at most a share.

    low_known, high_known : whether it exceeds that beyond the end; otherwise the peaks were not followed on.
    higher : on either side the next value at which a higher peak ends, and its ratio to the least
    """

    share: float
    low: float
    high: float
    low_known: bool
    high_known: bool
    higher: tuple[tuple[float, float], ...] = ()


class Optimal(Frozen):
    """The least value of the greatest of some peaks."""

    parameters: dict[str, float]
    values: dict[str, float]  # of the chosen numbers
    minimised: tuple[str, ...]
    value: float
    active: tuple[tuple[str, float], ...]  # degrees of freedom with the greatest peaks, and their frequencies
    kind: str  # "smooth", "kink", "corner", "end", "bound", "flat", "trials", "unfinished"
    harmonics: tuple[int, ...]
    error: float = np.nan  # estimated relative error of the value
    between: tuple[float, float] | None = None  # neighbouring numbers, if it was found by trials
    tried: tuple[tuple[float, float], ...] = ()  # numbers tried, and the greatest peak there, by trials
    stable: tuple[float, ...] = ()  # stability of each of the active, see `Peak`
    residual: tuple[float, ...] = ()  # residual of each of the active, see `Peak`
    fewer: Optimal | None = None  # optimum found with fewer harmonics before
    flat: dict[str, tuple[float, float]] = field(
        default_factory=dict
    )  # between which the peaks do not depend
    higher: tuple[str, float] | None = (
        None  # which minimised quantity is higher in the response there, unfollowed; and its value
    )
    # estimated relative error of the number at which a higher peak ends; by trials, of a higher peak next to
    # the least; 0 without one
    end_error: float = 0.0
    beside: dict[str, float] = field(default_factory=dict)  # numbers at which that peak still exists
    leaves_range: float = np.nan  # [rad/s] where that peak, or the least, leaves the frequency range
    nearly: NearlyLeast | None = None  # the numbers around it with which the peak is hardly greater
    # ranges of the number in which the greatest tracked peak is higher but unstable, and that peak
    unstable: tuple[tuple[float, float, float], ...] = ()

    def summary(self, unit: str) -> dict[str, Any]:
        """Entries of the optimum for JSON."""
        return {
            "parameters": self.parameters,
            "values": self.values,
            "minimise": list(self.minimised),
            "value": self.value,
            "at": [
                {
                    "dof": dof,
                    "frequency": float(in_unit(omega, unit)),
                    "stable": None if np.isnan(stable) else bool(stable),
                    "residual_change": residual,
                }
                for (dof, omega), stable, residual in zip(
                    self.active, self.stable, self.residual, strict=True
                )
            ],
            "kind": self.kind,
            "harmonics": list(self.harmonics),
            "error": self.error,
            "between": None if self.between is None else list(self.between),
            "tried": [list(pair) for pair in self.tried],
            "flat": {key: list(ends) for key, ends in self.flat.items()},
            "nearly_least": None if self.nearly is None else asdict(self.nearly),
            "unstable_peaks": [
                {"from": low, "to": high, "greatest": peak} for low, high, peak in self.unstable
            ],
            "end_error": self.end_error,
            "leaves_range": None if np.isnan(self.leaves_range) else float(in_unit(self.leaves_range, unit)),
            "higher": None if self.higher is None else dict(zip(("what", "value"), self.higher, strict=True)),
        }


@dataclass
class Tracking:
    """Result of tracking; `key` is the number along which the curves are followed."""

    key: str
    what: str
    span: tuple[float, float]
    harmonics: tuple[int, ...]
    curves: list[TrackedCurve]
    optima: list[Optimal] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    interrupted: bool = False
    # values of the number and frequencies [rad/s] at which the initial response curves may lack branches
    uncertain_at: list[tuple[float, float]] = field(default_factory=list)
    short_of: str = ""  # why it misses the requested accuracy, or ''

    @property
    def complete(self) -> bool:
        """Whether every curve was followed to its end; for an optimum, whether there are no problems."""
        followed = self.what == "optimum" or all(curve.complete for curve in self.curves)
        return followed and not self.problems

    def is_lower(self, one: TrackedCurve, dofs: Sequence[str]) -> bool:
        """Whether an incomplete curve of peaks lies below complete curves of the same peak all along it."""
        dof = one.what.removeprefix("peak of ")
        if one.complete or dof == one.what or dof not in dofs:
            return False
        same = [c for c in self.curves if c.complete and (c.what, c.parameters) == (one.what, one.parameters)]
        column, counts = dofs.index(dof), ~one.trough
        points = zip(one.number[counts].tolist(), one.amplitude[counts, column].tolist(), strict=True)
        return all(any(_height(other, column, s) > height for other in same) for s, height in points)

    def summary(self, unit: str, dofs: Sequence[str] = ()) -> dict[str, Any]:
        """Entries of the tracking for JSON; dofs: names of the columns of amplitudes."""
        return {
            "what": self.what,
            "over": self.key,
            "span": list(self.span),
            "harmonics": list(self.harmonics),
            "complete": self.complete,
            "problems": self.problems,
            "curves": [
                curve.summary(unit) | ({"lower": True} if self.is_lower(curve, dofs) else {})
                for curve in self.curves
            ],
            **({"short_of_accuracy": self.short_of} if self.short_of else {}),
            "branches_unsure_at": [[number, float(in_unit(at, unit))] for number, at in self.uncertain_at],
        }


def _height(curve: TrackedCurve, column: int, s: float) -> float:
    """The greatest amplitude of a curve at a number, by its chords without troughs; -inf if there is none."""
    first, last = curve.number[:-1], curve.number[1:]
    over = (np.minimum(first, last) <= s) & (s <= np.maximum(first, last))
    over &= ~(curve.trough[:-1] | curve.trough[1:])
    way = np.where(last == first, 1.0, last - first)
    chords = curve.amplitude[:-1, column] + np.diff(curve.amplitude[:, column]) * (s - first) / way
    return float(np.max(chords[over], initial=-np.inf))
