"""What is followed: n equations residual(z) = 0 for n unknowns and a parameter, the last of z.

A problem knows nothing of the curve, and the follower nothing of what the unknowns mean. A problem writes
what it is asked for into arrays of its own, so that a step of the follower makes no new ones. It is smooth
while none of its margins changes sign.
"""

from __future__ import annotations

import cython
import numpy as np

NONE = cython.declare(cython.int, -1)  # kind of a margin that is none


@cython.cclass
class Problem:
    """Equations of a curve; see the methods for what each array holds.

    residual (n,), jacobian (n, n + 1): by `evaluate`, the derivative by the parameter in the last column.
    scale (n + 1,): by `measure`. margin, kind, angle (margins,): by `bound`. output, growth (outputs,): by
    `report`.
    coarse: whether there are approximate equations, with which each place is sought first; see `refine`.
    """

    def __init__(self, unknowns: cython.int, margins: cython.int, outputs: cython.int) -> None:
        self.unknowns, self.margins, self.outputs = unknowns, margins, outputs
        self.coarse = False
        self.residual = np.zeros(unknowns)
        self.jacobian = np.zeros((unknowns, unknowns + 1))
        self.scale = np.ones(unknowns + 1)
        self.margin, self.angle = np.ones(margins), np.zeros(margins)
        self.kind = np.arange(margins, dtype=np.intc)
        self.output = np.zeros(outputs)
        self.growth = np.zeros(outputs)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        """Residual and its derivatives at z (n + 1,)."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def measure(self, z: cython.double[::1]) -> cython.int:
        """Units in which lengths along the curve are measured at z: of each unknown, and of the parameter."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def bound(self, z: cython.double[::1]) -> cython.int:
        """Margins: functions of z of which each changes sign where the problem is not smooth.

        Which function each is its kind says, and of those of one kind the angle [rad], which varies with z;
        NONE where there is none. Margins may come and go, and stand in any order.
        """
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def refine(self, exact: cython.bint) -> cython.int:
        """Evaluate the equations themselves from now on, or approximate ones."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def report(self, z: cython.double[::1], direction: cython.double[::1]) -> cython.int:
        """What is reported of z, positive numbers, and their growth along a direction (n + 1,)."""
        return 0
