r"""Solutions from which the branches of a response are traced, by raising the level of the forces from rest.

At both ends of the range, at the resonances inside it that the structure has with its contacts all stuck, as
at rest, and all open, and in the middle of the widest interval between these, the level is followed from
nearly nothing until it is well beyond every level at which a contact can change what it does. Every passing
of the level 1 is a solution.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from fcm.branches.level_turns import Turn, turns_of
from fcm.branches.linear_limits import (
    closed_at_rest,
    foresee,
    highest,
    least,
    linear_responses,
)
from fcm.branches.options import LEVEL_CURVE, LINEAR_LIMITS
from fcm.branches.shared_levels import in_common, passings
from fcm.continuation import Events, FollowOptions, Path, Status, follow
from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.cost_model import paid, seconds_of
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


@dataclass(frozen=True)
class Found:
    """Solutions at one frequency with some harmonics, z (unknown + 1,), and whether their level was followed
    to its end, or back to its beginning; how far it is to be followed with more harmonics, infinite if that
    is not told; and where it turned.
    """

    omega: float
    harmonics: tuple[int, ...]
    solutions: tuple[FloatArray, ...]
    complete: bool
    reach: float
    turns: tuple[Turn, ...] = ()


@dataclass(frozen=True)
class LevelReachOptions:
    """How far the level of the forces is followed with many contacts, of which there always is one that slips
    or opens only far above 1: contacts, from so many on up to the level most, or only up to straight where
    the curve has not turned until then, or back by this part of its level at most: a contact that begins to
    slip in a plane turns its mean displacement as a root, which turns the level back a little.

    turn, miss, cosine, far, close: of the steps of a curve of which the passings of the level 1 alone matter,
    as of `fcm.continuation.options`, and to what its other points are known."""

    contacts: int = 12
    most: float = 12.0
    straight: float = 3.0
    back: float = 1e-3
    turn: float = 0.35
    miss: float = 0.1
    cosine: float = 0.5
    far: float = 1.0
    close: float = 1e-6


LEVEL_REACH = LevelReachOptions()  # where nothing else is said


def solutions(system: System, omega: float, reach: float | None = None) -> Found:
    """All solutions at omega on the curve of the force level that begins at rest.

    Far above 1 the curve of the level of many harmonics has many folds and corners, none of which matters if
    it does not come back. That of fewer tells: it comes back about as far. reach is what was found with them;
    otherwise a few are taken for that.
    """
    most, linear = highest(system, omega), LEVEL_CURVE.before * least(system, omega)
    if len(system.scene.contacts) >= LEVEL_REACH.contacts:
        most = min(most, LEVEL_REACH.most)
    if reach is None and len(system.harmonics) > few_of(system):
        few = system.with_harmonics(system.harmonics[: few_of(system)])
        reach = _followed(few, omega, linear, most, most).reach
    found = _followed(system, omega, linear, most if reach is None else min(reach, most), most)
    if linear >= 1.0:
        at_rest = np.append(next(linear_responses(system, omega, 1.0)), omega)
        return replace(found, solutions=(at_rest, *found.solutions))
    return found if found.solutions else replace(found, solutions=tuple(_from_linear(system, omega)))


def found_at(system: System, frequencies: Sequence[float], fewer: Sequence[Found] = ()) -> tuple[Found, ...]:
    """Solutions at some frequencies; those of fewer harmonics tell how far the level is to be followed."""
    foresee(system, frequencies)
    reach = {one.omega: one.reach for one in fewer if np.isfinite(one.reach)}
    return tuple(solutions(system, omega, reach.get(omega)) for omega in frequencies)


def _followed(system: System, omega: float, linear: float, top: float, most: float) -> Found:
    """What the level passes from where it is linear to its top, which may be less than the most."""
    if linear >= top:
        return Found(omega, system.harmonics, (), True, _reach(system, Status.COMPLETE, np.empty(0)))
    shared = _shared(system, omega, top) if top >= most else None
    return shared or _found(system, omega, linear, top)


def _found(system: System, omega: float, linear: float, top: float) -> Found:
    path, near = None, LEVEL_REACH.straight
    if len(system.scene.contacts) >= LEVEL_REACH.contacts and linear < near < top:
        path = _hasty(system, omega, linear, near, (1.0,))
        path = None if _turned(path) or path.status is not Status.COMPLETE else path
    path = path or _hasty(system, omega, linear, top, (1.0,))
    found = path.z[path.parameter == 1.0]
    found[:, -1] = omega
    complete = path.status in (Status.COMPLETE, Status.RETURNED)
    reach, turns = _reach(system, path.status, path.parameter), turns_of(path, omega)
    return Found(omega, system.harmonics, tuple(found), complete, reach, turns)


def _turned(path: Path) -> bool:
    """Whether a curve turns back by more than a beginning slip does."""
    levels = path.parameter
    return bool((levels < (1.0 - LEVEL_REACH.back) * np.maximum.accumulate(levels)).any())


def _shared(system: System, omega: float, top: float) -> Found | None:
    """The same from the curve that systems of other preloads have, too, if it goes as far.

    That is followed to its end, which is dear where fewer harmonics tell that less is enough.
    """
    if not system.unit or top >= LINEAR_LIMITS.greatest:
        return None
    path = in_common(system, omega, _whole)
    if path is not None:  # whoever followed it
        system.work.take(seconds_of(system, path.evaluations, len(system.harmonics)))
    if path is None or top > (1.0 + LEVEL_CURVE.rounded) * system.unit * path.parameter[-1]:
        return None
    found = passings(system, path, omega)
    if found is None:
        return None
    reach = _reach(system, path.status, system.unit * path.parameter)
    turns = turns_of(path, omega, system.unit)
    return Found(omega, system.harmonics, tuple(found), True, reach, turns)


def _whole(system: System, omega: float) -> Path:
    return _hasty(system, omega, LEVEL_CURVE.before * least(system, omega), highest(system, omega), ())


def _hasty(system: System, omega: float, linear: float, top: float, stations: tuple[float, ...]) -> Path:
    """The curve of the level, by long steps if those come to its end, and to its stations; shorter ones may
    where they do not."""
    for step, lightly in ((LEVEL_CURVE.long, True), (LEVEL_CURVE.step, False)):
        path = level_curve(system, omega, (0.0, top), step, stations, linear, True, lightly)
        if path.status is Status.COMPLETE and not _lost(path, stations):
            return path
    for step in (LEVEL_CURVE.step, LEVEL_CURVE.shorter * LEVEL_CURVE.step):
        path = level_curve(system, omega, (0.0, top), step, stations, linear)
        if path.status not in (Status.STALLED, Status.AROUND):
            break
    return replace(path, status=Status.STALLED) if _lost(path, stations) else path


def _lost(path: Path, stations: tuple[float, ...]) -> bool:
    """Whether a curve leads across one of its stations without a point there."""
    levels = path.parameter.tolist()
    return any((a - one) * (b - one) < 0.0 for one in stations for a, b in pairwise(levels))


def few_of(system: System) -> int:
    """How many harmonics tell how far the level of more is to be followed."""
    layout = system.layout
    means, each = layout.directions, layout.stride
    return min(max((LEVEL_CURVE.unknowns // max(layout.contacts, 1) - means) // each, 1), LEVEL_CURVE.few)


def _reach(system: System, status: Status, levels: FloatArray) -> float:
    """Up to which level the curve of more harmonics is to be followed, if those of a system tell it."""
    if status is not Status.COMPLETE or len(system.harmonics) < few_of(system):
        return np.inf
    near = np.flatnonzero(levels < LEVEL_CURVE.near)
    most = float(levels[: near[-1] + 1].max()) if near.size else LEVEL_CURVE.near
    return LEVEL_CURVE.further * max(most, LEVEL_CURVE.near)  # however far apart the points are


def level_curve(
    system: System,
    omega: float,
    span: tuple[float, float],
    step: float = LEVEL_CURVE.step,
    stations: tuple[float, ...] = (1.0,),
    linear: float = 0.0,
    hasty: bool = False,
    lightly: bool = False,
) -> Path:
    """Response at omega against the level of the forces, from rest, or from a level up to which it is
    linear; hasty if only its stations matter, as of `follow`, lightly if slight corners are stepped over."""
    # a stiffened resonance may take much less than leads to it
    path, low = None, max(span[0], LEVEL_CURVE.weak[-1])
    for weak in LEVEL_CURVE.weak:
        level = max(span[0], weak, linear)
        for x in linear_responses(system, omega, level):
            start, whole = np.append(x, level), (low, span[1])
            path = _raised(system, start, omega, whole, step, stations, hasty, lightly)
            if _back(path, low):
                path = _raised(system, start, omega, whole, LEVEL_CURVE.finer * step, stations)
                path = replace(path, status=Status.STALLED) if _back(path, low) else path
            if path.z.shape[0]:
                return path
    assert path is not None
    return path


def _raised(
    system: System,
    start: FloatArray,
    omega: float,
    span: tuple[float, float],
    step: float,
    stations: tuple[float, ...],
    hasty: bool = False,
    lightly: bool = False,
) -> Path:
    level, stepper = system.raised
    level.begin(omega, lightly)
    wanted, options = Events(stations), FollowOptions(step, hasty)
    if lightly and len(system.scene.contacts) >= LEVEL_REACH.contacts:
        reach = LEVEL_REACH
        steps = replace(options.step, turn=reach.turn, miss=reach.miss, cosine=reach.cosine, far=reach.far)
        newton = replace(options.newton, preliminary=reach.close)
        options = replace(options, step=steps, newton=newton)
    along = partial(follow, level, start, span, wanted, options, stepper=stepper)
    return paid(system, stepper, None, lambda report: along(progress=report))


def _back(path: Path, low: float) -> bool:
    """Whether a curve that began above the lowest level has gone all its way back.

    None does: where all is linear there is one solution.
    """
    levels = path.parameter
    return bool(levels.size and levels[0] > low and levels[-1] <= low)


def _from_linear(system: System, omega: float) -> Iterator[FloatArray]:
    """Solutions that Newton's method finds from linear responses, where no level could be followed."""
    newton = Newton(system.balance())
    row = np.zeros(newton.problem.unknowns + 1)
    row[-1] = 1.0
    for x in linear_responses(system, omega, 1.0):
        z = np.append(x, omega)
        newton.problem.measure(z)
        newton.scale[:] = newton.problem.scale
        newton.z[:], newton.row[:] = z, row
        if newton.correct(1.0):
            yield np.array(newton.z)


