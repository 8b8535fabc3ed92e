"""A way out of a corner of a soft problem, where the direction just beyond it leads nowhere.

Where contacts just touch, the derivative grows as the root of the distance beyond, and a curve may turn back
within less than any step: on its other side it is so close to where they do not touch that a guess has to be
beside that by the right distance. Where a transition passes the start of the period, more than two pieces
meet, and the way that the curve came leads into one that it does not have.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import NamedTuple

import numpy as np

from fcm.continuation.front import Front
from fcm.continuation.path import FloatArray

REACHES = (1e-5, 1e-4, 1e-3, 1e-6)  # lengths at which the curve is looked for
PARTS = (1.0, 0.1, 1e-2, 1e-3)  # of these, by which a direction is looked for beyond, and a guess is aside
AROUND = 16  # directions into other pieces


class Way(NamedTuple):
    """To a point of the curve that is about a reach from the corner."""

    reach: float
    direction: FloatArray  # (unknown + 1,) scaled, that of the piece in which it is
    aside: FloatArray  # (unknown + 1,) scaled, from where that direction leads to the point's guess


def way_out(front: Front, came: FloatArray, leads_on: Callable[[float], bool]) -> Way | None:
    """The first that is found from the corner that is here; None without any.

    Parameters
    ----------
    came : (unknown + 1,)
        Direction in which the curve came to the corner.
    leads_on : callable
        Whether a way at an angle of that cosine to it is another, the problem being bound there.
    """
    for reach in REACHES:
        for look, aside in _guesses(reach, came):
            direction = _direction(front, look)
            if direction is not None and _found(front, came, Way(reach, direction, aside), leads_on):
                return Way(reach, direction, aside)
    return None


def _guesses(reach: float, came: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Where a direction is looked for, and from where it is taken, both from the corner."""
    for look, aside in product(PARTS, PARTS):
        yield look * reach * came, aside * reach * came
    around = np.random.default_rng(0).normal(size=(AROUND, came.size))
    for way in around / np.linalg.norm(around, axis=1, keepdims=True):
        yield reach * way, np.zeros(came.size)


def _direction(front: Front, look: FloatArray) -> FloatArray | None:
    """That which the equations have there, with the orientation of here."""
    newton = front.newton
    np.asarray(newton.row)[:] = look / np.linalg.norm(look)
    np.asarray(newton.z)[:] = np.asarray(front.here.z) + np.asarray(newton.scale) * look
    if not newton.look():
        return None
    return np.array(newton.tangent) * (1.0 if newton.orientation == front.here.orientation else -1.0)


def _found(front: Front, came: FloatArray, way: Way, leads_on: Callable[[float], bool]) -> bool:
    """Whether a way leads to a point at which the curve goes on from here; the problem is bound there."""
    newton, here, scale = front.newton, np.asarray(front.here.z), np.asarray(front.newton.scale)
    np.asarray(newton.row)[:] = way.direction
    np.asarray(newton.z)[:] = here + scale * (way.reach * way.direction + way.aside)
    if not newton.correct(2.0 * way.reach) or newton.orientation != front.here.orientation:
        return False
    step = (np.asarray(newton.z) - here) / scale
    length = float(np.linalg.norm(step))
    front.problem.bound(newton.z)
    forward = bool(np.asarray(newton.tangent) @ step > 0.5 * length)
    return forward and leads_on(float(came @ step) / length)
