r"""Solutions from which the branches of a response are traced, found by raising the force level from rest.

The level is followed at both ends of the range, and at the resonances inside it of the structure with its
contacts all stuck, as at rest, and all open. It is also followed in the middle of the widest interval between
these, and in wide gaps through which a resonance moves. Each curve goes from nearly 0 to well beyond every
level at which a contact can change its sequence of states. Each crossing of the level 1 is a solution.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from fcm.branches.level_folds import LevelFold, level_folds
from fcm.branches.linear_limits import (
    closed_at_rest,
    highest_linear_limit,
    linear_responses,
    lowest_linear_limit,
    precompute,
)
from fcm.branches.options import LEVEL_CURVE, LINEAR_LIMITS
from fcm.branches.shared_levels import shared_curve, solutions_at_level_one
from fcm.continuation import End, Events, FollowOptions, Path, Status, follow
from fcm.continuation.corrector import Newton
from fcm.continuation.follow import Progress
from fcm.continuation.nearby_solution import solution_near
from fcm.frozen import Frozen
from fcm.harmonic_balance.cost_model import charged_to_work, seconds_of
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class LevelSolutions(Frozen):
    """Solutions at one frequency with some harmonics, each (unknown + 1,), on the curve of the level.

    complete: whether that curve was followed to its end, or back to its beginning. max_level: level up to
    which it is to be followed with more harmonics, infinite if unknown. folds: where the level turns back.
    """

    omega: float
    harmonics: tuple[int, ...]
    solutions: tuple[FloatArray, ...]
    complete: bool
    max_level: float
    folds: tuple[LevelFold, ...] = ()


class LevelReachOptions(Frozen):
    """Options on how far the level of the forces is followed with many contacts.

    One of many contacts always slips or opens only far above the level 1.

    Attributes
    ----------
    min_contacts : int
        Number of contacts from which on they are many.
    max_level : float
        Level up to which the curve is followed.
    max_level_without_fold : float
        Level up to which it is followed if it has not turned back until then.
    max_reversal : float
        Relative fall of its level up to which a curve does not count as turned back. The mean displacement of
        a contact that begins to slip in a plane changes like a root, which turns the level back a little.
    target_turn, target_miss, min_cosine, max_miss, tolerance : float
        Options of the steps of a curve of which only the points at the level 1 matter, as in
        `fcm.continuation.options`; and the tolerance of its other points.
    corner_tolerance : float
        Error of the place of a corner, relative to the step.
    beyond_fraction, min_seconds_beyond : float
        Most work beyond the level 1, relative to the work up to it; and [s] work that is allowed in any case.
        A curve that is given up there is not complete: it may come back to 1.
    """

    min_contacts: int = 12
    max_level: float = 12.0
    max_level_without_fold: float = 3.0
    max_reversal: float = 1e-3
    target_turn: float = 0.35
    target_miss: float = 0.1
    min_cosine: float = 0.5
    max_miss: float = 1.0
    tolerance: float = 1e-6
    corner_tolerance: float = 1e-6
    beyond_fraction: float = 1.0
    min_seconds_beyond: float = 5.0


LEVEL_REACH = LevelReachOptions()  # the defaults


def solutions(system: System, omega: float, max_level: float | None = None) -> LevelSolutions:
    """All solutions at omega on the curve of the force level that begins at rest.

    With many harmonics, the curve has many folds and corners far above 1, which do not matter if it does not
    come back. The curve of fewer harmonics shows how far it has to be followed. max_level is that result; if
    it is not given, a few harmonics are followed first.
    """
    most, linear = (
        highest_linear_limit(system, omega),
        system.option(LEVEL_CURVE).linear_fraction * lowest_linear_limit(system, omega),
    )
    reached = system.option(LEVEL_REACH)
    if len(system.scene.contacts) >= reached.min_contacts:
        most = min(most, reached.max_level)
    if max_level is None and len(system.harmonics) > few_harmonics(system):
        few = system.with_harmonics(system.harmonics[: few_harmonics(system)])
        max_level = _followed(few, omega, linear, most).max_level
    found = _followed(system, omega, linear, most if max_level is None else min(max_level, most))
    if linear >= 1.0:
        at_rest = np.append(next(linear_responses(system, omega, 1.0)), omega)
        return replace(found, solutions=(at_rest, *found.solutions))
    return found if found.solutions else replace(found, solutions=tuple(_from_linear(system, omega)))


def solutions_at(
    system: System, frequencies: Sequence[float], fewer: Sequence[LevelSolutions] = ()
) -> tuple[LevelSolutions, ...]:
    """Solutions at some frequencies; those of fewer harmonics show how far the level is to be followed."""
    return tuple(solutions_in_turn(system, frequencies, fewer))


def solutions_in_turn(
    system: System, frequencies: Sequence[float], fewer: Sequence[LevelSolutions] = ()
) -> Iterator[LevelSolutions]:
    """Yield the solutions of `solutions_at`, each computed when it is needed."""
    precompute(system, frequencies)
    max_levels = {one.omega: one.max_level for one in fewer if np.isfinite(one.max_level)}
    for k, omega in enumerate(frequencies, start=1):
        system.work.tell(f"the level of the forces, {k} of {len(frequencies)}")
        yield solutions(system, omega, max_levels.get(omega))


def _followed(system: System, omega: float, linear: float, top: float) -> LevelSolutions:
    """Solutions at the level 1 on the curve from where it is linear to its top."""
    if linear >= top:
        return LevelSolutions(
            omega, system.harmonics, (), True, _max_level(system, Status.COMPLETE, np.empty(0))
        )
    return _shared(system, omega, top) or _found(system, omega, linear, top)


def _found(system: System, omega: float, linear: float, top: float) -> LevelSolutions:
    options = system.option(LEVEL_REACH)
    path, near = None, options.max_level_without_fold
    if len(system.scene.contacts) >= options.min_contacts and linear < near < top:
        path = _coarse_curve(system, omega, linear, near, (1.0,))
        again = path.status is not Status.COMPLETE or turned_back(path, options)
        path = None if again and path.status not in (Status.EVENT, Status.REVERSED) else path
    path = path or _coarse_curve(system, omega, linear, top, (1.0,))
    found = path.z[path.parameter == 1.0]
    found[:, -1] = omega
    complete = path.status in (Status.COMPLETE, Status.RETURNED)
    max_level, turns = _max_level(system, path.status, path.parameter), level_folds(path, omega)
    return LevelSolutions(omega, system.harmonics, tuple(found), complete, max_level, turns)


def turned_back(path: Path, options: LevelReachOptions) -> bool:
    """Whether a curve of the level turns back by more than the onset of slip does.

    Only levels above 1 / `max_level_without_fold` count.
    """
    levels = path.parameter[path.parameter > 1.0 / options.max_level_without_fold]
    return bool((levels < (1.0 - options.max_reversal) * np.maximum.accumulate(levels)).any())


def _shared(system: System, omega: float, top: float) -> LevelSolutions | None:
    """Solutions from the curve shared by systems of other preloads, up to a level; None if there is none."""
    if not system.preload_unit or top >= LINEAR_LIMITS.max_level:
        return None
    path = shared_curve(system, omega, top / system.preload_unit, _without_user_points)
    if path is None:
        return None
    system.work.add(seconds_of(system, path.evaluations, len(system.harmonics)))  # also of another
    found = solutions_at_level_one(system, path, omega)
    if found is None:
        return None
    max_level = _max_level(system, path.status, system.preload_unit * path.parameter)
    turns = level_folds(path, omega, system.preload_unit)
    return LevelSolutions(omega, system.harmonics, tuple(found), True, max_level, turns)


def _without_user_points(system: System, omega: float, top: float) -> Path:
    linear = system.option(LEVEL_CURVE).linear_fraction * lowest_linear_limit(system, omega)
    return _coarse_curve(system, omega, linear, top, ())


def _coarse_curve(
    system: System, omega: float, linear: float, top: float, user_values: tuple[float, ...]
) -> Path:
    """Follow the curve of the level by long steps, or by shorter ones if those fail.

    Steps fail if they do not reach the end of the curve, and all its user points. Shorter steps do not help
    if the curve goes back on itself, or is too long.
    """
    options = system.option(LEVEL_CURVE)
    for step, over_corners in ((options.max_step_user_points, True), (options.max_step, False)):
        path = level_curve(
            system, omega, LevelRange((0.0, top), step, user_values, linear, True, over_corners)
        )
        if path.status in (Status.REVERSED, Status.TOO_LONG):
            return path
        if path.status in (Status.COMPLETE, Status.EVENT) and not _skips_user_point(path, user_values):
            return path
    for step in (options.max_step, options.stalled_fraction * options.max_step):
        path = level_curve(system, omega, LevelRange((0.0, top), step, user_values, linear))
        if path.status not in (Status.STALLED, Status.AROUND):
            break
    return replace(path, status=Status.STALLED) if _skips_user_point(path, user_values) else path


def _skips_user_point(path: Path, user_values: tuple[float, ...]) -> bool:
    """Whether a curve crosses one of its user values without a point there."""
    off = path.parameter - np.array(user_values)[:, None]
    return bool((off[:, :-1] * off[:, 1:] < 0.0).any())


def few_harmonics(system: System) -> int:
    """Number of harmonics that show how far the level is to be followed with more."""
    layout, options = system.layout, system.option(LEVEL_CURVE)
    means, each = layout.directions, layout.stride
    return min(
        max((options.few_unknowns // max(layout.contacts, 1) - means) // each, 1), options.few_harmonics
    )


def _max_level(system: System, status: Status, levels: FloatArray) -> float:
    """Level up to which the curve of more harmonics is to be followed; inf if that is unknown."""
    if status is not Status.COMPLETE or len(system.harmonics) < few_harmonics(system):
        return np.inf
    options = system.option(LEVEL_CURVE)
    near = np.flatnonzero(levels < options.clear_level)
    most = float(levels[: near[-1] + 1].max()) if near.size else options.clear_level
    return options.reach_factor * max(most, options.clear_level)  # at least that, if points are far apart


class LevelRange(Frozen):
    """A range of levels over which a response is followed, and how.

    Attributes
    ----------
    span : (float, float)
        Lowest and highest level.
    step : float
        Longest step, as in `FollowOptions`.
    user_values : tuple of float
        Levels at which a point is computed.
    linear : float
        Level up to which the response is known to be linear.
    user_points_only : bool
        Whether nothing but the user points matters, as in `FollowOptions`.
    over_corners : bool
        Whether slight corners are stepped over.
    progress : callable, optional
        Called from time to time with the fraction of the span that is covered.
    """

    span: tuple[float, float]
    step: float = LEVEL_CURVE.max_step
    user_values: tuple[float, ...] = (1.0,)
    linear: float = 0.0
    user_points_only: bool = False
    over_corners: bool = False
    progress: Progress | None = None


def level_curve(system: System, omega: float, levels: LevelRange) -> Path:
    """Response at omega against the level of the forces, from rest, or from where it ceases to be linear."""
    # a stiffened resonance may take much less than leads to it
    options, (first, last) = system.option(LEVEL_CURVE), levels.span
    path, low = None, max(first, options.linear_levels[-1])
    whole = replace(levels, span=(low, last))
    shorter = options.reversed_fraction * levels.step
    carefully = replace(whole, step=shorter, user_points_only=False, over_corners=False)
    for weak in options.linear_levels:
        level = max(first, weak, levels.linear)
        for x in linear_responses(system, omega, level):
            start = np.append(x, level)
            path = _follow_level(system, start, omega, whole)
            if _comes_back(path, low):
                path, top = _follow_level(system, start, omega, carefully), path.parameter.max()
                if _comes_back(path, low):
                    same = abs(path.parameter.max() - top) < options.reversal_tolerance * top
                    path = replace(path, status=Status.REVERSED if same else Status.STALLED)
            if path.z.shape[0]:
                return path
    assert path is not None
    return path


def _follow_level(system: System, start: FloatArray, omega: float, levels: LevelRange) -> Path:
    level, stepper = system.level_problem
    level.begin(omega, levels.over_corners)
    wanted = Events(levels.user_values)
    options = FollowOptions(levels.step, levels.user_points_only, step=system.option(LEVEL_CURVE).step)
    if levels.over_corners and len(system.scene.contacts) >= system.option(LEVEL_REACH).min_contacts:
        reach = system.option(LEVEL_REACH)
        steps = replace(
            options.step,
            target_turn=reach.target_turn,
            target_miss=reach.target_miss,
            min_cosine=reach.min_cosine,
            max_miss=reach.max_miss,
        )
        newton = replace(options.newton, preliminary_tolerance=reach.tolerance)
        events = replace(options.events, tolerance=reach.corner_tolerance)
        options = replace(options, step=steps, newton=newton, events=events)
        if 1.0 in levels.user_values:
            enough = _WayBeyond(stepper.newton, seconds_of(system, 1, len(system.harmonics)), reach)
            wanted = replace(wanted, ends=(End(enough),))
    along = partial(follow, level, start, levels.span, wanted, options, stepper=stepper)
    return charged_to_work(system, stepper, levels.progress, lambda report: along(progress=report))


class _WayBeyond:
    """End function of a curve of the level: 1 as long as it may be followed beyond the level 1, then -1.

    See `LevelReachOptions.beyond_fraction`.
    """

    def __init__(self, newton: Newton, each: float, options: LevelReachOptions) -> None:
        """Count the evaluations of newton, each of which takes `each` seconds of work."""
        self.newton, self.each, self.options = newton, each, options
        self.to_one: float | None = None

    def __call__(self, z: FloatArray) -> float:
        taken = self.each * self.newton.evaluations
        if self.to_one is None and z[-1] < 1.0:
            return 1.0
        if self.to_one is None:
            self.to_one = taken
        most = max(self.options.beyond_fraction * self.to_one, self.options.min_seconds_beyond)
        return 1.0 if taken - self.to_one <= most else -1.0


def _comes_back(path: Path, low: float) -> bool:
    """Whether a curve that began above the lowest level has gone all the way back to it.

    No true curve does: where all is linear, there is only one solution.
    """
    levels = path.parameter
    return bool(levels.size and levels[0] > low and levels[-1] <= low)


def _from_linear(system: System, omega: float) -> Iterator[FloatArray]:
    """Yield solutions that Newton's method finds from linear responses, if no level could be followed."""
    newton = Newton(system.new_balance())
    for x in linear_responses(system, omega, 1.0):
        found = solution_near(newton, np.append(x, omega))
        if found is not None:
            yield found


