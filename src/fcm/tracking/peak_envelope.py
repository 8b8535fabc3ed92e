r"""The envelope of several tracked peaks over a number, and its least value.

A curve of peaks is cut into pieces on which the number is monotone. Each piece is a function of the number,
evaluated by Newton's method to rounding. The envelope, the greatest of all, is piecewise smooth. Its least
value is at a minimum of a piece, at a crossing of two pieces, or at an end of one.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import solution_near
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.tracking.curve import SpecialPointCurve
from fcm.tracking.extended_system import Condition, ExtendedSystem, Kind
from fcm.tracking.tracked_point import TrackedPoint, TrackingSetup

INCOMPLETE = "unfinished"  # kind of the least value of an interrupted search


class Target(NamedTuple):
    """A quantity to be minimised: a degree of freedom, and whether the ends of the range count."""

    dof: int
    ends: bool = False


class PieceHeight(NamedTuple):
    """Height of a piece at a value of the number, with its slope."""

    value: float
    slope: float
    z: FloatArray  # (x, omega, s)
    dof: int


class EnvelopeMinimum(Frozen):
    """The least value of an envelope on a line: the value of s, the amplitude, and the pieces with it."""

    s: float
    value: float
    active: tuple[PieceHeight, ...]
    kind: str  # "smooth", "kink" of equal peaks, "corner", "end" of a higher peak, "bound", "flat", "trials",
    # "unfinished"
    between: tuple[float, float] | None = None  # neighbouring values of s, if it was found by trials
    flat: tuple[tuple[int, float, float], ...] = ()  # index of a number, and the two values of it, here of s,
    # between which the envelope does not depend on it
    tried: tuple[tuple[float, float], ...] = ()  # ascending s, and the greatest height, if found by trials


class MonotonePiece:
    """A part of a tracked curve along which s is monotone; its height is that of a degree of freedom."""

    def __init__(
        self, setup: TrackingSetup, track: SpecialPointCurve, places: Sequence[int], dof: int
    ) -> None:
        order = list(places) if track.s[places[0]] <= track.s[places[-1]] else list(places)[::-1]
        self.setup, self.condition, self.dof = setup, track.condition, dof
        self.tracked_points = [track.points[i] for i in order]
        self.s, self.height = track.s[order], track.amplitude[order, dof]
        self._problems: dict[Condition | None, ExtendedSystem] = {}
        self._heights: dict[float, PieceHeight] = {}

    def covers(self, s: float) -> bool:
        """Whether the piece has a height at s."""
        return bool(self.s[0] <= s <= self.s[-1])

    def roughly(self, s: float) -> float:
        """Height at s by the chord between two points."""
        return float(np.interp(s, self.s, self.height))

    def at(self, s: float) -> PieceHeight:
        """Height at s exactly, or by the chord where Newton's method does not converge."""
        if s not in self._heights:
            self._heights[s] = self._at(s)
        return self._heights[s]

    def _at(self, s: float) -> PieceHeight:
        guess, i, part, _ = self._guess(s)
        if (solved := self._solved(s)) is not None:
            return self._height(*solved)
        slope = (self.height[i + 1] - self.height[i]) / max(self.s[i + 1] - self.s[i], 1e-300)
        return PieceHeight(
            float(self.height[i] + part * (self.height[i + 1] - self.height[i])), slope, guess, self.dof
        )

    def point(self, s: float, rising: float) -> TrackedPoint | None:
        """The point at s of a curve along which s rises (1) or falls (-1); None if it is not found."""
        if (solved := self._solved(s)) is None:
            return None
        _, newton = solved
        z, t = np.array(newton.z), np.asarray(newton.tangent) * np.asarray(newton.scale)
        return TrackedPoint(z, t if t[-1] * rising > 0.0 else -t, self._guess(s)[3])

    def _guess(self, s: float) -> tuple[FloatArray, int, float, Condition | None]:
        """A guess at s by the chord: z, the index of the chord, the part of it, and the tracked corner."""
        i = int(np.clip(np.searchsorted(self.s, s) - 1, 0, len(self.s) - 2))
        one, other = self.tracked_points[i], self.tracked_points[i + 1]
        part = (s - self.s[i]) / max(self.s[i + 1] - self.s[i], 1e-300)
        guess = one.z + part * (other.z - one.z)
        guess[-1] = s
        return guess, i, part, other.corner if one.switch else one.corner

    def _solved(self, s: float) -> tuple[ExtendedSystem, Newton] | None:
        guess, _, _, corner = self._guess(s)
        problem = self._problem(corner)
        newton = Newton(problem)
        found = solution_near(newton, guess, reach=problem.options.pieces.reach)
        return None if found is None else (problem, newton)

    def _problem(self, corner: Condition | None) -> ExtendedSystem:
        if corner not in self._problems:
            self._problems[corner] = self.setup.tracked(corner or self.condition)
        return self._problems[corner]

    def _height(self, problem: ExtendedSystem, newton: Newton) -> PieceHeight:
        """Amplitude at the point found, and its rate by s along the curve."""
        z, t = np.array(newton.z), np.asarray(newton.tangent) * np.asarray(newton.scale)
        value, slope = problem.amplitude_along(z, t / t[-1], self.dof)
        return PieceHeight(value, slope, z, self.dof)


