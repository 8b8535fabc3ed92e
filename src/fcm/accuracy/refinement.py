"""Add harmonics until a response reaches an accuracy: trace, compare with the reference, add, repeat."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fcm.accuracy.budget import Budget, share_of
from fcm.accuracy.embedded_pair import Mask, PathErrors, errors_along, unknown_errors, with_nearest
from fcm.accuracy.options import OF_GIVEN, PAIR, REFINEMENT, PairOptions, RefinementOptions
from fcm.accuracy.required_harmonics import dofs_of_interest, needed, required_harmonics
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

# called with the traced response, its change by the reference (NaN: unknown), and the next harmonics
OnTraced = Callable[[UncheckedResponse, float, tuple[int, ...]], None]


class RefinedResponse(UncheckedResponse):
    """A response with its estimated errors and the accuracy that was asked for.

    errors (path,) are those of the branches' paths. peak (dof,) is the relative error of the greatest
    amplitude over all paths. max_error is the greatest error of peaks and folds, NaN if one is unknown;
    max_known_error is the greatest of the known ones. further: larger set of harmonics that would be needed,
    but takes too long, if any. begun: whether tracing with these had begun when it was given up.
    """

    errors: tuple[PathErrors, ...]
    peak: FloatArray
    max_error: float
    max_known_error: float
    accuracy: float
    further: tuple[int, ...] = ()
    begun: bool = False

    @property
    def reached(self) -> bool:
        """Whether the greatest error is within the accuracy; False where an error is unknown."""
        return self.max_error <= self.accuracy

    @property
    def peak_frequency(self) -> FloatArray:
        """Relative errors (dof,) of the frequencies of the greatest amplitudes.

        NaN where they are unknown, or the greatest amplitude is not a peak.
        """
        which = np.array([one.amplitude.max(axis=0) for one in self.quantities]).argmax(axis=0)
        found: FloatArray = np.array([one.peak_frequency for one in self.errors])[
            which, np.arange(len(which))
        ]
        return np.where(np.isnan(self.peak), np.nan, found)

    @property
    def folds(self) -> FloatArray:
        """Relative errors of the frequencies of all folds, branch after branch."""
        return np.concatenate([np.empty(0), *(one.fold for one in self.errors)])

    def thinned(self, most: int) -> UncheckedResponse:
        """The response reduced to about `most` points, with the errors of the points kept."""
        few = super().thinned(most)
        if few is self:
            return self
        errors = [one.part(rows) for one, rows in zip(self.errors, self._rows(most), strict=True)]
        own = few.system, few.traced, few.quantities, few.seconds, tuple(errors)
        return RefinedResponse(*own, self.peak, self.max_error, self.max_known_error, self.accuracy)

    @property
    def height(self) -> FloatArray:
        """Greatest amplitudes (dof,) over all branches."""
        found: FloatArray = np.max([one.amplitude.max(axis=0) for one in self.quantities], axis=0)
        return found

    @property
    def dofs_of_interest(self) -> Mask:
        """Mask (dof,) of the degrees of freedom whose peaks must reach the accuracy."""
        return dofs_of_interest(self.system.scene, self.height)

    @property
    def agrees(self) -> bool:
        """Whether the pair agrees: the accuracy is reached, or only errors of folds are unknown.

        More harmonics would not make the latter known.
        """
        unknown = np.isnan(self.peak[self.dofs_of_interest]).any()
        return self.reached or (self.max_known_error <= self.accuracy and not unknown)


def refined_response(
    system: System,
    accuracy: float,
    progress: Progress | None = None,
    options: RefinementOptions = REFINEMENT,
    on_traced: OnTraced | None = None,
) -> RefinedResponse:
    """The response of a scene (of one curve) with the harmonics that an accuracy takes; system has one.

    Everything is traced again with the harmonics that the spectrum names. This ends when no peak of a degree
    of freedom, and no fold, differs from the reference's by more than the accuracy (relative). Tracing starts
    from solutions with more harmonics near the branches traced before, and near their stable peaks. The force
    level is followed only with the harmonics that are predicted to be enough; it may lead to branches that
    fewer harmonics do not have.

    A round that would exceed the total time of `WorkOptions` is not begun, and one that does exceed it is
    given up. The status of the branches tells whether they are complete. Each traced response is passed to
    on_traced before the next round.
    """
    found: UncheckedResponse = unchecked_response(system, progress)
    if on_traced is not None and found.quantities:
        on_traced(found, np.nan, ())
    checked: RefinedResponse | None = None
    further, begun = tuple[int, ...](), False
    for _ in range(options.max_rounds):
        if not found.quantities:
            break
        checked, required = None, required_harmonics(found, options)
        if required.is_known and required.change <= accuracy:
            found = found.with_levels()
            checked = with_errors(found, accuracy)
            if checked.agrees:
                more = with_low_harmonics(found.system, found.traced.found)
                if more == found.system.harmonics:
                    return checked
            else:
                more = enlarged(checked, accuracy)
        else:
            more = needed(required, found.system.harmonics, accuracy, options)
        if on_traced is not None:
            on_traced(checked or found, required.change if required.is_known else np.nan, more)
        then, further, begun = with_more(found, more, required.is_known, progress, options)
        if then is None:
            break
        found, checked = then, None
    if checked is None:
        found = found.with_levels()
    many = len(system.scene.contacts) >= PAIR.many_contacts
    if checked is None or (many and not checked.agrees):
        # nothing is traced again: the pair of many contacts only gives the errors, as with given harmonics
        checked = with_errors(found, accuracy, options=OF_GIVEN if many else None)
    return replace(checked, further=further, begun=begun)


def retrace(found: RefinedResponse, harmonics: tuple[int, ...], accuracy: float) -> RefinedResponse | None:
    """Trace the response again with more harmonics.

    None if no solution is found, or if all would take longer than `WorkOptions` allows.
    """
    work = found.system.work
    if work.seconds + found.seconds_with(harmonics) > found.system.options.work.max_seconds:
        return None
    nearby, traced = prolongated_solutions(found, harmonics), found.traced
    system = found.system.with_harmonics(harmonics)
    then = unchecked_response(system, None, traced.found, nearby, traced.peaks)
    return with_errors(then, accuracy) if then.quantities else None


def with_given_harmonics(
    system: System, progress: Progress | None = None, on_traced: OnTraced | None = None
) -> RefinedResponse:
    """The response with the harmonics that a system has, see `unchecked_with_given_harmonics`."""
    return with_errors(unchecked_with_given_harmonics(system, progress, on_traced), np.inf)


def unchecked_with_given_harmonics(
    system: System, progress: Progress | None = None, on_traced: OnTraced | None = None
) -> UncheckedResponse:
    """The response with the harmonics of the system, without errors.

    It is traced first with one of them, then with the few that show how far to follow the force level, then
    with half of them, then with all. Solutions with more harmonics beside the stable peaks are starts, too,
    as the force level may not lead to them. A branch that is isolated with three harmonics may be connected
    to the others with one.
    """
    counts = sorted({1, few_harmonics(system), max(len(system.harmonics) // 2, few_harmonics(system))})
    before, peaks = None, tuple[FoundPeak, ...]()
    for count in counts if system.scene.contacts else ():
        if count < len(system.harmonics):
            before = _after(before, system.with_harmonics(system.harmonics[:count]))
            peaks = (*before.traced.peaks, *peaks)
            if on_traced is not None and before.quantities:
                on_traced(before, np.nan, system.harmonics)
    found = _after(before, system, progress, peaks)
    if on_traced is not None and found.quantities and system.scene.contacts:
        on_traced(found, np.nan, ())
    return found


def every_branch(system: System) -> UncheckedResponse:
    """The response with the system's harmonics, isolated branches and those at branch points included."""
    return unchecked_with_given_harmonics(system).with_every_branch()


