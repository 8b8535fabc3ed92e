"""Whether more harmonics have solutions of their own where a window of several solutions is near.

With one harmonic the level of the forces may turn back just above 1, and with more just below it: the curve
of one harmonic then shows nothing of what is there, and its errors are those of another motion. So where the
level turns near 1 it is followed with a few more harmonics as well.
"""

from __future__ import annotations

from collections.abc import Sequence

from fcm.harmonic.linear_contacts import foresee
from fcm.harmonic.start import Found, few_of, solutions
from fcm.harmonic.system import System

NEAR = (
    2.0  # times 1, or part of it: so far few harmonics may move a turn, as one errs by up to that in a peak
)
ENOUGH = 3  # harmonics, with which a peak that one harmonic has at twice its height is within some per cent


def with_a_window(system: System, looked: Sequence[Found]) -> tuple[int, ...]:
    """Harmonics of a system, and those with which other solutions hang together with rest, if some do.

    looked: where solutions were looked for with those of the system, and what was found.
    """
    few = tuple(sorted({*system.harmonics, *range(1, min(ENOUGH, few_of(system)) + 1)}))
    near = [one for one in looked if any(1.0 / NEAR < level < NEAR for level in one.turns)]
    if few == system.harmonics or not near:
        return system.harmonics
    finer = system.with_harmonics(few)
    foresee(finer, [one.omega for one in near])
    other = any(len(solutions(finer, one.omega).solutions) != len(one.solutions) for one in near)
    return few if other else system.harmonics
