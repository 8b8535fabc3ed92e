"""Path following: curves of one parameter traced together, through folds and corners.

Predictor and corrector work along the arc of each curve, in coordinates made dimensionless by the curve's
own size, so that neither units nor the frequency scale matter. Curves are rows of arrays: one evaluation
and one stacked solve serve all of them, each with its own step.

Where a regime begins, a response curve has a corner (`fcm.response.corner`), which a short step crosses.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.corner import POINT, corner_ahead, turn_back
from fcm.response.newton import CLOSE, Equations, Newton, amplitudes, correct, scales
from fcm.response.structure import BoolArray, IntArray

Progress = Callable[[float, str], None]  # finished fraction and a text

SAME_DIRECTION = 0.94  # cosine: a smooth step turns by less than 20 degrees
GENTLE_TURN = 0.25  # [rad] the turn that the step size aims at
AIM_SHORT = 0.98  # of the distance to a corner
CORNER = 1e-4  # a step this short may turn by any angle below a right angle: it crosses a corner
STRAIGHT = 0.999  # cosine above which a change of orientation is a branch point and not a corner
FIRST_STEP = 1e-3
LONGEST_PATH = 20000  # steps

BOUNDLESS = 1e9  # amplitude, in units of that at the start, that only an undamped resonance reaches

RUNNING, COMPLETE, RETURNED, STALLED, TOO_LONG, UNBOUNDED = range(6)
REASONS = {
    COMPLETE: "",
    RETURNED: "the curve came back to the frequency where it began, and none was found from the other end",
    STALLED: "no further point could be found; try a smaller --max-step or another range",
    UNBOUNDED: "the amplitude grows without limit, at a resonance that hardly anything damps; add damping",
    TOO_LONG: f"the curve did not leave the range within {LONGEST_PATH} steps; try a larger --max-step",
}


@dataclass
class Trace:
    """Points of all curves in the order in which they were found."""

    curve: IntArray  # (point,)
    z: FloatArray  # (point, unknown + 1), the parameter last
    direction: FloatArray  # (point, unknown + 1) along the curve, any length
    status: IntArray  # (curve,)
    ticks: int = 0  # steps of the group


@dataclass
class _Front:
    """The advancing end of each running curve."""

    curve: IntArray
    z: FloatArray
    scale: FloatArray
    largest: FloatArray  # (curve, block) greatest amplitude so far
    tangent: FloatArray  # unit vector in scaled coordinates
    bend: FloatArray  # change of the tangent per arc
    orientation: FloatArray
    step: FloatArray
    resume: FloatArray  # step before a corner came near, 0 if none has

    def take(self, keep: BoolArray | IntArray) -> _Front:
        return replace(self, **{name: value[keep] for name, value in vars(self).items()})


def follow(
    equations: Equations,
    z: FloatArray,
    low: FloatArray,
    high: FloatArray,
    max_step: FloatArray | float,
    progress: Progress | None = None,
    boundless: float = BOUNDLESS,
    close: float = CLOSE,
) -> Trace:
    """Trace every curve from z, where the parameter is low or high, until it leaves the range.

    close is the error, estimated and relative, within which a point between the ends is one of the curve.
    """
    return _Follower(equations, z, low, high, max_step, progress, boundless, close).run()


class _Follower:
    def __init__(
        self,
        equations: Equations,
        z: FloatArray,
        low: FloatArray,
        high: FloatArray,
        max_step: FloatArray | float,
        progress: Progress | None,
        boundless: float,
        close: float,
    ) -> None:
        curves = z.shape[0]
        self.all_equations, self.progress, self.close = equations, progress, close
        self.low, self.high = np.broadcast_to(low, (curves,)), np.broadcast_to(high, (curves,))
        self.max_step = np.broadcast_to(max_step, (curves,))
        self.status = np.full(curves, RUNNING)
        self.start = z[:, -1].copy()  # low or high
        self.furthest = np.zeros(curves)  # fraction of the range that has been covered
        self.too_large = boundless * amplitudes(z[:, :-1]).max(axis=1, initial=0.0)
        self.points: list[tuple[IntArray, FloatArray, FloatArray]] = []
        self.ticks = 0
        self._begin(z)

    def _begin(self, z: FloatArray) -> None:
        curves = z.shape[0]
        largest = amplitudes(z[:, :-1])
        scale = scales(z[:, :-1], largest, self.high - self.low)
        inward = np.zeros_like(z)
        inward[:, -1] = np.where(self.start == self.low, 1.0, -1.0)
        first = correct(self.all_equations, z, scale, inward)
        self.front = _Front(
            np.arange(curves), first.z, scale, largest, first.tangent, np.zeros_like(z),
            first.determinant, np.minimum(FIRST_STEP, self.max_step), np.zeros(curves),
        )  # fmt: skip
        self.equations = self.all_equations
        self.front.z[:, -1] = self.start
        self._record(first.converged)
        self._retire(np.where(first.converged, RUNNING, STALLED))

    def run(self) -> Trace:
        for count in range(LONGEST_PATH):
            if self.front.curve.size == 0:
                break
            self._tick()
            if self.progress is not None and count % 10 == 0:
                self._report()
        self._retire(np.full(self.front.curve.size, TOO_LONG))
        curve, z, direction = (np.concatenate(part) for part in zip(*self.points, strict=True))
        order = np.argsort(curve, kind="stable")
        return Trace(curve[order], z[order], direction[order], self.status, self.ticks)

    def _tick(self) -> None:
        """One step of every running curve."""
        front = self.front
        h = front.step[:, None]
        guess = front.z + front.scale * (h * front.tangent + 0.5 * h * h * front.bend)
        close = np.minimum(self.close, 1e-4 * front.step)
        new = correct(self.equations, guess, front.scale, front.tangent, close, reach=front.step)
        self.ticks += 1
        turn = (new.tangent * front.tangent).sum(axis=1)
        missed = np.sqrt((((new.z - guess) / front.scale) ** 2).sum(axis=1)) / front.step
        short, tiny = front.step <= CORNER, front.step <= POINT
        kept = new.determinant == front.orientation
        kept |= short & (turn > STRAIGHT)  # a branch point: straight on, with the other orientation
        found = new.converged & kept
        good = found & (missed < 0.5) & ((turn > SAME_DIRECTION) | short)
        corner, at = good, front.step
        if not good.all():
            corner, at = corner_ahead((new.z - front.z) / front.scale, front.tangent, new.tangent, turn)
            corner = corner & found & (at < front.step)
        good |= corner & short
        outside = good & ((new.z[:, -1] > self.high[front.curve]) | (new.z[:, -1] < self.low[front.curve]))
        landed = self._land(outside, new) if outside.any() else outside
        accepted = good & ~outside
        shorter = self._shorter(corner & ~good, at)
        front.step = np.where(accepted | landed, front.step, shorter)
        self._advance(accepted, new, turn, missed)
        front.bend[~accepted] = np.where(short[~accepted, None], 0.0, front.bend[~accepted])
        stuck = ~accepted & ~landed & tiny
        turned = self._turn_corners(stuck) if stuck.any() else stuck
        self._record(accepted | landed | turned)
        status = np.full(front.curve.size, RUNNING)
        back = front.z[:, -1] == self.start[front.curve]
        status[landed] = np.where(back[landed], RETURNED, COMPLETE)
        status[stuck & ~turned] = STALLED
        status[front.largest.max(axis=1, initial=0.0) > self.too_large[front.curve]] = UNBOUNDED
        self._retire(status)

    def _shorter(self, corner: BoolArray, at: FloatArray) -> FloatArray:
        """The step to try next: to the corner, and at last across it; a quarter where there is none."""
        front = self.front
        front.resume = np.where(corner, np.maximum(front.resume, front.step), front.resume)
        to_corner = np.where(at < 0.5 * CORNER, CORNER, AIM_SHORT * at)
        return np.where(corner, np.minimum(to_corner, 0.9 * front.step), 0.25 * front.step)

    def _advance(self, accepted: BoolArray, new: Newton, turn: FloatArray, missed: FloatArray) -> None:
        """Move the accepted curves to their new points and choose their next steps."""
        front = self.front
        x = new.z[:, :-1]
        largest = np.maximum(front.largest, amplitudes(np.where(accepted[:, None], x, 0.0)))
        scale = scales(
            np.where(accepted[:, None], x, 1.0), largest, self.high[front.curve] - self.low[front.curve]
        )
        change = front.scale / scale
        tangent = new.tangent * change
        rate = np.sqrt((tangent * tangent).sum(axis=1, keepdims=True))
        tangent /= np.where(rate > 0.0, rate, 1.0)
        angle = np.arccos(np.clip(turn, -1.0, 1.0))
        smooth = (turn > SAME_DIRECTION)[:, None]
        # the bend of the arc, estimated from the last two tangents (both in the old coordinates)
        bend = np.where(smooth, (new.tangent - front.tangent) / front.step[:, None], 0.0) * change
        bend -= tangent * (tangent * bend).sum(axis=1, keepdims=True)
        growth = np.minimum(GENTLE_TURN / np.maximum(angle, 1e-9), np.sqrt(0.03 / np.maximum(missed, 1e-9)))
        step = np.minimum(front.step * np.clip(0.9 * growth, 0.4, 2.5), self.max_step[front.curve])
        crossed = accepted & ~smooth[:, 0]
        step = np.where(crossed, np.maximum(step, 0.5 * front.resume), step)
        front.resume[crossed | (accepted & (step >= front.resume))] = 0.0
        pick = accepted[:, None]
        front.z = np.where(pick, new.z, front.z)
        front.scale = np.where(pick, scale, front.scale)
        front.largest = np.where(pick, largest, front.largest)
        front.tangent = np.where(pick, tangent, front.tangent)
        front.bend = np.where(pick, bend, front.bend)
        front.orientation = np.where(accepted, new.determinant, front.orientation)
        front.step = np.where(accepted, step, front.step)

    def _land(self, outside: BoolArray, new: Newton) -> BoolArray:
        """Replace a step that leaves the range by one that ends on its limit."""
        front = self.front
        some = np.flatnonzero(outside)
        curve = front.curve[some]
        before, after = front.z[some], new.z[some]
        limit = np.where(after[:, -1] > self.high[curve], self.high[curve], self.low[curve])
        share = (limit - before[:, -1]) / (after[:, -1] - before[:, -1])
        guess = before + share[:, None] * (after - before)
        guess[:, -1] = limit
        level = np.zeros_like(guess)
        level[:, -1] = np.sign(after[:, -1] - before[:, -1])
        end = correct(self.equations.take(some), guess, front.scale[some], level)
        reach = np.sqrt((((end.z - guess) / front.scale[some]) ** 2).sum(axis=1))
        ok = end.converged & (reach < 0.5 * front.step[some] + 1e-9)
        landed = np.zeros_like(outside)
        landed[some[ok]] = True
        end.z[:, -1] = limit
        front.z[some[ok]] = end.z[ok]
        front.tangent[some[ok]] = end.tangent[ok]
        return landed

    def _turn_corners(self, stuck: BoolArray) -> BoolArray:
        """Leave a corner, known to within POINT, in a direction that may point backwards."""
        front, turned = self.front, np.zeros_like(stuck)
        for i in np.flatnonzero(stuck):
            here = front.take(np.array([i]))
            beyond = turn_back(
                self.equations.take(np.array([i])), here.z, here.scale, here.tangent, here.orientation
            )
            if beyond is not None:
                front.z[i], front.tangent[i], front.step[i] = beyond
                front.bend[i], turned[i] = 0.0, True
        return turned

    def _record(self, which: BoolArray) -> None:
        front = self.front
        self.points.append((front.curve[which], front.z[which], (front.scale * front.tangent)[which]))

    def _retire(self, status: IntArray) -> None:
        """Take the finished curves out of the group."""
        front = self.front
        self.status[front.curve] = status
        covered = np.abs(front.z[:, -1] - self.start[front.curve]) / (self.high - self.low)[front.curve]
        self.furthest[front.curve] = np.maximum(self.furthest[front.curve], covered)
        keep = status == RUNNING
        if not keep.all():
            self.front = front.take(keep)
            self.equations = self.equations.take(np.flatnonzero(keep))

    def _report(self) -> None:
        assert self.progress is not None
        share = np.where(self.status == RUNNING, self.furthest, 1.0)
        left = self.front.curve.size
        self.progress(float(share.mean()), f"{left} curve{'s' if left != 1 else ''} running")
