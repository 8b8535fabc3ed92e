"""What is reported of a cycle: greatest and least displacement, mean, fundamental, in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fcm.motion.cycle import Cycle
from fcm.motion.rows import Rows
from fcm.motion.scan import Scan
from fcm.motion.segments import Segments
from fcm.motion.system import System
from fcm.scene.model import FloatArray


@dataclass(frozen=True)
class Measure:
    """One cycle of each degree of freedom; lengths in the scene's unit."""

    amplitude: FloatArray  # (dof,) half the peak-to-peak
    fundamental: FloatArray  # (dof,) amplitude of the fundamental
    phase: FloatArray  # (dof,) [rad], of fundamental * sin(omega t + phase)
    mean: FloatArray  # (dof,) time average
    greatest: FloatArray  # (dof,)
    least: FloatArray  # (dof,)


def measure(cycle: Cycle, known: Extremes | None = None) -> Measure:
    """Measure the displacements over a cycle, of which the extremes may be known.

    The integrals are exact to rounding; each extreme is a root of the velocity.
    """
    system, shapes = cycle.system, cycle.system.scene.modal.shapes
    least, greatest = known or displaced(system, cycle.segments)
    system.run(system.integrals, cycle.segments)
    mean, sine, cosine = (np.asarray(system.integrals.sums) @ shapes) / cycle.duration
    # x = a sin(theta + phase): its mean with sin(theta) + i cos(theta) is a exp(i phase) / 2
    wave = 2.0 * (sine + 1j * cosine)
    high, low = (np.array([one.value for one in ends]) for ends in (greatest, least))
    return Measure(0.5 * (high - low), np.abs(wave), np.angle(wave), mean, high, low)


class Extreme(NamedTuple):
    """The least or greatest value of a row over segments, and where it is."""

    value: float
    segment: int
    position: float  # in steps


Extremes = tuple[list[Extreme], list[Extreme]]  # the least and the greatest of several rows


def displaced(system: System, segments: Segments) -> Extremes:
    """The least and the greatest displacement of each degree of freedom."""
    return _extremes(system, segments, system.displaced)


def extremes(system: System, segments: Segments, rows: FloatArray) -> Extremes:
    """The least and the greatest of each of rows @ y, y without the forces' angle: rows (row, d - 2)."""
    return _extremes(system, segments, Scan(system.flows, Rows(rows)))


def _extremes(system: System, segments: Segments, found: Scan) -> Extremes:
    system.run(found, segments)
    values = zip(np.asarray(found.least).tolist(), np.asarray(found.greatest).tolist(), strict=True)
    least, greatest = list[Extreme](), list[Extreme]()
    for (low, high), place in zip(values, np.asarray(found.place).tolist(), strict=True):
        greatest.append(Extreme(high, int(place[0]), place[1]))
        least.append(Extreme(low, int(place[2]), place[3]))
    return least, greatest
