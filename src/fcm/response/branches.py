"""Every branch of a response that reaches an end of its range: where to start, and what has been traced.

A curve is followed from a solution at the low end. Where that does not arrive at the high end, it is followed
from there as well; and other solutions at both ends, if Newton's method finds them from a stuck or an open
contact, are branches of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.newton import CLOSE, amplitudes, scales
from fcm.response.path import COMPLETE, RETURNED, STALLED, Progress, Trace, follow
from fcm.response.start import linear_starts, starting_points
from fcm.response.structure import BoolArray, IntArray

DISTINCT = 1e-5  # solutions further apart than this, relative to their size, are different


@dataclass
class Branches:
    """Traced branches, those of a curve together; the first of a curve begins at the low end if it can."""

    trace: Trace  # its curve is the number of the branch
    curve: IntArray  # (branch,)
    status: IntArray  # (branch,)


def all_branches(
    balance: Balance, max_step: FloatArray, progress: Progress | None, close: float = CLOSE
) -> Branches:
    """Follow the curves of a group from both ends of their ranges; close is that of `path.follow`."""
    return _Explorer(balance, max_step, progress, close).run()


class _Explorer:
    def __init__(
        self, balance: Balance, max_step: FloatArray, progress: Progress | None, close: float
    ) -> None:
        self.balance, self.max_step, self.progress, self.close = balance, max_step, progress, close
        shape = max_step.shape
        self.low, self.high = (
            np.broadcast_to(f, shape).copy() for f in (balance.group.low, balance.group.high)
        )
        self.runs: list[tuple[int, int, FloatArray, FloatArray]] = []  # curve, status, points, directions

    def run(self) -> Branches:
        everything = np.arange(self.max_step.size)
        x, found = starting_points(self.balance, self.low)
        self._follow(everything[found], x[found], from_low=True)
        arrived = {curve for curve, status, _, _ in self.runs if status == COMPLETE}
        left = np.array([i for i in everything if i not in arrived], dtype=np.intp)
        if left.size:
            x, found = starting_points(self.balance.take(left), self.high[left])
            self._follow(left[found], x[found], from_low=False)
            self._drop_superseded()
        for from_low in (True, False):
            self._follow_others(from_low)
        return self._collected()

    def _follow(self, curve: IntArray, x: FloatArray, from_low: bool) -> None:
        """Trace from solutions x (start, unknown) at one end."""
        if curve.size == 0:
            return
        low, high = self.low[curve], self.high[curve]
        z = np.column_stack((x, low if from_low else high))
        equations, step = self.balance.take(curve), self.max_step[curve]
        path = follow(equations, z, low, high, step, self.progress, close=self.close)
        bounds = np.searchsorted(path.curve, np.arange(curve.size + 1))
        for i, number in enumerate(curve):
            part = slice(bounds[i], bounds[i + 1])
            points, direction, status = path.z[part], path.direction[part], int(path.status[i])
            if not from_low and status == COMPLETE:
                points, direction = points[::-1], -direction[::-1]
            if points.shape[0]:
                self.runs.append((int(number), status, points, direction))

    def _drop_superseded(self) -> None:
        """A branch that stopped on its way up is part of one that came down to its start."""
        whole = {curve: points[0] for curve, status, points, _ in self.runs if status == COMPLETE}
        self.runs = [
            run
            for run in self.runs
            if run[1] in (COMPLETE, RETURNED)
            or run[0] not in whole
            or self._distance(whole[run[0]][None], run[2][0], run[0])[0] > DISTINCT
        ]

    def _follow_others(self, from_low: bool) -> None:
        """Trace the solutions at one end that no branch has reached."""
        level = self.low if from_low else self.high
        for x, found in linear_starts(self.balance, level):
            z = np.column_stack((x, level))
            new = [i for i in np.flatnonzero(found) if self._is_new(int(i), z[i])]
            self._follow(np.array(new, dtype=np.intp), x[new], from_low)

    def _is_new(self, curve: int, z: FloatArray) -> bool:
        ends = [run[2][k] for run in self.runs if run[0] == curve for k in (0, -1)]
        here = np.array([end for end in ends if end[-1] == z[-1]]).reshape(-1, z.size)
        return not np.any(self._distance(here, z, curve) < DISTINCT)

    def _distance(self, others: FloatArray, z: FloatArray, curve: int) -> FloatArray:
        extent = self.high[curve : curve + 1] - self.low[curve : curve + 1]
        scale = scales(z[None, :-1], amplitudes(z[None, :-1]), extent)
        distance: FloatArray = np.abs((others - z) / scale).max(axis=1)
        return distance

    def _collected(self) -> Branches:
        runs = sorted(self.runs, key=lambda run: run[0])  # stable: in the order in which they were found
        unknowns = 5 * self.balance.group.contacts + 1
        number = np.repeat(np.arange(len(runs)), [run[2].shape[0] for run in runs]).astype(np.intp)
        empty = [np.empty((0, unknowns))]
        status = np.array([run[1] for run in runs], dtype=np.intp)
        z = np.concatenate([run[2] for run in runs] or empty)
        direction = np.concatenate([run[3] for run in runs] or empty)
        return Branches(
            Trace(number, z, direction, status), np.array([run[0] for run in runs], dtype=np.intp), status
        )


def outcome(branches: Branches, curve: int) -> tuple[bool, int]:
    """Whether a curve is complete, every branch of it from end to end, and the status that says why not."""
    status = branches.status[branches.curve == curve].tolist()
    if not status:
        return False, STALLED
    bad = [s for s in status if s not in (COMPLETE, RETURNED)]
    if COMPLETE in status or (len(status) > 1 and not bad):
        return True, COMPLETE
    return False, bad[0] if bad else RETURNED


def hang_together(number: IntArray) -> BoolArray:
    """Whether a point and the next belong to one branch, (point - 1,)."""
    together: BoolArray = number[1:] == number[:-1]
    return together
