"""Derivatives of a motion by its initial state, and by the frequency or the level of the forces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.model.scene import FloatArray
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.segments import Segments


class InstantDerivative(NamedTuple):
    """The derivative of the state at an instant of a motion."""

    columns: FloatArray  # (unknown + 2, d): by each of x = (q, q', f), by the parameter; last the state
    rate: FloatArray  # (d,) time derivative of the state [1/s]


def derivative_at(
    system: EquationsOfMotion, segments: Segments, last: int, position: float
) -> InstantDerivative:
    """The derivative of the state at a position (in steps) in a segment."""
    kernel = system.derivative()
    kernel.begins(segments, system.by_level)
    while (missing := kernel.go(segments, last, position)) >= 0:
        system.make(np.asarray(segments.states)[missing])
    return InstantDerivative(np.array(kernel.columns), np.array(kernel.rate))


def period_derivative(
    system: EquationsOfMotion, segments: Segments, duration: float
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of x = (q, q', f) after a duration T by the initial x, and by the parameter.

    The parameter is the frequency or the level. T shortens as the frequency grows: dT / d omega = -T / omega.
    """
    kernel, u = system.derivative(), system.unknowns
    by_state, by_parameter = np.empty((u, u)), np.empty(u)
    kernel.begins(segments, system.by_level)
    while (missing := kernel.closes(segments, duration, by_state, by_parameter)) >= 0:
        system.make(np.asarray(segments.states)[missing])
    return by_state, by_parameter


def displacement_rates(
    system: EquationsOfMotion, segments: Segments, places: FloatArray, way: FloatArray, rate: float
) -> FloatArray:
    """Directional derivative (place, mode) of the modal displacements at places, by initial x and frequency.

    Parameters
    ----------
    places : (place, 2)
        Segments, and positions in them, in steps.
    way : (unknown,)
        Change of x = (q, q', f) at the start of the segments.
    rate : float
        Change of the frequency.
    """
    kernel, order = system.derivative_along(), np.lexsort(places.T[::-1])
    kernel.begins_along(segments, way, rate)
    sought, (found, out) = places[order], np.empty((2, order.size, system.modes))
    while (missing := kernel.at_places(segments, sought, found)) >= 0:
        system.make(np.asarray(segments.states)[missing])
    out[order] = found
    return out
