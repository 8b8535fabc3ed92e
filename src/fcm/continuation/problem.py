"""Problems to be followed: n equations residual(z) = 0 for n unknowns and a parameter, the last of z.

A problem knows nothing of the curve, and the follower nothing of the meaning of the unknowns. A problem
writes its results into its own arrays, so that a step of the follower allocates none. It is smooth while none
of its margins changes sign. A `Point` of its curve holds the problem's results there; a `PointStore` keeps
many points.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs

from fcm.continuation.options import PROBLEM, ProblemOptions
from fcm.continuation.path import FloatArray, Path, Status

NONE = cython.declare(cython.int, -1)  # kind of an absent margin
PI = cython.declare(cython.double, 3.141592653589793)
NAN = cython.declare(cython.double, float("nan"))
RENAMED = {
    "probe": "evaluate_residual",
    "measure": "evaluate_scale",
    "bound": "evaluate_margins",
    "report": "evaluate_outputs",
    "square": "squared_margin",
}  # old names of a problem's functions, which are not called any more
ROOM = 256  # initial capacity of a store, in points


@cython.cclass
class Problem:
    """Equations of a curve; the methods say what each array holds.

    residual (n,), jacobian (n, n + 1): filled by `evaluate`, the derivative by the parameter in the last
    column; `evaluate_residual` fills the residual alone.
    scale (n + 1,): by `evaluate_scale`. margin, kind, angle (margins,): by `evaluate_margins`. output, growth
    (outputs,): by `evaluate_outputs`.
    rank: 0; or the size of a smaller system to which the problem itself condenses that of Newton's method.
    Then jacobian is (n, 1), the derivative by the parameter alone; see `factor` and `solve`.
    group: number of successive margins that belong together; margins of different groups never match.
    unbounded: growth of the solution, relative to its size at the start, that only an undamped resonance has.
    costly: whether there are so many unknowns that every point counts. Slight corners are then stepped over,
    and peaks and folds are sought between all known points of a step.
    has_root_margins: whether a margin may begin as a root of the distance from a corner, so that `Newton`
    halves steps.
    labelled: whether the margins are labels. The problem is smooth while they stay the same; it need not be
    where one changes.
    """

    def __init__(
        self,
        unknowns: cython.int,
        margins: cython.int,
        outputs: cython.int,
        rank: cython.int = 0,
        options: ProblemOptions = PROBLEM,
    ) -> None:
        _refuse_old_names(type(self))
        self.unknowns, self.margins, self.outputs, self.rank = unknowns, margins, outputs, rank
        self.labelled, self.unbounded = False, options.unbounded
        self.costly_size, self.difference_length, self.max_angle = (
            options.costly_size,
            options.difference_length,
            options.max_angle,
        )
        self.has_root_margins = False
        self.group, self.costly = margins, unknowns >= self.costly_size
        self.residual = np.zeros(unknowns)
        self.jacobian = np.zeros((unknowns, 1 if rank else unknowns + 1))
        self.scale = np.ones(unknowns + 1)
        self.margin, self.angle = np.ones(margins), np.zeros(margins)
        self.kind = np.arange(margins, dtype=np.intc)
        self.output = np.zeros(outputs)
        self.growth = np.zeros(outputs)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        """Fill residual and Jacobian at z (n + 1,)."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_residual(self, z: cython.double[::1]) -> cython.int:
        """Fill the residual alone at z, if that costs less."""
        return self.evaluate(z)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_scale(self, z: cython.double[::1]) -> cython.int:
        """Fill the units of length along the curve at z, of each unknown and of the parameter."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_margins(self, z: cython.double[::1]) -> cython.int:
        """Fill the margins: functions of z that change sign where the problem is not smooth.

        kind says which function a margin is. angle [rad], which varies with z, distinguishes margins of one
        kind. The kind is NONE where there is no margin. Margins may appear, vanish and change places.
        """
        return 0

    @cython.ccall
    @cython.exceptval(-1.0, check=True)
    def squared_margin(self, kind: cython.int, z: cython.double[::1]) -> cython.double:
        """The squared margin of a kind at z; NaN if the margin is not a root.

        It is a smooth function of z with the sign of the margin. The margin is its root, and so are the
        equations."""
        return NAN

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_outputs(self, z: cython.double[::1], direction: cython.double[::1]) -> cython.int:
        """Fill the outputs at z, positive numbers, and their growth along a direction (n + 1,)."""
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        """Factor the equations evaluated last, closed by a row (n + 1,), in units of scale (n + 1,).

        Returns the sign of the determinant, 0 if they are singular."""
        return 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        """Replace a right side (n + 1,) by the solution of the equations factored last, in their units."""
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def solved_sign(self) -> cython.double:
        """The sign of the determinant of the equations for which a tangent was solved last.

        The factored equations may only be near to these."""
        return 0.0


def _refuse_old_names(kind: type[Problem]) -> None:
    """Raise TypeError for a class that defines a problem's function only under its old name."""
    for old, new in RENAMED.items():
        if hasattr(kind, old) and getattr(kind, new) is getattr(Problem, new):
            raise TypeError(
                f"{kind.__name__}.{old}: this function of a problem is {new} now, and {old} is not called. "
                "Rename it; if it is a function of your own, give it another name"
            )


