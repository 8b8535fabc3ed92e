"""All curves of special points of a response over a range of a number, each followed once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fcm.continuation.follow import Progress
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray
from fcm.track.corner import Corner
from fcm.track.follow import follow, land
from fcm.track.seeds import moved, special_points
from fcm.track.spot import Ending, Spot, Way
from fcm.track.tracked import Condition, Kind, Tracked
from fcm.track.varied import Line

SEEDS = 13  # values of the number, evenly spaced, at which ordinary curves are traced
MOST_PEAKS = 3  # curves of peaks along which onsets are looked for
SAME = 1e-5  # in the problem's scale: points nearer than this are one
BESIDE = 0.1  # of a chord: what is nearer to it lies on the curve
CUSP = 1e-3  # of the frequency's rate beside a turn: at the turn it is less where it turns back, too

BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Track:
    """One curve: points in the order along it."""

    condition: Condition
    spots: tuple[Spot, ...]
    s: FloatArray  # (point,)
    frequency: FloatArray  # (point,) [rad/s]
    amplitude: FloatArray  # (point, dof)
    greatest: BoolArray  # (point,) of peaks: whether it is one, and not a trough
    endings: tuple[Ending, Ending]

    @property
    def whole(self) -> bool:
        """Whether there is no more of it."""
        return all(ending.whole for ending in self.endings)

    def turns(self) -> list[tuple[int, str]]:
        """Points at which the number turns back, and what they are."""
        other = "peak and trough" if self.condition.kind is Kind.PEAK else "extreme"
        fold, turns = self.condition.kind is Kind.FOLD, [i for i, spot in enumerate(self.spots) if spot.turn]
        return [(i, self._turn_of_fold(i) if fold else other) for i in turns]

    def _turn_of_fold(self, i: int) -> str:
        """A cusp where two folds meet with one tangent; an isola where the frequency passes on.

        Along a curve of folds w . R_omega omega' + w . R_s s' = 0, with w the adjoint null vector. At a cusp
        omega' vanishes with s', as w . R_omega does not; else it is w . R_omega that vanishes, and the
        response has an isolated point, or crosses itself. At a corner the frequency turns back, or does not.
        """
        beside = [self.spots[j].direction[-2] for j in (i - 1, i + 1) if 0 <= j < len(self.spots)]
        if self.spots[i].switch and len(beside) == 2:
            return "cusp" if beside[0] * beside[1] < 0.0 else "isola"
        still = abs(self.spots[i].direction[-2]) < CUSP * max(map(abs, beside), default=0.0)
        return "cusp" if still else "isola"


@dataclass(frozen=True)
class Tracks:
    """All curves, and what could not be followed."""

    curves: tuple[Track, ...]
    problems: tuple[str, ...] = ()
    interrupted: bool = False  # so that there may be more


def tracks(
    system: System,
    line: Line,
    span: tuple[float, float],
    conditions: list[Condition],
    seeds: tuple[float, ...] = (),
    progress: Progress | None = None,
) -> Tracks:
    """The curves of conditions, from ordinary curves at some values of s, and at more seeds.

    An onset that comes and goes between two such values is first met by the highest peak. Interrupted, it
    returns the curves that are finished.
    """
    values = sorted({*np.linspace(*span, SEEDS).tolist(), *seeds})
    way = Way(system, line, span, tuple(values[1:-1]), system.scene.max_step)
    made, stopped = _Made(way), False
    try:
        _follow_all(made, values, conditions, progress)
    except KeyboardInterrupt:
        stopped = True
    return Tracks(tuple(made.curves), tuple(made.problems), stopped)


def _follow_all(
    made: _Made, values: list[float], conditions: list[Condition], progress: Progress | None
) -> None:
    """From ordinary curves at some values."""
    system, line = made.way.system, made.way.line
    for number, value in enumerate(values):
        if progress is not None:
            progress(number / len(values))
        points, wrong = special_points(moved(system, line.scene(system.scene, value)), conditions)
        if wrong:
            made.problems.append(f"at {value:.6g}: {wrong}")
        made.from_points([(condition, np.append(z, value)) for condition, z in points])
    onsets = [condition for condition in conditions if condition.kind is Kind.ONSET]
    if onsets:
        made.from_points(_met_by_peaks(made.way, onsets))


class _Made:
    """The curves so far."""

    def __init__(self, way: Way) -> None:
        self.way = way
        self.curves: list[Track] = []
        self.problems: list[str] = []

    def from_points(self, points: list[tuple[Condition, FloatArray]]) -> None:
        """Follow those that no curve has passed; z = (x, omega, s)."""
        for condition, z in points:
            spot = land(self.way, condition, z)
            if spot is not None and not any(passed(one, condition, spot, self.way) for one in self.curves):
                self.curves.append(whole(self.way, condition, spot))


def _met_by_peaks(way: Way, onsets: list[Condition]) -> list[tuple[Condition, FloatArray]]:
    """Points of onsets next to which the peak of the degree of freedom that moves most comes."""
    middle = moved(way.system, way.line.scene(way.system.scene, 0.5 * sum(way.span)))
    peaks = [Condition(Kind.PEAK, d) for d in range(len(middle.scene.modal.dofs))]
    points = special_points(middle, peaks)[0]
    problem = way.tracked(onsets[0])
    made = _Made(way)
    for condition, z in points[:MOST_PEAKS]:
        made.from_points([(condition, np.append(z, 0.5 * sum(way.span)))])
    found = []
    for spots in (curve.spots for curve in made.curves):
        for onset in onsets:
            value = np.array([problem.onset_at(spot.z, onset) for spot in spots])
            for i in np.flatnonzero(value[:-1] * value[1:] <= 0.0):
                found.append((onset, np.array(spots[i + int(abs(value[i + 1]) < abs(value[i]))].z)))
    return found


def passed(curve: Track, condition: Condition, spot: Spot, way: Way) -> bool:
    """Whether a curve has passed a spot."""
    if curve.condition != condition:
        return False
    problem = way.tracked(condition)
    problem.measure(spot.z)
    points = (np.array([one.z for one in curve.spots]) - spot.z) / np.asarray(problem.scale)
    there = np.abs(points[:, -1]) <= SAME
    if there.any():
        return bool(np.linalg.norm(points[there], axis=1).min() < 1e2 * SAME)
    return _on_chord(points)


def _on_chord(points: FloatArray) -> bool:
    """Whether the origin lies on a line through points, as near as its chords are to a curve."""
    chord = np.diff(points, axis=0)
    length = np.maximum(np.linalg.norm(chord, axis=1), 1e-300)
    part = np.clip(-(points[:-1] * chord).sum(axis=1) / length**2, 0.0, 1.0)
    off = np.linalg.norm(points[:-1] + part[:, None] * chord, axis=1)
    return bool((off < BESIDE * length).any())


def whole(way: Way, condition: Condition, spot: Spot) -> Track:
    """The curve through a spot, both ways."""
    spots, ending = follow(way, condition, spot, True)
    endings = (ending, ending)
    if ending is not Ending.CLOSED:
        back, other = follow(way, condition, spot, False)
        turned = [replace(one, direction=-one.direction) for one in back[:0:-1]]
        spots, endings = [*turned, *spots], (other, ending)
    return recorded(way, condition, spots or [spot], endings)


def recorded(way: Way, condition: Condition, spots: list[Spot], endings: tuple[Ending, Ending]) -> Track:
    """A curve with what is reported of its points."""
    problem = way.tracked(condition)
    amplitude, greatest = [], []
    for spot in spots:
        problem.measure(spot.z)
        amplitude.append(problem.along(spot.z)[1])
        greatest.append(condition.kind is not Kind.PEAK or is_top(problem, spot))
    z = np.array([spot.z for spot in spots])
    return Track(
        condition, tuple(spots), z[:, -1], z[:, -2], np.array(amplitude), np.array(greatest), endings
    )


def is_top(problem: Tracked, spot: Spot) -> bool:
    """Whether a tracked peak is one, and not a trough."""
    if spot.corner is None or spot.switch:
        return problem.is_top(spot.z)
    corner = Corner(problem, spot.corner)
    corner.problem.row[:] = problem.row
    corner.problem.measure(spot.z)
    before, after = corner.sides(spot.z)
    return bool(before > after)
