"""Every branch of the response of a system over its range."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from fcm.branches.force_level import LevelSolutions, level_frequencies, solutions_at, solutions_in_turn
from fcm.branches.mirror_images import without_images
from fcm.branches.narrow_resonances import narrow_resonances
from fcm.branches.options import LEVEL_CURVE, LevelCurveOptions
from fcm.continuation import Branches, Events, FollowOptions, Mark, Path, all_branches, follow
from fcm.continuation.all_branches import Follow, Following
from fcm.continuation.follow import Progress
from fcm.continuation.path import PathInterrupted
from fcm.continuation.problem import Problem
from fcm.frozen import Frozen
from fcm.harmonic_balance.cost_model import charged_to_work
from fcm.harmonic_balance.reported_quantities import recorded
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.well_posedness import undetermined
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.model.scene import FloatArray


class FoundPeak(NamedTuple):
    """A peak of a response: omega [rad/s], and the size of the contacts' displacements."""

    omega: float
    size: float

    def is_like(self, other: FoundPeak, options: LevelCurveOptions) -> bool:
        """Whether another response has this peak, too."""
        near = abs(other.omega - self.omega) < options.same_peak[0] * self.omega
        return near and other.size > options.same_peak[1] * self.size


class Traced(Frozen):
    """The traced branches, and the solutions at the frequencies at which the level was followed.

    found: those solutions, maybe with fewer harmonics. work: its cost in seconds of `cost_model`. mirrored:
    the numbers of the branches whose mirror images are left out. folds_lost: frequencies [rad/s] at which
    curves of folds were lost or not followed, so that isolated branches may be missing. symmetry_lost:
    frequencies at which a symmetric motion loses its symmetry by harmonics that are not balanced.
    symmetry_lost_in_level: frequencies at which a branch that leaves the curve of the level is unsymmetric by
    even harmonics that are not balanced, and its leading even harmonics. fewer_peaks: peaks of the responses
    with fewer harmonics.
    """

    branches: Branches
    found: tuple[LevelSolutions, ...]
    work: float = 0.0
    mirrored: tuple[int, ...] = ()
    folds_lost: tuple[float, ...] = ()
    symmetry_lost: tuple[float, ...] = ()
    symmetry_lost_in_level: tuple[tuple[float, tuple[int, ...]], ...] = ()
    fewer_peaks: tuple[FoundPeak, ...] = ()

    @property
    def own_peaks(self) -> tuple[FoundPeak, ...]:
        """Peaks of the traced branches."""
        tops = (path.z[path.where(Mark.PEAK)] for path in self.branches.paths)
        return tuple(FoundPeak(float(z[-1]), float(np.linalg.norm(z[:-1]))) for one in tops for z in one)

    @property
    def peaks(self) -> tuple[FoundPeak, ...]:
        """Peaks of the traced branches, then those of the response with fewer harmonics."""
        return *self.own_peaks, *self.fewer_peaks

    def lost_peaks(self, options: LevelCurveOptions) -> tuple[float, ...]:
        """Frequencies [rad/s] of the peaks with fewer harmonics that no branch has.

        Their branch may be isolated with more harmonics.
        """
        return self.not_met(self.fewer_peaks, options)

    def not_met(self, peaks: Sequence[FoundPeak], options: LevelCurveOptions) -> tuple[float, ...]:
        """Frequencies [rad/s] of those peaks of another response that no branch has."""
        own = self.own_peaks
        return tuple(one.omega for one in peaks if not any(one.is_like(other, options) for other in own))


def traced(
    system: System,
    progress: Progress | None = None,
    fewer: tuple[LevelSolutions, ...] = (),
    near: Sequence[FloatArray] = (),
    peaks: tuple[FoundPeak, ...] = (),
) -> Traced:
    """Trace the branches through all solutions at the frequencies at which the level is followed.

    fewer: the solutions found there with fewer harmonics, if any. near: known solutions (unknown + 1,) whose
    branches are traced, too, if they are within the range. peaks: peaks with fewer harmonics. The level is
    also followed where the branches have lost one of these peaks.
    """
    levels, found, work = level_frequencies(system), list[LevelSolutions](), 0.0

    def starts() -> Iterator[FloatArray]:
        nonlocal work
        ahead = solutions_in_turn(system, levels, fewer)
        for _ in levels:  # branches are traced before the next level is followed
            before = system.work.seconds
            try:
                found.append(next(ahead))
            except PathInterrupted:  # its path is a curve of the level, not a branch
                raise KeyboardInterrupt from None
            work += system.work.seconds - before
            yield from found[-1].solutions
        yield from near

    user_values = [*levels, *(float(z[-1]) for z in near)]
    branches = branches_through(system, starts(), user_values, progress)
    response = _without_images(system, Traced(branches, tuple(found), work, fewer_peaks=peaks))
    lost = response.lost_peaks(system.option(LEVEL_CURVE))
    further = [omega for omega in level_frequencies(system, lost) if omega not in levels] if lost else []
    if not further:
        return response
    more = solutions_at(system, further)
    return with_further(system, response, more, [z for one in more for z in one.solutions])


