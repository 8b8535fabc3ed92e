"""A response without its errors, and the same with more harmonics, within the time allowed.

While harmonics are chosen, only the branches near those of fewer harmonics are followed. The force levels
take about as long as these. They are followed at the end, with the harmonics that are enough
(`UncheckedResponse.with_levels`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import field, replace

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import REFINEMENT, RefinementOptions
from fcm.branches.force_level import LevelSolutions
from fcm.branches.prolongation import prolongated
from fcm.branches.search import with_further_branches
from fcm.branches.trace import FoundPeak, Traced, traced, traced_from, with_levels
from fcm.continuation import Branches, BranchesInterrupted, Path
from fcm.continuation.follow import Progress
from fcm.frozen import Frozen
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.reported_quantities import ReportedQuantities, reported_quantities
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.model.scene import FloatArray


class UncheckedResponse(Frozen):
    """A response whose errors are not known yet; `quantities` (path,) are those of its branches' paths.

    seconds: approximate time for following its levels and branches. before: the response with fewer harmonics
    from which its branches come, until a level is followed with its own, see `with_levels`.
    """

    system: System
    traced: Traced
    quantities: tuple[ReportedQuantities, ...]
    seconds: float
    before: UncheckedResponse | None = field(default=None, kw_only=True)

    def with_traced(self, traced: Traced) -> UncheckedResponse:
        """The response with further branches appended after its own."""
        further = traced.branches.paths[len(self.quantities) :]
        quantities = (*self.quantities, *(reported_quantities(self.system, path) for path in further))
        return UncheckedResponse(self.system, traced, quantities, self.seconds)

    def with_every_branch(self) -> UncheckedResponse:
        """The response with isolated branches, and with those through branch points."""
        return self.with_traced(with_further_branches(self.system, self.traced))

    def seconds_with(self, harmonics: tuple[int, ...]) -> float:
        """Estimated seconds for following the levels and branches with other harmonics."""
        return self._seconds_with(self.seconds, harmonics)

    def _seconds_with(self, seconds: float, harmonics: tuple[int, ...]) -> float:
        """Scale seconds of work from the present harmonics to others."""
        few, many = len(self.system.harmonics), len(harmonics)
        if not seconds:  # nothing was to be followed
            return 0.0
        grown = seconds_of(self.system, 1, many) / seconds_of(self.system, 1, few)
        return seconds * grown * many / few

    def limited_harmonics(
        self, seconds: float, more: tuple[int, ...], options: RefinementOptions = REFINEMENT
    ) -> tuple[int, ...]:
        """`more` without its highest new harmonics, so that following takes at most the given seconds.

        The lowest stay: a branch of one harmonic may not belong to any motion.
        """
        least = {*self.system.harmonics, *range(1, options.complete_harmonics + 1)}
        while self.seconds_with(more) > seconds and not least.issuperset(more):
            highest = max(set(more) - least)
            more = tuple(h for h in more if h != highest)
        return more

    def prolongated(
        self, harmonics: tuple[int, ...], near: Sequence[FloatArray], progress: Progress | None
    ) -> UncheckedResponse:
        """The response with more harmonics, from its own branches and from the solutions `near`.

        If these lead to no branch, the force level is followed.
        """
        system = self.system.with_harmonics(harmonics)
        begin = system.work.seconds
        response = traced_from(system, self.traced, near, progress)
        if response is None or not response.branches.paths:
            return unchecked_response(system, progress, self.traced.found, near, self.traced.peaks)
        levels = self._seconds_with(self.traced.work, harmonics)  # for the levels, still to be followed
        response, seconds = replace(response, work=levels), system.work.seconds - begin + levels
        return UncheckedResponse(
            system, response, _shown(system, response.branches.paths), seconds, before=self
        )

    def thinned(self, most: int) -> UncheckedResponse:
        """The response reduced to about `most` points; the response itself if it has no more."""
        paths = self.traced.branches.paths
        if points_of(self) <= most and len(self.quantities) == len(paths):
            return self
        rows = self._rows(most)
        few = [path.part(some) for path, some in zip(paths, rows, strict=True)]
        if len(self.quantities) == len(paths):
            quantities = tuple(one.part(some) for one, some in zip(self.quantities, rows, strict=True))
        else:
            quantities = _shown(self.system, few)
        response = replace(self.traced, branches=replace(self.traced.branches, paths=tuple(few)))
        return UncheckedResponse(self.system, response, quantities, self.seconds)

    def of_thinned(self, values: Sequence[FloatArray], most: int) -> list[FloatArray]:
        """Values (path, point) at the points that the response keeps if it is thinned to about `most`."""
        if points_of(self) <= most:
            return list(values)
        return [one[rows] for one, rows in zip(values, self._rows(most), strict=True)]

    def _rows(self, most: int) -> list[npt.NDArray[np.intp]]:
        """Indices of about `most` points of all paths, each path with its share."""
        count = max(points_of(self), 1)
        paths = self.traced.branches.paths
        return [path.representative(math.ceil(len(path.z) * most / count)) for path in paths]

    def with_levels(self, most: float | None = None) -> UncheckedResponse:
        """The response with the branches to which only the force level leads, with its own harmonics.

        If that takes more than `most` seconds in all, it is given up, and other branches may be missing. By
        default, `most` is that of the system's options.
        """
        if self.before is None:
            return self
        system, known = self.system, len(self.quantities)
        begin = system.work.seconds
        with system.work.limited_to(system.options.work.max_seconds if most is None else most):
            response = with_levels(system, self.traced)
        quantities = (*self.quantities, *_shown(system, response.branches.paths[known:]))
        seconds = self.seconds - self.traced.work + system.work.seconds - begin
        return UncheckedResponse(system, response, quantities, seconds)


class ResponseInterrupted(KeyboardInterrupt):
    """Raised when tracing is interrupted; `response` has the branches so far, without quantities."""

    def __init__(self, response: UncheckedResponse) -> None:
        super().__init__()
        self.response = response


def unchecked_response(
    system: System,
    progress: Progress | None = None,
    fewer: tuple[LevelSolutions, ...] = (),
    near: Sequence[FloatArray] = (),
    peaks: tuple[FoundPeak, ...] = (),
) -> UncheckedResponse:
    """The response of a system; the other arguments are those of `traced`.

    Raises
    ------
    ResponseInterrupted
        On a `KeyboardInterrupt`, if there is a part of a branch; it has the branches up to there.
    """
    before = system.work.seconds
    try:
        response = traced(system, progress, fewer, near, peaks)
    except BranchesInterrupted as stopped:
        paths = tuple(path for path in stopped.branches.paths if len(path.z) > 1)
        if not paths:
            raise
        partial = Traced(Branches(paths), ())
        begun = UncheckedResponse(system, partial, (), system.work.seconds - before)
        raise ResponseInterrupted(begun) from None
    quantities = _shown(system, response.branches.paths)
    return UncheckedResponse(system, response, quantities, system.work.seconds - before)


def points_of(response: UncheckedResponse) -> int:
    """Number of points of all branches of a response."""
    return sum(len(path.z) for path in response.traced.branches.paths)


def _shown(system: System, paths: Sequence[Path]) -> tuple[ReportedQuantities, ...]:
    return tuple(reported_quantities(system, path) for path in paths)


def with_more(
    found: UncheckedResponse,
    more: tuple[int, ...],
    is_known: bool,
    progress: Progress | None = None,
    options: RefinementOptions = REFINEMENT,
) -> tuple[UncheckedResponse | None, tuple[int, ...], bool]:
    """Trace the response with more harmonics within the time allowed.

    Returns the response, or None; the harmonics that take too long, if any; and whether tracing with these
    had begun. is_known tells whether these harmonics are known to bring the accuracy. If not, or if they take
    too long, only as many are added as are quick, at least the lowest three.
    """
    work, wanted, most = found.system.work, more, found.system.options.work.max_seconds
    if not is_known or work.seconds + found.seconds_with(more) > most:
        more = found.limited_harmonics(options.max_seconds_without_progress - work.seconds, more, options)
    if more == found.system.harmonics:
        return None, () if more == wanted else wanted, False
    if work.seconds + found.seconds_with(more) > most:
        return None, wanted, False
    stable = prolongated_solutions(found, more)
    try:
        with work.limited_to(most):
            then = found.prolongated(more, stable, progress)
    except WorkLimitError:
        return None, more, True
    # if no solution is found, the response with fewer harmonics stays, with its error
    return (then if then.quantities else None), (), False


def prolongated_solutions(before: UncheckedResponse, harmonics: tuple[int, ...]) -> list[FloatArray]:
    """Solutions with more harmonics near the branches of a response."""
    system = before.system
    return list(prolongated(system.with_harmonics(harmonics), system.harmonics, before.traced.branches.paths))