def level_frequencies(system: System, peaks: Sequence[float] = ()) -> tuple[float, ...]:
    """The frequencies at which the level is followed; peaks: those of a response with fewer harmonics."""
    span, inside = system.scene.frequency_range, linear_resonances(system)
    known = np.array([span[0], *inside, span[1]])
    widest = int(np.diff(known).argmax())
    found = (*span, *inside, float(known[widest : widest + 2].mean()))
    return *found, *frequencies_in_gaps(system, found, peaks)


def frequencies_in_gaps(
    system: System, known: Sequence[float], peaks: Sequence[float] = ()
) -> Iterator[float]:
    """Yield frequencies between the known ones, where these are far apart and a mode may resonate.

    As its amplitude grows, a resonance moves from where the contacts stick to where they are open. A closed
    branch may lie where the level is 1 on this way, and levels followed far from there do not show it. If the
    response of fewer harmonics has a peak, that of more has one nearby, which may be isolated.
    """
    if len(system.scene.contacts) >= system.option(LEVEL_REACH).min_contacts:
        return
    stuck, options = system.springs(stuck=True), system.option(LEVEL_CURVE)
    most, distinct = options.max_gap, options.distinct_peak
    moved = [
        band
        for harmonic in system.linear.driven
        for band in zip(
            system.linear.stiffened(0.0 * stuck, harmonic) / harmonic,
            system.linear.stiffened(stuck, harmonic) / harmonic,
            strict=True,
        )
    ]
    for low, high in pairwise(sorted(known)):
        inner = [(max(low, a), min(high, b)) for a, b in moved if a < high and b > low]
        if low <= 0.0 or not inner:
            continue
        count = max(math.ceil(math.log(high / low) / math.log1p(most)), 1)
        spaced = [low * (high / low) ** (k / count) for k in range(count + 1)]
        apart = spaced[1:-1]
        for omega in peaks:
            if min(abs(omega - other) for other in (*spaced, *apart)) > distinct * omega:
                apart.append(omega)
        yield from (omega for omega in apart if any(a < omega < b for a, b in inner))


