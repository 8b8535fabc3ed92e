"""How far the following of a curve has come: enough to go on from there, to the same points."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fcm.continuation.front import Front
from fcm.continuation.path import FloatArray, Path, Status
from fcm.continuation.trail import Kept, Trail


class Stage(NamedTuple):
    """The points that are there, and the front of the curve."""

    kept: Kept
    z: FloatArray  # (n + 1,) of the front
    scale: FloatArray  # (n + 1,)
    tangent: FloatArray  # (n + 1,) in units of the scale
    bend: FloatArray  # (n + 1,)
    aside: FloatArray  # (n + 1,) of the next place, beyond a corner
    cubic: tuple[FloatArray, FloatArray, bool, bool]  # second and third derivative; known, taken
    margin: FloatArray
    output: FloatArray
    growth: FloatArray
    orientation: float
    step: float  # the next one
    greatest: FloatArray  # of each output so far
    size: float  # of the solution at the start
    start: FloatArray  # (n + 1,)
    heading: FloatArray  # (n + 1,) the direction there
    interior: bool  # whether the start is inside the span
    evaluations: int

    def path(self, status: Status) -> Path:
        """The points as a path."""
        trail = Trail(self.z.size)
        trail.restore(self.kept)
        return trail.path(status, self.evaluations)


_OF_PLACE = ("z", "tangent", "margin", "output", "growth")


def state_of(front: Front) -> dict[str, Any]:
    """What of a stage the front knows."""
    copies = {name: np.array(getattr(front.here, name)) for name in _OF_PLACE}
    way = front.prediction
    more = {"scale": np.array(front.newton.scale), "bend": np.array(way.bend), "aside": np.array(front.aside)}
    cubic = np.array(way.second), np.array(way.third), bool(way.known), bool(way.cubic)
    return {
        **copies,
        **more,
        "cubic": cubic,
        "orientation": front.here.orientation,
        "evaluations": front.newton.evaluations,
    }


def put_back(front: Front, stage: Stage) -> None:
    """Bring the front to where it was."""
    for name in _OF_PLACE:
        np.asarray(getattr(front.here, name))[:] = getattr(stage, name)
    front.here.orientation = stage.orientation
    np.asarray(front.newton.scale)[:] = stage.scale
    way = front.prediction
    np.asarray(way.bend)[:] = stage.bend
    np.asarray(front.aside)[:] = stage.aside
    np.asarray(way.second)[:], np.asarray(way.third)[:], way.known, way.cubic = stage.cubic
    front.newton.evaluations = stage.evaluations
