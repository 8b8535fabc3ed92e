"""From transition to transition: when a combination of states ends, and which one follows.

What follows is decided by the sign of the first derivative that does not vanish of each exit function, so
that coinciding transitions, grazing ones and contacts released at rest need no cases of their own. Up to
that derivative the motion is the same in the old and the new state, so that the answer is unique.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from fcm.scene.model import FloatArray
from fcm.simulate.descent import first_descent
from fcm.simulate.errors import CycleError
from fcm.simulate.flow import LONGEST, SHORTEST, Flow
from fcm.simulate.system import NEGATIVE, OPEN, POSITIVE, STICK, System

ROUNDING = 3e-14  # of a state vector after a step, relative to its terms; a derivative below it is zero
DEPTH = 1e-13  # an exit that is passed by less than this, relative to its size, is not passed
MOST_PASSES = 100  # until a combination of states agrees with itself
LEADING = 8  # derivatives that are looked at
MOST_TRANSITIONS = 200_000  # in one cycle
MOST_STEPS = 2e8  # in one cycle


class Segment(NamedTuple):
    """The motion between two transitions."""

    flow: Flow
    states: str  # one letter of EPNS for each contact
    start: float  # [s] from the start of the cycle
    y: FloatArray  # (d,) at the start
    length: float  # in steps of the flow
    exit: int  # row of the exit that ended it, -1 at the end of the cycle


def march(
    system: System, y: FloatArray, states: str, duration: float
) -> tuple[list[Segment], FloatArray, str]:
    """The segments of the motion over a duration [s], the state at its end and the contacts' states."""
    _check_steps(system, states, duration)
    segments: list[Segment] = []
    time, forced, terms = 0.0, -1, system.flow(states).terms(y)
    while True:
        y, states, powers = settle(system, y, states, ROUNDING * terms, forced)
        flow = system.flow(states)
        left = (duration - time) / flow.step
        position, y_end, forced, terms = next_exit(flow, y, powers, left)
        segments.append(Segment(flow, states, time, y, position, forced))
        if forced < 0:
            return segments, y_end, states
        time, y = time + position * flow.step, y_end
        if len(segments) > MOST_TRANSITIONS:
            raise CycleError(
                f"more than {MOST_TRANSITIONS} transitions in one cycle at {system.omega:g} rad/s: "
                "the contacts chatter; give the modes more damping, or the contacts less stiffness"
            )


def _check_steps(system: System, states: str, duration: float) -> None:
    steps = duration / system.flow(states).step
    if steps > MOST_STEPS:
        raise CycleError(
            f"a cycle at {system.omega:g} rad/s lasts {steps:.1g} radians of the fastest motion; "
            "give the contacts less stiffness, leave the highest modes out, or raise the frequency"
        )


def settle(
    system: System, y: FloatArray, states: str, noise: FloatArray, forced: int = -1
) -> tuple[FloatArray, str, FloatArray]:
    """The combination of states that lasts from y on.

    Parameters
    ----------
    states : str
        The states until now; `forced` is the exit that they have just passed, or -1.
    noise : (d,)
        Rounding error of y.

    Returns
    -------
    y, states, powers
        The state with the friction forces of the new states, and the exits' Taylor coefficients from
        there, (ORDER + 1, exit), cleaned of leading rounding.
    """
    for _ in range(MOST_PASSES):
        flow = system.flow(states)
        powers = flow.exits @ y
        failed = _failing(flow, powers, noise)
        if forced >= 0 and forced not in failed:
            failed.append(forced)
        forced = -1
        if not failed:
            return y, states, powers
        y, states = _switched(system, y, states, [flow.owners[i] for i in failed])
        noise = 2.0 * noise  # states that take turns differ by rounding that was underrated
    raise CycleError(
        f"the contacts' states cannot be told apart at {system.omega:g} rad/s, now {states!r}; "
        "change a parameter of the contacts slightly"
    )


def _failing(flow: Flow, powers: FloatArray, noise: FloatArray) -> list[int]:
    """Exits whose first coefficient beyond rounding is negative; the ones before it are set to zero."""
    if not flow.owners:
        return []
    zero = np.abs(powers[:LEADING]) <= flow.rounding[:LEADING] @ noise
    failing = []
    for i in range(powers.shape[1]):
        lead = 0
        while lead < LEADING and zero[lead, i]:
            powers[lead, i] = 0.0
            lead += 1
        if lead < LEADING and powers[lead, i] < 0.0:
            failing.append(i)
    return failing


