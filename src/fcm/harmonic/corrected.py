"""The curve of a balance with more harmonics, point by point beside one with fewer."""

from __future__ import annotations

import itertools

import numpy as np
import numpy.typing as npt

from fcm.continuation import Mark, Path
from fcm.harmonic.corrector import corrector_of
from fcm.harmonic.filled import Filled, places, steepness
from fcm.harmonic.further import LEAST_AMPLITUDE
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

EVERY = 16  # points from one that is displaced to the next, before it is known how they change
FARTHER = 32  # the same, to see along which stretches no displacement is found
OFF = 0.2  # of a displacement, by which it may be off where it is interpolated
NOTHING = 3e-5  # a displacement, relative, that is too small to be looked at more closely
STEEP = 100.0  # relative change of an amplitude over that of the frequency, up to which both count
UNSETTLED = 1e-7  # a displacement at a top, relative, worth to be settled: all harmonics may do more than one
TOGETHER = 8  # points, within which tops of degrees of freedom lie together
ALONE = 0  # the same where to settle them is cheap: each has other harmonics that do most
EFFORT = 8e7  # evaluations times the square of the unknowns, some second of work, for what is followed
LOOKS = 2  # at a fold with more and more harmonics, which move it to and fro less and less
BESIDE = (1, 2, 4, 8)  # points from a corner at which it is looked for what happens at the corner,
NEXT = (1, 2)  # and where that is a top, which a longer stretch may be higher than

Indices = npt.NDArray[np.intp]


