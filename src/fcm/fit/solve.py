"""Least squares from several starts: first with large (blurred) errors, then with the stated ones.

If errors are not stated, they are estimated from the residuals, and the fit is repeated with them. Both steps
alternate, so that the likelihood grows, until the numbers move little compared with their standard errors.
There are two such iterations, since each may converge to another result: one begins with the likeliest form
of the errors, one with errors proportional to the amplitudes. The likeliest result is returned.

A fit is a series of numbered searches. Their results are saved if there is a place for them. A resumed fit
does not repeat finished searches, and continues the interrupted one from its best unknowns.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from fcm.fit.backbone import backbone_rows
from fcm.fit.forced import NoMotionError, errors_of, forced_rows
from fcm.fit.least_squares_rows import ResidualRows, joined
from fcm.fit.options import FIT, FitOptions
from fcm.fit.parameters import FitError, Parameters
from fcm.fit.weights import reweighted
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Measured

Tell = Callable[[float, str], None]


class SearchResult(Frozen):
    """Final unknowns x of a search and their cost; x is None if the model has no response at the start.

    settled : whether it ended at a minimum, not at the limit of evaluations.
    """

    x: FloatArray | None
    cost: float
    settled: bool = False


class SavedSearches(Protocol):
    """Protocol of saved searches by number: results of finished ones, states of interrupted ones."""

    finished: dict[int, list[Any]]
    states: dict[int, list[Any]]

    def add(self, number: int, results: list[Any]) -> None:
        """Saves the results of a finished search."""

    def save(self, number: int, state: Any) -> None:
        """Saves the state of an unfinished search."""


@dataclass
class SearchStart:
    """A start of the fit: its first and last numbers, and the cost at the last.

    cost: in the search for starts that of the thinned data with blurred errors; for a finalist that of all
    points with the errors of the best finalist. effect: (number,) whether a number changes the data there.
    """

    begin: FloatArray
    end: FloatArray
    cost: float
    effect: npt.NDArray[np.bool_]
    points: int = 0  # number of points in the cost
    finished: bool = False


@dataclass
class Solved:
    """The best numbers, their rows by data set, the data with the errors used, and the starts."""

    values: FloatArray
    parts: list[ResidualRows]
    data: list[Measured]
    starts: list[SearchStart]
    interrupted: bool = False
    settled: bool = True  # whether the search for these numbers ended at a minimum

    @property
    def rows(self) -> ResidualRows:
        return joined(self.parts)


@dataclass
class FitProblem:
    """Residuals of all data as a function of the unknowns; the last evaluation is cached.

    best : the evaluated unknowns of the least cost.
    """

    parameters: Parameters
    data: Sequence[Measured]
    harmonics: tuple[int, ...]
    blurred: bool
    options: FitOptions = FIT
    known: tuple[bytes, list[ResidualRows] | None] = field(default=(b"", None))
    best: SearchResult | None = None

    def parts(self, x: FloatArray) -> list[ResidualRows] | None:
        """Rows of each data set; None if the model has no response."""
        if self.known[0] != x.tobytes():
            try:
                self.known = (x.tobytes(), self._parts(x))
            except (NoMotionError, np.linalg.LinAlgError):
                self.known = (x.tobytes(), None)
        return self.known[1]

    def _parts(self, x: FloatArray) -> list[ResidualRows]:
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
            return np.full(size, self.options.lost_residual)
        return np.concatenate([part.residual.ravel() for part in parts])

    def cost(self, x: FloatArray) -> float:
        """Half the sum of the squares of the residuals."""
        return 0.5 * float((self.residual(x) ** 2).sum())

    def jacobian(self, x: FloatArray) -> FloatArray:
        parts, rates = self.parts(x), self.parameters.rates(self.parameters.values(x))
        assert parts is not None  # least_squares asks where the cost has fallen
        return np.concatenate([(part.rates * rates).reshape(-1, len(rates)) for part in parts])

    def least(
        self, x: FloatArray, evaluations: int, tell: Callable[[SearchResult], None] | None = None
    ) -> SearchResult:
        """The local minimum of the cost from start x; tell is called with the result of each evaluation.

        x of the result is None if the model has no response at the start.
        """
        low, high = (self.parameters.unknowns(end) for end in (self.parameters.low, self.parameters.high))
        x = np.clip(x, low, high)
        inside = np.clip(x, low + 1e-9 * np.abs(low), high - 1e-9 * np.abs(high))
        if self.parts(inside) is None:
            return SearchResult(None, np.inf)

        def residual(x: FloatArray) -> FloatArray:
            found = self.residual(x)
            here = SearchResult(x.copy(), 0.5 * float(found @ found))
            self.note(here)
            if tell is not None:
                tell(here)
            return found

        found = least_squares(
            residual, inside, self.jacobian, bounds=(low, high), x_scale="jac", max_nfev=evaluations
        )
        return SearchResult(found.x, float(found.cost), bool(found.status > 0))

    def apart(self, x: FloatArray, other: FloatArray) -> float:
        """Distance of two sets of unknowns, in standard errors along their difference.

        This is |J (other - x)| over the spread of the residuals, with the rates J at x.
        """
        moved, residual = self.jacobian(x) @ (other - x), self.residual(x)
        freedom = max(sum(part.independent for part in self.parts(x) or []) - x.size, 1)
        spread = float(np.sqrt(residual @ residual / freedom))
        return float(np.linalg.norm(moved)) / max(spread, 1e-300)

    def note(self, found: SearchResult) -> None:
        """Updates the best unknowns with a result of this run or an earlier one."""
        if found.x is not None and (self.best is None or found.cost < self.best.cost):
            self.best = found


class Searches:
    """Runs the searches of a fit in order, reports their progress and saves their results."""

    def __init__(self, kept: SavedSearches | None = None, tell: Tell | None = None) -> None:
        self.kept, self.tell, self.number = kept, tell, 0

    def least(
        self, problem: FitProblem, x: FloatArray, evaluations: int, share: tuple[float, float], what: str
    ) -> SearchResult:
        """Result of a search from given unknowns, or the saved result if there is one.

        share: begin and end of its part of the progress bar.
        """
        number, evaluated, least = self.number, 0, np.inf
        self.number += 1
        if self.kept is not None and number in self.kept.finished:
            known: SearchResult = self.kept.finished[number][0]
            problem.note(known)
            return known
        if self.kept is not None and (saved := self.kept.states.get(number)):
            x = min(saved, key=lambda one: one.cost).x
        self._say(share[0], what)

        def tell(here: SearchResult) -> None:
            nonlocal evaluated, least
            evaluated += 1
            done = min(evaluated / evaluations, 1.0)
            self._say(share[0] + done * (share[1] - share[0]), f"{what}, evaluation {evaluated}")
            if here.cost < least:
                least = here.cost
                if self.kept is not None:
                    self.kept.save(number, here)

        found = problem.least(x, evaluations, tell)
        if self.kept is not None:
            self.kept.add(number, [found])
        return found

    def _say(self, done: float, text: str) -> None:
        if self.tell is not None:
            self.tell(done, text)


def solved(
    parameters: Parameters,
    data: Sequence[Measured],
    harmonics: tuple[int, ...],
    options: FitOptions = FIT,
    searches: Searches | None = None,
    begin: Sequence[FloatArray] = (),
) -> Solved:
    """The numbers with the least residuals.

    begin : sets of numbers near the solution; those with the least cost replace the usual starts.

    searches : saved searches of an earlier run with the same arguments; new results are added.

    Raises
    ------
    FitError
        If the model has no response near the data from any start.
    KeyboardInterrupt
        If it is interrupted before any evaluation; later the best numbers so far are returned.
    """
    few = [_thinned(one, options.few_points) for one in data]
    rough = FitProblem(parameters, few, harmonics, True, options)
    fine = FitProblem(parameters, data, harmonics, False, options)
    searches, starts, ends = searches or Searches(), list[SearchStart](), list[_End]()
    try:
        begins = [parameters.unknowns(one) for one in begin]
        nearest = sorted(begins, key=rough.cost)[: options.finalists]
        _tried(parameters, rough, starts, options, searches, nearest)
        finalists = _by_cost(starts, options)[: options.finalists] if starts else []
        for k, one in enumerate(finalists):
            begun = options.search_share
            shares = [
                begun + (1.0 - begun) * (k + part) / len(finalists)
                for part in (0.0, *options.weighing_shares)
            ]
            what = f"all points, from the best starts ({k + 1} of {len(finalists)})"
            found = searches.least(
                fine, parameters.unknowns(one.end), options.finalist_evaluations, (shares[0], shares[1]), what
            )
            if found.x is None:
                continue
            same = next((end for end in ends if fine.apart(end.before, found.x) < options.settled_move), None)
            if same is not None:
                ends += [replace(end, start=one) for end in ends if end.start is same.start]
                continue
            for i in (0, 1) if _unstated(data) else (0,):
                of_bar = shares[1 + i], shares[2 + i]
                end = _End(one, found.x, fine, found.x, np.inf, found.settled)
                ends.append(_weighed(end, i == 1, options, searches, of_bar))
                if ends[-1].interrupted:
                    raise KeyboardInterrupt
        interrupted = False
    except KeyboardInterrupt:
        if not ends:
            return _so_far(fine, rough, starts)
        interrupted = True
    if not ends:
        raise FitError("fit: the model has no response in the range of the data, from any start")
    return _likeliest(ends, starts, options, interrupted)


def _so_far(fine: FitProblem, rough: FitProblem, starts: list[SearchStart]) -> Solved:
    """The best numbers of an interrupted fit: from the fit to all points if it has begun, else from a start.

    Raises
    ------
    KeyboardInterrupt
        If nothing has been evaluated.
    """
    best = fine.best or rough.best
    if best is None or best.x is None:
        raise KeyboardInterrupt
    return _with_rows(fine if fine.parts(best.x) is not None else rough, best.x, starts, True)


@dataclass
class _End:
    """A finalist: its problem with the errors used, its unknowns, and how unlikely the residuals are.

    before : unknowns of the least cost with the initial errors, which are the same for all finalists.
    """

    start: SearchStart
    before: FloatArray
    problem: FitProblem
    x: FloatArray
    unlikely: float
    settled: bool
    interrupted: bool = False


def _weighed(
    end: _End, share: bool, options: FitOptions, searches: Searches, of_bar: tuple[float, float]
) -> _End:
    """Estimates unstated errors from the residuals and fits with them, in turns, until the numbers settle.

    share : whether the first errors are proportional to the amplitudes; of_bar : part of the progress bar.
    """
    try:
        for k in range(options.reweightings + 1):
            parts = end.problem.parts(end.x)
            assert parts is not None
            data, end.unlikely = reweighted(end.problem.data, parts, options, share and k == 0)
            if all(one.estimated is None for one in data):
                break
            if k == options.reweightings:
                end.settled = False
                break
            again = replace(end.problem, data=data, known=(b"", None), best=None)
            further = searches.least(
                again, end.x, options.finalist_evaluations, of_bar, "errors of the points estimated"
            )
            if further.x is None:
                end.settled = False
                break
            rests = k > 0 and again.apart(end.x, further.x) < options.settled_move
            end.problem, end.x, end.settled = again, further.x, further.settled
            if rests:
                break
    except KeyboardInterrupt:
        end.interrupted = True
    return end


def _unstated(data: Sequence[Measured]) -> bool:
    """Whether there are responses without stated errors."""
    return any(one.damping is None and one.amplitude_error is None for one in data)


def _likeliest(
    ends: Sequence[_End], starts: list[SearchStart], options: FitOptions, interrupted: bool
) -> Solved:
    """The numbers of the likeliest finalist; sets the costs of all finalists, with its errors."""
    best = ends[0]
    for end in ends[1:]:
        if end.unlikely < best.unlikely - options.cost_tolerance:
            best = end
    for end in sorted(ends, key=lambda end: -end.unlikely):
        end.start.end, end.start.finished = best.problem.parameters.values(end.x), True
        end.start.cost, end.start.points = (
            best.problem.cost(end.x),
            sum(one.points for one in end.problem.data),
        )
    best.start.end, best.start.cost = best.problem.parameters.values(best.x), best.problem.cost(best.x)
    return replace(_with_rows(best.problem, best.x, starts, interrupted), settled=best.settled)


def _tried(
    parameters: Parameters,
    rough: FitProblem,
    starts: list[SearchStart],
    options: FitOptions,
    searches: Searches,
    begins: Sequence[FloatArray] = (),
) -> None:
    """Fits the thinned data from each start, until `agreeing_starts` end at the same, best numbers.

    starts : list to which the starts are added; begins : unknowns in place of the usual starts.
    """
    every = begins or parameters.starts(options.starts)
    most = len(begins) or options.starts
    for k, x in enumerate(every):
        share = options.search_share * k / most, options.search_share * (k + 1) / most
        what = f"start {k + 1} of at most {most}"
        found = searches.least(rough, x, options.start_evaluations, share, what)
        if found.x is None:
            continue
        effect = np.abs(rough.jacobian(found.x)).max(axis=0, initial=0.0) > options.min_effect
        points = sum(one.points for one in rough.data)
        starts.append(
            SearchStart(parameters.values(x), parameters.values(found.x), found.cost, effect, points)
        )
        least = _by_cost(starts, options)[0]
        same = [
            np.isclose(one.end, least.end, rtol=options.number_tolerance, atol=0.0) | ~least.effect
            for one in starts
        ]
        if sum(bool(one.all()) for one in same) >= options.agreeing_starts:
            return


def _by_cost(starts: Sequence[SearchStart], options: FitOptions) -> list[SearchStart]:
    """Starts ordered by cost; among nearly equal least costs the earliest start is first."""
    least = min(one.cost for one in starts)
    return sorted(
        starts, key=lambda one: one.cost if one.cost > least * (1.0 + options.cost_tolerance) else least
    )


def _with_rows(problem: FitProblem, x: FloatArray, starts: list[SearchStart], interrupted: bool) -> Solved:
    parts = problem.parts(x)
    assert parts is not None
    values = problem.parameters.values(x)
    return Solved(values, parts, list(problem.data), starts, interrupted)


def _thinned(data: Measured, most: int) -> Measured:
    """Some of the points, spread evenly."""
    if data.points <= most:
        return data
    chosen = np.unique(np.linspace(0, data.points - 1, most).astype(np.intp))
    every: dict[str, Any] = {
        name: None if (value := getattr(data, name)) is None else value[chosen]
        for name in ("frequency", "amplitude", "phase", "damping", "weight", "level")
    }
    return replace(data, **every)