def _switched(
    system: System, y: FloatArray, states: str, exits: list[tuple[int, str]]
) -> tuple[FloatArray, str]:
    """The state after the contacts have taken the exits."""
    wanted: dict[int, set[str]] = {}
    for contact, to in exits:
        wanted.setdefault(contact, set()).add(to)
    y, letters = y.copy(), list(states)
    for contact, goals in wanted.items():
        # both limits of stick passed at once, or the load gone while slipping: the contact opens
        state = OPEN if len(goals) > 1 or OPEN in goals else goals.pop()
        letters[contact] = state
        set_friction(system, y, contact, state)
    return y, "".join(letters)


def set_friction(system: System, y: FloatArray, contact: int, state: str) -> None:
    """Put the friction force of a contact where its state wants it."""
    f, load = system.f.start + contact, system.contacts[contact].mu * system.loads(y)[contact]
    if state != STICK:
        y[f] = {POSITIVE: load, NEGATIVE: -load, OPEN: 0.0}[state]


class Exit(NamedTuple):
    """The end of a segment."""

    position: float  # in steps
    y: FloatArray  # (d,)
    row: int  # of the exit that is passed, -1 at the end of the cycle
    terms: FloatArray  # (d,) of which y is the sum: its rounding error is in proportion


def next_exit(flow: Flow, y: FloatArray, powers: FloatArray, left: float) -> Exit:
    """The first exit within `left` steps, or else the end; powers are those of the exits at y."""
    if not flow.owners:
        return Exit(left, flow.at(y, left), -1, np.abs(y))
    floors = DEPTH * (flow.rounding[:3] @ np.abs(y)).max(axis=0)
    base, steps = 0, SHORTEST
    found = _exit_of(powers, range(len(flow.owners)), floors)
    if found is not None and found[0] <= left:
        return Exit(found[0], flow.within(y, found[0]), found[1], flow.terms(y))
    while True:
        seen = flow.watch(y, steps)
        floors = np.maximum(floors, DEPTH * np.abs(seen[:, 0]).max(axis=0))
        for k, rows in _suspects(seen, floors, first=1 if base == 0 else 0):
            if base + k >= left:
                break
            here = flow.advance(y, k)
            found = _exit_of(flow.exits @ here, rows, floors)
            if found is not None and base + k + found[0] <= left:
                return Exit(base + k + found[0], flow.within(here, found[0]), found[1], flow.terms(here))
        if base + steps >= left:
            return Exit(left, flow.at(y, left - base), -1, flow.terms(y))
        base, y, steps = base + steps, flow.advance(y, steps), min(2 * steps, LONGEST)


def _suspects(seen: FloatArray, floors: FloatArray, first: int) -> Iterator[tuple[int, list[int]]]:
    """Steps, in order, in which an exit may be passed, with its rows.

    The least of the Bernstein coefficients of the cubic through g and g' at both ends bounds g from below
    but for h**4 / 384 times the greatest fourth derivative. A step is at most a radian of the fastest
    motion: inside it that derivative is no more than twice the greater of its ends'.
    """
    g, slope, fourth = seen[:, 0], seen[:, 1] / 3.0, np.abs(seen[:, 2])
    low = np.minimum(np.minimum(g[:-1], g[1:]), np.minimum(g[:-1] + slope[:-1], g[1:] - slope[1:]))
    passed = low - np.maximum(fourth[:-1], fourth[1:]) / 192.0 < -floors
    for k in np.flatnonzero(passed.any(axis=1)).tolist():
        if k >= first:
            yield k, np.flatnonzero(passed[k]).tolist()


def _exit_of(powers: FloatArray, rows: list[int] | range, floors: FloatArray) -> tuple[float, int] | None:
    """The first exit among the rows within one step."""
    best: tuple[float, int] | None = None
    for i in rows:
        at = first_descent(powers[:, i], float(floors[i]))
        if at is not None and (best is None or at < best[0]):
            best = (at, i)
    return best
