"""Continuation of all curves of periodic solutions of a scene over its frequency range."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from fcm.branches.branch_points import BranchPoint, branch_points_of, sign_changes, with_leaving
from fcm.branches.mirror_images import symmetric_half
from fcm.branches.options import BRANCHING, BranchingOptions
from fcm.continuation import FollowOptions, Mark, Path, Status, all_branches, follow
from fcm.continuation.all_branches import Branches, Follow, Following, contains
from fcm.harmonic_balance.consecutive_points import runs
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.force_level import LevelMotions, level_motions
from fcm.shooting.harmonic_balance_branches import converged_balance, passes
from fcm.shooting.initial_orbits import find_initial_orbits, first_point, height_of, orbits_along_balance
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.orbit_record import OrbitRecord, recorded, samples
from fcm.shooting.periodic_orbit import Orbit, Poll, approached, never_interrupt, periodic
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.work_budget import BranchBudget, UncertainFrequencies
from fcm.stability.unstable_ranges import unstable_stretches
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.units import UNIT

Progress = Callable[[float, str], None]


@dataclass
class Branch:
    """Periodic solutions along one curve, and how it ended."""

    orbits: list[OrbitRecord] = field(default_factory=list)  # in the order along the curve
    status: Status = Status.COMPLETE
    periods: int = 0  # number of periods computed

    @property
    def folds(self) -> list[OrbitRecord]:
        """The solutions at which the curve turns back in frequency."""
        return [orbit for orbit in self.orbits if orbit.mark & Mark.FOLD]

    @property
    def complete(self) -> bool:
        """Whether it goes from one end of the range to the other."""
        return self.status is Status.COMPLETE


def trace_orbits(
    scene: Scene,
    max_step: float | None = None,
    start: Orbit | None = None,
    progress: Progress | None = None,
    options: ShootingOptions = SHOOTING,
) -> Branch:
    """Follow the periodic solutions of a scene over its frequency range, stable or not.

    This is pseudo-arclength continuation of the exact motion, through folds and through corners at which
    regimes begin. Its points are solutions that `periodic` finds.

    Parameters
    ----------
    scene : Scene
        Its `frequency_range` is traced.
    max_step : float, optional
        Longest step along the curve, relative to the range and to the size of the motion; the scene's by
        default.
    start : Orbit, optional
        Start at an end of the range; by default from rest at its lower end.
    progress : optional
        Called regularly with the covered fraction of the range and a text.
    options : ShootingOptions, optional
        Tolerances and limits.

    Raises
    ------
    SimulationError
        If no periodic solution is found as a start.

    Examples
    --------
    >>> import fcm
    >>> from dataclasses import replace
    >>> scene = replace(fcm.load_scene("yang1998-n5"), frequency_range=(1.1, 1.3))
    >>> [round(fold.frequency, 4) for fold in trace_orbits(scene).folds]
    [1.2398, 1.1936]
    """
    longest = scene.max_step if max_step is None else max_step
    if not longest > 0.0:
        raise SimulationError(f"max_step is {longest:g}; it must be positive")
    problem, span = OrbitProblem(scene, options=options), scene.frequency_range
    begin = periodic(scene, span[0], options=options) if start is None else start
    z = first_point(problem, begin)
    said = None if progress is None else lambda fraction: progress(fraction, "")
    forward = z[-1] - span[0] <= span[1] - z[-1]
    return branch_of(
        problem, follow(problem, z, span, options=FollowOptions(longest), forward=forward, progress=said)
    )


class Explored(NamedTuple):
    """All branches of a scene, a sentence on missing ones, and the number of mirror images left out."""

    paths: list[Path]
    missing: str
    mirrored: int


def explore(
    problem: OrbitProblem,
    along: Follow = follow,
    poll: Poll = never_interrupt,
    most: float = np.inf,
    uncertain: UncertainFrequencies | None = None,
) -> Explored:
    """Find and follow all branches of a scene; return them with a sentence on what is missing, else ''.

    The sentence says why an end of the range has no solution, and why the search for further branches was
    given up. The search for their starts may take at most `most` seconds of processor time. uncertain
    receives the uncertain frequencies of the balance that gives starts.
    """
    scene = problem.scene
    found, missed, sought, apart = find_initial_orbits(problem, poll)
    branches = partial(
        all_branches,
        lambda: problem,
        span=scene.frequency_range,
        following=Following(FollowOptions(scene.max_step), along),
    )
    paths, lost = branches(found).paths, list[float]()
    bounded = BranchBudget(poll, most, problem.options)
    search = _BranchSearch(problem, branches, bounded, uncertain or UncertainFrequencies())
    if not sought:
        paths = search.with_others(paths, apart)
    if not bounded.given_up:
        paths = search.with_branching(paths)
    if search.too_many_broken(paths):
        bounded.add_reason(f"{problem.options.search.max_broken} of them broke off while they were followed")
    if not bounded.given_up:
        paths = search.with_motions(paths, orbits_in_unstable_ranges(problem, paths, poll))
    ends = (end for end in missed if not any((path.parameter == end).any() for path in paths))
    if not bounded.given_up:  # else this is the reason given
        lost = [
            omega for omega, height in search.unreached if not _reaches_height(problem, paths, omega, height)
        ]
    told = [
        f"no exact motion was found from the stable branch of harmonic balance at {one}"
        for one in dict.fromkeys(frequency_text(scene, omega) for omega in lost)
    ]
    missing = "; ".join([*_by_cause([missed[end] for end in ends]), *told, *bounded.given_up])
    kept, mirrored = search.without_images(paths)
    return Explored(kept, missing, mirrored)


def _by_cause(reasons: Sequence[str]) -> list[str]:
    """Merge reasons with the same cause after the colon.

    >>> _by_cause(["none at 1 Hz: no damping", "none at 2 Hz: no damping", "none at 3 Hz"])
    ['none at 1 Hz and none at 2 Hz: no damping', 'none at 3 Hz']
    """
    found: dict[str, list[str]] = {}
    for reason in reasons:
        what, _, cause = reason.partition(": ")
        found.setdefault(cause, []).append(what)
    return [": ".join(filter(None, (" and ".join(what), cause))) for cause, what in found.items()]


def _reaches_height(problem: OrbitProblem, paths: Sequence[Path], omega: float, height: float) -> bool:
    """Whether a path has motions as high as the balance near a frequency [rad/s]."""
    for path in paths:
        near = path.z[np.abs(path.parameter / omega - 1.0) < problem.options.balance.accuracy]
        if any(height_of(problem, z) >= problem.options.start.min_height * height for z in near):
            return True
    return False


@dataclass
class _BranchSearch:
    """Search for further branches of a problem.

    unreached: frequencies [rad/s] and amplitudes of points of the balance from which no motion as high was
    found. images: the two mirror images at each branch point from which a branch of unsymmetric motions
    leaves.
    """

    problem: OrbitProblem
    branches: Callable[..., Branches]
    bounded: BranchBudget
    uncertain: UncertainFrequencies
    unreached: list[tuple[float, float]] = field(default_factory=list)
    images: list[Sequence[FloatArray]] = field(default_factory=list)

    def with_others(self, paths: tuple[Path, ...], apart: bool) -> tuple[Path, ...]:
        """Add the paths found from the converged balance and from continuation in the force level.

        The latter is skipped if a motion as high was found from each end and peak of the balance. Points of
        the balance without such a motion are added to `unreached`, see `BalanceOrbits`. apart is that of
        `converged_balance`.
        """
        problem, bounded, scene = self.problem, self.bounded, self.problem.scene
        high = True
        for balance in bounded.each(converged_balance(scene, apart, bounded.poll, problem.options)):
            self.uncertain.replace_with(balance.traced)
            along = orbits_along_balance(problem, balance, bounded.outside)
            paths, high = self.with_motions(paths, along.points), along.near_balance
            self.unreached += along.unreached
        if high:
            return paths

        def there(omega: float) -> list[FloatArray]:
            return [z for path in paths for z in path.z[path.parameter == omega]]

        last = dict[float, LevelMotions]()
        for one in bounded.each(level_motions(scene, there, bounded)):
            paths = self.with_motions(paths, one.motions)
            last[one.omega] = one
            if self.too_many_broken(paths):
                return paths
        for one in (each for each in last.values() if not each.complete):
            failed = (
                f"takes more than its share of {bounded.most:.3g} s"
                if one.out_of_time
                else "cannot be followed"
            )
            bounded.add_reason(f"at {frequency_text(scene, one.omega)} the level of the forces {failed}")
        return paths

    def with_motions(self, paths: tuple[Path, ...], motions: Iterable[FloatArray]) -> tuple[Path, ...]:
        """Add the paths through motions that no path passes, unless too many paths break off."""
        for z in motions:  # no path is followed through a motion that is passed already
            if self.too_many_broken(paths):
                break
            if not is_known(paths, [z], self.problem):
                paths = self._with_branches_through(paths, z)
        return paths

    def _with_branches_through(self, paths: tuple[Path, ...], z: FloatArray) -> tuple[Path, ...]:
        """Add the branch through a motion, unless it is among the paths."""
        problem, more = self.problem, self.branches([z], known=paths).paths[len(paths) :]
        fresh = (one for one in more if not is_known(paths, distinct_motions(one, problem.options), problem))
        return (*paths, *fresh)

    def with_branching(
        self, paths: tuple[Path, ...], options: BranchingOptions = BRANCHING
    ) -> tuple[Path, ...]:
        """Add the paths that leave at branch points, unless too many paths break off."""
        problem = self.problem

        def points(fresh: Sequence[Path]) -> Iterator[BranchPoint]:
            found = branch_points_of(problem, lambda: np.array(problem.jacobian), fresh, options)
            return self.bounded.each(found)

        def extended(paths: tuple[Path, ...], point: BranchPoint) -> tuple[Path, ...] | None:
            if self.too_many_broken(paths):
                return None
            return self._with_branches_at(paths, point.starts, options)

        return with_leaving(paths, lambda paths: paths, points, extended, options)

    def _with_branches_at(
        self, paths: tuple[Path, ...], starts: Sequence[FloatArray], options: BranchingOptions
    ) -> tuple[Path, ...]:
        """Add the branches through starts at a branch point, unless they are among the paths.

        So close to another path, Newton's method may lead to that one. Two starts with the same amplitudes
        count as mirror images: otherwise amplitudes change by opposite amounts on the two sides.
        """
        problem = self.problem
        if not self._are_images(starts, options):
            for z in starts:
                paths = self._with_branches_through(paths, z)
            return paths
        self.images.append(starts)
        if any(contains(path, z, problem) for path in paths for z in starts):
            return paths
        new = self._with_branches_through(paths, starts[0])[len(paths) :]
        return (*paths, *(part for one in new for part in self._new_parts(one, paths)))

    def without_images(self, paths: Sequence[Path]) -> tuple[list[Path], int]:
        """Leave out mirror images; return the remaining paths and the number of images left out.

        Of two images one remains, and of a path that is its own image one half.
        """
        kept, mirrored = dict(enumerate(paths)), 0
        for starts in self.images:
            one, other = (
                next((k for k, path in kept.items() if contains(path, z, self.problem)), None) for z in starts
            )
            if one is None or other is None:  # already left out
                continue
            half = symmetric_half(kept[one]) if one == other else kept[one]
            mirrored += half is not kept[one] or one != other
            kept[one] = half
            if one != other:
                del kept[other]
        return list(kept.values()), mirrored

    def _new_parts(self, path: Path, paths: Sequence[Path]) -> list[Path]:
        """The parts of a path, between branch points, that no other path has; adjacent ones are joined."""
        ends = [0, *(i + 1 for i in sign_changes(path.orientation)), len(path.z)]
        middles = [(first + end) // 2 for first, end in pairwise(ends)]
        new = [not any(contains(one, path.z[i], self.problem) for one in paths) for i in middles]
        if all(new):
            return [path]
        inner = {0, len(middles)}.isdisjoint
        return [
            replace(
                path.part(np.arange(ends[first], ends[end])),
                status=Status.COMPLETE if path.status.is_whole or inner((first, end)) else path.status,
            )
            for first, end in runs(np.array(new))
        ]

    def _are_images(self, starts: Sequence[FloatArray], options: BranchingOptions) -> bool:
        """Whether there are two starts with the same amplitudes."""
        amplitudes = [shot.amplitude for z in starts if (shot := self.problem.shot(z)) is not None]
        if len(amplitudes) < 2:
            return False
        off = np.abs(np.subtract(*amplitudes)).max(initial=0.0)
        return bool(off <= options.motion_tolerance * np.max(amplitudes))

    def too_many_broken(self, paths: Sequence[Path]) -> bool:
        """Whether so many paths have broken off that no more are sought."""
        count = sum(not path.status.is_whole for path in paths)
        return count >= self.problem.options.search.max_broken


def is_known(paths: Sequence[Path], motions: Sequence[FloatArray], problem: OrbitProblem) -> bool:
    """Whether paths pass the majority of some motions.

    A single motion does not decide: at a branch point another branch passes it, and next to a fold it may not
    be found.
    """
    known = sum(any(passes(path, z, problem) for path in paths) for z in motions)
    return 2 * known > len(motions)


def distinct_motions(path: Path, options: ShootingOptions = SHOOTING) -> list[FloatArray]:
    """Motions of a path at equal intervals of points, for `is_known`."""
    chosen = np.linspace(0.0, len(path.z) - 1.0, options.search.compared_motions)
    return list(path.z[chosen.astype(np.intp)]) if len(path.z) else []


def branch_of(problem: OrbitProblem, path: Path) -> Branch:
    """The branch of the solutions on a path."""
    orbits = samples(problem, path)
    return Branch(orbits, path.status, problem.periods)


def incomplete(scene: Scene, paths: Sequence[Path], problem: str) -> str:
    """Reasons why the curve of some paths is incomplete, else ''."""
    broken = [path for path in paths if not path.status.is_whole]
    reasons = dict.fromkeys(
        f"stopped at {frequency_text(scene, path.parameter[-1])}: {path.status.value}" for path in broken
    )
    missing = [*reasons, *filter(None, [problem])]
    return "; ".join(missing) or ("" if paths else "no solution was found to start from")


def stop_reason(scene: Scene, paths: Sequence[Path]) -> str:
    """Text on where a curve was stopped and on its number of folds, which is great with light damping."""
    if not paths:
        return "the start"
    folds = sum(path.where(Mark.FOLD).size for path in paths)
    turns = f", after {folds} fold{'s' if folds > 1 else ''}" if folds else ""
    return frequency_text(scene, paths[-1].parameter[-1]) + turns


def frequency_text(scene: Scene, omega: float) -> str:
    """A frequency [rad/s] as text in the scene's unit."""
    return f"{omega / UNIT[scene.frequency_unit]:.8g} {scene.frequency_unit}"


def orbits_in_unstable_ranges(
    problem: OrbitProblem, paths: Sequence[Path], poll: Poll
) -> Iterator[FloatArray]:
    """Yield stable motions (unknown + 1,) from simulations from rest where all motions of paths are unstable.

    The frequencies are the middles of the widest such stretches of the range. Nothing is simulated if a mode
    is undamped.
    """
    scene = problem.scene
    if not (scene.modal.damping > 0.0).all():
        return
    parts = [(path.parameter, np.array([_stable(problem, z) for z in path.z])) for path in paths]
    for low, high in unstable_stretches(parts, scene.frequency_range)[: problem.options.stability.max_ranges]:
        try:
            orbit = approached(EquationsOfMotion(scene, 0.5 * (low + high)), poll, problem.options)
            if orbit.stable:
                yield first_point(problem, orbit, poll)
        except SimulationError:  # the motion does not become periodic, or is not determined
            continue


def _stable(problem: OrbitProblem, z: FloatArray) -> float:
    return float(recorded(problem, z).stable)
