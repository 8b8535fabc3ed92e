"""Least squares from several starts: blurred first, which finds the way, then with the errors as stated.

A fit is a series of searches, each by its number in that series. What a search has come to is kept, where
there is a place for it: a fit that goes on does not make those again that are finished, and begins the one
that was interrupted where it was best.
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
from fcm.fit.least_squares_rows import Rows, joined
from fcm.fit.options import FIT, FitOptions
from fcm.fit.parameters import FitError, Parameters
from fcm.fit.weights import reweighted
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Measured

Tell = Callable[[float, str], None]


class SearchResult(Frozen):
    """Unknowns that a search has come to, and their cost; None where there is no response at its start."""

    x: FloatArray | None
    cost: float


class SavedSearches(Protocol):
    """Searches of an earlier run by their number: the finished ones, and how far others were; and of this."""

    finished: dict[int, list[Any]]
    states: dict[int, list[Any]]

    def add(self, number: int, results: list[Any]) -> None:
        """A search is finished."""

    def save(self, number: int, state: Any) -> None:
        """A search has come so far."""


@dataclass
class Start:
    """Numbers that were tried: where they began, and where they came to, with the cost by the errors stated.

    cost is that of a start while it is sought, of a finalist that of all points, before errors of theirs are
    estimated; effect: (number,) whether the data change with a number there.
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
    """Residuals of all data as a function of the unknowns, each point evaluated once.

    best : of all unknowns that were evaluated, those of the least cost.
    """

    parameters: Parameters
    data: Sequence[Measured]
    harmonics: tuple[int, ...]
    blurred: bool
    options: FitOptions = FIT
    known: tuple[bytes, list[Rows] | None] = field(default=(b"", None))
    best: SearchResult | None = None

    def parts(self, x: FloatArray) -> list[Rows] | None:
        """Rows of each data set; None where the model has no response."""
        if self.known[0] != x.tobytes():
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
        """The least cost next to a start; told of each evaluation. None where there is no response."""
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
        return SearchResult(found.x, float(found.cost))

    def note(self, found: SearchResult) -> None:
        """Unknowns that were evaluated, now or in an earlier run."""
        if found.x is not None and (self.best is None or found.cost < self.best.cost):
            self.best = found


class Searches:
    """The searches of a fit in their order, told and kept."""

    def __init__(self, kept: SavedSearches | None = None, tell: Tell | None = None) -> None:
        self.kept, self.tell, self.number = kept, tell, 0

    def least(
        self, problem: Problem, x: FloatArray, evaluations: int, share: tuple[float, float], what: str
    ) -> SearchResult:
        """What a search from these unknowns comes to, or has come to already; share: of the bar."""
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
    """The numbers with which the residuals are least.

    begin : numbers of which some are known to be near; those with the least residuals are begun with.

    searches : those of an earlier run with the same arguments, and where more goes.

    Raises
    ------
    FitError
        If the model has no response near the data from any start.
    KeyboardInterrupt
        If nothing is found then; else the best numbers so far are returned, and that it was interrupted.
    """
    few = [_thinned(one, options.few_points) for one in data]
    rough = Problem(parameters, few, harmonics, True, options)
    fine = Problem(parameters, data, harmonics, False, options)
    searches, starts = searches or Searches(), list[Start]()
    best: SearchResult | None = None
    chosen: Start | None = None
    try:
        begins = [parameters.unknowns(one) for one in begin]
        nearest = sorted(begins, key=rough.cost)[: options.finalists]
        _tried(parameters, rough, starts, options, searches, nearest)
        finalists = _by_cost(starts, options)[: options.finalists] if starts else []
        for k, one in enumerate(finalists):
            begun = options.search_share
            share = tuple(begun + (1.0 - begun) * (k + i) / (len(finalists) + 1) for i in (0, 1))
            what = f"all points, from the best starts ({k + 1} of {len(finalists)})"
            found = searches.least(
                fine, parameters.unknowns(one.end), options.finalist_evaluations, (share[0], share[1]), what
            )
            if found.x is None:
                continue
            one.end, one.cost, one.finished = parameters.values(found.x), found.cost, True
            if best is None or found.cost < best.cost * (1.0 - options.cost_tolerance):
                best, chosen = found, one
    except KeyboardInterrupt:
        return _so_far(fine, rough, starts)
    if best is None or best.x is None or chosen is None:
        raise FitError("fit: the model has no response in the range of the data, from any start")
    weighed = _weighed(fine, best.x, starts, options, searches)
    chosen.end = weighed.values
    return weighed


def _so_far(fine: Problem, rough: Problem, starts: list[Start]) -> Solved:
    """The best numbers of a fit that was interrupted: of all points where these were begun with.

    Raises
    ------
    KeyboardInterrupt
        If nothing has been evaluated.
    """
    best = fine.best or rough.best
    if best is None or best.x is None:
        raise KeyboardInterrupt
    return _with_rows(fine if fine.parts(best.x) is not None else rough, best.x, starts, True)


def _weighed(
    fine: Problem, x: FloatArray, starts: list[Start], options: FitOptions, searches: Searches
) -> Solved:
    """The fit made again with the errors that its residuals tell, where none are stated."""
    again = fine
    try:
        for _ in range(options.reweightings):
            parts = fine.parts(x)
            assert parts is not None
            data = reweighted(fine.data, parts, options)
            if all(one.estimated is None for one in data):
                break
            again = replace(fine, data=data, known=(b"", None), best=None)
            found = searches.least(
                again, x, options.finalist_evaluations, (0.97, 1.0), "errors of the points estimated"
            )
            if found.x is None:
                break
            fine, x = again, found.x
    except KeyboardInterrupt:
        if again is not fine and again.best is not None and again.best.x is not None:
            fine, x = again, again.best.x
        return _with_rows(fine, x, starts, True)
    return _with_rows(fine, x, starts, False)


def _tried(
    parameters: Parameters,
    rough: Problem,
    starts: list[Start],
    options: FitOptions,
    searches: Searches,
    begins: Sequence[FloatArray] = (),
) -> None:
    """Starts, until some have led to the same numbers, and these are the best; begins: other than usual."""
    every = begins or parameters.starts(options.starts)
    most = len(begins) or options.starts
    for k, x in enumerate(every):
        share = options.search_share * k / most, options.search_share * (k + 1) / most
        what = f"start {k + 1} of at most {most}"
        found = searches.least(rough, x, options.start_evaluations, share, what)
        if found.x is None:
            continue
        effect = np.abs(rough.jacobian(found.x)).max(axis=0, initial=0.0) > options.min_effect
        starts.append(Start(parameters.values(x), parameters.values(found.x), found.cost, effect))
        least = _by_cost(starts, options)[0]
        same = [
            np.isclose(one.end, least.end, rtol=options.number_tolerance, atol=0.0) | ~least.effect
            for one in starts
        ]
        if sum(bool(one.all()) for one in same) >= options.agreeing_starts:
            return


def _by_cost(starts: Sequence[Start], options: FitOptions) -> list[Start]:
    """Those of the least cost first; of equal ones the earlier, which are nearer to the scene."""
    least = min(one.cost for one in starts)
    return sorted(
        starts, key=lambda one: one.cost if one.cost > least * (1.0 + options.cost_tolerance) else least
    )


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
