"""What is followed: n equations residual(z) = 0 for n unknowns and a parameter, the last of z.

A problem knows nothing of the curve, and the follower nothing of what the unknowns mean. A problem writes
what it is asked for into arrays of its own, so that a step of the follower makes no new ones. It is smooth
while none of its margins changes sign.
"""

from __future__ import annotations

import cython
import numpy as np

BOUNDLESS = cython.declare(cython.double, 1e9)  # `unbounded` where a problem says nothing else
COSTLY_SIZE = cython.declare(cython.int, 100)  # unknowns, from which on most of the work is to solve for them
NONE = cython.declare(cython.int, -1)  # kind of a margin that is none


@cython.cclass
class Problem:
    """Equations of a curve; see the methods for what each array holds.

    residual (n,), jacobian (n, n + 1): by `evaluate`, the derivative by the parameter in the last column; by
    `probe` the residual alone.
    scale (n + 1,): by `measure`. margin, kind, angle (margins,): by `bound`. output, growth (outputs,): by
    `report`.
    rank: 0; or the size of a smaller system to which that of Newton's method is condensed, by the problem
    itself. Then jacobian is (n, 1), the derivative by the parameter alone; see `factor` and `solve`.
    group: margins of so many in a row belong together; one is never the same as one of another group.
    unbounded: growth of the solution, in units of its size at the start, that only an undamped resonance has.
    costly: whether there are so many unknowns that every point counts: slight corners are stepped over,
    peaks and folds sought between all points of a step that are known.
    rooted: whether a margin may begin as a root of the distance from a corner, so that `Newton` halves steps.
    labelled: whether the margins are labels: while they stay the problem is smooth; else it may not be.
    """

    def __init__(
        self, unknowns: cython.int, margins: cython.int, outputs: cython.int, rank: cython.int = 0
    ) -> None:
        self.unknowns, self.margins, self.outputs, self.rank = unknowns, margins, outputs, rank
        self.labelled, self.unbounded = False, BOUNDLESS
        self.rooted = False
        self.group, self.costly = margins, unknowns >= COSTLY_SIZE
        self.residual = np.zeros(unknowns)
        self.jacobian = np.zeros((unknowns, 1 if rank else unknowns + 1))
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
    def probe(self, z: cython.double[::1]) -> cython.int:
        """The residual alone at z, where that costs less."""
        return self.evaluate(z)

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
    def report(self, z: cython.double[::1], direction: cython.double[::1]) -> cython.int:
        """What is reported of z, positive numbers, and their growth along a direction (n + 1,)."""
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        """Factor the equations, as evaluated last and closed by a row (n + 1,), in units of scale (n + 1,);
        the sign of the determinant, 0 if they are singular."""
        return 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        """Replace a right side (n + 1,) of the equations factored last by the solution, in their units."""
        return 0