def with_low_harmonics(system: System, found: Sequence[LevelSolutions]) -> tuple[int, ...]:
    """Harmonics of a system with the lowest added, if these find other solutions from rest.

    found: solutions with the system's harmonics, at all frequencies searched. With one harmonic the level of
    the forces may turn back just above 1, or not at all, where with three it turns back just below 1. Its
    curve then shows nothing of the further solutions, and its errors are those of another motion.
    """
    low = min(system.option(LEVEL_CURVE).reliable_harmonics, few_harmonics(system))
    few = tuple(sorted({*system.harmonics, *range(1, low + 1)}))
    if few == system.harmonics:
        return few
    finer = solutions_at(system.with_harmonics(few), [one.omega for one in found])
    same = all(len(one.solutions) == len(other.solutions) for one, other in zip(found, finer, strict=True))
    return system.harmonics if same else few


def linear_resonances(system: System) -> list[float]:
    """Resonances within the range with all contacts stuck, as at rest, and all open, in order.

    They are natural frequencies divided by each driven harmonic, with the small `resonance_offset`.
    """
    low, high = system.scene.frequency_range
    stuck, found = system.springs(stuck=True), set[float]()
    offset = system.option(LEVEL_CURVE).resonance_offset
    for closed in (np.ones(stuck.size, dtype=bool), closed_at_rest(system), np.zeros(stuck.size, dtype=bool)):
        for harmonic in system.linear.driven:
            natural = system.linear.stiffened(stuck * closed, harmonic) * (1.0 + offset) / harmonic
            found.update(float(w) for w in natural if low < w < high)
    return sorted(found)
