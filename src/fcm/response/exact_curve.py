"""Task that computes a curve of exact periodic solutions: followed in its range, or visited."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import field, replace
from functools import partial

from fcm.frozen import Frozen
from fcm.harmonic_balance.stiff_contacts import too_stiff
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, HeldContact, Scene
from fcm.reduction.constant_state_contacts import NotKeptError, check_kept, expected_constant
from fcm.response.coexisting_orbits import coexisting_orbits
from fcm.response.coexisting_search import Search
from fcm.response.curve_batches import Group, lost_curve
from fcm.response.only_peaks import PeaksOnly, peaks_curve, peaks_of, peaks_only
from fcm.response.options import EXACT_CURVES, ExactOptions
from fcm.response.orbit_branches import OrbitBranches
from fcm.response.orbit_curve import orbit_curve, visited_curve
from fcm.response.reinstated_contacts import ReinstatedContacts
from fcm.response.resumable_branches import CurveTimeLimit, ResumablePaths, TimeOver
from fcm.response.stepped_sweep import SteppedSweep
from fcm.results.cause import Cause
from fcm.results.result import INTERRUPTED, Curve
from fcm.run import Interrupted, Report
from fcm.scene.errors import counted
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.orbit_record import OrbitRecord
from fcm.shooting.period_doubling import DoubledPeriodProblem, doubled_paths
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.trace import explore, frequency_text, incomplete, stop_reason
from fcm.shooting.work_budget import UncertainFrequencies
from fcm.time_domain.errors import SimulationError

Expected = Callable[[Scene, Callable[[], None]], tuple[HeldContact, ...]]
AT_END = f"{INTERRUPTED} at its end, while other motions beside its points were sought"


class ExactCurveTask(Frozen):
    """The task that computes exact curves: traced, or visited at frequencies."""

    at: tuple[float, ...] | None  # [rad/s]
    only_peaks: bool = False
    whole: bool = False  # nothing may be left out
    periods: int = 1  # greatest number of periods of motions that are followed
    shooting: ShootingOptions = SHOOTING
    options: ExactOptions = EXACT_CURVES
    expected: Expected = expected_constant  # finds the contacts that are held at first

    def __call__(self, group: Group, report: Report) -> list[Curve]:
        return [self._curve(scene, report) for scene in group]

    def _curve(self, scene: Scene, report: Report) -> Curve:
        begin = time.perf_counter()
        try:
            curve = self._made(scene, report)
        except SimulationError as error:  # no state of rest exists
            curve = lost_curve(scene, str(error))
        curve = replace(curve, seconds=time.perf_counter() - begin)
        if not curve.complete and curve.cause is Cause.INTERRUPTED:
            raise Interrupted([curve])
        return curve

    def _made(self, scene: Scene, report: Report) -> Curve:
        if self.at is not None:
            return _visited(scene, self.at, report, self.options, self.shooting)
        stiff, limit = _too_stiff(scene, self.options)
        clock = CurveTimeLimit(limit, report)
        try:
            return self._in_time(scene, report, clock, stiff)
        except TimeOver as stop:  # before the search for the first point
            return lost_curve(scene, f"{_stop_prefix(stop, limit)}the start{stiff}")

    def _in_time(self, scene: Scene, report: Report, clock: CurveTimeLimit, stiff: str) -> Curve:
        followed = _CurveFollower(
            report, clock, stiff, self.periods, options=self.shooting, search=self.options.search_fraction
        )
        if self.only_peaks:
            return followed.peaks(scene)
        if self.whole or len(scene.contacts) < self.options.min_contacts:
            return followed.curve(scene)
        return followed.with_held_contacts(scene, self.expected(scene, clock.poll))


class _CurveFollower(Frozen):
    """Follows the exact curves of a scene in its range."""

    report: Report
    clock: CurveTimeLimit
    stiff: str  # sentence on a contact that is too stiff, added where a curve is incomplete
    periods: int
    before: list[tuple[OrbitProblem, ResumablePaths]] = field(default_factory=list)  # the paths followed last
    uncertain: UncertainFrequencies = field(
        default_factory=UncertainFrequencies
    )  # of the balance that gave the starting points
    options: ShootingOptions = SHOOTING
    search: float = EXACT_CURVES.search_fraction

    def with_held_contacts(self, scene: Scene, held: tuple[HeldContact, ...]) -> Curve:
        """Follow the curve with contacts held that keep their state all along it.

        Contacts that turn out to change their state are released, and the curve is followed again.
        """
        while True:
            lost: tuple[int, ...] = ()
            try:
                curve = self._held_or_lost(scene, held)
            except NotKeptError as found:
                curve, lost = lost_curve(scene, found.reason), found.places
            if not (held and (lost or not curve.points)):
                return curve
            if curve.cause is Cause.INTERRUPTED or self.clock.over:
                return lost_curve(
                    scene, curve.reason, curve.cause
                )  # the points found belong to contacts that are wrongly held
            held = tuple(one for one in held if lost and one.place not in lost)

    def _held_or_lost(self, scene: Scene, held: tuple[HeldContact, ...]) -> Curve:
        """The curve with contacts held; a curve without points if it cannot be begun."""
        if not held:
            return self.curve(scene)
        try:
            return self.curve(scene.holding(held))
        except SimulationError as error:
            return lost_curve(scene, str(error))

    def curve(self, scene: Scene) -> Curve:
        """Follow the curve with all contacts that the scene computes."""
        groups, reason, cause = self.branches(scene)
        search = Search(self.clock.poll, self.report, self.options)
        return _with_uncertain_frequencies(
            _finished(partial(orbit_curve, groups), reason, search, cause), self.uncertain
        )

    def peaks(self, scene: Scene) -> Curve:
        """Compute the curve of peaks, folds and jumps alone."""
        known, search = list[OrbitRecord](), Search(self.clock.poll, self.report, self.options)
        try:
            alone = peaks_only(scene, known, self.report, self.clock.poll, self.options)
        except (KeyboardInterrupt, TimeOver) as stop:
            where = frequency_text(scene, known[-1].frequency) if known else "the start"
            reason = _stop_prefix(stop, self.clock.limit) + where + self.stiff
            found = PeaksOnly(sorted(known, key=lambda one: one.frequency))
            return _finished(partial(peaks_curve, scene, found), reason, search, _cause(stop))
        if alone is not None:
            return _with_uncertain_frequencies(
                _finished(partial(peaks_curve, scene, alone), "", search), alone.uncertain
            )
        groups, reason, cause = self.branches(scene)
        return _with_uncertain_frequencies(
            _finished(partial(peaks_of, groups), reason, search, cause), self.uncertain
        )

    def branches(self, scene: Scene) -> tuple[list[OrbitBranches], str, Cause]:
        """Follow all branches; return them, the reason why they are incomplete, else '', and its cause.

        The reason includes the sentence on stiff contacts.

        Raises
        ------
        NotKeptError
            If a contact that is held would not have kept its state.
        """
        resumable = ResumablePaths(
            scene.frequency_range, self.report, self.clock.poll, _check_held_contacts if scene.held else None
        )
        problems, groups, cause = (
            [OrbitProblem(scene, options=self.options)],
            list[OrbitBranches](),
            Cause.CALCULATION,
        )
        try:
            for problem, found in self.before:
                resumable.take(ReinstatedContacts(problem, problems[0]).saved_paths(found.found(problem)))
            self.before[:] = [(problems[0], resumable)]
            explored = explore(
                problems[0], resumable, resumable.poll, self.clock.share(self.search), self.uncertain
            )
            reason = incomplete(scene, explored.paths, explored.missing)
            groups.append(OrbitBranches(problems[0], explored.paths, mirrored=explored.mirrored))
            while 2 * problems[-1].repeats <= self.periods and not reason:
                problem = DoubledPeriodProblem(problems[-1])
                problems.append(problem)
                paths, lost = doubled_paths(problem, groups[-1].points, resumable, resumable.poll)
                reason = incomplete(scene, paths, "") if paths else ""
                reason = reason or (_missing_periods(problem, lost) if lost else "")
                groups.append(OrbitBranches(problem, paths, groups[-1]))
        except (KeyboardInterrupt, TimeOver) as stop:
            resumable.keep()
            while resumable.paths(
                further := DoubledPeriodProblem(problems[-1])
            ):  # an earlier run has reached them
                problems.append(further)
            groups = [OrbitBranches(one, resumable.paths(one), cut_off=True) for one in problems]
            paths = [path for group in groups for path in group.paths]
            reason, cause = _stop_prefix(stop, self.clock.limit) + stop_reason(scene, paths), _cause(stop)
        return groups, reason + self.stiff if reason else "", cause


def _finished(
    made: Callable[[str, Search], Curve], reason: str, search: Search, cause: Cause = Cause.CALCULATION
) -> Curve:
    """Make the curve of the branches found; after an interruption, without a search for other motions."""
    if cause is Cause.INTERRUPTED:
        search.end()
    try:
        return replace(made(reason, search), cause=cause)
    except KeyboardInterrupt:
        search.end()
        curve = made(f"{AT_END}; {reason}" if reason else AT_END, search)
        return replace(curve, cause=Cause.INTERRUPTED)


def _with_uncertain_frequencies(curve: Curve, uncertain: UncertainFrequencies) -> Curve:
    """Add the frequencies at which the balance that gave its starting points may lack branches."""
    curve.uncertain_at, curve.folds_uncertain_at = list(uncertain.levels), list(uncertain.folds)
    return curve


def _missing_periods(problem: OrbitProblem, lost: int) -> str:
    """Sentence on period doublings at which the motions of doubled period were not found."""
    return (
        f"from {counted(lost, 'period doubling')} no motion was found that repeats after {problem.repeats} "
        "periods"
    )


def _check_held_contacts(problem: OrbitProblem, z: FloatArray) -> None:
    """Raise `NotKeptError` if a held contact would change its state in the motion at z."""
    shot = problem.shot(z)
    if shot is not None:
        check_kept(shot)


def _stop_prefix(stop: BaseException, limit: float | None) -> str:
    """First part of the sentence on why a curve was stopped."""
    over = isinstance(stop, TimeOver)
    return f"not finished in {limit:g} s of processor time, at " if over else f"{INTERRUPTED} at "


def _cause(stop: BaseException) -> Cause:
    """Cause of the incompleteness of a curve that was stopped."""
    return Cause.CALCULATION if isinstance(stop, TimeOver) else Cause.INTERRUPTED


def _too_stiff(scene: Scene, options: ExactOptions) -> tuple[str, float | None]:
    """Sentence on a contact too stiff for integration in time, else ''; and the time limit [s].

    Without a limit by the user, `stiff_seconds` limits a curve with such a contact, which may never end.
    """
    whole, limit = scene.whole(), options.max_seconds
    resists = whole.contacts and whole.modal.frequency.all()
    stiff = too_stiff(System(whole, (1,)), moves=True) if resists else ""
    return stiff, options.stiff_seconds if stiff and limit is None else limit


def _visited(
    scene: Scene, at: tuple[float, ...], report: Report, options: ExactOptions, shooting: ShootingOptions
) -> Curve:
    around = replace(scene, frequency_range=(0.0, at[-1]))
    stiff, limit = _too_stiff(replace(scene, frequency_range=(at[0], at[-1])), options)
    looks = CurveTimeLimit(limit, report)
    poll = looks.poll
    visitor, others, reason, uncertain = (
        SteppedSweep(around, poll),
        list[OrbitRecord](),
        "",
        UncertainFrequencies(),
    )
    cause = Cause.CALCULATION
    try:
        visitor.run(at, report)
        others.extend(coexisting_orbits(scene, at, visitor.points, looks, uncertain, shooting))
    except (KeyboardInterrupt, TimeOver) as stop:
        where = frequency_text(scene, visitor.points[-1].frequency) if visitor.points else "the start"
        reason, cause = _stop_prefix(stop, limit) + where, _cause(stop)
    except SimulationError as error:
        reason = str(error)
    reason = reason or visitor.reason
    reason = reason + stiff if reason else ""
    found = _finished(
        partial(visited_curve, scene, visitor, others), reason, Search(poll, report, shooting), cause
    )
    return _with_uncertain_frequencies(found, uncertain)
