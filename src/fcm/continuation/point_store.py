"""The points that were kept of a curve, one after the other, in arrays that grow."""

from __future__ import annotations

from typing import Any, NamedTuple

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs

from fcm.continuation.path import FloatArray, Path, Status
from fcm.continuation.point import Point

ROOM = 256  # points for which there is room at first


class Points(NamedTuple):
    """Points of a store."""

    z: FloatArray  # (point, unknown + 1)
    direction: FloatArray
    mark: npt.NDArray[np.int64]  # (point,)
    orientation: FloatArray  # (point,)


class Stored(NamedTuple):
    """The points of a store: those before the last do not change any more, and are not copied."""

    before: Points
    last: tuple[FloatArray, FloatArray, int, float]  # to be put again

    @property
    def number(self) -> int:
        """How many there are."""
        return len(self.before.mark) + 1


@cython.cclass
class PointStore:
    """count points: z, direction (point, unknown + 1), mark, orientation (point,), as of a `Path`."""

    def __init__(self, size: cython.int) -> None:
        self.count, self.size = 0, size
        self.z, self.direction = np.empty((ROOM, size)), np.empty((ROOM, size))
        self.mark, self.orientation = np.empty(ROOM, dtype=np.int64), np.empty(ROOM)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add(self, point: Point, scale: cython.double[::1], mark: cython.long) -> cython.int:
        """Keep a point, with lengths in units of scale."""
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
        """Keep a point."""
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
        """The last point."""
        return np.array(self.z[self.count - 1])

    def tail(self) -> tuple[FloatArray, FloatArray, int, float]:
        """A copy of the last point, to be put again."""
        k = self.count - 1
        return self.last(), np.array(self.direction[k]), int(self.mark[k]), float(self.orientation[k])

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def ends_at(self, point: Point) -> cython.bint:
        """Whether the last point is a point."""
        i: cython.Py_ssize_t
        for i in range(self.size):  # noqa: SIM110 - a loop in C
            if self.z[self.count - 1, i] != point.z[i]:
                return False
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def same(self, i: cython.Py_ssize_t, k: cython.Py_ssize_t, part: cython.double) -> cython.bint:
        """Whether two points differ by less than a part of the greatest unknown of the second."""
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
        """Mark the last point by that, too."""
        self.mark[self.count - 1] |= mark
        return 0

    def cut(self, count: int) -> None:
        """Forget all but so many points."""
        self.count = count

    def drop(self) -> int:
        """Forget the last point; its mark."""
        self.count -= 1
        return int(self.mark[self.count])

    def close(self) -> None:
        """End at the first point."""
        first = np.array(self.z[0]), np.array(self.direction[0])
        self.put(*first, self.mark[0], self.orientation[0])

    def points(self) -> Points:
        """The points as they are now."""
        return self._first(self.count)

    def _first(self, count: int) -> Points:
        z, direction = np.asarray(self.z)[:count], np.asarray(self.direction)[:count]
        return Points(z, direction, np.asarray(self.mark)[:count], np.asarray(self.orientation)[:count])

    def state(self) -> Stored:
        """The points as they will be kept, whatever comes after."""
        return Stored(self._first(self.count - 1), self.tail())

    def restore(self, kept: Stored) -> None:
        """Have these points and no others."""
        self.count = 0
        for z, direction, mark, orientation in zip(*kept.before, strict=True):
            self.put(np.array(z), np.array(direction), mark, orientation)
        self.put(*kept.last)

    def path(self, status: Status, evaluations: int) -> Path:
        """The points as they are."""
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
    """With as much room again."""
    array = np.asarray(kept)
    return np.concatenate((array, np.empty_like(array)))
