"""Continuation in the family of motions over the residual friction of contacts that always stick."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fcm.model.scene import FloatArray
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Poll, converged, never_interrupt
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import always_stuck, limit_distances, resting_at
from fcm.time_domain.errors import SimulationError


class TractionPath:
    """The family in one direction, until all pushed contacts are at their limits, or other contacts stick."""

    def __init__(
        self,
        begun: Shot,
        contacts: list[int],
        sense: FloatArray,
        poll: Poll = never_interrupt,
        options: ShootingOptions = SHOOTING,
    ) -> None:
        self.options = options
        self.system, self.last, self.contacts, self.ended = begun.system, begun, contacts, False
        self.poll = poll
        self.beyond: Shot | None = None  # the motion just beyond the end, where other contacts stick
        self.tried = 0  # number of motions tried
        self.room = self._limit_distances(begun)
        self.most_room = self.room.sum(axis=1)  # the greatest so far
        self.push = np.zeros(len(self.system.contacts))
        self.push[contacts] = sense * self.most_room / self.options.family.steps
        self.far = self.options.family.max_distance * float(
            max(self.most_room.max(), np.abs(residual_of(begun)).max())
        )
        self.slope: FloatArray | None = None  # derivative of x by the share of the push

    def shots(self, tries: int) -> Iterator[Shot]:
        """Yield the motions along the direction, the last one at the limits, with at most this many tries."""
        share = longest = 1.0
        most = self.options.family.max_factor
        while share > self.options.family.min_step * longest and not self.ended and self.tried < tries:
            self.tried += 1
            new = self._next_motion(share)
            if new is None:
                share, most = 0.25 * share, 1.0
                continue
            self.ended = all(choice.limited for choice in new.chosen if self.push[choice.contact] != 0.0)
            self.ended |= bool(np.abs(residual_of(new)).max() > self.far)
            self.slope = (new.x - self.last.x) / share
            share, most = share * min(self._growth(new), most), self.options.family.max_factor
            self.last, longest = new, max(longest, share)
            yield new
        self.ended |= self.beyond is not None

    def _growth(self, new: Shot) -> float:
        """Ratio of the next step to the last one, from the change of the distances to the limits.

        Where the structure is softer than a contact, a step mostly moves the structure.
        """
        before, self.room = self.room, self._limit_distances(new)
        self.most_room = np.maximum(self.most_room, before.sum(axis=1))
        used = np.abs(self.room - before).max(axis=1) / np.where(self.most_room > 0.0, self.most_room, 1.0)
        return 1.0 / (self.options.family.steps * max(float(used.max()), self.options.family.zero_distance))

    def _limit_distances(self, shot: Shot) -> FloatArray:
        """Distances (contact, 2) of each contact's friction force from its two limits."""
        found = limit_distances(self.system, shot.segments, self.contacts)
        return np.array([(found[j][0].value, found[j][1].value) for j in self.contacts])

    def _next_motion(self, share: float) -> Shot | None:
        """The motion after a further step of the residual friction; None if it is not found.

        It is also None if other contacts stick in it; `beyond` is then this motion.
        """
        guess = None if self.slope is None else self.last.x + share * self.slope
        new = with_traction(
            self.last, -(residual_of(self.last) + share * self.push), guess, self.poll, self.options
        )
        if new is None:
            return None
        self.beyond = None if sticking_contacts(new) == self.contacts else new
        return new if self.beyond is None else None


def with_traction(
    shot: Shot,
    force: FloatArray,
    guess: FloatArray | None = None,
    poll: Poll = never_interrupt,
    options: ShootingOptions = SHOOTING,
) -> Shot | None:
    """The motion near another whose sticking contacts have the slip motions w = force / k_u; or None."""
    system, x = shot.system, shot.x.copy() if guess is None else guess
    change = -(force + residual_of(shot))
    for choice in shot.chosen:
        if guess is None and not choice.limited:  # a limited one might be moved farther beyond its limit
            x[system.f.start + choice.contact] += change[choice.contact]
    w = force / np.where(system.k_u > 0.0, system.k_u, 1.0)
    try:
        found = converged(
            Shot(system, x, w, shot.periods),
            options.family.max_iterations,
            poll,
            options.family.min_fraction,
            options,
        )
    except SimulationError:
        return None
    return None if found is None else found[0]


def midpoint(
    one: Shot, other: Shot, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> Shot | None:
    """The motion with the mean residual friction of two motions that are close to each other."""
    return with_traction(
        one, -0.5 * (residual_of(one) + residual_of(other)), 0.5 * (one.x + other.x), poll, options
    )


def sticking_contacts(shot: Shot) -> list[int]:
    """The contacts that stick throughout a motion."""
    return always_stuck(shot.system, shot.segments)


def residual_of(shot: Shot) -> FloatArray:
    """The residual friction forces -k_u w (contact,), which remain at zero displacement."""
    force: FloatArray = -shot.system.k_u * resting_at(shot.system, shot.x)
    return force