def pieces_of(
    setup: TrackingSetup, tracks: Sequence[SpecialPointCurve], target: Target
) -> list[MonotonePiece]:
    """The monotone pieces of the curves that count for a target; troughs are left out."""
    found = []
    for track in tracks:
        kind, which = track.condition.kind, track.condition.which
        if not (kind is Kind.PEAK and which == target.dof) and not (kind is Kind.END and target.ends):
            continue
        found += [MonotonePiece(setup, track, places, target.dof) for places in _monotone(track)]
    return found


def _monotone(track: SpecialPointCurve) -> list[list[int]]:
    """Indices of runs of points along which s is monotone, without troughs."""
    parts: list[list[int]] = [[]]
    for i in range(len(track.s)):
        if not track.greatest[i] and not track.points[i].turn:
            parts.append([])
            continue
        last = parts[-1]
        if last and track.s[i] == track.s[last[-1]]:
            continue
        if len(last) > 1 and (track.s[i] - track.s[last[-1]]) * (track.s[last[-1]] - track.s[last[-2]]) < 0.0:
            parts.append([last[-1]])
        parts[-1].append(i)
    return [part for part in parts if len(part) > 1]


def envelope_minimum(setup: TrackingSetup, pieces: Sequence[MonotonePiece]) -> EnvelopeMinimum | None:
    """The least value of the envelope of pieces; None without a piece."""
    if not pieces:
        return None
    low, high = setup.span
    grid = np.unique(np.concatenate([piece.s for piece in pieces]))
    grid = grid[(grid >= low) & (grid <= high)]
    rough = np.array([np.max([p.roughly(s) for p in pieces if p.covers(s)]) for s in grid])
    inner = np.pad(rough, 1, constant_values=np.inf)
    lowest = np.flatnonzero((rough <= inner[:-2]) & (rough <= inner[2:]))
    lowest = lowest[np.argsort(rough[lowest])][: setup.options.envelope.brackets]
    envelope = _Envelope(pieces, setup)
    found = [_refined(envelope, setup, *_around(pieces, grid, i)) for i in lowest.tolist()]
    return _where_flat(envelope, setup, grid, min(found, key=lambda one: one.value))


