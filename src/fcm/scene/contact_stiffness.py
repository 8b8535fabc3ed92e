"""Questions contacts that are far stiffer or softer than the structure, mostly by a wrong unit."""

from __future__ import annotations

import numpy as np

from fcm.model.question import Question
from fcm.model.scene import FloatArray, Scene, has_friction
from fcm.scene.contact_springs import stuck_stiffness
from fcm.scene.errors import several
from fcm.scene.force_reach import pushed
from fcm.scene.options import MESSAGES, TOLERANCES
from fcm.units import UNIT

SHORTER = {"m": "mm", "mm": "um"}  # units shorter by 1000, in which a stiffness has a 1000 times larger unit


def notes_of_stiffness(scene: Scene) -> list[str]:
    """Questions about contacts far stiffer or far softer than the structure.

    A contact is stiff by k times the flexibility of the elastic modes along its displacement,
    sum phi^2 / (m omega^2). Contacts are soft if they change no resonance up to the end of the range while
    all of them stick. If units are given, very different k_u and k_v are questioned too. There are no
    questions on rings, nor on stiffnesses that are swept, optimised or fitted.
    """
    if scene.ring is not None or not scene.contacts or varies(scene, ".k_u", ".k_v"):
        return []
    ratio = _stiffness_beside_structure(scene)
    stiff = np.flatnonzero(ratio > MESSAGES.stiff_contact)
    if stiff.size:
        names = several([scene.contacts[i].name for i in stiff])
        contacts, at_most = ("contacts", " at most") if stiff.size > 1 else ("contact", "")
        return [
            Question(
                f"{contacts} {names}: {ratio.max():.1e} times as stiff as the structure there{at_most}. "
                "Are k_u and k_v in its units? Beyond some hundred times little changes, and runs take long"
            )
        ]
    soft = _soft(scene, ratio.max()) if ratio.max() > 0.0 else ""
    return [Question(one) for one in (soft or _unequal(scene),) if one]


def varies(scene: Scene, *ends: str) -> bool:
    """Whether a key path with one of these ends is swept, optimised or fitted."""
    keys = [] if scene.draft is None else [one.key for one in scene.draft.swept]
    return any(key.endswith(ends) for key in keys) or are_sought(scene, *ends)


def are_sought(scene: Scene, *ends: str) -> bool:
    """Whether a key path with one of these ends is optimised or fitted."""
    tables = [one for one in (scene.optimum, scene.fit) if one is not None]
    return any(key.endswith(ends) for one in tables for key in one.vary)


def _soft(scene: Scene, ratio: float) -> str:
    """Question about contacts that change no resonance up to the range's end while they stick; or ''.

    ratio is that of the stiffest contact to the structure there. Contacts that even with 1 / ratio times
    their stiffness change no resonance are not questioned: these resonances do not move them. If there are
    rigid-body modes, only elastic modes that forces excite count. Nothing is asked if the forces excite a
    rigid-body mode whose resonance on the contact springs is within the range, as on soft mounts.
    """
    modal = scene.modal
    floating = modal.frequency == 0.0
    contacts = stuck_stiffness(scene) - np.diag(modal.frequency**2)
    kept = ~floating & (pushed(scene, np.eye(floating.size)) | ~floating.any())
    opened = np.sort(modal.frequency[kept & (np.arange(floating.size) < floating.size - modal.added)])
    structure, held = np.diag(modal.frequency[kept] ** 2), contacts[np.ix_(kept, kept)]
    near = np.ones(opened.size, np.bool_)
    if scene.has_range:
        low, high = scene.frequency_range
        highest = max((one.harmonic for one in scene.forces), default=1) * high
        near = opened <= MESSAGES.range_near * highest
        squares, turn = np.linalg.eigh(contacts[np.ix_(floating, floating)])
        if (
            pushed(scene, turn.T @ np.eye(floating.size)[floating])
            & (squares > low**2)
            & (squares < highest**2)
        ).any():
            return ""
    if not near.any():
        return ""

    def change(times: float) -> FloatArray:
        squares = np.linalg.eigvalsh(structure + times * held)[: opened.size]
        return np.where(near, np.sqrt(np.maximum(squares, 0.0)) / opened - 1.0, 0.0)

    most = int(np.argmax(found := change(1.0)))
    if found[most] >= MESSAGES.soft_contacts or change(1.0 / ratio).max() < MESSAGES.soft_contacts:
        return ""
    unit = scene.frequency_unit
    percent = f"{100.0 * found[most]:.2g} %"
    return (
        "the contacts are soft beside the structure: while all stick, the resonance at "
        f"{opened[most] / UNIT[unit]:.5g} {unit} is {percent} higher, so that friction changes little. Are "
        f"k_u and k_v in its units?{_per_shorter(*scene.units)}"
    )


def _per_shorter(length: str, force: str) -> str:
    """Sentence on the common unit mistake that makes stiffnesses a thousand times too small; or ''.

    >>> _per_shorter("m", "N"), _per_shorter("", "")
    (' They are read in N/m; if they are in N/mm, write 1000 times as much', '')
    """
    if not force or length not in SHORTER:
        return ""
    read, shorter = f"{force}/{length}", f"{force}/{SHORTER[length]}"
    return f" They are read in {read}; if they are in {shorter}, write 1000 times as much"


def _unequal(scene: Scene) -> str:
    """Question about a contact whose k_u and k_v differ as by a unit mistake, if units are given; or ''."""
    if not all(scene.units):
        return ""
    length, force = scene.units
    for one in scene.contacts:
        if not has_friction(one) or not one.k_v:
            continue
        size = max(one.k_u / one.k_v, one.k_v / one.k_u)
        if size > MESSAGES.unequal_springs:
            given = f"k_u = {one.k_u:.6g} and k_v = {one.k_v:.6g} {force}/{length}"
            return (
                f'contact "{one.name}": are {given} both right? They differ {size:.3g} times. Of metal faces '
                "k_u is mostly 0.5 to 1 times k_v"
            )
    return ""


def _stiffness_beside_structure(scene: Scene) -> FloatArray:
    """Ratio (contact,): the greater of k_u and k_v times the flexibility along the displacement."""
    springs = np.array([(one.k_u, one.k_v) for one in scene.contacts])
    ratio: FloatArray = (springs * contact_flexibility(scene)).max(axis=1)
    return ratio


def contact_flexibility(scene: Scene) -> FloatArray:
    """Flexibility (contact, 2) of the elastic modes along each contact's sliding direction and normal.

    For a planar contact the greater of both sliding directions is used. Displacements that are rounding
    compared with the greatest of any mode of mass 1 count as zero.
    """
    modal = scene.modal
    elastic = modal.frequency > 0.0

    def along(direction: FloatArray) -> float:
        moved = modal.shapes @ direction / np.sqrt(modal.mass)
        real = elastic & (np.abs(moved) > TOLERANCES.displacement * np.abs(moved).max(initial=0.0))
        return float(np.sum((moved[real] / modal.frequency[real]) ** 2))

    each = [[along(direction) for direction in one.directions] for one in scene.contacts]
    return np.array([(max(sliding), normal) for *sliding, normal in each]).reshape(-1, 2)
