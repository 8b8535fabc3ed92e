"""Which harmonics an accuracy takes, told from the peaks and folds of a curve of fewer.

The highest points and the folds are moved to the curve of many harmonics, chosen by what they do. There the
harmonics that do least are left out again, one after the other, as long as that changes what is looked at by
less than the accuracy: the balance of the others is solved at these points alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import compress

import numpy as np
import numpy.typing as npt

from fcm.continuation import Mark, Path
from fcm.harmonic.corrector import ENOUGH
from fcm.harmonic.crest import RIVAL
from fcm.harmonic.further import HIGHEST, Further, padded
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.ranking import Ranking
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

STAGES = 4  # of more harmonics, each with those that the motion of the last asks for,
SETTLED = 0.1  # of the accuracy: a stage that changes no place by more is the last
SPARE = 0.4  # of the accuracy, to which what is left out is chosen to come
BELIEVED = 0.02  # of a change: places that move far say no more of what it takes where they come to
TOGETHER = 8  # points, within which one top speaks for those of other degrees of freedom
BESIDE = (
    -1,
    1,
    -2,
    2,
    -4,
    4,
    -8,
    8,
)  # points from a top, where the curve may be found if it is not at the top
FOLDS = 24  # folds of a path that are looked at, at most
DEAR = 240  # unknowns, beyond which it costs too much to leave out single harmonics
LOW = 3  # up to this no single harmonic is left out: stability between folds may hang on it
NOTHING = 1e-6  # of the greatest amplitude: degrees of freedom that move less have no peak
FIRST = 4  # harmonics that are added at most to one, and as many as there are to more, where nothing is told
FEW = 6  # or as many as there are: more are not believed to be needed where not all is told
UNKNOWN = 3.0  # times what harmonics do without feedback, what they do, as long as that is not told


@dataclass(frozen=True)
class Place:
    """A point of a path, values (1 + dof,), frequency and amplitudes, there, and which of these count."""

    z: FloatArray
    direction: FloatArray
    values: FloatArray
    counts: npt.NDArray[np.bool_]

    def difference(self, other: Place) -> float:
        """Greatest relative difference from the values that count to those of another place."""
        now = self.values[self.counts]
        return float((np.abs(other.values[self.counts] - now) / np.where(now > 0.0, now, 1.0)).max())


@dataclass(frozen=True)
class Foreseen:
    """change: by how much a peak or fold is changed, relative, by many harmonics, as far as that is told.

    told: whether it is of all peaks. harmonics: those of the balance and those that bring what is told to the
    accuracy, or nearer to it; where not all is told, also those that would do most without feedback.
    """

    change: float
    told: bool
    harmonics: tuple[int, ...]


def foreseen(
    system: System, paths: Sequence[Path], amplitudes: Sequence[FloatArray], accuracy: float
) -> Foreseen:
    """From paths of a system with their amplitudes (point, dof)."""
    height = np.max([amplitude.max(axis=0) for amplitude in amplitudes], axis=0)
    tops = list(_places(paths, amplitudes, height, RIVAL))
    if not tops:  # nothing moves
        return Foreseen(0.0, True, system.harmonics)
    found = _ahead(system, tops, height, accuracy)
    if found is None and len(paths) > 1:  # what is lower may lead further; of one path all was looked at
        found = _ahead(system, list(_places(paths, amplitudes, height, 0.0)), height, accuracy)
        found = None if found is None else replace(found, told=False)
    found = found or Foreseen(0.0, False, system.harmonics)
    if found.told:
        return found
    share = _share(system, [one[0] for one in tops], height, system.harmonics)
    more, has = needed(share, system.harmonics, UNKNOWN, accuracy), len(system.harmonics)
    joined = _joined(found.harmonics, more)
    return replace(found, harmonics=joined if len(joined) - has <= max(FEW, has) else more)


def needed(share: FloatArray, harmonics: tuple[int, ...], gain: float, accuracy: float) -> tuple[int, ...]:
    """Harmonics and those that would do most, until the others do less than a part of the accuracy.

    share (harmonic,) is what each would have without feedback, gain times which it does.
    """
    order = np.argsort(-share)
    left = share.sum() - np.cumsum(share[order])
    enough = 1 + int(np.count_nonzero(gain * left > SPARE * accuracy))
    has = len(harmonics)
    count = min(enough, max(FIRST, has), HIGHEST - has)
    return _joined(harmonics, [int(k) + 1 for k in order[:count] if share[k] > 0.0])


def _ahead(
    system: System, tops: Sequence[Sequence[Place]], height: FloatArray, accuracy: float
) -> Foreseen | None:
    """From the first of each places that leads to the curve of many harmonics; None where none does."""
    begin = places = [one[0] for one in tops]
    many, told = system, True
    for stage in range(STAGES):
        more = Ranking(many).best(_share(many, places, height, many.harmonics))
        if more == many.harmonics:
            break
        if stage == 0:
            begin = places = [_first(system, one, more) for one in tops]
        moved = _moved(many, places, more)
        known = [there is not None for there in moved]
        told = told and all(one or place.counts[0] for one, place in zip(known, places, strict=True))
        if not any(known):
            return None
        begin, before = list(compress(begin, known)), list(compress(places, known))
        places, many = [there for there in moved if there is not None], system.with_harmonics(more)
        if _greatest(before, places) <= SETTLED * accuracy:
            break
    change = _greatest(begin, places)
    if told and change <= accuracy:
        return Foreseen(change, told, system.harmonics)
    share = _share(many, places, height, system.harmonics)
    order = [int(k) + 1 for k in np.argsort(-share) if k + 1 in many.harmonics and share[k] > 0.0]
    allowed = SPARE * max(accuracy, BELIEVED * (change if told else max(change, 1.0)))
    return Foreseen(change, told, _Choice(many, places, system.harmonics, allowed).fewest(order))


def _first(system: System, places: Sequence[Place], more: tuple[int, ...]) -> Place:
    """The first that has a place on the curve of more harmonics beside it; the first of all if none has."""
    if len(places) == 1 or _moved(system, places[:1], more)[0] is not None:
        return places[0]
    moved = _moved(system, places[1:], more)
    return next((place for place, there in zip(places[1:], moved, strict=True) if there), places[0])


def _greatest(some: Sequence[Place], others: Sequence[Place]) -> float:
    """Difference of places from others."""
    return max(one.difference(other) for one, other in zip(some, others, strict=True))


def _places(
    paths: Sequence[Path], amplitudes: Sequence[FloatArray], height: FloatArray, rival: float
) -> Iterator[list[Place]]:
    """The highest points of paths that are as high as a part of the highest of all, with points around each,
    and folds."""
    matter = height > NOTHING * height.max()
    for path, amplitude in zip(paths, amplitudes, strict=True):
        rivals = matter & (amplitude.max(axis=0) >= rival * height)
        tops = amplitude.argmax(axis=0)
        unique = np.unique(tops[rivals])
        for group in np.split(unique, np.flatnonzero(np.diff(unique) > TOGETHER) + 1):
            if group.size:
                counts = np.append(False, rivals & np.isin(tops, group))
                top = int(group[len(group) // 2])
                around = [top, *(top + step for step in BESIDE if 0 <= top + step < len(path.z))]
                yield [_place(path, amplitude, i, counts) for i in around]
        folds = path.where(Mark.FOLD)
        every = -(-len(folds) // FOLDS) or 1
        for i in folds[::every].tolist():
            yield [_place(path, amplitude, i, np.arange(1 + len(height)) == 0)]


def _place(path: Path, amplitude: FloatArray, i: int, counts: npt.NDArray[np.bool_]) -> Place:
    return Place(path.z[i], path.direction[i], np.append(path.parameter[i], amplitude[i]), counts)


def _share(system: System, places: Sequence[Place], height: FloatArray, known: tuple[int, ...]) -> FloatArray:
    """What each harmonic (harmonic,) but the known ones has at most at some places, of heights (dof,)."""
    further, z = Further(system), np.array([place.z for place in places])
    share = further.shares(z, np.tile(height, (len(z), 1)), known)
    most: FloatArray = share[:, :HIGHEST].max(axis=0)
    return most


def _moved(system: System, places: Sequence[Place], harmonics: tuple[int, ...]) -> list[Place | None]:
    """Places of a system to its curve of other harmonics, normal to their own; None where there is none."""
    lifted = Lifted(system.with_harmonics(harmonics).balance(), list(harmonics), list(harmonics), ENOUGH)
    found: list[Place | None] = []
    for place in places:
        z, direction = (padded(one, system.harmonics, harmonics) for one in (place.z, place.direction))
        there = None
        if lifted.beside(z, direction):
            along = np.asarray(lifted.newton.tangent) * lifted.newton.scale
            there = Place(np.array(lifted.newton.z), along, np.array(lifted.found), place.counts)
        found.append(there)
    return found


class _Choice:
    """Harmonics that leave places of many harmonics where they are, but for what is allowed."""

    def __init__(self, many: System, places: Sequence[Place], least: tuple[int, ...], allowed: float) -> None:
        self.many, self.places, self.least, self.allowed = many, places, least, allowed

    def fewest(self, order: Sequence[int]) -> tuple[int, ...]:
        """The least harmonics and as few as can be of others, given in the order of what they have."""
        few, enough = 0, len(order)
        while few < enough:
            middle = (few + enough) // 2
            few, enough = (few, middle) if self.near(order[:middle]) else (middle + 1, enough)
        low = [h for h in order[:enough] if h <= LOW]
        chosen = [*low, *(h for h in order[:enough] if h > LOW)]
        unknowns = len(self.many.scene.contacts) * (2 + 4 * (enough + len(self.least)))
        chosen = self.without(chosen, len(low), enough - 1) if unknowns <= DEAR else chosen
        return _joined(self.least, chosen)

    def without(self, chosen: list[int], first: int, end: int) -> list[int]:
        """What remains of others when those that matter least are left out, of first to end: all at once, or
        else of either half. A harmonic may have much and do little."""
        if first >= end:
            return chosen
        fewer = chosen[:first] + chosen[end:]
        if self.near(fewer):
            return fewer
        if end - first == 1:
            return chosen
        middle = (first + end) // 2
        return self.without(self.without(chosen, middle, end), first, middle)

    def near(self, others: Sequence[int]) -> bool:
        """Whether all places stay where they are with the least harmonics and others."""
        moved = _moved(self.many, self.places, _joined(self.least, others))
        return all(
            there is not None and place.difference(there) <= self.allowed
            for place, there in zip(self.places, moved, strict=True)
        )


def _joined(harmonics: tuple[int, ...], others: Sequence[int]) -> tuple[int, ...]:
    return tuple(sorted({*harmonics, *others}))