def traced_from(
    system: System, before: Traced, near: Sequence[FloatArray], progress: Progress | None = None
) -> Traced | None:
    """Trace the branches through solutions near those of fewer harmonics; None if there are none.

    No level is followed: `found` stays as before.
    """
    if not near:
        return None
    places = [float(z[-1]) for z in near]
    branches = branches_through(system, near, places, progress)
    return _without_images(system, replace(before, branches=branches, fewer_peaks=before.peaks))


def with_levels(system: System, before: Traced) -> Traced:
    """The traced response with the branches to which the levels of the forces lead.

    Branches are traced through the solutions that lie on no known one. If that takes more work than allowed,
    no level counts as followed to its end.
    """
    begin, (low, high) = system.work.seconds, system.scene.frequency_range
    frequencies = level_frequencies(system, before.lost_peaks(system.option(LEVEL_CURVE)))
    try:
        levels = solutions_at(system, frequencies, before.found)
        inside = [z for one in levels for z in one.solutions if low <= z[-1] <= high]
        found = with_further(system, replace(before, found=()), levels, inside)
    except WorkLimitError:
        left = (LevelSolutions(omega, system.harmonics, (), False, np.inf) for omega in frequencies)
        found = replace(before, found=tuple(left))
    return replace(found, work=system.work.seconds - begin)


def branches_through(
    system: System,
    starts: Iterable[FloatArray],
    user_values: Sequence[float] = (),
    progress: Progress | None = None,
) -> Branches:
    """Trace the branches through solutions; those outside the range are ignored."""
    low, high = system.scene.frequency_range
    inside = (z for z in starts if low <= z[-1] <= high)
    following = Following(FollowOptions(system.scene.max_step), _follow_shared(system, progress))
    places = [omega for omega in user_values if low <= omega <= high]
    found = all_branches(system.reset_balance, inside, (low, high), following, user_values=places)
    return _without_unsteady(system, found)


def with_further(
    system: System, before: Traced, found: Sequence[LevelSolutions], starts: Sequence[FloatArray]
) -> Traced:
    """The traced response with solutions at further frequencies, and the branches through further starts.

    New branches come after those that were traced before.
    """
    span, known = system.scene.frequency_range, before.branches
    following = Following(FollowOptions(system.scene.max_step), _follow_shared(system))
    branches = all_branches(system.reset_balance, starts, span, following, known.paths)
    further = (path for path in branches.paths[len(known.paths) :] if not _is_unsteady(system, path))
    branches = Branches((*known.paths, *further), (*known.lost, *branches.lost))
    return replace(before, branches=branches, found=(*before.found, *found))


def _without_images(system: System, found: Traced) -> Traced:
    """The traced response with one of two branches that are mirror images."""
    paths, mirrored = without_images(system, found.branches.paths)
    return replace(found, branches=replace(found.branches, paths=paths), mirrored=mirrored)


def _follow_shared(system: System, progress: Progress | None = None) -> Follow:
    """A function that follows the shared balance of a system, with its shared stepper.

    progress is called with the fraction of each path that is covered.
    """
    stepper, places = system.shared_stepper, narrow_resonances(system)

    def along(
        problem: Problem,
        start: FloatArray,
        span: tuple[float, float],
        wanted: Events,
        options: FollowOptions,
        *,
        forward: bool,
    ) -> Path:
        landed = replace(wanted, narrow=places)
        one = partial(follow, problem, start, span, landed, options, forward=forward, stepper=stepper)
        return charged_to_work(system, stepper, progress, lambda report: one(progress=report))

    return along


def _without_unsteady(system: System, branches: Branches) -> Branches:
    """The branches without those that are no steady motion, if any are left.

    The equations do not include the mean of an unconstrained rigid-body mode. A branch on which friction
    pushes along such a mode at all points does not balance it.
    """
    paths = branches.paths
    if len(paths) < 2:
        return branches
    kept = tuple(path for path in paths if not _is_unsteady(system, path))
    return replace(branches, paths=kept) if kept else branches


def _is_unsteady(system: System, path: Path) -> bool:
    """Whether friction pushes along an unconstrained rigid-body mode at all points of a path."""
    if system.linear.natural.min(initial=1.0) > 0.0:
        return False
    points = recorded(system, [path])
    return bool(undetermined(system, points.z, points.force).get("pushed", np.zeros(1, bool)).all())