def _after(
    before: UncheckedResponse | None,
    system: System,
    progress: Progress | None = None,
    peaks: tuple[FoundPeak, ...] = (),
) -> UncheckedResponse:
    """Trace the response of a system, started from that with fewer harmonics if there is one."""
    if before is None:
        return unchecked_response(system, progress)
    near = prolongated_solutions(before, system.harmonics)
    return unchecked_response(system, progress, before.traced.found, near, peaks)


def with_errors(
    outline: UncheckedResponse,
    accuracy: float,
    known: tuple[PathErrors, ...] = (),
    options: PairOptions | None = None,
) -> RefinedResponse:
    """A response with its errors; those of its first branches may be given as `known`.

    An infinite accuracy means that the harmonics are given, not chosen by an accuracy.
    """
    outline.system.work.tell("its errors")
    options = options or (OF_GIVEN if np.isinf(accuracy) else PAIR)
    system, response, quantities = outline.system, outline.traced, outline.quantities
    paths = response.branches.paths
    rest = list(zip(paths, quantities, strict=True))[len(known) :]
    part = share_of([path.evaluations for path in paths], len(known))
    shares = Budget.of(system.work, options, part).shares(len(rest))
    new = [errors_along(system, *one, options, share) for one, share in zip(rest, shares, strict=True)]
    errors = with_nearest(system, paths, quantities, (*known, *new), len(known), options)
    own = system, response, quantities, outline.seconds, errors
    if not paths:
        none = np.full(len(system.scene.modal.dofs), np.nan)
        return RefinedResponse(*own, none, np.nan, np.nan, accuracy)
    heights = np.array([one.amplitude.max(axis=0) for one in quantities])
    height, peak = heights.max(axis=0), _peaks(heights, errors, options)
    matter = peak[dofs_of_interest(system.scene, height)]
    each = np.concatenate((matter, *(one.fold for one in errors)))
    worst, worst_known = float(each.max(initial=0.0)), float(each[np.isfinite(each)].max(initial=0.0))
    return RefinedResponse(*own, peak, worst, worst_known, accuracy)


