"""Finds peaks between the points of a path, for degrees of freedom whose peaks the path did not locate."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from fcm.continuation import Path
from fcm.continuation.segment import Segment
from fcm.frozen import Frozen
from fcm.harmonic_balance.reported_quantities import ReportedQuantities, reported_at
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

Indices = npt.NDArray[np.intp]


class InterpolationOptions(Frozen):
    """Options for finding a peak between two points of a path, by polynomials through solutions.

    Attributes
    ----------
    degree : int
        Degree of the polynomials through solutions between two points.
    tolerance : float
        Last coefficients of an amplitude's polynomial, relative to it, above which the interval is halved.
    max_halvings : int
        Greatest number of nested halvings of an interval; after that the polynomial is used as it is.
    samples : int
        Number of points at which the greatest value of a polynomial is searched for.
    max_steps : int
        Number of Newton steps from there to a zero of its slope.
    """

    degree: int = 8
    tolerance: float = 1e-9
    max_halvings: int = 3
    samples: int = 129
    max_steps: int = 3


INTERPOLATION = InterpolationOptions()


def tops_between(system: System, path: Path, quantities: ReportedQuantities) -> tuple[FloatArray, FloatArray]:
    """Greatest amplitudes (dof,) of a path and their frequencies, at its points or next to the highest point.

    Between two neighbours there is a peak if the amplitude grows at the first and decreases at the second.
    """
    top, d = quantities.amplitude.argmax(axis=0), np.arange(quantities.amplitude.shape[1])
    height, omega = quantities.amplitude[top, d], path.parameter[top]
    last = len(path.z) - 1
    first = np.where(quantities.growth[top, d] > 0.0, top, top - 1)
    inside = (first >= 0) & (first < last)
    first = np.clip(first, 0, max(last - 1, 0))
    inside &= (quantities.growth[first, d] > 0.0) & (quantities.growth[np.minimum(first + 1, last), d] < 0.0)
    for i in np.unique(first[inside]).tolist():
        way = _Way(system, path, i, np.flatnonzero(inside & (first == i)))
        way.raise_to(height, omega)
    return height, omega


class _Way:
    """The segment of a curve from a point of a path to the next, for some degrees of freedom."""

    def __init__(self, system: System, path: Path, first: int, dofs: Indices) -> None:
        scene = system.scene
        chosen = np.zeros(len(scene.modal.dofs), dtype=np.bool_)
        chosen[dofs] = True
        self.system = system.of(scene.at_attached_and(chosen))
        place = {name: i for i, name in enumerate(self.system.scene.modal.dofs)}
        self.columns = np.array([place[scene.modal.dofs[d]] for d in dofs], dtype=np.intp)
        self.dofs, self.between = dofs, Segment(self.system.new_balance(), path, first)

    def raise_to(self, height: FloatArray, omega: FloatArray) -> None:
        """Updates heights (dof,) and their frequencies with greater ones found on the segment."""
        self._part(0.0, 1.0, np.arange(len(self.dofs)), height, omega, INTERPOLATION.max_halvings)

    def _part(
        self, low: float, high: float, which: Indices, height: FloatArray, omega: FloatArray, halvings: int
    ) -> None:
        """Searches a part of the segment for greater amplitudes of some of its degrees of freedom."""
        degree = INTERPOLATION.degree
        x = chebyshev.chebpts2(degree + 1)
        points = [self._at(low + 0.5 * (1.0 + one) * (high - low)) for one in x]
        z = np.array([one for one in points if one is not None])
        if len(z) < len(x):
            return
        amplitude = reported_at(self.system, z).amplitude[:, self.columns[which]]
        of_amplitude, of_omega = (
            chebyshev.chebfit(x, amplitude, degree),
            chebyshev.chebfit(x, z[:, -1], degree),
        )
        rough = np.abs(of_amplitude[-2:]).max(axis=0) > INTERPOLATION.tolerance * amplitude.max(axis=0)
        if halvings and rough.any():
            middle = 0.5 * (low + high)
            self._part(low, middle, which[rough], height, omega, halvings - 1)
            self._part(middle, high, which[rough], height, omega, halvings - 1)
        smooth = ~rough if halvings else np.ones_like(rough)
        for k, polynomial in zip(which[smooth], of_amplitude.T[smooth], strict=True):
            at = _highest(polynomial)
            value, d = float(chebyshev.chebval(at, polynomial)), self.dofs[k]
            if value > height[d]:
                height[d], omega[d] = value, float(chebyshev.chebval(at, of_omega))

    def _at(self, part: float) -> FloatArray | None:
        """The point of the curve at a fraction of the segment; None if it is not found."""
        return self.between.z if self.between.find(part) else None


def _highest(polynomial: FloatArray) -> float:
    """The argument in [-1, 1] at which a Chebyshev series is greatest."""
    places = np.linspace(-1.0, 1.0, INTERPOLATION.samples)
    at = float(places[chebyshev.chebval(places, polynomial).argmax()])
    slope, bend = chebyshev.chebder(polynomial), chebyshev.chebder(polynomial, 2)
    for _ in range(INTERPOLATION.max_steps):
        down = float(chebyshev.chebval(at, bend))
        if down < 0.0:
            at = min(max(at - float(chebyshev.chebval(at, slope)) / down, -1.0), 1.0)
    return at
