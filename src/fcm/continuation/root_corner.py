"""Corners at which the equations begin as the root of a smooth function, the `squared_margin`.

For example, the common area of discs that hold a slider shrinks to a point as the root of what is left. The
forces do likewise: their derivatives have no limit, and the tangent of the curve lies in the surface where
the square vanishes. There is one curve on either side. It may leave in the direction that it came from, a
cusp, so that nothing is found ahead. If the square is held at a small value of the other sign, its root
hardly changes, and Newton's method finds the curve from the corner itself.

Symmetric contacts reach their corners together. Four parts of curves may meet there: two with the same states
of both contacts, two with different ones. They are joined as if the corners were slightly apart: all cross
the same surface first, and the orientation is kept. So no curve is continued by a wrong one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from fcm.continuation.options import SwitchingOptions
from fcm.continuation.path import FloatArray
from fcm.continuation.problem import Point
from fcm.continuation.step_control import Stepper


class RootCorner(NamedTuple):
    """A surface, next to a point, where the squared margin of a kind vanishes.

    Lengths are scaled; the unit normal points to where the square is positive.
    """

    kind: int
    side: float  # sign of the margin on the side from which the curve comes
    off: float  # signed length from the surface to the point, along the normal
    slope: float  # of the square along the normal
    normal: FloatArray


def is_met(stepper: Stepper) -> bool:
    """Whether the curve has come to a corner at which the equations begin as a root."""
    return any(_corners_ahead(stepper, stepper.options.switching.root_distance))


def land(stepper: Stepper) -> None:
    """Move here along the curve to just before the surface of the corner ahead.

    Where the root is steep, its extrapolation stops short of the surface by more than `root_distance`. The
    step beyond would then begin and end on the wrong sides.
    """
    newton, options = stepper.newton, stepper.options.switching
    z, scale = np.array(stepper.here.z), np.array(newton.scale)
    for one in _corners_ahead(stepper, options.reached_distance_root):
        found = _solve(stepper, one, 0.5 * one.side * options.root_distance, z)
        if found is not None and np.linalg.norm((found - z) / scale) < options.reached_distance_root:
            stepper.here.z[:] = found
            return


def find_beyond(stepper: Stepper, before: Point) -> float:
    """Move the corrector to the curve beyond a corner at here, to which `before` led; return the distance.

    0 if there is no such corner, or no curve with the orientation of here beyond it.
    """
    newton, z, scale = stepper.newton, np.array(stepper.here.z), np.array(stepper.newton.scale)
    corners = list(_corners_near(stepper, before, stepper.options.switching.root_distance))
    for crossed, length in _crossings(corners, stepper.options.switching):
        sides = np.array([-one.side if i in crossed else one.side for i, one in enumerate(corners)])
        one = corners[crossed[0]]
        found = _solve(stepper, one, -one.side * length, _beside(stepper, corners, sides * length))
        if found is None or any(
            _side(stepper, one, found) != side for one, side in zip(corners, sides, strict=True)
        ):
            continue
        if newton.take_tangent() and newton.orientation == stepper.here.orientation:
            return float(np.linalg.norm((found - z) / scale))
    return 0.0


def _crossings(corners: Sequence[RootCorner], options: SwitchingOptions) -> Iterator[tuple[list[int], float]]:
    """Sets of surfaces to cross, in turn, and the length beyond them at which the curve is sought.

    First the nearest, if it is clearly so; then each alone, lower kinds first, as if they were slightly
    apart; then all together.
    """
    near = sorted(range(len(corners)), key=lambda i: abs(corners[i].off))
    if len(corners) > 1:
        first, second = (abs(corners[i].off) for i in near[:2])
        if first < options.root_separation * second:
            yield near[:1], float(np.sqrt(first * second))
    in_turn = sorted(range(len(corners)), key=lambda i: corners[i].kind)
    yield from (([i], options.root_distance) for i in in_turn)
    if len(corners) > 1:
        yield in_turn, options.root_distance


def _side(stepper: Stepper, corner: RootCorner, z: FloatArray) -> float:
    """The side of the surface of a corner on which z lies: -1 or 1."""
    return float(np.sign(stepper.problem.squared_margin(corner.kind, z)))


def _beside(stepper: Stepper, corners: Sequence[RootCorner], lengths: FloatArray) -> FloatArray:
    """The point nearest to here at given lengths from the surfaces of corners."""
    normals = np.array([one.normal for one in corners])
    off = np.array([one.off for one in corners])
    step = np.linalg.lstsq(normals, lengths - off, rcond=None)[0]
    return np.asarray(stepper.here.z + np.asarray(stepper.newton.scale) * step)


def _solve(stepper: Stepper, corner: RootCorner, wanted: float, at: FloatArray) -> FloatArray | None:
    """Move the corrector to the curve at a length from the surface of a corner; None if that fails."""
    newton, problem, options = stepper.newton, stepper.problem, stepper.options.newton
    scale = np.array(newton.scale)
    newton.row[:] = np.sign(wanted) * corner.normal
    for _ in range(options.max_iterations):
        off = problem.squared_margin(corner.kind, at) / corner.slope
        newton.z[:] = last = at + scale * corner.normal * (wanted - off)
        if not newton.single_step():
            return None
        at = np.array(newton.z)
        if np.linalg.norm((at - last) / scale) < options.negligible_step:
            break
    return at


def _corners_ahead(stepper: Stepper, distance: float) -> Iterator[RootCorner]:
    """Corners within a distance of here to which the curve goes, without those that it leaves."""
    tangent = np.asarray(stepper.here.tangent)
    near = _corners_near(stepper, stepper.here, distance)
    return (one for one in near if one.side * float(one.normal @ tangent) < 0.0)


def _corners_near(stepper: Stepper, before: Point, distance: float) -> Iterator[RootCorner]:
    """Corners within a distance of here; their sides are those of the point `before`."""
    options, z, scale = stepper.options.switching, np.array(stepper.here.z), np.array(stepper.newton.scale)
    margins, kinds = np.asarray(before.margin), np.asarray(before.kind)
    for k in np.flatnonzero((margins != 0.0) & (np.abs(margins) < options.max_root_margin) & (kinds >= 0)):
        kind = int(kinds[k])
        value = stepper.problem.squared_margin(kind, z)
        if not np.isfinite(value):
            continue
        slopes = _differences(stepper, kind, z, options.root_difference * scale) / options.root_difference
        slope = float(np.linalg.norm(slopes))
        if abs(value) < distance * slope:
            yield RootCorner(kind, float(np.sign(margins[k])), value / slope, slope, slopes / slope)


def _differences(stepper: Stepper, kind: int, z: FloatArray, steps: FloatArray) -> FloatArray:
    """Differences (n + 1,) of the squared margin of a kind for a step ahead of z in each unknown."""
    value, ahead, found = stepper.problem.squared_margin(kind, z), z.copy(), np.empty(len(z))
    for i in range(len(z)):  # all at once would need a matrix as large as the Jacobian
        ahead[i] += steps[i]
        found[i] = stepper.problem.squared_margin(kind, ahead) - value
        ahead[i] = z[i]
    return found
