"""The family of periodic motions of a scene with contacts that always stick, over their residual friction.

The slider of such a contact may rest anywhere between its limits, and every place gives a steady motion. The
family is followed from the motion that is chosen to the limits of one contact after the other, in both
directions, and of all together. Where the other contacts do not feel it, the amplitudes stay the same; where
one begins to slip, or to stick, the family goes on from there with those that stick then.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fcm.motion.errors import SimulationError
from fcm.motion.measure import measure
from fcm.motion.state import State
from fcm.motion.system import System
from fcm.orbit.periodic import Look, converged, without_end
from fcm.orbit.residual_friction import always_stuck, resting_at, rooms
from fcm.orbit.shooting import Shot
from fcm.scene.model import FloatArray, Scene

STEPS = 8  # from one limit of slip to the other
SHORTEST = 1e-3  # part of a step below which the family has an end of its own
ITERATIONS = 8  # of Newton's method: with more a shorter step is found sooner
GROWTH = 4.0  # of a step to the next, at most
FAR = 1e4  # times the first reach: a contact that its own residual friction presses together has no end
TINY = 1e-12  # part of the reach that is none
MOST_TOGETHER = 3  # contacts of which all combinations of directions are followed
MOST_TRIED = 500  # motions that are looked for: some contacts have hundreds of sets of those that stick


@dataclass(frozen=True)
class Family:
    """The extent of the periodic motions at one frequency."""

    contacts: tuple[int, ...]  # that always stick
    friction: FloatArray  # (contact, 2) least and greatest friction force k_u w from which they are reached
    least: FloatArray  # (dof,) amplitude, half the peak-to-peak
    greatest: FloatArray  # (dof,)
    complete: bool  # whether every way was followed to its end

    @property
    def spread(self) -> FloatArray:
        """By how much the amplitude is not determined, relative to its greatest value: (dof,)."""
        size = np.where(self.greatest > 0.0, self.greatest, 1.0)
        return (self.greatest - self.least) / size


def family(scene: Scene, frequency: float, state: State, periods: int = 1) -> Family | None:
    """The family that a periodic motion belongs to; None if no contact of it always sticks.

    Parameters
    ----------
    scene : Scene
    frequency : float
        Of the external forces [rad/s].
    state : State
        Of a periodic motion at the forces' angle 0.
    periods : int
        Of the force, after which it repeats.

    Raises
    ------
    SimulationError
        If the state is not that of a periodic motion.

    Examples
    --------
    >>> import fcm
    >>> from dataclasses import replace
    >>> from fcm.orbit import periodic
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> stuck = replace(scene, contacts=(replace(scene.contacts[0], n_0=100.0),))
    >>> found = family(stuck, 1.3, periodic(stuck, 1.3).state)
    >>> bool(found.spread.max() < 1e-9)  # nothing else feels it
    True
    """
    system = System(scene, frequency)
    x = np.concatenate((state.q, state.velocity, state.friction))
    found = converged(Shot(system, x, resting_at(system, x), periods))
    if found is None:
        raise SimulationError(f"no periodic motion is found at {frequency:g} rad/s from this state")
    begun = found[0]
    contacts = _stuck(begun)
    if not contacts:
        return None
    shots, complete = _members(begun)
    amplitude = np.array([measure(shot.cycle).amplitude for shot in shots])
    friction = np.array([_residual(shot)[contacts] for shot in shots if contacts == _stuck(shot)])
    return Family(
        tuple(contacts), np.stack((friction.min(axis=0), friction.max(axis=0)), axis=1),
        amplitude.min(axis=0), amplitude.max(axis=0), complete,
    )  # fmt: skip


def _members(begun: Shot) -> tuple[list[Shot], bool]:
    """Motions of the family up to its ends, and whether these were reached on every way."""
    shots, waiting, seen, complete = [begun], [begun], set[tuple[int, ...]](), True
    left = MOST_TRIED
    while waiting:
        first = waiting.pop(0)
        contacts = _stuck(first)
        if not contacts or tuple(contacts) in seen:
            continue
        seen.add(tuple(contacts))
        for sense in _senses(len(contacts)):
            way = _Way(first, contacts, sense)
            shots += way.shots(min(left, MOST_TRIED // 5))
            left -= way.tried
            complete &= way.ended
            if way.beyond is not None:
                shots.append(way.beyond)
                waiting.append(way.beyond)
    return shots, complete


def _stuck(shot: Shot) -> list[int]:
    return always_stuck(shot.system, shot.segments)


def _senses(count: int) -> list[FloatArray]:
    """The directions in which the family is followed: each contact alone, and all together."""
    alone = [sign * row for row in np.eye(count) for sign in (1.0, -1.0)]
    if count == 1:
        return alone
    if count > MOST_TOGETHER:
        return [*alone, np.ones(count), -np.ones(count)]
    together = np.array(np.meshgrid(*([(1.0, -1.0)] * count))).reshape(count, -1).T
    return [*alone, *together]


def _residual(shot: Shot) -> FloatArray:
    """The friction forces that are left when the displacement is taken away, -k_u w: (contact,)."""
    force: FloatArray = -shot.system.k_u * resting_at(shot.system, shot.x)
    return force


class _Way:
    """The family in one direction, until every contact that is pushed is at its limit, or others stick."""

    def __init__(self, begun: Shot, contacts: list[int], sense: FloatArray) -> None:
        self.system, self.last, self.contacts, self.ended = begun.system, begun, contacts, False
        self.beyond: Shot | None = None  # the motion just beyond the end, where others stick
        self.tried = 0  # motions that were looked for
        self.room = self._rooms(begun)
        self.reach = self.room.sum(axis=1)  # the greatest so far
        self.push = np.zeros(len(self.system.contacts))
        self.push[contacts] = sense * self.reach / STEPS
        self.far = FAR * float(max(self.reach.max(), np.abs(_residual(begun)).max()))
        self.slope: FloatArray | None = None  # of x by the share of the push

    def shots(self, tries: int) -> Iterator[Shot]:
        """The motions on the way, the last one at the limits, as far as so many trials lead."""
        share = longest = 1.0
        most = GROWTH
        while share > SHORTEST * longest and not self.ended and self.tried < tries:
            self.tried += 1
            new = self._further(share)
            if new is None:
                share, most = 0.25 * share, 1.0
                continue
            self.ended = all(choice.limited for choice in new.chosen if self.push[choice.contact] != 0.0)
            self.ended |= bool(np.abs(_residual(new)).max() > self.far)
            self.slope = (new.x - self.last.x) / share
            share, most = share * min(self._growth(new), most), GROWTH
            self.last, longest = new, max(longest, share)
            yield new
        self.ended |= self.beyond is not None

    def _growth(self, new: Shot) -> float:
        """Of a step to the next: most of it moves the structure where that is softer than the contact."""
        before, self.room = self.room, self._rooms(new)
        self.reach = np.maximum(self.reach, before.sum(axis=1))
        used = np.abs(self.room - before).max(axis=1) / np.where(self.reach > 0.0, self.reach, 1.0)
        return 1.0 / (STEPS * max(float(used.max()), TINY))

    def _rooms(self, shot: Shot) -> FloatArray:
        """How far each contact's force is from its limits, (contact, 2)."""
        found = rooms(self.system, shot.segments, self.contacts)
        return np.array([(found[j][0].value, found[j][1].value) for j in self.contacts])

    def _further(self, share: float) -> Shot | None:
        """The motion when the contacts are stressed a little more."""
        guess = None if self.slope is None else self.last.x + share * self.slope
        new = _moved(self.last, -(_residual(self.last) + share * self.push), guess)
        if new is None:
            return None
        self.beyond = None if _stuck(new) == self.contacts else new
        return new if self.beyond is None else None


