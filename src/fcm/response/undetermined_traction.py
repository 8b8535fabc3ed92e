"""Points whose motion may be one of many: a contact that never slips may have any residual friction."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Scene

FELT = 1e-9  # change of a contact's load, relative to the residual friction of another: less is rounding


def undetermined(scene: Scene, states: npt.NDArray[np.str_]) -> npt.NDArray[np.bool_]:
    """Of points with states (point, contact): whether a contact never slips beside one that may feel it.

    That is one that changes its state, or whose load the residual friction changes: with another residual it
    may slip, open or close. A contact alone sticks in the same motion with every residual that lets it.

    >>> import fcm
    >>> from dataclasses import replace
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> two = replace(scene, contacts=scene.contacts * 2)
    >>> undetermined(two, np.array([["E", "SEP"], ["E", "S"], ["E", "E"], ["EPEN", "SEP"]])).tolist()
    [True, True, True, False]
    >>> undetermined(scene, np.array([["E"], ["EPEN"]])).tolist()
    [False, False]
    """
    if len(scene.contacts) < 2 or scene.with_own_laws:
        return np.zeros(len(states), dtype=np.bool_)
    rough = np.array([contact.mu * contact.k_u > 0.0 for contact in scene.contacts], dtype=np.bool_)
    stuck, changing = (states == "E") & rough, np.char.str_len(states) > 1
    found: npt.NDArray[np.bool_] = stuck.any(axis=1) & changing.any(axis=1)
    still = stuck.any(axis=1) & ~changing.any(axis=1)
    if still.any():
        rows, which = np.unique(states[still], axis=0, return_inverse=True)
        felt = np.array([_felt(scene, row == "E", (row == "E") & rough) for row in rows])
        found[still] = felt[which.ravel()]
    return found


def _felt(scene: Scene, closed: npt.NDArray[np.bool_], stuck: npt.NDArray[np.bool_]) -> bool:
    """Whether the residual friction of a contact that sticks changes the load of another, if both stay so."""
    modal, contacts = scene.modal, scene.contacts
    slides = [(i, way) for i, contact in enumerate(contacts) for way in contact.directions[:-1]]
    whose = np.array([i for i, _ in slides])
    along = np.array([modal.shapes @ way for _, way in slides])
    across = np.array([modal.shapes @ contact.normal for contact in contacts])
    k_u, k_v = (np.array([getattr(contact, name) for contact in contacts]) for name in ("k_u", "k_v"))
    stiffness: FloatArray = (along.T * (k_u * stuck)[whose]) @ along + (across.T * (k_v * closed)) @ across
    stiffness += np.diag(modal.mass * modal.frequency**2)
    try:
        load = k_v[:, None] * (across @ np.linalg.solve(stiffness, along.T))  # (contact, friction)
    except np.linalg.LinAlgError:  # a mode is free to drift with it
        return True
    load[whose, np.arange(whose.size)] = 0.0
    return bool((np.abs(load[:, stuck[whose]]) > FELT).any())