class _Envelope:
    """The envelope of the pieces as an exact function of s."""

    def __init__(self, pieces: Sequence[MonotonePiece], setup: TrackingSetup) -> None:
        self.pieces, self.options = pieces, setup.options.envelope

    def highest(self, s: float) -> tuple[PieceHeight, MonotonePiece]:
        """The height of the highest piece at s, and the piece; infinite where none is known."""
        rough = {piece: piece.roughly(s) for piece in self.pieces if piece.covers(s)}
        if not rough:
            return PieceHeight(np.inf, 0.0, np.zeros(0), -1), self.pieces[0]
        top = max(rough.values())
        heights = [
            (piece.at(s), piece)
            for piece, height in rough.items()
            if height >= self.options.chord_fraction * top
        ]
        return max(heights, key=lambda pair: pair[0].value)

    def active(self, s: float, value: float) -> tuple[PieceHeight, ...]:
        """Heights of all pieces at s that reach a value."""
        heights = (piece.at(s) for piece in self.pieces if piece.covers(s))
        return tuple(one for one in heights if one.value >= value * (1.0 - self.options.height_tolerance))


def _where_flat(
    envelope: _Envelope, setup: TrackingSetup, grid: FloatArray, best: EnvelopeMinimum
) -> EnvelopeMinimum:
    """The middle of the flat stretch at the least value, on which s has no effect; best without one."""
    span, options = setup.span[1] - setup.span[0], setup.options.envelope

    def flat(s: float) -> bool:
        there = envelope.highest(s)[0]
        near = abs(there.value - best.value) <= options.flat_height * best.value
        return near and abs(there.slope) * span <= options.flat_slope * best.value

    least = options.min_flat * span
    around = [s for s in (best.s - least, best.s + least) if setup.span[0] <= s <= setup.span[1]]
    inner = next((s for s in around if flat(s)), None)
    if inner is None:
        return best
    fine = options.value_tolerance * span
    ends = (
        _end_of_flat(flat, inner, grid[grid < inner][::-1], fine),
        _end_of_flat(flat, inner, grid[grid > inner], fine),
    )
    middle = 0.5 * sum(ends)
    top = envelope.highest(middle)[0].value
    return replace(
        best, s=middle, value=top, active=envelope.active(middle, top), kind="flat", flat=((0, *ends),)
    )


def spans_beside_flat(setup: TrackingSetup, best: EnvelopeMinimum | None) -> list[tuple[float, float]]:
    """The rest of the span below and above a flat stretch over most of it; empty without such a stretch.

    Each part includes a piece of the flat stretch that is as wide as itself.
    """
    (low, high), options = setup.span, setup.options.envelope
    if best is None or not best.flat:
        return []
    ((_, first, last),) = best.flat
    if last - first < options.wide_flat * (high - low):
        return []
    sides = ((low, min(2.0 * first - low, last)), (max(2.0 * last - high, first), high))
    return [side for side in sides if side[1] - side[0] > options.value_tolerance * (high - low)]


def _end_of_flat(flat: Callable[[float], bool], s: float, further: FloatArray, fine: float) -> float:
    """The last flat value on one side of s, over points of the grid and then by bisection."""
    for there in further.tolist():
        if not flat(there):
            while abs(there - s) > fine:
                middle = 0.5 * (s + there)
                s, there = (middle, there) if flat(middle) else (s, middle)
            return s
        s = there
    return s


def uncovered_values(
    setup: TrackingSetup, pieces: Sequence[MonotonePiece], tried: Collection[float] = ()
) -> list[float]:
    """Values of s that no piece covers: ends of the span, and middles of gaps.

    An end that was tried, and has no peak, is replaced by the middle of its gap.
    """
    low, high = setup.span
    least, found, last = setup.options.envelope.min_gap * (high - low), [], low
    if not pieces:
        ends = [end for end in setup.span if end not in tried]
        return ends or [0.5 * (low + high)]
    for piece in sorted(pieces, key=lambda piece: float(piece.s[0])):
        if piece.s[0] - last > least:
            at_end = last == low and low not in tried
            found.append(low if at_end else 0.5 * (last + float(piece.s[0])))
        last = max(last, float(piece.s[-1]))
    if high - last > least:
        found.append(0.5 * (last + high) if high in tried else high)
    return found


