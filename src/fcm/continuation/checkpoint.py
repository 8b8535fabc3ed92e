"""Checkpoints: the state of a curve while it is followed, from which following resumes identically."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fcm.continuation.path import FloatArray, Path, Status
from fcm.continuation.problem import PointStore, Stored
from fcm.continuation.step_control import Stepper


class Checkpoint(NamedTuple):
    """The points kept so far, and the state of the stepper."""

    kept: Stored
    z: FloatArray  # (n + 1,) the stepper's point
    scale: FloatArray  # (n + 1,)
    tangent: FloatArray  # (n + 1,) in units of the scale
    curvature: FloatArray  # (n + 1,)
    offset: FloatArray  # (n + 1,) of the guess of the next point, beyond a corner
    cubic: tuple[FloatArray, FloatArray, bool, bool]  # second, third, has_cubic, cubic of `Predictor`
    margin: FloatArray
    output: FloatArray
    growth: FloatArray
    orientation: float
    step: float  # length of the next step
    greatest: FloatArray  # of each output so far
    size: float  # of the solution at the start
    first: FloatArray  # (n + 1,) the start
    initial_direction: FloatArray  # (n + 1,) direction at the start
    interior: bool  # whether the start is inside the span
    evaluations: int

    def path(self, status: Status) -> Path:
        """The points of the checkpoint as a `Path` with a status."""
        store = PointStore(self.z.size)
        store.restore(self.kept)
        return store.path(status, self.evaluations)


_POINT_FIELDS = ("z", "tangent", "margin", "output", "growth")


def stepper_state(stepper: Stepper) -> dict[str, Any]:
    """The part of a checkpoint that comes from the stepper: its point, predictor and scale."""
    copies = {name: np.array(getattr(stepper.here, name)) for name in _POINT_FIELDS}
    way = stepper.predictor
    more = {
        "scale": np.array(stepper.newton.scale),
        "curvature": np.array(way.curvature),
        "offset": np.array(stepper.offset),
    }
    cubic = np.array(way.second), np.array(way.third), bool(way.has_cubic), bool(way.cubic)
    return {
        **copies,
        **more,
        "cubic": cubic,
        "orientation": stepper.here.orientation,
        "evaluations": stepper.newton.evaluations,
    }


def restore_stepper(stepper: Stepper, checkpoint: Checkpoint) -> None:
    """Restore the state of the stepper from a checkpoint."""
    for name in _POINT_FIELDS:
        np.asarray(getattr(stepper.here, name))[:] = getattr(checkpoint, name)
    stepper.here.orientation = checkpoint.orientation
    np.asarray(stepper.newton.scale)[:] = checkpoint.scale
    way = stepper.predictor
    np.asarray(way.curvature)[:] = checkpoint.curvature
    np.asarray(stepper.offset)[:] = checkpoint.offset
    np.asarray(way.second)[:], np.asarray(way.third)[:], way.has_cubic, way.cubic = checkpoint.cubic
    stepper.newton.evaluations = checkpoint.evaluations
