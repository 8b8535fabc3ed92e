"""Kernel: the sequence of the states of a contact, as a word and with the angles at which they begin."""

import cython
import numpy as np
from cython.cimports.libc.math import atan2, fabs

if cython.compiled:
    from cython.cimports.fcm.contact.cycle import PI, Cycle
    from cython.cimports.fcm.contact.slip_limits import OPEN, SLIPPING, STUCK
else:
    from fcm.contact.cycle import PI, Cycle
    from fcm.contact.slip_limits import OPEN, SLIPPING, STUCK

NAN = cython.declare(cython.double, float("nan"))
# A slip that moves w by less than this, a stick shorter than this, is below what float64 can tell from none.
INVISIBLE = cython.declare(cython.double, 1e-15)

LETTER_E = cython.declare(cython.int, ord("E"))
LETTER_P = cython.declare(cython.int, ord("P"))
LETTER_N = cython.declare(cython.int, ord("N"))
LETTER_S = cython.declare(cython.int, ord("S"))
MOST = cython.declare(cython.int, 7)  # states of a cycle, and one more


@cython.cclass
class Sequence(Cycle):
    """The regions of a cycle that float64 can tell from none, and those without which the others cannot be.

    Between opposite slips there is always a stick, however short. A stick after a slip ends in the opposite
    slip: the limit that pushed w is past its extreme, and w must leave it to be at the other one at the end.

    ``regions`` has a row for each, ``count`` in all: its letter, its angle since the first begins, and w
    while it sticks. ``state`` is +1 in positive slip, -1 in negative slip, 0 in stick, 2 in separation.
    """

    def __init__(self) -> None:
        self.regions = np.empty((MOST, 3))

    def of(self, n0_bar: float, b_bar: float, phi: float) -> None:
        """Fill the regions; none where an argument is no number."""
        self.count = 0
        behaviour: cython.int = self.find(n0_bar, b_bar, phi)
        if behaviour == STUCK:
            self._region(LETTER_E, 0.0, -self.stuck_force())
        elif behaviour == OPEN:
            self._region(LETTER_S, 0.0, NAN)
        elif behaviour == SLIPPING and self.opens and self.state == 0.0 and self.last_slip != 0.0:
            self._region(LETTER_N if self.last_slip > 0.0 else LETTER_P, self.since, NAN)

    def take(self) -> None:
        """Adds the regions of a span."""
        if self.span == 0:
            self.since, self.last_slip = 2.0 * (PI - self.theta_1), 0.0
            self.state = 2.0 if self.opens else -1.0
            if self.opens:
                self._region(LETTER_S, 0.0, NAN)
        side: float = self._seen()
        slip: float = self.slip if side == self.side else 0.0
        stick: float = self.length - (self.slip if side != 0.0 else 0.0)
        if self.state != 0.0 and (stick > INVISIBLE or (side != 0.0 and self.state == -side)):
            self._region(LETTER_E, self.since, self.w_start)
            self.state = 0.0
        self.since += self.length
        if side != 0.0 and side != self.state:
            self._region(LETTER_P if side > 0.0 else LETTER_N, self.since - slip, NAN)
        if side != 0.0:
            self.state = self.last_slip = side

    def _seen(self) -> float:
        """Side of the slip in a span, 0 where there is none to be seen."""
        if self.opens:
            return self.side if fabs(self.w_end - self.w_start) > INVISIBLE else 0.0
        if self.lower_P - self.upper_N <= INVISIBLE:  # there are both slips, equally large, or none
            return 0.0
        return 1.0 if self.span == 0 else -1.0

    def _region(self, letter: cython.int, since: float, w: float) -> None:
        self.regions[self.count, 0], self.regions[self.count, 1], self.regions[self.count, 2] = (
            letter,
            since,
            w,
        )
        self.count += 1

    def loop(
        self, n0_bar: cython.double, b_bar: cython.double, phi: cython.double
    ) -> tuple[float, np.ndarray]:
        """Angle at which the first region begins [rad], and the regions (region, 3); arguments all finite."""
        self.of(n0_bar, b_bar, phi)
        at: float = 0.0
        if self.count > 1:
            at = atan2(self.end_sin, self.end_cos) if self.opens else atan2(self.first_sin, self.first_cos)
        return at, np.array(self.regions[: self.count])

    def words(self, points: cython.double[:, ::1]) -> np.ndarray:
        """The words of many contacts, (point,); rows (3, point) of n0_bar, b_bar, phi."""
        i: cython.Py_ssize_t
        k: cython.int
        letters = np.zeros((points.shape[1], MOST - 1), dtype=np.uint32)
        out: cython.uint[:, ::1] = letters
        with cython.nogil:
            for i in range(points.shape[1]):
                self.of(points[0, i], points[1, i], points[2, i])
                for k in range(min(self.count, MOST - 1)):
                    out[i, k] = cython.cast(cython.uint, self.regions[k, 0])
        return letters.view(f"U{MOST - 1}")[:, 0]
