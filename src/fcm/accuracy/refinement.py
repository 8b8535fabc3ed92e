"""As many harmonics as an accuracy takes: trace, compare with the partner, add what the spectrum
names, again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fcm.accuracy.budget import Budget, share_of
from fcm.accuracy.embedded_pair import Errors, Mask, errors_along, unknown_errors, with_nearest
from fcm.accuracy.options import OF_GIVEN, PAIR, REFINEMENT, PairOptions, RefinementOptions
from fcm.accuracy.required_harmonics import judged, needed, required_harmonics
from fcm.accuracy.unchecked_response import (
    UncheckedResponse,
    prolongated_solutions,
    unchecked_response,
    with_more,
)
from fcm.branches.force_level import few_harmonics, with_low_harmonics
from fcm.branches.trace import FoundPeak
from fcm.continuation.follow import Progress
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

# what has been traced, by how much its partner changes it (NaN: not told), and the harmonics that come next
Keep = Callable[[UncheckedResponse, float, tuple[int, ...]], None]


@dataclass(frozen=True)
class RefinedResponse(UncheckedResponse):
    """A response, its errors, and the accuracy that was asked for.

    errors (path,) belong to the branches' paths, too; peak (dof,) is the relative error of the greatest
    amplitude over all of them; worst the greatest of these and of the errors of the folds, NaN where one
    cannot be told, and told the greatest of those that can.
    """

    errors: tuple[Errors, ...]
    peak: FloatArray
    max_error: float
    max_known_error: float
    accuracy: float

    @property
    def reached(self) -> bool:
        """Whether all errors are below the accuracy."""
        return self.max_error <= self.accuracy

    @property
    def folds(self) -> FloatArray:
        """Errors of all folds, branch after branch."""
        return np.concatenate([np.empty(0), *(one.fold for one in self.errors)])

    def thinned(self, most: int) -> UncheckedResponse:
        """With the errors that are told."""
        few = super().thinned(most)
        if few is self:
            return self
        errors = [one.part(rows) for one, rows in zip(self.errors, self._rows(most), strict=True)]
        own = few.system, few.traced, few.shown, few.seconds, tuple(errors)
        return RefinedResponse(*own, self.peak, self.max_error, self.max_known_error, self.accuracy)

    @property
    def judged(self) -> Mask:
        """Degrees of freedom (dof,) of whose peaks the accuracy is asked."""
        heights = [one.amplitude.max(axis=0) for one in self.shown]
        return judged(self.system.scene, np.max(heights, axis=0))

    @property
    def agrees(self) -> bool:
        """Whether the pair does: it is accurate, or folds alone cannot be told, which more do not change."""
        untold = np.isnan(self.peak[self.judged]).any()
        return self.reached or (self.max_known_error <= self.accuracy and not untold)


def refined_response(
    system: System,
    accuracy: float,
    progress: Progress | None = None,
    options: RefinementOptions = REFINEMENT,
    keep: Keep | None = None,
) -> RefinedResponse:
    """The response of a scene (of one curve) with the harmonics that an accuracy takes; system has one.

    As long as a peak of a degree of freedom, or a fold, differs from the partner's by more than the accuracy
    (relative), the harmonics are added that the spectrum names, and all is traced again: from what the
    branches before, and their stable peaks, lead to with more. Only with what is foreseen to be enough the
    level of the forces is followed, which may lead to branches that fewer harmonics do not have. What would
    take longer, with all before it, than anyone waits is not begun, see `WorkOptions`, and what does take
    longer is given up. Whether the branches are complete is another question, see their status. What has been
    traced is told to keep, before more is.
    """
    found: UncheckedResponse = unchecked_response(system, progress)
    if keep is not None and found.shown:
        keep(found, np.nan, ())
    sure: RefinedResponse | None = None
    further, begun = tuple[int, ...](), False
    for _ in range(options.max_rounds):
        if not found.shown:
            break
        sure, ahead = None, required_harmonics(found, options)
        if ahead.is_known and ahead.change <= accuracy:
            found = found.with_levels()
            if found.further:
                break
            sure = with_errors(found, accuracy)
            if sure.agrees:
                more = with_low_harmonics(found.system, found.traced.found)
                if more == found.system.harmonics:
                    return sure
            else:
                more = enlarged(sure, accuracy)
        else:
            more = needed(ahead, found.system.harmonics, accuracy, options)
        if keep is not None:
            keep(sure or found, ahead.change if ahead.is_known else np.nan, more)
        then, further, begun = with_more(found, more, ahead.is_known, progress, options)
        if then is None:
            break
        found, sure = then, None
    if sure is None:
        found = found.with_levels()
        further, begun = (found.further, found.begun) if found.further else (further, begun)
        sure = with_errors(found, accuracy)
    return replace(sure, further=further, begun=begun)


def retrace(found: RefinedResponse, harmonics: tuple[int, ...], accuracy: float) -> RefinedResponse | None:
    """The response traced again with more harmonics; None where no solution is found, or that takes longer
    than is worth it."""
    if found.seconds_with(harmonics) > found.system.options.work.max_seconds_repeated:
        return None
    nearby, traced = prolongated_solutions(found, harmonics), found.traced
    system = found.system.with_harmonics(harmonics)
    then = unchecked_response(system, None, traced.found, nearby, traced.peaks)
    return with_errors(then, accuracy) if then.shown else None


def with_given_harmonics(
    system: System, progress: Progress | None = None, keep: Keep | None = None
) -> RefinedResponse:
    """The response with the harmonics that a system has, see `unchecked_with_given_harmonics`."""
    return with_errors(unchecked_with_given_harmonics(system, progress, keep), np.inf)


def unchecked_with_given_harmonics(
    system: System, progress: Progress | None = None, keep: Keep | None = None
) -> UncheckedResponse:
    """The response with the harmonics that a system has, of whose errors none is known.

    Traced with one of them first, then with those that tell how far the level of all is to be followed, then
    with half: what is beside its stable peaks with more is a start, too, as the level of the forces may not
    lead to it. A branch that is isolated with three harmonics may be connected with the others with one.
    """
    counts = sorted({1, few_harmonics(system), max(len(system.harmonics) // 2, few_harmonics(system))})
    before, peaks = None, tuple[FoundPeak, ...]()
    for count in counts if system.scene.contacts else ():
        if count < len(system.harmonics):
            before = _after(before, system.with_harmonics(system.harmonics[:count]))
            peaks = (*before.traced.peaks, *peaks)
            if keep is not None and before.shown:
                keep(before, np.nan, system.harmonics)
    found = _after(before, system, progress, peaks)
    if keep is not None and found.shown and system.scene.contacts:
        keep(found, np.nan, ())
    return found


def every_branch(system: System) -> UncheckedResponse:
    """The response with the harmonics that a system has, isolated branches and those at branch points
    with it."""
    return unchecked_with_given_harmonics(system).with_every_branch()


def _after(
    before: UncheckedResponse | None,
    system: System,
    progress: Progress | None = None,
    peaks: tuple[FoundPeak, ...] = (),
) -> UncheckedResponse:
    """The response of a system, after that with fewer harmonics."""
    if before is None:
        return unchecked_response(system, progress)
    near = prolongated_solutions(before, system.harmonics)
    return unchecked_response(system, progress, before.traced.found, near, peaks)


def with_errors(
    outline: UncheckedResponse,
    accuracy: float,
    known: tuple[Errors, ...] = (),
    options: PairOptions | None = None,
) -> RefinedResponse:
    """A response with its errors, of which those of its first branches may be known.

    Without an accuracy, which is infinite then, its harmonics are given.
    """
    options = options or (OF_GIVEN if np.isinf(accuracy) else PAIR)
    system, response, shown = outline.system, outline.traced, outline.shown
    paths = response.branches.paths
    rest = list(zip(paths, shown, strict=True))[len(known) :]
    part = share_of([path.evaluations for path in paths], len(known))
    shares = Budget.of(system.work, options, part).shares(len(rest))
    new = [errors_along(system, *one, options, share) for one, share in zip(rest, shares, strict=True)]
    errors = with_nearest(system, paths, shown, (*known, *new), len(known), options)
    own = system, response, shown, outline.seconds, errors
    if not paths:
        none = np.full(len(system.scene.modal.dofs), np.nan)
        return RefinedResponse(*own, none, np.nan, np.nan, accuracy)
    heights = np.array([one.amplitude.max(axis=0) for one in shown])
    height, peak = heights.max(axis=0), _peaks(heights, errors)
    matter = peak[judged(system.scene, height)]
    each = np.concatenate((matter, *(one.fold for one in errors)))
    worst, told = float(each.max(initial=0.0)), float(each[np.isfinite(each)].max(initial=0.0))
    return RefinedResponse(*own, peak, worst, told, accuracy)


def without_errors(outline: UncheckedResponse) -> RefinedResponse:
    """A response of whose errors none is told."""
    system, response, shown = outline.system, outline.traced, outline.shown
    every = zip(response.branches.paths, shown, strict=True)
    errors = tuple(unknown_errors(system, *one) for one in every)
    none = np.full(len(system.scene.modal.dofs), np.nan)
    return RefinedResponse(system, response, shown, outline.seconds, errors, none, np.nan, np.nan, np.inf)


def with_estimated_errors(
    system: System, accuracy: float, progress: Progress | None = None
) -> RefinedResponse:
    """The response of a system, with its errors."""
    return with_errors(unchecked_response(system, progress), accuracy)


def _peaks(heights: FloatArray, errors: tuple[Errors, ...]) -> FloatArray:
    """Relative error of the greatest of heights (path, dof) of each degree of freedom.

    Another path may be the highest of the partner's; unknown where that of one nearly as high is.
    """
    which, d = heights.argmax(axis=0), np.arange(heights.shape[1])
    now = heights[which, d]
    peak = np.array([one.peak for one in errors])[which, d]
    theirs = np.array([one.height for one in errors])
    greatest = np.where(np.isnan(theirs), 0.0, theirs).max(axis=0)
    other = greatest > theirs[which, d]
    peak = np.where(other, np.abs(greatest - now) / np.where(now > 0.0, now, 1.0), peak)
    unknown = (np.isnan(theirs) & (heights > PAIR.rival_fraction * now)).any(axis=0)
    return np.where(unknown, np.nan, peak)


def enlarged(found: RefinedResponse, accuracy: float, seconds: float = np.inf) -> tuple[int, ...]:
    """The harmonics of a response and those that the spectrum names for the accuracy.

    No more are added than can be followed in some seconds.
    """
    has, ahead = found.system.harmonics, required_harmonics(found)
    if np.isfinite(found.max_error):
        ahead = replace(ahead, change=found.max_error, is_known=True)
    share = ahead.share
    more = sorted(set(needed(ahead, has, accuracy)) - set(has), key=lambda h: -share[h - 1])
    while more and found.seconds_with((*has, *more)) > seconds:
        more.pop()
    return tuple(sorted((*has, *more)))