def looked_at(system: System) -> tuple[float, ...]:
    """The frequencies at which the level is followed."""
    span, inside = system.scene.frequency_range, resonances(system)
    known = np.array([span[0], *inside, span[1]])
    widest = int(np.diff(known).argmax())
    return *span, *inside, float(known[widest : widest + 2].mean())


def with_low_harmonics(system: System, found: Sequence[Found]) -> tuple[int, ...]:
    """Harmonics of a system, and the lowest where with these other solutions are reached from rest.

    found: where solutions were looked for with those of the system, and what was found. With one harmonic the
    level of the forces may turn back just above 1, or go on, and with three turn just below 1: its curve then
    shows nothing of what is there, and its errors are those of another motion.
    """
    few = tuple(sorted({*system.harmonics, *range(1, min(LEVEL_CURVE.enough, few_of(system)) + 1)}))
    if few == system.harmonics:
        return few
    finer = found_at(system.with_harmonics(few), [one.omega for one in found])
    same = all(len(one.solutions) == len(other.solutions) for one, other in zip(found, finer, strict=True))
    return system.harmonics if same else few


def resonances(system: System) -> list[float]:
    """Natural frequencies within the range, with all contacts stuck, as at rest, and all open, in order; of
    forces at other harmonics these divided by them."""
    low, high = system.scene.frequency_range
    stuck, found = system.springs(stuck=True), set[float]()
    for closed in (np.ones(stuck.size, dtype=bool), closed_at_rest(system), np.zeros(stuck.size, dtype=bool)):
        for harmonic in system.linear.driven:
            natural = (
                system.linear.stiffened(stuck * closed, harmonic) * (1.0 + LEVEL_CURVE.beside) / harmonic
            )
            found.update(float(w) for w in natural if low < w < high)
    return sorted(found)
