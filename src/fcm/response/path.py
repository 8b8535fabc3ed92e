"""Path following: curves of one parameter traced together, through folds and corners.

Predictor and corrector work along the arc of each curve, in coordinates made dimensionless by the curve's
own size, so that neither units nor the frequency scale matter. Curves are rows of arrays: one evaluation
and one stacked solve serve all of them, each with its own step.

Where a regime begins, a response curve has a corner. The step shrinks until the corner is a point; if the
curve turns back on itself there, its new direction is found from the equations just beyond, with the
orientation that the sign of the determinant carries across a corner (Eaves 1976, Allgower and Georg,
"Introduction to numerical continuation methods", section 2.1 and chapter 15).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.response.structure import IntArray

BoolArray = npt.NDArray[np.bool_]
Progress = Callable[[float, str], None]  # finished fraction and a text

MAX_ITERATIONS = 7  # Newton steps before a predictor is judged too far away
CLOSE = 1e-8  # error of a point, estimated from quadratic convergence; every point is corrected later
SAME_DIRECTION = 0.94  # cosine: a smooth step turns by less than 20 degrees
GENTLE_TURN = 0.25  # [rad] the turn that the step size aims at
CORNER = 1e-4  # a step this short may turn by any angle below a right angle: it crosses a corner
POINT = 1e-7  # a corner known to this is a point from which the curve may turn back
CORNER_TRIES = 16  # directions around a corner in which its regimes are looked for
STRAIGHT = 0.999  # cosine above which a change of orientation is a branch point and not a corner
FIRST_STEP = 1e-3
LONGEST_PATH = 20000  # steps
OWN_FLOOR, OTHER_FLOOR = 0.1, 1e-6  # a scale is at least this much of its own, and of the greatest, maximum

BOUNDLESS = 1e9  # amplitude, in units of that at the start, that only an undamped resonance reaches

RUNNING, COMPLETE, RETURNED, STALLED, TOO_LONG, UNBOUNDED = range(6)
REASONS = {
    COMPLETE: "",
    RETURNED: "the curve came back to the frequency where it began, and none was found from the other end",
    STALLED: "no further point could be found; try a smaller --max-step or another range",
    UNBOUNDED: "the amplitude grows without limit, at a resonance that nothing damps; add damping",
    TOO_LONG: f"the curve did not leave the range within {LONGEST_PATH} steps; try a larger --max-step",
}


class Derivatives(Protocol):
    """What the follower needs at a point of each curve."""

    @property
    def residual(self) -> FloatArray: ...  # (curve, unknown)
    @property
    def jacobian(self) -> FloatArray: ...  # (curve, unknown, unknown)
    @property
    def by_omega(self) -> FloatArray: ...  # (curve, unknown), by the parameter of the path


class Equations(Protocol):
    """residual(x, p) = 0 for a group of curves."""

    def evaluate(self, x: FloatArray, omega: FloatArray, /) -> Derivatives:
        """Residual and derivatives at x (curve, unknown) and the parameter (curve,)."""

    def take(self, index: IntArray, /) -> Equations:
        """The equations of some of the curves."""


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

    def take(self, keep: BoolArray) -> _Front:
        return replace(self, **{name: value[keep] for name, value in vars(self).items()})


def amplitudes(x: FloatArray) -> FloatArray:
    """Size of the tangential and the normal displacement of each contact, (curve, 2 contacts)."""
    blocks = x.reshape(x.shape[0], x.shape[1] // 5, 5)
    u = np.hypot(blocks[..., 0], blocks[..., 1])
    v = np.maximum(np.hypot(blocks[..., 2], blocks[..., 3]), np.abs(blocks[..., 4]))
    return np.stack((u, v), axis=-1).reshape(x.shape[0], 2 * blocks.shape[1])


def scales(x: FloatArray, largest: FloatArray, extent: FloatArray) -> FloatArray:
    """Units in which a curve is measured: amplitudes by their present size, the parameter by its range."""
    overall = largest.max(axis=1, initial=0.0, keepdims=True)
    size = np.maximum(amplitudes(x), np.maximum(OWN_FLOOR * largest, OTHER_FLOOR * overall))
    size = np.where(size > 0.0, size, 1.0) * np.sqrt(max(size.shape[1], 1))
    pairs = size.reshape(x.shape[0], x.shape[1] // 5, 2)
    each = np.repeat(pairs, [2, 3], axis=2).reshape(x.shape)
    return np.concatenate((each, np.broadcast_to(extent, (x.shape[0],))[:, None]), axis=1)


def solve_each(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Stacked linear solve; a singular or non-finite system gives NaN instead of stopping the others."""
    finite = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=(1, 2))
    try:
        if finite.all():
            return np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        pass
    out = np.full(right.shape, np.nan)
    for i in np.flatnonzero(finite):
        try:
            out[i] = np.linalg.solve(matrix[i], right[i])
        except np.linalg.LinAlgError:
            continue
    return out


