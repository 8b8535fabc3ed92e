"""Measures of a cycle: greatest and least displacement, mean and fundamental, in closed form."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.measures import Scan
from fcm.time_domain.segments import Segments


class Measure(Frozen):
    """Measures of one cycle for each degree of freedom; lengths are in the scene's unit."""

    amplitude: FloatArray  # (dof,) half the peak-to-peak
    fundamental: FloatArray  # (dof,) amplitude of the fundamental
    phase: FloatArray  # (dof,) [rad], of fundamental * sin(omega t + phase)
    mean: FloatArray  # (dof,) time average
    greatest: FloatArray  # (dof,)
    least: FloatArray  # (dof,)


def measure(cycle: Cycle, known: Displaced | None = None) -> Measure:
    """Measures of the displacements over a cycle, from their extremes if these are known.

    The integrals are exact to rounding; each extreme is a root of the velocity.
    """
    system, shapes = cycle.system, cycle.system.scene.modal.shapes
    least, greatest, _ = known or displaced(system, cycle.segments)
    system.run(system.integrals, cycle.segments)
    mean, sine, cosine = (np.asarray(system.integrals.sums) @ shapes) / cycle.duration
    # x = a sin(theta + phase): its mean with sin(theta) + i cos(theta) is a exp(i phase) / 2
    size, phase = 2.0 * np.hypot(sine, cosine), np.arctan2(cosine, sine)
    return Measure(0.5 * (greatest - least), size, phase, mean, greatest, least)


class Displaced(NamedTuple):
    """Least and greatest displacement of each degree of freedom, and where they occur."""

    least: FloatArray  # (dof,)
    greatest: FloatArray  # (dof,)
    places: FloatArray  # (2 dof, 2) segment, and position in steps: of all least, then of all greatest values


def displaced(system: EquationsOfMotion, segments: Segments) -> Displaced:
    """The least and the greatest displacement of each degree of freedom."""
    scan = system.displaced
    system.run(scan, segments)
    return Displaced(np.array(scan.least), np.array(scan.greatest), np.array(scan.place))


class Scanned(NamedTuple):
    """Least and greatest value of every reported quantity of a motion, computed in one pass."""

    least: FloatArray  # (row,) displacements, then the others, see `EquationsOfMotion.parts`
    greatest: FloatArray  # (row,)
    displaced: Displaced

    def part(self, rows: slice) -> tuple[FloatArray, FloatArray]:
        """Least and greatest values of some rows."""
        return self.least[rows], self.greatest[rows]


def scanned(system: EquationsOfMotion, segments: Segments) -> Scanned:
    """Least and greatest value of every reported quantity over segments."""
    scan, dofs = system.reported, system.parts.displaced
    system.run(scan, segments)
    least, greatest = np.array(scan.least), np.array(scan.greatest)
    places = np.array(scan.place).reshape(2, -1, 2)[:, dofs].reshape(-1, 2)
    return Scanned(least, greatest, Displaced(least[dofs], greatest[dofs], places))


class Extreme(NamedTuple):
    """Least or greatest value of a row over segments, and where it occurs."""

    value: float
    segment: int
    position: float  # in steps


Extremes = tuple[list[Extreme], list[Extreme]]  # the least and the greatest of several rows


def extremes_by(scan: Scan, system: EquationsOfMotion, segments: Segments) -> Extremes:
    """Least and greatest values of the rows of a scan over segments.

    The rows act on the state vector without the forces' angle.
    """
    system.run(scan, segments)
    values = [*np.asarray(scan.least).tolist(), *np.asarray(scan.greatest).tolist()]
    places = np.asarray(scan.place).tolist()
    found = [Extreme(value, int(at[0]), at[1]) for value, at in zip(values, places, strict=True)]
    return found[: len(found) // 2], found[len(found) // 2 :]
