"""Points whose motion may be one of many, as a contact that never slips may have any residual friction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.branches.shakedown import changes_load
from fcm.distinct_values import distinct_values
from fcm.harmonic_balance.residual_traction import peak_changes
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.structure.linear import Linear


def undetermined(scene: Scene, states: npt.NDArray[np.str_]) -> npt.NDArray[np.bool_]:
    """Mask of the points at which a contact never slips and its residual friction may affect another.

    states (point, contact). The other contact changes its state within the cycle, or its load depends on the
    residual friction. With different residual friction it may slip, open or close. A single contact sticks in
    the same motion for every residual friction with which it sticks at all.

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
        felt = np.array([changes_load(scene, row == "E", (row == "E") & rough) for row in rows])
        found[still] = felt[which.ravel()]
    return found


def residual_changes(
    system: System,
    z: FloatArray,
    amplitude: FloatArray,
    states: npt.NDArray[np.str_],
    undetermined: npt.NDArray[np.bool_],
    quick: bool = False,
) -> FloatArray:
    """Relative changes of each peak by residual friction, see `harmonic_balance.residual_traction`.

    z (point, unknown + 1), amplitude (point, dof), states (point, contact) and the mask of `undetermined`
    points belong to one curve. quick: NaN for changes that need further motions.
    """
    top, contacts = amplitude.argmax(axis=0), system.scene.contacts
    if not undetermined[top].any():
        return np.zeros(top.size)
    if quick or type(system.linear) is not Linear:
        return np.where(undetermined[top], np.nan, 0.0)
    rough = np.array([one.mu * one.k_u > 0.0 for one in contacts], dtype=np.bool_)
    stuck = (states[top] == "E") & rough & undetermined[top, None]
    return peak_changes(system, z, amplitude, top, stuck)


def residual_changes_at_levels(
    system: System, z: FloatArray, level: FloatArray, amplitude: FloatArray, states: npt.NDArray[np.str_]
) -> FloatArray:
    """`residual_changes` for points at one frequency, with forces times level (point,).

    The frequency and the level of each peak are fixed.
    """
    scene, top, at = system.scene, amplitude.argmax(axis=0), float(z[0, -1])
    maybe, found = undetermined(scene, states), np.zeros(amplitude.shape[1])
    for i in distinct_values(top[maybe[top]]).tolist():
        forces = tuple(replace(one, amplitude=one.amplitude * float(level[i])) for one in scene.forces)
        held = replace(scene, forces=forces, frequency_range=(at, 2.0 * at))  # as at an end of a range
        there = System(held, system.harmonics, options=system.options, other_options=system.other_options)
        one = slice(i, i + 1)
        change = residual_changes(there, z[one], amplitude[one], states[one], maybe[one])
        found = np.where(top == i, change, found)
    return found