@cython.cclass
class Point:
    """A point of the curve with the problem's results there; the tangent is a unit vector, scaled."""

    def __init__(self, problem: Problem) -> None:
        self.z, self.tangent = np.zeros(problem.unknowns + 1), np.zeros(problem.unknowns + 1)
        self.margin, self.angle = np.zeros(problem.margins), np.zeros(problem.margins)
        self.kind = np.zeros(problem.margins, dtype=np.intc)
        self.slope = np.zeros(problem.margins)  # of the margins with respect to scaled length
        self.output, self.growth = np.zeros(problem.outputs), np.zeros(problem.outputs)
        self.orientation, self.group, self.max_angle = 0.0, problem.group, problem.max_angle
        self.has_margin_slopes = False  # whether slope is computed for this point

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def set_margins(self, problem: Problem) -> cython.int:
        """Take the margins that the problem evaluated last."""
        k: cython.Py_ssize_t
        for k in range(problem.margins):
            self.margin[k], self.kind[k], self.angle[k] = problem.margin[k], problem.kind[k], problem.angle[k]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def copy_from(self, other: Point, unit: cython.double) -> cython.int:
        """Copy another point; unit: its unit of length in units of the new one."""
        i: cython.Py_ssize_t
        self.orientation, self.has_margin_slopes = other.orientation, other.has_margin_slopes
        for i in range(other.z.shape[0]):
            self.z[i], self.tangent[i] = other.z[i], other.tangent[i]
        for i in range(other.slope.shape[0]):
            self.margin[i], self.kind[i], self.angle[i] = other.margin[i], other.kind[i], other.angle[i]
            self.slope[i] = other.slope[i] / unit
        for i in range(other.growth.shape[0]):
            self.output[i], self.growth[i] = other.output[i], other.growth[i] / unit
        return 0

    @cython.ccall
    @cython.exceptval(-2, check=False)
    def matching_margin(
        self, k: cython.Py_ssize_t, kind: cython.int[::1], angle: cython.double[::1]
    ) -> cython.Py_ssize_t:
        """Number of the margin at another point that matches margin k of this one; -1 if none does.

        It is of the same group and kind. Each of the two has to be the nearest to the other.
        """
        i: cython.Py_ssize_t
        first: cython.Py_ssize_t = k - k % self.group
        if self.kind[k] == NONE:
            return -1
        if kind[k] == self.kind[k] and angle[k] == self.angle[k]:
            return k
        i = self.nearest(self.kind[k], self.angle[k], kind, angle, first)
        return i if i >= 0 and self.nearest(kind[i], angle[i], self.kind, self.angle, first) == k else -1

    @cython.cfunc
    @cython.exceptval(check=False)
    def nearest(
        self,
        wanted: cython.int,
        at: cython.double,
        kind: cython.int[::1],
        angle: cython.double[::1],
        first: cython.Py_ssize_t,
    ) -> cython.Py_ssize_t:
        """Number of the margin of a kind with the angle nearest to `at`, in the group beginning at `first`.

        -1 if none is within `max_angle`.
        """
        i: cython.Py_ssize_t
        best: cython.Py_ssize_t = -1
        least: cython.double = self.max_angle
        for i in range(first, first + self.group):
            if kind[i] == wanted:
                off: cython.double = fabs(at - angle[i])
                off = off if off <= PI else fabs(2.0 * PI - off)
                if off < least:
                    least, best = off, i
        return best

    @cython.ccall
    @cython.exceptval(-1e300, check=False)
    def margin_at(self, k: cython.Py_ssize_t, other: Point) -> cython.double:
        """The margin at another point that matches margin k of this one; 0 if none does."""
        i: cython.Py_ssize_t = self.matching_margin(k, other.kind, other.angle)
        return other.margin[i] if i >= 0 else 0.0

    @cython.cfunc
    @cython.exceptval(-1e300, check=False)
    def margin_of_problem(self, k: cython.Py_ssize_t, problem: Problem) -> cython.double:
        """The margin evaluated last by the problem that matches margin k here; 0 if none does."""
        i: cython.Py_ssize_t = self.matching_margin(k, problem.kind, problem.angle)
        return problem.margin[i] if i >= 0 else 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def differentiate_margins(
        self, problem: Problem, scale: cython.double[::1], probe: cython.double[::1]
    ) -> cython.int:
        """Compute the slopes of the margins along the tangent by difference quotients."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        self.has_margin_slopes = True
        if problem.margins == 0 or problem.labelled:
            return 0
        length: cython.double = problem.difference_length
        for i in range(probe.shape[0]):
            probe[i] = self.z[i] + length * scale[i] * self.tangent[i]
        problem.evaluate_margins(probe)
        for k in range(problem.margins):
            self.slope[k] = 0.0
            i = self.matching_margin(k, problem.kind, problem.angle)
            if i >= 0:
                self.slope[k] = (problem.margin[i] - self.margin[k]) / length
        return 0


class Points(NamedTuple):
    """Arrays of the points of a store."""

    z: FloatArray  # (point, unknown + 1)
    direction: FloatArray
    mark: npt.NDArray[np.int64]  # (point,)
    orientation: FloatArray  # (point,)


class Stored(NamedTuple):
    """The points of a store: all before the last are final, and are not copied."""

    before: Points
    last: tuple[FloatArray, FloatArray, int, float]  # copies, for `PointStore.put`

    @property
    def number(self) -> int:
        """Number of points."""
        return len(self.before.mark) + 1


@cython.cclass
class PointStore:
    """The points of a curve, `count` of them, in arrays as those of a `Path`; `size` is n + 1."""

    def __init__(self, size: cython.int) -> None:
        self.count, self.size = 0, size
        self.z, self.direction = np.empty((ROOM, size)), np.empty((ROOM, size))
        self.mark, self.orientation = np.empty(ROOM, dtype=np.int64), np.empty(ROOM)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add(self, point: Point, scale: cython.double[::1], mark: cython.long) -> cython.int:
        """Add a point with a mark; scale converts its tangent to a direction."""
        i: cython.Py_ssize_t
        self.widen()
        for i in range(self.size):
            self.z[self.count, i] = point.z[i]
            self.direction[self.count, i] = scale[i] * point.tangent[i]
        self.mark[self.count] = mark
        self.orientation[self.count] = point.orientation
        self.count += 1
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def put(
        self,
        z: cython.double[::1],
        direction: cython.double[::1],
        mark: cython.long,
        orientation: cython.double,
    ) -> cython.int:
        """Add a point with its direction, mark and orientation."""
        self.widen()
        self.z[self.count, :], self.direction[self.count, :] = z, direction
        self.mark[self.count] = mark
        self.orientation[self.count] = orientation
        self.count += 1
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def widen(self) -> cython.int:
        """Make room for one more point."""
        if self.count < self.mark.shape[0]:
            return 0
        self.z, self.direction = _twice(self.z), _twice(self.direction)
        self.mark, self.orientation = _twice(self.mark), _twice(self.orientation)
        return 0

    def last(self) -> FloatArray:
        """The unknowns and parameter of the last point."""
        return np.array(self.z[self.count - 1])

    def tail(self) -> tuple[FloatArray, FloatArray, int, float]:
        """A copy of the last point, for `put`."""
        k = self.count - 1
        return self.last(), np.array(self.direction[k]), int(self.mark[k]), float(self.orientation[k])

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def ends_at(self, point: Point) -> cython.bint:
        """Whether the last point of the store has exactly the z of a point."""
        i: cython.Py_ssize_t
        for i in range(self.size):  # noqa: SIM110 - a loop in C
            if self.z[self.count - 1, i] != point.z[i]:
                return False
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def same(self, i: cython.Py_ssize_t, k: cython.Py_ssize_t, part: cython.double) -> cython.bint:
        """Whether points i and k differ by less than a part of the greatest unknown of point k."""
        j: cython.Py_ssize_t
        off: cython.double = fabs(self.z[i, self.size - 1] - self.z[k, self.size - 1])
        size: cython.double = 0.0
        for j in range(self.size - 1):
            off = max(off, fabs(self.z[i, j] - self.z[k, j]))
            size = max(size, fabs(self.z[k, j]))
        return off < part * size

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def mark_last(self, mark: cython.long) -> cython.int:
        """Add a mark to the last point."""
        self.mark[self.count - 1] |= mark
        return 0

    def cut(self, count: int) -> None:
        """Drop all but the first count points."""
        self.count = count

    def drop(self) -> int:
        """Drop the last point; return its mark."""
        self.count -= 1
        return int(self.mark[self.count])

    def close(self) -> None:
        """Close the curve: add its first point again at the end."""
        first = np.array(self.z[0]), np.array(self.direction[0])
        self.put(*first, self.mark[0], self.orientation[0])

    def points(self) -> Points:
        """Views of the points."""
        return self._first(self.count)

    def _first(self, count: int) -> Points:
        z, direction = np.asarray(self.z)[:count], np.asarray(self.direction)[:count]
        return Points(z, direction, np.asarray(self.mark)[:count], np.asarray(self.orientation)[:count])

    def state(self) -> Stored:
        """The points in a form that stays valid when more are added."""
        return Stored(self._first(self.count - 1), self.tail())

    def restore(self, kept: Stored) -> None:
        """Replace all points by stored ones."""
        self.count = 0
        for z, direction, mark, orientation in zip(*kept.before, strict=True):
            self.put(np.array(z), np.array(direction), mark, orientation)
        self.put(*kept.last)

    def path(self, status: Status, evaluations: int) -> Path:
        """A path with copies of the points."""
        z, direction, mark, orientation = self.points()
        return Path(
            z=np.array(z),
            direction=np.array(direction),
            mark=np.array(mark),
            orientation=np.array(orientation),
            status=status,
            evaluations=evaluations,
        )


def _twice(kept: object) -> Any:
    """Copy an array into one with twice as many rows."""
    array = np.asarray(kept)
    return np.concatenate((array, np.empty_like(array)))
