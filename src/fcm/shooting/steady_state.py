"""The steady motion that a simulation reaches: the number of periods after which it repeats, or its range.

A motion repeats after a number of periods if Newton's method on their closure finds a stable motion close to
the simulated one. Of several the nearest counts: one of one period and one of two may both be stable. A
motion that does not repeat, and whose amplitudes neither grow nor decay any more, is quasi-periodic or
irregular. This is judged over windows of many cycles: growth or decay continues from each window to the next,
while an intermittent motion has bursts in some.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Poll, converged, never_interrupt, within_unit_circle
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import resting_at
from fcm.time_domain.contact_loads import contact_loads
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import Measure, measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.simulation import cycles_from
from fcm.time_domain.state import State


class SteadyMotion(NamedTuple):
    """A steady motion; amplitudes are half the peak-to-peak."""

    periods: int  # after which it repeats; 0 if it is quasi-periodic or irregular
    state: State  # at its start
    states: tuple[str, ...]  # of each contact over the periods, or over the last cycle
    measure: Measure  # over the periods, or over the examined cycles
    least: FloatArray  # (dof,) least amplitude of a cycle
    greatest: FloatArray  # (dof,) greatest amplitude of a cycle
    shares: FloatArray  # (contact, 3) of the time in stick, in slip, open
    multipliers: npt.NDArray[np.complex128]  # Floquet multipliers over the periods; empty for periods 0
    error: float  # closure error, relative to the motion; nan for periods 0
    contact_loads: FloatArray  # (contact, 4) as of `contact_loads`


def steady(
    system: EquationsOfMotion, state: State, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> SteadyMotion | State:
    """The steady motion that a simulation from a state reaches; without one, the state at its end.

    poll is called after every cycle.

    Examples
    --------
    >>> import fcm
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> found = steady(EquationsOfMotion(scene, 1.3), State.rest(scene))
    >>> found.periods, found.states, found.measure.amplitude.round(4)
    (1, ('SPEN',), array([7.1681, 7.1663]))
    """
    windows = list[list[Cycle]]()
    for count in options.steady.cycles:
        ends, cycles = deque([state], options.steady.max_periods + 1), list[Cycle]()
        for cycle, end in cycles_from(system, count, state):
            poll()
            ends.append(end)
            cycles.append(cycle)
        state = ends[-1]
        near = np.inf if _linear(cycles) else options.steady.max_distance
        every = [_repeating(system, state, k, near, options) for k in _candidates(ends, options)]
        found = [one for one in every if one is not None]
        if found:
            return min(found, key=lambda one: _distance(one.state, state))
        if count >= options.steady.ranging_cycles:
            windows.append(cycles)
    return (_ranging(windows, options) if windows else None) or state


def _distance(one: State, other: State) -> float:
    """Greatest difference of two states, relative to the displacements and the velocities."""
    pairs = ((one.q, other.q), (one.velocity, other.velocity))
    return max(float(np.abs(a - b).max() / max(np.abs(b).max(), 1e-300)) for a, b in pairs)


def _candidates(ends: Sequence[State], options: ShootingOptions = SHOOTING) -> list[int]:
    """Numbers of periods after which the motion may repeat, from the states at the ends of cycles."""
    past = np.array([np.concatenate((end.q, end.velocity)) for end in ends])
    size = np.maximum(np.abs(past).max(axis=0), 1e-300)
    apart = np.abs((past[-1] - past[-2::-1]) / size).max(axis=1)
    return [
        1,
        *(
            k + 1
            for k in range(1, apart.size)
            if apart[k] < min(options.steady.max_distance, options.steady.return_ratio * apart[:k].min())
        ),
    ]


def _linear(cycles: Sequence[Cycle]) -> bool:
    """Whether no contact changes its state: the transient then decays, however slowly."""
    return all(bool((np.ptp(np.asarray(cycle.segments.states), axis=0) == 0).all()) for cycle in cycles)


def _repeating(
    system: EquationsOfMotion, state: State, periods: int, near: float, options: ShootingOptions = SHOOTING
) -> SteadyMotion | None:
    """The stable motion near a state that repeats after this number of periods and not earlier; or None."""
    x = np.concatenate((state.q, state.velocity, state.friction))
    shot = _closed(system, x, x, periods, options)
    if shot is None or np.abs((shot.x - x) / shot.scale)[: 2 * system.modes].max() > near:
        return None
    if periods > 1 and (before := _shorter(shot, options)) is not None:
        shot = _flipped(before, x, periods, options)
        if shot is None:
            return None
    return _of_shot(shot) if within_unit_circle(shot.multipliers, options) else None


def multi_period_motion(shot: Shot) -> SteadyMotion | None:
    """A motion of several periods, stable or not, as a steady motion; None for one period."""
    return _of_shot(shot) if shot.periods > 1 else None


def _of_shot(shot: Shot) -> SteadyMotion:
    """The steady motion of a shot that closes after its periods."""
    parts = [measure(cycle) for cycle, _ in cycles_from(shot.system, shot.periods, shot.state)]
    amplitude = np.array([part.amplitude for part in parts])
    return SteadyMotion(
        shot.periods, shot.state, shot.cycle.states, measure(shot.cycle), amplitude.min(axis=0),
        amplitude.max(axis=0), state_fractions([shot.cycle]), shot.multipliers, shot.residual,
        contact_loads([shot.cycle]),
    )  # fmt: skip


def _closed(
    system: EquationsOfMotion,
    x: FloatArray,
    member: FloatArray,
    periods: int,
    options: ShootingOptions = SHOOTING,
) -> Shot | None:
    """The shot of a number of periods near x that closes; None without one.

    Contacts that never slip keep the rest positions of the state member.
    """
    try:
        found = converged(Shot(system, x, resting_at(system, member), periods), options=options)
    except SimulationError:
        return None
    return None if found is None else found[0]


def _shorter(shot: Shot, options: ShootingOptions = SHOOTING) -> Shot | None:
    """The motion over fewer periods, if it repeats earlier; else None."""
    for k in range(1, shot.periods):
        if shot.periods % k == 0:
            part = Shot(shot.system, shot.x, periods=k)
            if part.residual < options.doubling.closure_tolerance:
                return part
    return None


def _flipped(once: Shot, x: FloatArray, periods: int, options: ShootingOptions = SHOOTING) -> Shot | None:
    """The motion of doubled period near an unstable one that the simulated state x leaves alternately.

    Just beyond a flip the simulation leaves so slowly that Newton's method returns to the unstable motion.
    From farther away in the same direction it does not.
    """
    if periods != 2 * once.periods or once.multipliers[0].real >= -1.0:
        return None
    way = (x - once.x) / once.scale
    size = float(np.abs(way).max())
    for reach in options.doubling.distances:
        found = _closed(
            once.system, once.x + reach / max(size, 1e-300) * way * once.scale, x, periods, options
        )
        if found is not None and _shorter(found, options) is None:
            away = np.abs((found.x - once.x) / found.scale)[: 2 * once.system.modes].max()
            return found if away < options.steady.distinct_distance else None
    return None


def _ranging(windows: Sequence[list[Cycle]], options: ShootingOptions = SHOOTING) -> SteadyMotion | None:
    """The motion over windows of cycles that do not repeat; None if its amplitudes grow or decay.

    If they grow or decay over all windows, only the last window counts, judged by its halves.
    """
    measures = [[measure(cycle) for cycle in window] for window in windows]
    amplitudes = [np.array([one.amplitude for one in window]) for window in measures]
    if grows_or_decays(amplitudes, options):
        if grows_or_decays(np.array_split(amplitudes[-1], 2), options):
            return None
        windows, measures, amplitudes = windows[-1:], measures[-1:], amplitudes[-1:]
    cycles, amplitude = [one for window in windows for one in window], np.concatenate(amplitudes)
    start, none = cycles[0], np.zeros(0, dtype=np.complex128)
    system, y = start.system, np.asarray(start.segments.y)[0]
    state = State(y[system.q].copy(), y[system.p].copy(), y[system.f].copy(), start.angle)
    return SteadyMotion(
        0, state, cycles[-1].states, combined_measure([one for window in measures for one in window]),
        amplitude.min(axis=0), amplitude.max(axis=0), state_fractions(cycles), none, np.nan,
        contact_loads(cycles),
    )  # fmt: skip


def grows_or_decays(windows: Sequence[FloatArray], options: ShootingOptions) -> bool:
    """Whether mean or spread of amplitudes (cycle, dof) changes the same way from each window to the next."""
    mean = np.array([window.mean(axis=0) for window in windows])
    spread = np.array([window.std(axis=0) for window in windows])
    least = options.approach.max_drift * np.ptp(np.concatenate(windows), axis=0)
    part = options.steady.min_spread_ratio
    ways = (
        np.diff(mean, axis=0) > least,
        np.diff(mean, axis=0) < -least,
        spread[1:] < part * spread[:-1],
        spread[:-1] < part * spread[1:],
    )
    return any(bool(way.all(axis=0).any()) for way in ways)


def combined_measure(measures: Sequence[Measure]) -> Measure:
    """Combine the measures of successive cycles of one motion: extremes, mean and fundamental.

    >>> import numpy as np
    >>> one, other = (Measure(*np.full((6, 1), x)) for x in (1.0, 3.0))
    >>> combined_measure([one, other]).mean, combined_measure([one, other]).amplitude
    (array([2.]), array([1.]))
    """
    greatest = np.max([m.greatest for m in measures], axis=0)
    least = np.min([m.least for m in measures], axis=0)
    wave = np.mean([m.fundamental * np.exp(1j * m.phase) for m in measures], axis=0)
    mean = np.mean([m.mean for m in measures], axis=0)
    return Measure(0.5 * (greatest - least), np.abs(wave), np.angle(wave), mean, greatest, least)


def state_fractions(cycles: Sequence[Cycle]) -> FloatArray:
    """Fractions (contact, 3) of the time in which each contact sticks, slips and is open."""
    total = np.zeros((len(cycles[0].system.contacts), 4))
    for cycle in cycles:
        lasts = np.diff(np.append(np.asarray(cycle.segments.start), cycle.duration))
        for code in range(4):
            total[:, code] += lasts @ (np.asarray(cycle.segments.states) == code)
    total /= sum(cycle.duration for cycle in cycles)
    part: FloatArray = np.stack((total[:, 1], total[:, 2] + total[:, 3], total[:, 0]), axis=1)
    return part
