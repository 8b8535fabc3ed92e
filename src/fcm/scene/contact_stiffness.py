"""Contacts whose springs are far stiffer, or far softer, than the structure: mostly of another unit."""

from __future__ import annotations

import numpy as np

from fcm.model.question import Question
from fcm.model.scene import FloatArray, Scene, has_friction
from fcm.scene.contact_springs import stuck_stiffness
from fcm.scene.errors import several
from fcm.scene.force_reach import pushed
from fcm.scene.options import MESSAGES, TOLERANCES
from fcm.units import UNIT

SHORTER = {"m": "mm", "mm": "um"}  # by a thousand: a stiffness per shorter unit is a thousand times as much


def notes_of_stiffness(scene: Scene) -> list[str]:
    """Questions about contacts far stiffer than the structure at them, and about those that are far softer.

    The measure of stiff ones is k times the flexibility of the elastic modes along the contact's
    displacement, sum phi^2 / (m omega^2). Contacts are soft if they change no resonance up to the range's
    end while all of them stick. Where units are given, k_u and k_v of very different size are asked about.
    Nothing is said of rings, nor of stiffnesses that are swept, chosen or fitted.
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
    """Whether numbers whose paths end so are swept, chosen or fitted."""
    keys = [] if scene.draft is None else [one.key for one in scene.draft.swept]
    return any(key.endswith(ends) for key in keys) or are_sought(scene, *ends)


def are_sought(scene: Scene, *ends: str) -> bool:
    """Whether numbers whose paths end so are chosen or fitted."""
    tables = [one for one in (scene.optimum, scene.fit) if one is not None]
    return any(key.endswith(ends) for one in tables for key in one.vary)


def _soft(scene: Scene, ratio: float) -> str:
    """Question about contacts that change no resonance up to the range's end while they stick; or ''.

    Nothing where they would not even if the stiffest were as stiff as the structure there, by the ratio: then
    these resonances do not move them. Where rigid bodies float, motions that no force pushes are taken as
    held, as a damper's beside a blade: can friction change a resonance of the forces? Nothing where they push
    a rigid body that the contacts hold in resonance within the range, as on soft mounts.
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
    """Sentence on the usual slip of units by which stiffnesses are a thousand times too small; or ''.

    >>> _per_shorter("m", "N"), _per_shorter("", "")
    (' They are read in N/m; if they are in N/mm, write 1000 times as much', '')
    """
    if not force or length not in SHORTER:
        return ""
    read, shorter = f"{force}/{length}", f"{force}/{SHORTER[length]}"
    return f" They are read in {read}; if they are in {shorter}, write 1000 times as much"


def _unequal(scene: Scene) -> str:
    """Question about a contact whose springs differ as by a slip of units, where units are given; or ''."""
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
    """Displacement (contact, 2) per unit load, by elastic modes: where each contact slides, and its normal.

    Of a contact in a plane the greater one of both directions. Zero where it is rounding beside the greatest
    displacement of a mode of mass 1.
    """
    modal = scene.modal
    elastic = modal.frequency > 0.0

    def along(direction: FloatArray) -> float:
        moved = modal.shapes @ direction / np.sqrt(modal.mass)
        real = elastic & (np.abs(moved) > TOLERANCES.displacement * np.abs(moved).max(initial=0.0))
        return float(np.sum((moved[real] / modal.frequency[real]) ** 2))

    each = [[along(direction) for direction in one.directions] for one in scene.contacts]
    return np.array([(max(sliding), normal) for *sliding, normal in each]).reshape(-1, 2)