def chosen(shot: Shot, wanted: FloatArray, look: Look = without_end) -> Shot | None:
    """The member that a scene chooses of the family that a motion belongs to, in as many steps as it takes.

    Parameters
    ----------
    shot : Shot
        A motion that closes.
    wanted : (contact,)
        The slip motions w of the contacts where the scene starts: `Shooting.resting`.
    """
    begin, end = -_residual(shot), shot.system.k_u * wanted
    done, share = 0.0, 1.0
    while done < 1.0 and share > SHORTEST:
        reach = min(done + share, 1.0)
        new = _moved(shot, begin + reach * (end - begin), look=look)
        if new is None:
            share *= 0.25
        else:
            shot, done, share = new, reach, 2.0 * share
    return shot if done == 1.0 else None


def _moved(
    shot: Shot, force: FloatArray, guess: FloatArray | None = None, look: Look = without_end
) -> Shot | None:
    """The motion near another whose contacts rest where they would have the friction forces k_u w."""
    system, x = shot.system, shot.x.copy() if guess is None else guess
    change = -(force + _residual(shot))
    for choice in shot.chosen:
        if guess is None and not choice.limited:  # else it may be sent further beyond
            x[system.f.start + choice.contact] += change[choice.contact]
    w = force / np.where(system.k_u > 0.0, system.k_u, 1.0)
    try:
        found = converged(Shot(system, x, w, shot.periods), ITERATIONS, look)
    except SimulationError:
        return None
    return None if found is None else found[0]
