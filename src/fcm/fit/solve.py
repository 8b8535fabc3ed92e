"""Least squares from several starts: blurred first, which finds the way, then with the errors as stated."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from fcm.fit.backbone import backbone_rows
from fcm.fit.forced import NoMotionError, errors_of, forced_rows
from fcm.fit.options import FIT, FitOptions
from fcm.fit.parameters import FitError, Parameters
from fcm.fit.rows import Rows, joined
from fcm.fit.weights import reweighted
from fcm.model.scene import FloatArray, Measured

Tell = Callable[[float, str], None]


@dataclass
class Start:
    """Numbers that were tried: where they began, and where they came to, with the cost by the errors stated.

    cost is that of a start while it is sought, of a finalist that of all points; effect: (number,)
    whether the data change with a number there.
    """

    begin: FloatArray
    end: FloatArray
    cost: float
    effect: npt.NDArray[np.bool_]
    finished: bool = False


@dataclass
class Solved:
    """The best numbers, their rows by data set, the data with the errors they were given, and the starts."""

    values: FloatArray
    parts: list[Rows]
    data: list[Measured]
    starts: list[Start]
    interrupted: bool = False

    @property
    def rows(self) -> Rows:
        return joined(self.parts)


@dataclass
class Problem:
    """Residuals of all data as a function of the unknowns, each point evaluated once."""

    parameters: Parameters
    data: Sequence[Measured]
    harmonics: tuple[int, ...]
    blurred: bool
    options: FitOptions = FIT
    poll: Callable[[], None] = int  # type: ignore[assignment]
    known: tuple[bytes, list[Rows] | None] = field(default=(b"", None))

    def parts(self, x: FloatArray) -> list[Rows] | None:
        """Rows of each data set; None where the model has no response."""
        if self.known[0] != x.tobytes():
            self.poll()
            try:
                self.known = (x.tobytes(), self._parts(x))
            except (NoMotionError, np.linalg.LinAlgError):
                self.known = (x.tobytes(), None)
        return self.known[1]

    def _parts(self, x: FloatArray) -> list[Rows]:
        values = self.parameters.values(x)
        scene, numbers = self.parameters.at(values), self.parameters.numbers
        found = []
        for data in self.data:
            if data.damping is not None:
                found.append(backbone_rows(scene, numbers, self.harmonics, data, self.options))
            else:
                errors = errors_of(data, self.blurred, self.options)
                keys = self.parameters.keys
                found.append(forced_rows(scene, keys, self.harmonics, data, errors, self.options))
        return found

    def residual(self, x: FloatArray) -> FloatArray:
        parts = self.parts(x)
        if parts is None:
            size = sum(data.points * data.components for data in self.data)
            return np.full(size, self.options.lost)
        return np.concatenate([part.residual.ravel() for part in parts])

    def jacobian(self, x: FloatArray) -> FloatArray:
        parts, rates = self.parts(x), self.parameters.rates(self.parameters.values(x))
        assert parts is not None  # least_squares asks where the cost has fallen
        return np.concatenate([(part.rates * rates).reshape(-1, len(rates)) for part in parts])

    def least(self, x: FloatArray, evaluations: int) -> tuple[FloatArray, float] | None:
        """Unknowns of the least cost next to a start, and the cost; None where there is no response."""
        low, high = (self.parameters.unknowns(end) for end in (self.parameters.low, self.parameters.high))
        x = np.clip(x, low, high)
        inside = np.clip(x, low + 1e-9 * np.abs(low), high - 1e-9 * np.abs(high))
        if self.parts(inside) is None:
            return None
        found = least_squares(
            self.residual, inside, self.jacobian, bounds=(low, high), x_scale="jac", max_nfev=evaluations
        )
        return found.x, float(found.cost)


def solved(
    parameters: Parameters,
    data: Sequence[Measured],
    harmonics: tuple[int, ...],
    options: FitOptions = FIT,
    tell: Tell | None = None,
    begin: FloatArray | None = None,
) -> Solved:
    """The numbers with which the residuals are least; begin: numbers of which it is known that they are near.

    Raises
    ------
    FitError
        If the model has no response near the data from any start.
    KeyboardInterrupt
        If nothing is found then; else what is found is returned, and that it was interrupted.
    """
    few = [_thinned(one, options.few_points) for one in data]
    rough = Problem(parameters, few, harmonics, True, options)
    fine = Problem(parameters, data, harmonics, False, options)
    starts: list[Start] = []
    best: tuple[float, FloatArray] | None = None
    try:
        if begin is None:
            _tried(parameters, rough, starts, options, tell)
            finalists = _by_cost(starts, options)[: options.finalists]
        else:
            finalists = [Start(begin, begin, np.inf, np.ones(len(begin), dtype=bool))]
            starts.extend(finalists)
        for k, one in enumerate(finalists):
            if tell is not None:
                tell(
                    0.7 + 0.3 * k / len(finalists),
                    f"all points, from the best starts ({k + 1} of {len(finalists)})",
                )
            found = fine.least(parameters.unknowns(one.end), options.finishing)
            if found is None:
                continue
            one.end, one.cost, one.finished = parameters.values(found[0]), found[1], True
            if best is None or found[1] < best[0] * (1.0 - options.equal):
                best = (found[1], found[0])
    except KeyboardInterrupt:
        if not starts:
            raise
        x = best[1] if best is not None else parameters.unknowns(_by_cost(starts, options)[0].end)
        return _with_rows(fine, x, starts, True)
    if best is None:
        raise FitError("fit: the model has no response in the range of the data, from any start")
    return _weighed(fine, best[1], starts, options)


def _weighed(fine: Problem, x: FloatArray, starts: list[Start], options: FitOptions) -> Solved:
    """The fit made again with the errors that its residuals tell, where none are stated."""
    try:
        for _ in range(options.reweighted):
            parts = fine.parts(x)
            assert parts is not None
            data = reweighted(fine.data, parts, options)
            if all(one.estimated is None for one in data):
                break
            again = replace(fine, data=data, known=(b"", None))
            found = again.least(x, options.finishing)
            if found is None:
                break
            fine, x = again, found[0]
    except KeyboardInterrupt:
        return _with_rows(fine, x, starts, True)
    return _with_rows(fine, x, starts, False)


def _tried(
    parameters: Parameters, rough: Problem, starts: list[Start], options: FitOptions, tell: Tell | None
) -> None:
    """Starts, until some have led to the same numbers, and these are the best."""
    for k, x in enumerate(parameters.starts(options.starts)):
        if tell is not None:
            tell(0.7 * k / options.starts, f"start {k + 1} of at most {options.starts}")
        found = rough.least(x, options.starting)
        if found is None:
            continue
        effect = np.abs(rough.jacobian(found[0])).max(axis=0, initial=0.0) > options.effect
        starts.append(Start(parameters.values(x), parameters.values(found[0]), found[1], effect))
        least = _by_cost(starts, options)[0]
        same = [np.isclose(one.end, least.end, rtol=options.same, atol=0.0) | ~least.effect for one in starts]
        if sum(bool(one.all()) for one in same) >= options.agreeing:
            return


def _by_cost(starts: Sequence[Start], options: FitOptions) -> list[Start]:
    """Those of the least cost first; of equal ones the earlier, which are nearer to the scene."""
    least = min(one.cost for one in starts)
    return sorted(starts, key=lambda one: one.cost if one.cost > least * (1.0 + options.equal) else least)


def _with_rows(problem: Problem, x: FloatArray, starts: list[Start], interrupted: bool) -> Solved:
    parts = problem.parts(x)
    assert parts is not None
    values = problem.parameters.values(x)
    return Solved(values, parts, list(problem.data), starts, interrupted)


def _thinned(data: Measured, most: int) -> Measured:
    """Some of the points, spread evenly over them."""
    if data.points <= most:
        return data
    chosen = np.unique(np.linspace(0, data.points - 1, most).astype(np.intp))
    every: dict[str, Any] = {
        name: None if (value := getattr(data, name)) is None else value[chosen]
        for name in ("frequency", "amplitude", "phase", "damping", "weight", "level")
    }
    return replace(data, **every)