@dataclass
class Newton:
    """Outcome of a corrector: points, whether they converged, and the curve's direction there."""

    z: FloatArray
    converged: BoolArray
    tangent: FloatArray  # unit, scaled, on the side of the row that closed the system
    determinant: FloatArray  # sign of the bordered Jacobian


def correct(
    equations: Equations,
    z: FloatArray,
    scale: FloatArray,
    row: FloatArray,
    close: FloatArray | float = CLOSE,
    iterations: int = MAX_ITERATIONS,
    reach: FloatArray | float = 1.0,
) -> Newton:
    """Newton's method in the plane through z with normal row (scaled coordinates).

    Converged when the error that remains, estimated as length (length / length before), is below close;
    reach is the length that stands before the first step.
    """
    z = z.copy()
    size = z.shape[1]
    right = np.zeros((z.shape[0], size, 2))
    right[:, -1, 1] = 1.0
    before = np.broadcast_to(reach, (z.shape[0],))
    done = np.zeros(z.shape[0], dtype=bool)
    matrix = np.empty((z.shape[0], size, size))
    tangent = row.copy()
    for _ in range(iterations):
        fill(matrix, equations.evaluate(z[:, :-1], z[:, -1]), scale, right)
        matrix[:, -1, :] = row
        solution = solve_each(matrix, right)
        change = np.where(done[:, None], 0.0, solution[:, :, 0])
        tangent = np.where(done[:, None], tangent, solution[:, :, 1])
        z += scale * change
        length = np.sqrt((change * change).sum(axis=1))
        done |= (length * length < close * before) & (length < 0.1 * before)
        done |= length < 1e-2 * close
        before = length
        if done.all() or not np.isfinite(length).any():
            break
    norm = np.sqrt((tangent * tangent).sum(axis=1, keepdims=True))
    sign = np.linalg.slogdet(np.where(np.isfinite(matrix), matrix, 0.0))[0]
    ok = done & np.isfinite(norm[:, 0]) & (norm[:, 0] > 0.0)
    return Newton(z, ok, tangent / np.where(norm > 0.0, norm, 1.0), sign)


def fill(matrix: FloatArray, at: Derivatives, scale: FloatArray, right: FloatArray) -> None:
    """Rows and columns of the bordered system in scaled coordinates, and the residual."""
    rows = 1.0 / scale[:, :-1]
    matrix[:, :-1, :-1] = at.jacobian * (rows[:, :, None] * scale[:, None, :-1])
    matrix[:, :-1, -1] = at.by_omega * (rows * scale[:, -1:])
    right[:, :-1, 0] = -at.residual * rows


