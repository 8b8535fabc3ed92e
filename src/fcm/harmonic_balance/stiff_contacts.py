"""Contacts so much stiffer than the structure that rounding decides what they do: what to take instead.

A contact's force is its stiffness times a difference of displacements, of which one rounding stays. Beside
the force that the structure bears this is k |G| roundings. Where the force changes from stick to slip no
curve is followed through more than some 1e-9 of it. Long before, the contact is nearly rigid: the effect of
its compliance falls at least as the root of the stiffness, as where a mass bounces on it. How nearly depends
on the structure, where a resonance or a bounce magnifies that effect.
"""

from __future__ import annotations

import numpy as np

from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


def too_stiff(system: System, moves: bool = False) -> str:
    """Sentence on a contact whose stiffness leaves no digits, and what to take instead; empty without any.

    moves: whether what is said is of the motion in time, which has the digits, but of which every vibration
    on a contact that sticks is followed.
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
    """Receptances |G| of each port in its own direction, the least at the ends of the range."""
    receptance, found = system.shared_balance.receptance, []
    for omega in system.scene.frequency_range:
        receptance.at(omega)
        found.append(np.abs(receptance.of_harmonic(receptance.first).diagonal()))
    least: FloatArray = np.min(found, axis=0)
    return least
