"""Following the curve of periodic solutions along its arc: predictor and corrector, folds and corners.

Where a regime begins the curve may have a corner. The step shrinks until the corner is a point; beyond it the
curve goes on with the orientation that the sign of the determinant carries across, as for piecewise linear
paths (Allgower and Georg, "Introduction to Numerical Continuation Methods").
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fcm.scene.model import FloatArray
from fcm.simulate.arc import Equations, Point, level, rescaled

FIRST_STEP = 1e-2
SAME_DIRECTION = 0.94  # cosine: a smooth step turns by less than 20 degrees
GENTLE_TURN = 0.25  # [rad] the turn that the step size aims at
MISSED = 0.03  # distance of guess and point, in steps, that it aims at
CORNER = 1e-4  # a step this short may turn by any angle below a right angle: it crosses a corner
POINT = 1e-7  # a corner known to this is a point from which the curve may turn back
STRAIGHT = 0.999  # cosine above which a change of orientation is a branch point and not a corner
CORNER_TRIES = 16  # directions around a corner in which its regimes are looked for
REACHES = POINT * np.array([1e1, 1e2, 1e3, 1e4])  # distances at which they are
BOUNDLESS = 1e9  # size of the motion, in units of that at the start, that only an undamped resonance reaches
MOST_STEPS = 20_000
MANY = 20  # transitions in a cycle with which contacts chatter
CROWD, CROWDED = 100, 1e-3  # so many successive attempts that cover less arc than that


STALLED = "no further solution could be found; try a smaller max_step or another range"
UNBOUNDED = "the motion grows without limit, at a resonance that hardly anything damps; add damping"
CHATTER = (
    "the contacts chatter, and the states over the cycle change at almost every step; give the modes more "
    "damping, or the contacts less stiffness"
)
TOO_LONG = f"the curve did not leave the range within {MOST_STEPS} steps; try a larger max_step"


class Follower:
    """One way along the curve from a point; `reason` says why it did not end at an end of the range."""

    def __init__(self, equations: Equations, first: Point, longest: float) -> None:
        self.equations, self.point, self.longest = equations, first, longest
        self.low, self.high = equations.scene.frequency_range
        self.step = min(FIRST_STEP, longest)
        self.bend = np.zeros_like(first.z)  # change of the tangent per arc
        self.reason = ""

    def points(self) -> Iterator[Point]:
        """The points after the first, as they are found; the last one is at an end of the range."""
        limit = BOUNDLESS * _size(self.point)
        covered = np.ones(CROWD)  # arc covered by the last attempts
        for count in range(MOST_STEPS):
            if covered.sum() < CROWDED:
                self.reason = CHATTER if len(self.point.shot.segments) > MANY else STALLED
                return
            covered[count % CROWD] = 0.0
            new = self._attempt()
            if new is None and self.step > POINT:
                self._shorten()
                continue
            if new is None:
                new = self._turned()
            if new is None:
                self.reason = STALLED
                return
            if not self.low < new.z[-1] < self.high:
                new = self._landed(new)
                if new is None:
                    self._shorten()
                    continue
                yield new
                return
            covered[count % CROWD] = self.step
            self._move(new)
            yield self.point
            if _size(self.point) > limit:
                self.reason = UNBOUNDED
                return
        self.reason = TOO_LONG

    def _attempt(self) -> Point | None:
        """The point a step further on; None if the step is too long."""
        here, h = self.point, self.step
        guess = here.z + here.scale * (h * here.tangent + 0.5 * h * h * self.bend)
        new = self.equations.correct(guess, here.scale, here.tangent, 0.5 * h)
        if new is None:
            return None
        turn = float(new.tangent @ here.tangent)
        kept = new.orientation == here.orientation or (h <= CORNER and turn > STRAIGHT)
        chord = (new.z - here.z) / here.scale
        onward = float(new.tangent @ chord) > 0.5 * np.linalg.norm(chord)
        return new if kept and onward and (turn > SAME_DIRECTION or h <= CORNER) else None

    def _shorten(self) -> None:
        if self.step <= CORNER:
            self.bend = np.zeros_like(self.bend)
        self.step *= 0.25

    def _move(self, new: Point) -> None:
        """Go to a point, and choose the next step."""
        here, h = self.point, self.step
        turn = float(new.tangent @ here.tangent)
        guess = here.z + here.scale * (h * here.tangent + 0.5 * h * h * self.bend)
        missed = float(np.linalg.norm((new.z - guess) / here.scale)) / h
        self.point = rescaled(self.equations, new)
        bend = (new.tangent - here.tangent) / h if turn > SAME_DIRECTION else np.zeros_like(self.bend)
        bend = bend * here.scale / self.point.scale
        self.bend = bend - self.point.tangent * float(self.point.tangent @ bend)
        angle = float(np.arccos(np.clip(turn, -1.0, 1.0)))
        growth = min(GENTLE_TURN / max(angle, 1e-9), np.sqrt(MISSED / max(missed, 1e-9)))
        self.step = min(h * float(np.clip(0.9 * growth, 0.4, 2.5)), self.longest)

    def _landed(self, new: Point) -> Point | None:
        """The point at the end of the range, on the way to one beyond it."""
        here = self.point
        if new.z[-1] == here.z[-1]:  # along the end of the range: free motion at an undamped resonance
            return None
        end = self.high if new.z[-1] >= self.high else self.low
        share = (end - here.z[-1]) / (new.z[-1] - here.z[-1])
        guess = here.z + share * (new.z - here.z)
        guess[-1] = end
        sense = float(np.sign(new.z[-1] - here.z[-1]))
        landed = self.equations.correct(guess, here.scale, level(guess.size, sense), 0.5 * self.step + 1e-9)
        return None if landed is None else rescaled(self.equations, landed)

    def _turned(self) -> Point | None:
        """A point beyond a corner, which is here, in whatever direction the curve leaves it."""
        here = self.point
        rng = np.random.default_rng(0)
        for reach in REACHES:
            for direction in (here.tangent, *rng.normal(size=(CORNER_TRIES - 1, here.z.size))):
                new = self._beyond(reach, direction / np.linalg.norm(direction))
                if new is not None:
                    self.step, self.bend = reach, np.zeros_like(self.bend)
                    return new
        return None

    def _beyond(self, reach: float, direction: FloatArray) -> Point | None:
        """The curve in the regime that lies in a direction from here."""
        here, equations = self.point, self.equations
        around = here.z + reach * here.scale * direction
        tangent = equations.direction(around, here.scale, direction, here.orientation)
        if tangent is None:
            return None
        new = equations.correct(here.z + reach * here.scale * tangent, here.scale, tangent, 2.0 * reach)
        if new is None or new.orientation != here.orientation:
            return None
        step = (new.z - here.z) / here.scale
        length = float(np.linalg.norm(step))
        leads_away = float(new.tangent @ step) > 0.5 * length
        comes_back = float(here.tangent @ step) < -0.99 * length  # along the way that led here
        return new if leads_away and not comes_back else None


def _size(point: Point) -> float:
    """Of the motion."""
    return float(point.scale[:-1].max(initial=0.0))