def follow(
    equations: Equations,
    z: FloatArray,
    low: FloatArray,
    high: FloatArray,
    max_step: FloatArray | float,
    progress: Progress | None = None,
    boundless: float = BOUNDLESS,
) -> Trace:
    """Trace every curve from z, where the parameter is low or high, until it leaves the range."""
    return _Follower(equations, z, low, high, max_step, progress, boundless).run()


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
    ) -> None:
        curves = z.shape[0]
        self.all_equations, self.progress = equations, progress
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
            first.determinant, np.minimum(FIRST_STEP, self.max_step),
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
        close = np.minimum(CLOSE, 1e-4 * front.step)
        new = correct(self.equations, guess, front.scale, front.tangent, close, reach=front.step)
        self.ticks += 1
        turn = (new.tangent * front.tangent).sum(axis=1)
        missed = np.sqrt((((new.z - guess) / front.scale) ** 2).sum(axis=1)) / front.step
        short, tiny = front.step <= CORNER, front.step <= POINT
        kept = new.determinant == front.orientation
        kept |= short & (turn > STRAIGHT)  # a branch point: straight on, with the other orientation
        good = new.converged & kept & (missed < 0.5)
        good &= (turn > SAME_DIRECTION) | short
        outside = good & ((new.z[:, -1] > self.high[front.curve]) | (new.z[:, -1] < self.low[front.curve]))
        landed = self._land(outside, new) if outside.any() else outside
        accepted = good & ~outside
        self._advance(accepted, new, turn, missed)
        front.step = np.where(accepted | landed, front.step, 0.25 * front.step)
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
        turned = np.zeros_like(stuck)
        for i in np.flatnonzero(stuck):
            turned[i] = self._turn_corner(int(i))
        return turned

    def _turn_corner(self, i: int) -> bool:
        """Try the directions of the curve in the regimes around the corner, at growing distances."""
        front = self.front
        directions = np.random.default_rng(0).normal(size=(CORNER_TRIES, front.z.shape[1]))
        directions[0] = front.tangent[i]
        directions /= np.sqrt((directions**2).sum(axis=1, keepdims=True))
        equations = self.equations.take(np.full(CORNER_TRIES, i))
        scale = np.repeat(front.scale[i : i + 1], CORNER_TRIES, axis=0)
        orientation = np.full(CORNER_TRIES, front.orientation[i])
        for reach in POINT * np.array([1e1, 1e2, 1e3, 1e4]):
            around = front.z[i] + reach * scale * directions
            tangent = oriented_tangent(equations, around, scale, directions, orientation)
            guess = front.z[i] + reach * scale * tangent
            new = correct(equations, guess, scale, tangent, 1e-3 * reach, reach=reach)
            step = (new.z - front.z[i]) / scale
            length = np.sqrt((step**2).sum(axis=1))
            ok = new.converged & (new.determinant == orientation) & (length < 3.0 * reach)
            ok &= (new.tangent * step).sum(axis=1) > 0.5 * length  # the curve leads away from the corner
            ok &= step @ front.tangent[i] > -0.99 * length  # and is not the one that led to it
            if ok.any():
                self._leave(i, new, int(np.argmax(ok)), reach)
                return True
        return False

    def _leave(self, i: int, new: Newton, chosen: int, step: float) -> None:
        front = self.front
        front.z[i], front.tangent[i] = new.z[chosen], new.tangent[chosen]
        front.bend[i], front.step[i] = 0.0, step

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


def oriented_tangent(
    equations: Equations, z: FloatArray, scale: FloatArray, along: FloatArray, orientation: FloatArray
) -> FloatArray:
    """Direction of the curve through z whose bordered determinant has the sign of orientation."""
    matrix = np.empty((z.shape[0], z.shape[1], z.shape[1]))
    right = np.zeros((z.shape[0], z.shape[1], 2))
    right[:, -1, 1] = 1.0
    fill(matrix, equations.evaluate(z[:, :-1], z[:, -1]), scale, right)
    matrix[:, -1, :] = along
    tangent = solve_each(matrix, right)[:, :, 1]
    tangent = np.where(np.isfinite(tangent), tangent, along)
    tangent /= np.sqrt((tangent * tangent).sum(axis=1, keepdims=True))
    matrix[:, -1, :] = tangent
    sign = np.linalg.slogdet(np.where(np.isfinite(matrix), matrix, 0.0))[0]
    oriented: FloatArray = tangent * (sign * orientation)[:, None]
    return oriented