def _around(pieces: Sequence[MonotonePiece], grid: FloatArray, i: int) -> tuple[float, float, float]:
    """The grid value i and its neighbours, which bracket points of the highest piece on both sides."""
    s = float(grid[i])
    top = max((p for p in pieces if p.covers(s)), key=lambda p: p.roughly(s))
    low, high = float(grid[max(i - 1, 0)]), float(grid[min(i + 1, len(grid) - 1)])
    below, above = top.s[top.s < s], top.s[top.s > s]
    low = min(low, float(below.max())) if below.size else low
    high = max(high, float(above.min())) if above.size else high
    return low, s, high


def _refined(
    envelope: _Envelope, setup: TrackingSetup, low: float, middle: float, high: float
) -> EnvelopeMinimum:
    """The least value of the envelope between two values of s."""
    span, options = setup.span[1] - setup.span[0], setup.options.envelope
    pieces, highest = envelope.pieces, envelope.highest
    if high > low:
        most = options.unknown_factor * max(float(piece.height.max()) for piece in pieces)
        bounded = minimize_scalar(
            lambda s: min(highest(s)[0].value, most),
            bounds=(low, high),
            method="bounded",
            options={"xatol": options.search_tolerance * span},
        )
        tried = [float(bounded.x), low, middle, high]
        s = min(tried, key=lambda s: highest(s)[0].value)
    else:
        s = middle
    width = options.bracket * span
    left, right = max(low, s - width), min(high, s + width)
    (before, one), (after, other) = highest(left), highest(right)
    kind = "bound"
    if before.slope < 0.0 < after.slope:
        kind, s = _turned(highest, (one, other), (left, right), setup)
    elif low < s < high or setup.span[0] < s < setup.span[1]:
        kind = "corner"
    else:
        s = left if before.value <= after.value else right
    top = highest(s)[0]
    active = envelope.active(s, top.value)
    kind = "kink" if len(active) > 1 else kind
    if kind == "corner" and any(
        _ends_higher(piece, s, top.value * (1.0 + options.height_tolerance), width) for piece in pieces
    ):
        kind = "end"
    return EnvelopeMinimum(s, top.value, active, kind)


def _ends_higher(piece: MonotonePiece, s: float, value: float, width: float) -> bool:
    """Whether a piece that does not cover s has an end close by that is higher than a value."""
    ends = ((piece.s[0], piece.height[0]), (piece.s[-1], piece.height[-1]))
    near = any(abs(end - s) < width and height > value for end, height in ends)
    return near and not piece.s[0] < s < piece.s[-1]


def _turned(
    highest: Callable[[float], tuple[PieceHeight, MonotonePiece]],
    pieces: tuple[MonotonePiece, MonotonePiece],
    between: tuple[float, float],
    setup: TrackingSetup,
) -> tuple[str, float]:
    """The kind and value of s of a minimum of the envelope: where pieces cross, or one has its minimum."""
    (one, other), span = pieces, setup.span[1] - setup.span[0]
    options = setup.options.envelope
    fine = options.value_tolerance * min(span, max(map(abs, between)))
    if one is not other:
        crossing = _root(lambda s: one.at(s).value - other.at(s).value, *between, fine)
        if one.covers(crossing) and other.covers(crossing):
            return "kink", crossing
    at = _root(lambda s: highest(s)[0].slope, *between, fine)
    beside = min(abs(highest(s)[0].slope) for s in between)
    return "smooth" if abs(highest(at)[0].slope) < options.smooth_slope * beside else "corner", at


def _root(function: Callable[[float], float], low: float, high: float, tolerance: float) -> float:
    """A zero of a function between two ends; if it keeps its sign, the end with the lesser magnitude."""
    if function(low) * function(high) > 0.0:
        return low if abs(function(low)) < abs(function(high)) else high
    return float(brentq(function, low, high, xtol=tolerance))