class Corrected:
    """From the points of a path to the corrected curve, relative: of the frequency, then of the amplitudes.

    unit (point, dof) is what those of the amplitudes are relative to: the amplitude or, of a degree of
    freedom that hardly moves, a part of the greatest, as the others would be lost in its rounding.
    linear (point,): where no contact slips or separates, so that nothing is to be corrected.
    effort is what is left of EFFORT for stretches along which the corrected curve is followed.
    """

    def __init__(
        self, system: System, path: Path, amplitude: FloatArray, linear: npt.NDArray[np.bool_]
    ) -> None:
        self.path, self.amplitude, self.linear = path, amplitude, _with_ends(path, linear)
        self.unit = np.maximum(amplitude, LEAST_AMPLITUDE * amplitude.max(axis=1, keepdims=True))
        self.unit[self.unit == 0.0] = 1.0
        self.corrector, self.effort = corrector_of(system), EFFORT
        count, dofs = amplitude.shape
        self.place, self.weight = np.zeros((2, count))
        places(path.z, path.direction, np.ptp(path.parameter) or 1.0, self.place)
        steepness(np.ascontiguousarray(path.parameter), amplitude, STEEP, self.weight)
        self.change = np.zeros((count, 1 + dofs))
        self.known = self.linear.copy()
        self.filled = Filled(self.place, self.change, self.known.view(np.uint8))

    def everywhere(self, places: Indices, tops: Indices) -> FloatArray:
        """Relative displacement (point, 1 + dof), interpolated between points at which it is found.

        These are the places given, every so many points, those next to a linear part, and those between two
        of them if the middle one is not what they lead to expect. The tops get the best further harmonics
        of their own, whatever points lie around them. Along stretches where no displacement is found nothing
        more is looked for: not to find one is what costs most.
        """
        count = len(self.known)
        changes = np.flatnonzero(np.diff(self.linear))
        ends = np.array([0, count - 1])
        for group in _groups(np.unique(tops)):
            self.find_group(group)
        lost = self.lost()
        places = places[~lost[places]]
        even = np.arange(0, count, EVERY)
        first = np.unique(np.concatenate((places, even, ends, changes, changes + 1, self.meetings())))
        first = first[~lost[first] | self.known[first]]
        self.find(first)
        before, after = first[:-1], first[1:]
        while len(before):
            wide = (after - before > 1) & ~(self.linear[before] & self.linear[after]) & ~lost[before + 1]
            before, after = before[wide], after[wide]
            middle = (before + after) // 2
            expected = self.interpolated(middle)
            self.find(middle)
            more = self.unforeseen(before, middle, after, expected)
            before, after = (
                np.concatenate((before[more], middle[more])),
                np.concatenate((middle[more], after[more])),
            )
        bridged = {k: self.bridged(k, NEXT if k in tops else BESIDE) for k in places.tolist()}
        for place, change in bridged.items():
            self.change[place] = change
        return self.interpolated(np.arange(count))

    def lost(self) -> npt.NDArray[np.bool_]:
        """Where (point,) no displacement is looked for: between places that are far apart, if none is found
        at three of them in a row."""
        count = len(self.known)
        some = np.append(np.arange(0, count - 1, FARTHER), count - 1)
        self.find(some)
        missed = np.isnan(self.change[some, 0])
        three = np.flatnonzero(missed[:-2] & missed[1:-1] & missed[2:])
        lost = np.zeros(count, dtype=np.bool_)
        for i in three.tolist():
            lost[some[i] + 1 : some[i + 2]] = True
        return lost

    def meetings(self) -> Indices:
        """Points where a harmonic that is left out meets a mode and leads there, each with those beside it.

        Displacements swing there from a point to the next: those around tell nothing of them.
        """
        if not self.corrector.ranking.cheap:
            return np.zeros(0, dtype=np.intp)
        met: Indices = self.corrector.further.meetings(self.path.z, self.amplitude)
        return met

    def settled(self, places: Indices, found: FloatArray) -> FloatArray:
        """Corrected amplitudes (dof,) at places of their own, where the displacement is settled.

        Those found are each as good as the harmonics that it was found with, so that the greatest of some is
        high by chance. Of places that lie together the middle one tells for all how much they change by that.
        Small displacements stay as they were found, and so do those that settling leads away from.
        """
        d, amplitude = np.arange(len(places)), found.copy()
        for group in _within(np.unique(places), ALONE if self.corrector.ranking.cheap else TOGETHER):
            i = int(group[len(group) // 2])
            change = self.settled_at(i)
            if change is None:
                continue
            there, now = (places >= group[0]) & (places <= group[-1]), self.amplitude[i]
            more = self.unit[i] * (change - self.change[i])[1:] / np.where(now > 0.0, now, 1.0)
            amplitude[there] += (self.amplitude[places, d] * more)[there]
        return amplitude

    def settled_at(self, place: int) -> FloatArray | None:
        """Relative displacement (1 + dof,) of a point, settled; None where it is small, or led nowhere."""
        if self.linear[place] or not np.abs(self.change[place, 1:]).max() > UNSETTLED:
            return None
        z, now = self.path.z[place], self.amplitude[place]
        found = self.corrector.settled(z, self.path.direction[place], now)
        if not np.isfinite(found).all():
            return None
        return np.append(found[0] / z[-1] - 1.0, (found[1:] - now) / self.unit[place])

    def farthest(self, fold: int, side: float) -> float:
        """The frequency on one side (-1 or 1) of a fold that this comes farthest to with more harmonics."""
        rounds = self.corrector.rounds(self.path.z[fold], self.path.direction[fold], self.amplitude[fold])
        found = [float(one[0]) for one in itertools.islice(rounds, LOOKS) if np.isfinite(one[0])]
        here = float(self.path.parameter[fold])
        found.append(here * (1.0 + float(self.change[fold, 0])))
        return max(found, key=lambda frequency: side * frequency)

    def shares(self, places: Indices, size: FloatArray) -> FloatArray:
        """Greatest share (harmonic,), at some points, of sizes (dof,)."""
        sizes = np.tile(size, (len(places), 1))
        most: FloatArray = self.corrector.further.shares(self.path.z[places], sizes).max(axis=0)
        return most

    def sets(self, places: Indices) -> tuple[int, ...]:
        """The harmonics of a corrected curve beside all of some places."""
        share = self.corrector.further.shares(self.path.z[places], self.amplitude[places])
        return self.corrector.ranking.enough_of(share.max(axis=0))

    def bridged(self, place: int, reach: tuple[int, ...]) -> FloatArray:
        """Displacement (1 + dof,) of a point: where the corrected curve is missed, as at a corner that has
        moved, the mean of what is found within reach on both sides, if something is."""
        now: FloatArray = self.change[place].copy()
        if np.isfinite(now).all():
            return now
        beside = []
        for step in (-1, 1):
            ways = [place + step * k for k in reach if 0 <= place + step * k < len(self.known)]
            for way in ways:
                self.find(np.array([way]))
                if np.isfinite(self.change[way]).all():
                    beside.append(self.change[way])
                    break
            else:
                return now
        mean: FloatArray = 0.5 * (beside[0] + beside[1])
        return mean

    def interpolated(self, points: Indices) -> FloatArray:
        """Displacements (point, 1 + dof) by cubics through those that are known, with slopes from them."""
        values = np.empty((len(points), self.change.shape[1]))
        self.filled.at(points, values)
        return values

    def unforeseen(
        self, before: Indices, middle: Indices, after: Indices, expected: FloatArray
    ) -> npt.NDArray[np.bool_]:
        """Where a displacement is not what the two around it lead to expect, as errors of an amplitude.

        Along a steep part one of the frequency is a so much larger error of the amplitude.
        """
        more = np.zeros(len(middle), dtype=np.uint8)
        points = np.array((before, middle, after))
        self.filled.unforeseen(points, expected, self.weight, OFF, NOTHING, more)
        return more.view(np.bool_)

    def find_group(self, group: Indices) -> None:
        """The displacements of tops that lie together, with the best harmonics of each; where those at both
        ends are missed, and the second, so are those between."""
        self.find(group[:2], True)
        if np.isnan(self.change[group[:2], 0]).all() and len(group) > 3:
            self.find(group[-1:], True)
            if np.isnan(self.change[group[-1], 0]):
                self.change[group], self.known[group] = np.nan, True
        self.find(group, True)

    def find(self, places: Indices, best: bool = False) -> None:
        """The displacements of some points, which are then known; with the best harmonics of each, or with
        those that are nearly as good and there already."""
        own = self.path.z, self.path.direction, self.amplitude, self.unit
        self.corrector.move(places, *own, self.change, self.known.view(np.uint8), best)


def _groups(tops: Indices) -> list[Indices]:
    """Those that lie together."""
    return np.split(tops, np.flatnonzero(np.diff(tops) > TOGETHER) + 1)


def _within(places: Indices, reach: int) -> list[Indices]:
    """Groups of which each lies within a number of points."""
    groups = []
    while places.size:
        near = places <= places[0] + reach
        groups.append(places[near])
        places = places[~near]
    return groups


def _with_ends(path: Path, linear: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """With the corners at which linear parts end: there rounding decides what a point is."""
    beside = np.zeros_like(linear)
    beside[1:] |= linear[:-1]
    beside[:-1] |= linear[1:]
    ends: npt.NDArray[np.bool_] = linear | (beside & ((path.mark & Mark.CORNER) > 0))
    return ends
