"""The result of following a curve: its points in order, their marks, and how it ended."""

from __future__ import annotations

from dataclasses import replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from fcm.distinct_values import distinct_values
from fcm.frozen import Frozen

FloatArray = npt.NDArray[np.float64]


class Status(Enum):
    """The reason why a curve ended."""

    COMPLETE = "the curve reached the other end of its range"
    RETURNED = "the curve came back to the end of the range where it began"
    CLOSED = "the curve came back to the point where it began"
    STALLED = "no further point could be found"
    UNBOUNDED = "the amplitude grows without limit, at a resonance that hardly anything damps; add damping"
    TOO_LONG = "the curve did not leave the range within the number of steps allowed; try a larger --max-step"
    AROUND = "a step left the curve for a closed one, and went around that; try a smaller --max-step"
    REVERSED = "at a corner the curve goes back on itself, even by short steps"
    EVENT = "the curve came to an event at which it was to end"
    INTERRUPTED = "interrupted"

    @property
    def is_whole(self) -> bool:
        """Whether the curve ended so that none of it is left to follow."""
        return self in (Status.COMPLETE, Status.RETURNED, Status.CLOSED)


class PathInterrupted(KeyboardInterrupt):
    """Following was interrupted; `path` is the curve up to there."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path


class Mark:
    """Bits that tell what is special at a point of a curve; plain integers, which arrays take fastest."""

    NONE = 0
    END = 1  # of the range
    FOLD = 2  # the parameter turns back
    CORNER = 4  # a margin changes sign
    PEAK = 8  # an output is greatest there, or at a corner
    USER_POINT = 16  # the parameter has a given value, as at AUTO's UZ
    BRANCH = 32  # the orientation changes without a fold
    CROSSING = 64  # stability changes between folds


SPECIAL = Mark.END | Mark.FOLD | Mark.PEAK | Mark.USER_POINT | Mark.BRANCH | Mark.CROSSING


class Path(Frozen):
    """Points of one curve in the order in which they were followed."""

    z: FloatArray  # (point, unknown + 1), the parameter last
    direction: FloatArray  # (point, unknown + 1) along the curve, in the units of z
    mark: npt.NDArray[np.int64]  # (point,) bits of `Mark`
    orientation: FloatArray  # (point,) sign of the determinant of the equations closed by the direction
    status: Status
    evaluations: int  # of the equations, to follow it
    ended_by: int = -1  # number of the end function that ended it

    def __repr__(self) -> str:
        """Number of points, range of the parameter, number of folds and status, without the arrays.

        >>> z, mark = np.array([[0.0, 0.5], [1.0, 2.0]]), np.array([Mark.END, Mark.END])
        >>> Path(z, z, mark, np.ones(2), Status.COMPLETE, 7)
        Path(2 points, parameter 0.5 to 2, 0 folds: the curve reached the other end of its range)
        """
        count, folds = len(self.z), self.where(Mark.FOLD).size
        ends = f", parameter {self.parameter[0]:.6g} to {self.parameter[-1]:.6g}" if count else ""
        turns = f"{folds} fold{'s' * (folds != 1)}"
        return f"Path({count} point{'s' * (count != 1)}{ends}, {turns}: {self.status.value})"

    @property
    def parameter(self) -> FloatArray:
        """The parameter at each point."""
        return self.z[:, -1]

    @property
    def parity(self) -> FloatArray:
        """Sign (point,) of det dr/dx, the derivative of the equations r by the unknowns x alone.

        0 where the path is normal to the parameter."""
        sign: FloatArray = self.orientation * np.sign(self.direction[:, -1])
        return sign

    def where(self, mark: int) -> npt.NDArray[np.intp]:
        """Numbers of the points that have any bit of a mark."""
        return np.flatnonzero(self.mark & mark)

    def representative(self, most: int) -> npt.NDArray[np.intp]:
        """Numbers of about `most` points evenly spread by number, and of all special points."""
        count = len(self.z)
        even = np.linspace(0, count - 1, min(max(most, 2), count)).round().astype(np.intp)
        return distinct_values(even, self.where(SPECIAL))

    def part(self, rows: npt.NDArray[np.intp]) -> Path:
        """The path with some of its points."""
        arrays = {name: getattr(self, name)[rows] for name in ("z", "direction", "mark", "orientation")}
        return replace(self, **arrays)

    def backwards(self) -> Path:
        """The path with its points in the opposite order."""
        return replace(
            self,
            z=self.z[::-1].copy(),
            direction=-self.direction[::-1].copy(),
            mark=self.mark[::-1],
            orientation=-self.orientation[::-1],
        )

    def then(self, other: Path) -> Path:
        """This path joined with another that begins where it ends."""
        return Path(
            z=np.concatenate((self.z, other.z[1:])),
            direction=np.concatenate((self.direction, other.direction[1:])),
            mark=np.concatenate((self.mark[:-1], self.mark[-1:] | other.mark[:1], other.mark[1:])),
            orientation=np.concatenate((self.orientation, other.orientation[1:])),
            status=other.status,
            evaluations=self.evaluations + other.evaluations,
        )
