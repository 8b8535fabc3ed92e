"""Checks of a tracked peak: that it is no trough, and belongs to the greatest extremes of the cycle."""

from __future__ import annotations

import numpy as np

from fcm.harmonic_balance.dense_jacobian import Amplitude
from fcm.model.scene import FloatArray
from fcm.tracking.corner import Corner
from fcm.tracking.extended_system import ExtendedSystem
from fcm.tracking.tracked_point import TrackedPoint


def is_top(problem: ExtendedSystem, point: TrackedPoint) -> bool:
    """Whether a tracked peak is no trough: the growth falls along the response.

    `evaluate_scale` must have been called at the point.
    """
    if point.corner is None or point.switch:
        problem.evaluate(point.z)  # nan where the response crosses itself, and a peak meets a trough
        gradient = np.asarray(problem.jacobian)[problem.n, : problem.n + 1]
        return bool(gradient @ (np.asarray(problem.scale)[:-1] * problem.row) < 0.0)
    corner = Corner(problem, point.corner)
    corner.problem.row[:] = problem.row
    corner.problem.evaluate_scale(point.z)
    before, after = corner.sides(point.z)
    return bool(before > after)


def overtaken(problem: ExtendedSystem, z: FloatArray) -> bool:
    """Whether other extremes than those fixed by the last `evaluate_scale` are the greatest of the cycle."""
    if problem.angles is None:
        return False
    problem.varied.set_parameter(float(z[-1]))
    y, balance = np.array(z[:-1]), problem.varied.balance
    balance.evaluate(y)
    one = Amplitude(balance, problem.condition.which)
    one.at(y)
    greatest = one.value
    one.at(y, problem.angles)
    return not one.value >= greatest * (1.0 - problem.options.envelope.extreme_tolerance)
