"""Curves on which contacts shake down: they stick by the residual friction that earlier slip has left.

If that friction also changes their normal load, they may go on slipping instead: the history decides. See
Klarbring, Ciavarella and Barber, Shakedown in elastic contact problems with Coulomb friction (2007).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.branches.linear_limits import lowest_linear_limits, precompute
from fcm.branches.options import FRICTION
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene


def shakedown_at(system: System, frequency: FloatArray, states: npt.NDArray[np.str_]) -> float:
    """Frequency [rad/s] at which contacts that shake down would slip if they began unstressed, or NaN.

    frequency (point,) and states (point, contact) are those of the curves, on which no contact slips. The
    result is the frequency at which the least force makes a contact slip.
    """
    scene = system.scene
    nothing = scene.strained or system.own_laws or not states.size or (states != states[0]).any()
    if nothing or not np.isin(states[0], ("E", "S")).all():
        return np.nan
    rough = np.array([contact.mu * contact.k_u > 0.0 for contact in scene.contacts], dtype=np.bool_)
    stuck = (states[0] == "E") & rough
    if not stuck.any() or not changes_load(scene, states[0] == "E", stuck, of_its_own=True):
        return np.nan
    precompute(system, frequency.tolist())
    levels = lowest_linear_limits(system, frequency.tolist())
    least = int(levels.argmin())
    return float(frequency[least]) if levels[least] < FRICTION.shakedown_level else np.nan


def may_wedge(scene: Scene) -> bool:
    r"""Whether friction forces may press their own contacts together enough to hold these.

    With all contacts closed, friction forces F change the limits :math:`\mu n` by G F. Forces of any size are
    held only if :math:`|F_i| \le |(G F)_i|` at all contacts, and none are if the norm of G is below 1:

    .. math:: G = \mu k_v A (K + A^T k_v A)^{-1} B^T

    with the modal stiffness K, and the modes at the contacts: A across them, B along them.

    >>> import fcm
    >>> may_wedge(fcm.load_scene("yang1998-n5"))
    False
    """
    rough = np.array([one.mu if one.k_u > 0.0 else 0.0 for one in scene.contacts])
    try:
        load, _ = _load_by_friction(scene, np.ones_like(rough), np.zeros_like(rough))
    except np.linalg.LinAlgError:  # a rigid-body mode is unconstrained
        return True
    return bool(np.linalg.norm(rough[:, None] * load, 2) >= 1.0)


def changes_load(
    scene: Scene, closed: npt.NDArray[np.bool_], stuck: npt.NDArray[np.bool_], of_its_own: bool = False
) -> bool:
    """Whether residual friction of a sticking contact changes the load of another one.

    With of_its_own, its own load counts, too. closed, stuck (contact,): the contacts that stay so.

    >>> import fcm
    >>> every = np.array([True])
    >>> changes_load(fcm.load_scene("yang1998-n5"), every, every, of_its_own=True)
    True
    """
    try:
        load, whose = _load_by_friction(scene, closed, stuck)
    except np.linalg.LinAlgError:  # a rigid-body mode is unconstrained
        return True
    if not of_its_own:
        load[whose, np.arange(whose.size)] = 0.0
    return bool((np.abs(load[:, stuck[whose]]) > FRICTION.load_tolerance).any())


def _load_by_friction(
    scene: Scene, closed: npt.NDArray[Any], stuck: npt.NDArray[Any]
) -> tuple[FloatArray, npt.NDArray[np.intp]]:
    """Changes of loads by unit friction forces (contact, friction), and the contact of each friction force.

    Contacts that are closed and stuck (contact,) stay so. Raises LinAlgError if a mode is free.
    """
    modal, contacts = scene.modal, scene.contacts
    slides = [(i, way) for i, contact in enumerate(contacts) for way in contact.directions[:-1]]
    whose = np.array([i for i, _ in slides])
    along = np.array([modal.shapes @ way for _, way in slides])
    across = np.array([modal.shapes @ contact.normal for contact in contacts])
    k_u, k_v = (np.array([getattr(contact, name) for contact in contacts]) for name in ("k_u", "k_v"))
    stiffness: FloatArray = (along.T * (k_u * stuck)[whose]) @ along + (across.T * (k_v * closed)) @ across
    stiffness += np.diag(modal.mass * modal.frequency**2)
    load: FloatArray = k_v[:, None] * (across @ np.linalg.solve(stiffness, along.T))
    return load, whose
