"""The coefficients over the plane (n0_bar, b_bar) at one phase, and its regimes (section 4.1)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fcm.contact.fourier import fourier_coefficients
from fcm.contact.limits import BoolArray, FloatArray, slip_limit
from fcm.contact.loop import sequences
from fcm.frozen import Frozen

COEFFICIENTS = ("F_b", "F_s", "F_c")
N0_RANGE, B_RANGE = (-2.0, 3.0), (0.0, 2.0)  # the default ranges
STEPS = (400, 160)  # along n0_bar and b_bar; of equal length, so that n0_bar = +-b_bar are diagonals of cells
CELLS = (400, 162)  # of unequal length, so that the cells' midpoints are not on these lines
FINE_CELLS = (800, 324)  # their edges look like a line

Law = Callable[[FloatArray, FloatArray, float], tuple[FloatArray, FloatArray, FloatArray]]


class ParameterPlane(Frozen):
    """A rectangle of n0_bar [-] and b_bar [-] at a phase [rad]."""

    phi: float = 0.0
    n0_range: tuple[float, float] = N0_RANGE
    b_range: tuple[float, float] = B_RANGE

    def nodes(self, steps: tuple[int, int] = STEPS) -> tuple[FloatArray, FloatArray]:
        """The nodes n0_bar (i,) and b_bar (j,), with the ends included."""
        n0, b = (
            np.linspace(*ends, n + 1) for ends, n in zip((self.n0_range, self.b_range), steps, strict=True)
        )
        return n0, b

    def centres(self, steps: tuple[int, int] = CELLS) -> tuple[FloatArray, FloatArray]:
        """The midpoints between the nodes, which avoid the special values 0 and 1."""
        n0, b = (0.5 * (nodes[1:] + nodes[:-1]) for nodes in self.nodes(steps))
        return n0, b


class CoefficientSurface(Frozen):
    """Values of one coefficient over a plane."""

    coefficient: str
    plane: ParameterPlane
    n0_bar: FloatArray  # (i,) [-]
    b_bar: FloatArray  # (j,) [-]
    values: FloatArray  # (j, i) [-]


def surface(
    coefficient: str, plane: ParameterPlane, steps: tuple[int, int] = STEPS, law: Law = fourier_coefficients
) -> CoefficientSurface:
    """Surface of one of COEFFICIENTS over a plane, from the closed form or from another law such as a table.

    >>> flat = surface("F_c", ParameterPlane(phi=0.0, b_range=(1.0, 2.0)), steps=(10, 10))
    >>> float(abs(flat.values).max())  # in phase, and the load varies enough: no damping
    0.0
    """
    n0, b = plane.nodes(steps)
    F = law(n0[None, :], b[:, None], plane.phi)
    return CoefficientSurface(coefficient, plane, n0, b, F[COEFFICIENTS.index(coefficient)])


def boundaries(b_bar: FloatArray, phi: float) -> dict[str, FloatArray]:
    """Boundary values of n0_bar between the regimes, for each b_bar.

    Below ``open`` the contact never closes; below ``separation`` it opens within the cycle; above ``slip``,
    equation (25), it never slips.

    >>> {name: n0.tolist() for name, n0 in boundaries(np.array([0.0, 0.5]), 0.0).items()}
    {'open': [-0.0, -0.5], 'separation': [0.0, 0.5], 'slip': [1.0, 1.0]}
    """
    return {"open": -b_bar, "separation": b_bar, "slip": slip_limit(b_bar, phi)}


class Edges(Frozen):
    """The boundary lines between the regimes, across a plane."""

    b_bar: FloatArray  # (j,) [-]
    n0_bar: dict[str, FloatArray]  # for each line (j,) [-]


def edges(plane: ParameterPlane) -> Edges:
    """The boundary lines between the regimes, at all b_bar of a plane."""
    b = np.linspace(*plane.b_range, STEPS[0] + 1)
    return Edges(b, boundaries(b, plane.phi))


class Regions(Frozen):
    """Masks that show where in a plane each sequence of states occurs."""

    n0_bar: FloatArray  # (i,) [-]
    b_bar: FloatArray  # (j,) [-]
    where: dict[str, FloatArray]  # for each sequence (j, i): 1 where it occurs, else 0
    separates: BoolArray  # (j, i) whether the contact opens and closes within the cycle
    edges: Edges


def regions(plane: ParameterPlane, steps: tuple[int, int] = FINE_CELLS) -> Regions:
    """Regions of the sequences of `hysteresis_loop` over a plane, evaluated at the midpoint of each cell."""
    n0, b = plane.centres(steps)
    found = sequences(n0[None, :], b[:, None], plane.phi)
    where = {str(name): (found == name).astype(np.float64) for name in np.unique(found)}
    return Regions(n0, b, where, np.abs(n0[None, :]) < b[:, None], edges(plane))
