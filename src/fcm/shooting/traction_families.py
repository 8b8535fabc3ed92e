"""The family of periodic motions of a scene over the residual friction of contacts that always stick.

The slider of such a contact may rest anywhere between its limits, and every position gives a steady motion.
The family is followed from a given motion to the limits of each single contact, in both directions, and of
all contacts together. Where other contacts are not affected, the amplitudes stay the same. Where a contact
begins to slip, or to stick, the family continues from there with the contacts that then stick.

For a stable motion the extent is that of the stable members, which a structure can show; else that of all.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise, product

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Poll, converged, never_interrupt, within_unit_circle
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import resting_at
from fcm.shooting.traction_continuation import (
    TractionPath,
    midpoint,
    residual_of,
    sticking_contacts,
    with_traction,
)
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State
from fcm.units import spoken


class Family(Frozen):
    """The range of periodic motions at one frequency over the residual friction of stuck contacts.

    Amplitudes are half the peak-to-peak. They are those of the stable members if the given motion is stable,
    else of all members.
    """

    contacts: tuple[int, ...]  # contacts that always stick
    friction: FloatArray  # (contact, 2) least and greatest residual friction force -k_u w of the members
    least: FloatArray  # (dof,) least amplitude
    greatest: FloatArray  # (dof,) greatest amplitude
    complete: bool  # whether every direction was followed to its end

    @property
    def spread(self) -> FloatArray:
        """Range (dof,) of each amplitude in the family, relative to its greatest value."""
        size = np.where(self.greatest > 0.0, self.greatest, 1.0)
        return (self.greatest - self.least) / size


def family(
    scene: Scene,
    frequency: float,
    state: State,
    periods: int = 1,
    poll: Poll = never_interrupt,
    options: ShootingOptions = SHOOTING,
) -> Family | None:
    """The family that a periodic motion belongs to; None if no contact of it always sticks.

    Parameters
    ----------
    scene : Scene
    frequency : float
        Frequency of the external forces [rad/s].
    state : State
        State of a periodic motion at the forces' angle 0.
    periods : int
        Periods of the force after which it repeats.
    poll : callable, optional
        Called regularly; raises an exception to end the search.

    Raises
    ------
    SimulationError
        If the state is not that of a periodic motion.

    Examples
    --------
    >>> import fcm
    >>> from dataclasses import replace
    >>> from fcm.shooting import periodic
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> stuck = replace(scene, contacts=(replace(scene.contacts[0], n_0=100.0),))
    >>> found = family(stuck, 1.3, periodic(stuck, 1.3).state)
    >>> bool(found.spread.max() < 1e-9)  # nothing else feels it
    True
    """
    system = EquationsOfMotion(scene, frequency)
    x = np.concatenate((state.q, state.velocity, state.friction))
    found = converged(Shot(system, x, resting_at(system, x), periods), poll=poll, options=options)
    if found is None:
        at = spoken(frequency, scene.frequency_unit)
        raise SimulationError(f"no periodic motion is found at {at} from this state")
    begun = found[0]
    contacts = sticking_contacts(begun)
    if not contacts:
        return None
    shots, complete = members(begun, poll, options)
    shown = [shot for shot in shots if _stable(shot, options)] if _stable(begun, options) else shots
    amplitude = np.array([shot.amplitude for shot in shown])
    friction = np.array(
        [residual_of(shot)[contacts] for shot in shots if contacts == sticking_contacts(shot)]
    )
    return Family(
        tuple(contacts), np.stack((friction.min(axis=0), friction.max(axis=0)), axis=1),
        amplitude.min(axis=0), amplitude.max(axis=0), complete,
    )  # fmt: skip


def members(
    begun: Shot, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> tuple[list[Shot], bool]:
    """Motions of the family up to its ends, and whether the ends were reached in every direction."""
    shots, waiting, seen, complete = [begun], [begun], list[_VisitedTractions](), True
    left = options.family.max_motions
    while waiting:
        first = waiting.pop(0)
        contacts = sticking_contacts(first)
        if not contacts or any(one.contains(contacts, first) for one in seen):
            continue
        found = [first]
        for direction in _directions(len(contacts), options):
            ways = [TractionPath(first, contacts, sign * direction, poll, options) for sign in (-1.0, 1.0)]
            behind, ahead = (list(way.shots(min(left, options.family.max_motions // 5))) for way in ways)
            left -= sum(way.tried for way in ways)
            complete &= all(way.ended for way in ways)
            line = [*reversed(behind), first, *ahead]
            found += [*line, *_refined(line, poll, options), *_last_stable(line, poll, options)]
            beyond = [way.beyond for way in ways if way.beyond is not None]
            shots += beyond
            waiting += beyond
        seen.append(_VisitedTractions(contacts, np.array([residual_of(shot) for shot in found]), options))
        shots += found
    return shots, complete


class _VisitedTractions:
    """The range of residual friction of motions already followed with the same sticking contacts."""

    def __init__(self, contacts: list[int], residual: FloatArray, options: ShootingOptions) -> None:
        self.options = options
        self.contacts = contacts
        self.low, self.high = residual[:, contacts].min(axis=0), residual[:, contacts].max(axis=0)

    def contains(self, contacts: list[int], shot: Shot) -> bool:
        """Whether a motion lies within the visited range.

        Another part of the family may lie beyond a gap in which other contacts stick.
        """
        if contacts != self.contacts:
            return False
        residual, within = residual_of(shot)[contacts], self.options.family.bound_tolerance[len(contacts) > 1]
        room = within * (self.high - self.low)
        return bool(((residual >= self.low - room) & (residual <= self.high + room)).all())


def _refined(line: list[Shot], poll: Poll, options: ShootingOptions = SHOOTING) -> list[Shot]:
    """Further motions next to those of a line at which an amplitude is greatest or least.

    An extreme at an end of the line may have a more extreme motion next to it.
    """
    amplitude = np.array([shot.amplitude for shot in line])
    flat = np.ptp(amplitude, axis=0) <= options.family.amplitude_tolerance * amplitude.max(axis=0)
    middles, last = _MidpointCache(poll, options), len(line) - 1
    for sense in (1.0, -1.0):
        for dof in np.flatnonzero(~flat).tolist():
            k = int(np.argmax(sense * amplitude[:, dof]))
            if 0 < k < last:
                _extreme_near(line[k - 1 : k + 2], sense, dof, middles)
                continue
            one, other = line[k], line[1] if k == 0 else line[-2]
            middle = middles.of(one, other)
            if middle is not None and sense * (middle.amplitude[dof] - one.amplitude[dof]) > 0.0:
                _extreme_near([one, middle, other], sense, dof, middles)
    return middles.found()


class _MidpointCache:
    """Cache of motions between two others: several amplitudes often have their extremes together."""

    def __init__(self, poll: Poll, options: ShootingOptions) -> None:
        self.poll, self.options = poll, options
        self.known: dict[tuple[int, int], tuple[Shot, Shot, Shot | None]] = {}

    def of(self, one: Shot, other: Shot) -> Shot | None:
        """The motion between two others; None if it is not found."""
        key = min(id(one), id(other)), max(id(one), id(other))
        if key not in self.known:  # the cache keeps both alive, so that their ids stay unique
            self.known[key] = one, other, midpoint(one, other, self.poll, self.options)
        return self.known[key][2]

    def found(self) -> list[Shot]:
        """All motions that were found."""
        return [middle for _, _, middle in self.known.values() if middle is not None]


def _last_stable(line: list[Shot], poll: Poll, options: ShootingOptions = SHOOTING) -> list[Shot]:
    """The last stable motions next to each loss of stability within a line, by bisection."""
    added = list[Shot]()
    for pair in pairwise(line):
        if _stable(pair[0], options) == _stable(pair[1], options):
            continue
        inner, outer = sorted(pair, key=partial(_stable, options=options), reverse=True)
        for _ in range(options.family.halvings_to_stable):
            middle = midpoint(inner, outer, poll, options)
            if middle is None:
                break
            inner, outer = (middle, outer) if _stable(middle, options) else (inner, middle)
        added.append(inner)
    return added


def _stable(shot: Shot, options: ShootingOptions = SHOOTING) -> bool:
    return within_unit_circle(shot.multipliers, options)


def _extreme_near(near: list[Shot], sense: float, dof: int, middles: _MidpointCache) -> None:
    """Refine the greatest (sense 1) or least (-1) amplitude of a degree of freedom among three motions."""
    for _ in range(middles.options.family.halvings_to_extreme):
        one, other = middles.of(near[0], near[1]), middles.of(near[1], near[2])
        if one is None or other is None:
            break
        five = [near[0], one, near[1], other, near[2]]
        top = max((1, 2, 3), key=lambda i: sense * float(five[i].amplitude[dof]))
        near = five[top - 1 : top + 2]


def _directions(count: int, options: ShootingOptions = SHOOTING) -> list[FloatArray]:
    """Directions in which the family is followed, both ways: each contact alone, and all together."""
    alone = list(np.eye(count))
    if count == 1:
        return alone
    if count > options.family.max_combined:
        return [*alone, np.ones(count)]
    return [*alone, *(np.array((1.0, *signs)) for signs in product((1.0, -1.0), repeat=count - 1))]


def member_at_start(
    shot: Shot, wanted: FloatArray, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> Shot | None:
    """The member of a motion's family with the residual friction of the scene's start; None if not reached.

    Parameters
    ----------
    shot : Shot
        A motion that closes.
    wanted : (contact,)
        The slip motions w of the contacts where the scene starts: `residual_traction.resting`.
    """
    begin, end = -residual_of(shot), shot.system.k_u * wanted
    done, share = 0.0, 1.0
    while done < 1.0 and share > options.family.min_step:
        at = min(done + share, 1.0)
        new = with_traction(shot, begin + at * (end - begin), poll=poll, options=options)
        if new is None:
            share *= 0.25
        else:
            shot, done, share = new, at, 2.0 * share
    return shot if done == 1.0 else None
