"""Advice on contacts so much stiffer than the structure that rounding decides their state.

A contact force is the stiffness times a difference of displacements, which has one rounding error. Relative
to the force that the structure bears, this is k |G| rounding errors. At a change from stick to slip no curve
can be followed with an error above some 1e-9. A far softer contact is already nearly rigid. The effect of its
compliance falls at least as the inverse root of the stiffness, as for a mass that bounces on it. A resonance
or a bounce of the structure magnifies this effect.
"""

from __future__ import annotations

import numpy as np

from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


def too_stiff(system: System, moves: bool = False) -> str:
    """Sentence on the stiffest contact, if it is too stiff, with a stiffness to use instead; else empty.

    moves: for integration in time, which loses no digits but follows every vibration on a sticking contact.
    """
    springs = system.springs(stuck=True)
    if not springs.size:
        return ""
    receptance = _least_receptance(system)
    worst = int((springs * receptance).argmax())
    ratio = springs[worst] * receptance[worst]
    options = system.options.stiff
    most, enough = options.max_stiffness, options.rigid_stiffness
    if moves:
        most, enough = options.max_stiffness_in_time, options.rigid_stiffness_in_time
    if not ratio > most:
        return ""
    at, along = divmod(worst, system.layout.directions)
    contact, key = system.scene.contacts[at], "k_v" if along == system.layout.directions - 1 else "k_u"
    instead = enough / receptance[worst]
    why = "rounding decides when it slips or opens"
    if moves:
        why = f"a period may have {np.sqrt(ratio):.0e} vibrations on it, each with slip of its own"
    return (
        f"; the {key} of contact {contact.name} is {ratio:.0e} times as stiff as the structure there, so "
        f"that {why}. Try {instead:.0e}, nearly rigid, and half of that to see how much it matters"
    )


def _least_receptance(system: System) -> FloatArray:
    """Receptance |G| (port,) of each port on itself, the lesser of those at the two ends of the range."""
    receptance, found = system.shared_balance.receptance, []
    for omega in system.scene.frequency_range:
        receptance.at(omega)
        found.append(np.abs(receptance.of_harmonic(receptance.first).diagonal()))
    least: FloatArray = np.min(found, axis=0)
    return least