def without_errors(outline: UncheckedResponse) -> RefinedResponse:
    """A response with every error unknown (NaN)."""
    system, response, quantities = outline.system, outline.traced, outline.quantities
    every = zip(response.branches.paths, quantities, strict=True)
    errors = tuple(unknown_errors(system, *one) for one in every)
    none = np.full(len(system.scene.modal.dofs), np.nan)
    return RefinedResponse(
        system, response, quantities, outline.seconds, errors, none, np.nan, np.nan, np.inf
    )


def _peaks(heights: FloatArray, errors: tuple[PathErrors, ...], options: PairOptions) -> FloatArray:
    """Relative errors (dof,) of the greatest of heights (path, dof) over all paths.

    The reference may be highest on another path. An error is unknown if that of a path nearly as high is.
    """
    which, d = heights.argmax(axis=0), np.arange(heights.shape[1])
    now = heights[which, d]
    peak = np.array([one.peak for one in errors])[which, d]
    of_reference = np.array([one.height for one in errors])
    greatest = np.where(np.isnan(of_reference), 0.0, of_reference).max(axis=0)
    other = greatest > of_reference[which, d]
    peak = np.where(other, np.abs(greatest - now) / np.where(now > 0.0, now, 1.0), peak)
    return np.where(has_unknown_rival(of_reference, heights, options), np.nan, peak)


def has_unknown_rival(known: FloatArray, heights: FloatArray, options: PairOptions) -> Mask:
    """Whether a value of known (path, ...) is NaN on a path nearly as high as the highest."""
    rivals = heights > options.rival_fraction * heights.max(axis=0)
    found: Mask = (np.isnan(known) & rivals).any(axis=0)
    return found


def enlarged(found: RefinedResponse, accuracy: float, seconds: float = np.inf) -> tuple[int, ...]:
    """The harmonics of a response together with those that the spectrum requires for the accuracy.

    No more are added than can be followed in the given seconds.
    """
    has, required = found.system.harmonics, required_harmonics(found)
    if np.isfinite(found.max_error):
        required = replace(required, change=found.max_error, is_known=True)
    share = required.share
    more = sorted(set(needed(required, has, accuracy)) - set(has), key=lambda h: -share[h - 1])
    while more and found.seconds_with((*has, *more)) > seconds:
        more.pop()
    return tuple(sorted((*has, *more)))
