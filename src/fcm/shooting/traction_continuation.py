"""A way through the family of motions over the residual friction of contacts that always stick."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fcm.model.scene import FloatArray
from fcm.shooting.periodic import Poll, converged, without_end
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import always_stuck, resting_at, rooms
from fcm.time_domain.errors import SimulationError

STEPS = 8  # from one limit of slip to the other
SHORTEST = 1e-3  # part of a step below which the family has an end of its own
ITERATIONS = 8  # of Newton's method: with more a shorter step is found sooner,
LEAST = 0.1  # and where only a smaller part of one of them brings it nearer
GROWTH = 4.0  # of a step to the next, at most
FAR = 1e4  # times the first reach: a contact that its own residual friction presses together has no end
TINY = 1e-12  # part of the reach that is none


class Way:
    """The family in one direction, until every contact that is pushed is at its limit, or others stick."""

    def __init__(self, begun: Shot, contacts: list[int], sense: FloatArray, poll: Poll = without_end) -> None:
        self.system, self.last, self.contacts, self.ended = begun.system, begun, contacts, False
        self.poll = poll
        self.beyond: Shot | None = None  # the motion just beyond the end, where others stick
        self.tried = 0  # motions that were looked for
        self.room = self._rooms(begun)
        self.reach = self.room.sum(axis=1)  # the greatest so far
        self.push = np.zeros(len(self.system.contacts))
        self.push[contacts] = sense * self.reach / STEPS
        self.far = FAR * float(max(self.reach.max(), np.abs(residual_of(begun)).max()))
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
            self.ended |= bool(np.abs(residual_of(new)).max() > self.far)
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
        new = moved(self.last, -(residual_of(self.last) + share * self.push), guess, self.poll)
        if new is None:
            return None
        self.beyond = None if stuck_in(new) == self.contacts else new
        return new if self.beyond is None else None


def moved(
    shot: Shot, force: FloatArray, guess: FloatArray | None = None, poll: Poll = without_end
) -> Shot | None:
    """The motion near another whose contacts rest where they would have the friction forces k_u w."""
    system, x = shot.system, shot.x.copy() if guess is None else guess
    change = -(force + residual_of(shot))
    for choice in shot.chosen:
        if guess is None and not choice.limited:  # else it may be sent further beyond
            x[system.f.start + choice.contact] += change[choice.contact]
    w = force / np.where(system.k_u > 0.0, system.k_u, 1.0)
    try:
        found = converged(Shot(system, x, w, shot.periods), ITERATIONS, poll, LEAST)
    except SimulationError:
        return None
    return None if found is None else found[0]


def between(one: Shot, other: Shot, poll: Poll = without_end) -> Shot | None:
    """The motion with the mean of the residual friction of two that are near to one another."""
    return moved(one, -0.5 * (residual_of(one) + residual_of(other)), 0.5 * (one.x + other.x), poll)


def stuck_in(shot: Shot) -> list[int]:
    """The contacts that stick all through a motion."""
    return always_stuck(shot.system, shot.segments)


def residual_of(shot: Shot) -> FloatArray:
    """The friction forces that are left when the displacement is taken away, -k_u w: (contact,)."""
    force: FloatArray = -shot.system.k_u * resting_at(shot.system, shot.x)
    return force
