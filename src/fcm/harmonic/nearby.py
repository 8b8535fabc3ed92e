"""Whether more harmonics have solutions of their own where a window of several solutions is near.

With one harmonic the level of the forces may turn back just above 1, and with more just below it: the curve
of one harmonic then shows nothing of what is there, and its errors are those of another motion. So where the
level turns near 1 it is followed with a few more harmonics as well; and where a contact comes to slip, open
or close just above 1: with one harmonic the level may go on from there, and with more turn back.
"""

from __future__ import annotations

from collections.abc import Sequence

from fcm.harmonic.linear_contacts import foresee, least
from fcm.harmonic.start import Found, few_of, solutions
from fcm.harmonic.system import System

ENOUGH = 3  # harmonics, with which a peak that one harmonic has at twice its height is within some per cent


def with_a_window(system: System, found: Sequence[Found]) -> tuple[int, ...]:
    """Harmonics of a system, and those with which other solutions hang together with rest, if some do.

    found: where solutions were looked for with those of the system, and what was found.
    """
    few = tuple(sorted({*system.harmonics, *range(1, min(ENOUGH, few_of(system)) + 1)}))
    near = [one for one in found if turns_near(one) or _bends_near(system, one)]
    if few == system.harmonics or not near:
        return system.harmonics
    finer = system.with_harmonics(few)
    foresee(finer, [one.omega for one in near])
    other = any(len(solutions(finer, one.omega).solutions) != len(one.solutions) for one in near)
    return few if other else system.harmonics


def turns_near(found: Found) -> bool:
    """Whether the level turned so near 1 that more harmonics may turn on its other side.

    One harmonic errs by up to a factor of two in a peak, and so do two: it may take the third. With more the
    error falls faster than their number rises.
    """
    near = _near(found)
    return any(1.0 / near < turn.level < near for turn in found.turns)


def _bends_near(system: System, found: Found) -> bool:
    """Whether the level is linear up to 1, and not much further."""
    return 1.0 <= least(system, found.omega) < _near(found)


def _near(found: Found) -> float:
    """Times the level 1."""
    return 1.0 + 1.0 / max(lowest_of(found.harmonics) - 1, 1)


def lowest_of(harmonics: Sequence[int]) -> int:
    """Up to which harmonic there are all."""
    return next(h for h in range(1, len(harmonics) + 2) if h not in harmonics) - 1
