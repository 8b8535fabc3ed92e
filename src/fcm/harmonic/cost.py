"""What a balance of more harmonics would take, so that what takes too long is said and not begun.

It is told in seconds of a core on which numpy's sine takes 10 ns a number, from the size of the balance and
not from a clock: the same scene has the same answer on every machine.
"""

from __future__ import annotations

from fcm.harmonic.condensed import rank_of
from fcm.harmonic.system import System

PATIENCE = 30.0  # seconds that following branches with more harmonics may take, time and again
AGAIN = 3.0  # where they are followed a dozen times, as in a search, or with one harmonic more each time
CYCLE = 3.5e-6  # seconds of an evaluation, for each harmonic of a contact: when it sticks, slips, is open
SYSTEM = 2.7e-11  # and for each third power of the unknowns that are solved for


def seconds_with(system: System, evaluations: int, harmonics: int) -> float:
    """About what following branches of a system with so many harmonics takes.

    evaluations are those that its own took: they grow as the harmonics do, with the corners and folds.
    """
    contacts, few = len(system.scene.contacts), max(len(system.harmonics), 1)
    modes = len(system.linear.natural)
    unknowns = rank_of(modes, 2 * contacts, harmonics) or contacts * (2 + 4 * harmonics)
    each = CYCLE * contacts * harmonics + SYSTEM * float(unknowns) ** 3
    return evaluations * (harmonics / few) * each
