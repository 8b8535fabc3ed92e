"""Notes on the normals of contacts: shared normals, and normals that slip moves along."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.model.scene import Contact, FloatArray, Scene
from fcm.rotational_dofs import is_rotation
from fcm.scene.errors import bare, counted, quoted, several, shown
from fcm.scene.options import MESSAGES, TOLERANCES
from fcm.scene.plane import axis_key


def note_of_shared_normals(scene: Scene) -> list[str]:
    """Notes on contacts with the same normal displacement, up to scale, and different tangential ones.

    Each of them carries its whole preload and normal stiffness, and the place all of them together. Nothing
    is said where at most one has a preload or a normal stiffness, where the tangential displacements are the
    same, as of several layers, nor of opposite normals, as of the two faces of a shroud.
    """
    groups: dict[tuple[bytes, bool], list[Contact]] = {}
    for contact in scene.contacts:
        if contact.normal.any():
            forward = bool(contact.normal[int(np.abs(contact.normal).argmax())] > 0.0)
            groups.setdefault((axis_key(contact.normal), forward), []).append(contact)
    doubled = [group for group in groups.values() if _counts_twice(group)]
    if not doubled:
        return []
    names = "; ".join(several([one.name for one in group]) for group in doubled[: MESSAGES.groups])
    more = f"; {counted(len(doubled), 'such place')} in all" if len(doubled) > MESSAGES.groups else ""
    return [
        f"contacts {names} have the same normal displacement and different tangential ones{more}. Their "
        f"preloads and normal stiffnesses add up there, as those of several contacts side by side"
        f"{_instead(scene, doubled[0])}"
    ]


def _instead(scene: Scene, group: list[Contact]) -> str:
    """Hint on how to write two contacts on lines as one planar contact; empty if one is planar already."""
    if any(one.second is not None for one in group):
        return ""
    one, other = _two_directions(scene, group)
    return (
        ". If it is one contact that slides in a plane, write it once with two directions, as in "
        f"tangential = [{one}, {other}]"
    )


def _two_directions(scene: Scene, group: list[Contact]) -> list[str]:
    """The first two different friction directions as written in a scene: axes of node pairs, or dofs."""
    along = {axis_key(one.tangential): one for one in group if one.mu > 0.0 and one.tangential.any()}
    first, second = list(along.values())[:2]
    drafts = () if scene.draft is None else scene.draft.parts["contact"]
    of_pairs = {one["name"] for one in drafts if "group" in one}
    if {first.name, second.name} <= of_pairs:
        return [quoted("x"), quoted("y")]
    return [as_written(one.tangential, scene.modal.dofs) for one in (first, second)]


def as_written(direction: FloatArray, dofs: Sequence[str]) -> str:
    """A direction (dof,) as written in a scene: a degree of freedom, or a table of weights.

    >>> as_written(np.array([1.0, 0.0]), ["1x", "1y"]), as_written(np.array([1.0, -0.5]), ["1x", "y"])
    ('"1x"', '{ "1x" = 1, y = -0.5 }')
    """
    at = np.flatnonzero(direction).tolist()
    if len(at) == 1 and direction[at[0]] == 1.0:
        return quoted(dofs[at[0]])
    return "{ " + ", ".join(f"{bare(dofs[i])} = {shown(float(direction[i]))}" for i in at) + " }"


def notes_of_slopes(scene: Scene) -> list[str]:
    """Notes on contacts whose slip has a component along their normal, as on the slope of a wedge.

    Often the cause is a name written twice, or a wrong angle. There is no note for a constant normal load
    (k_v = 0), nor without friction.
    """
    rubbing = (one for one in scene.contacts if one.k_v * one.k_u * one.mu != 0.0)
    translations = np.array([not is_rotation(dof) for dof in scene.modal.dofs])
    sloping = [(one.name, angle) for one in rubbing if (angle := _slope(one, translations)) > 0.0]
    own = [name for name, angle in sloping if angle == 90.0]
    angles = {name: angle for name, angle in sloping if angle < 90.0}
    means = "slip changes the normal load, as on the slope of a wedge"
    helps = "If that is not meant, give another normal"
    notes = []
    if own:
        slides = "contact {} slides along its" if len(own) == 1 else "contacts {} slide along their"
        notes.append(
            f"{slides.format(several(own))} normal displacement: {means}. {helps}, or k_v = 0 where the load "
            "is constant"
        )
    if angles:
        worst = max(angles, key=lambda name: angles[name])
        contacts = "contact {}: its normal is" if len(angles) == 1 else "contacts {}: their normals are"
        notes.append(
            f"{contacts.format(several(list(angles)))} not at right angles to the sliding, by "
            f"{angles[worst]:.2g} degrees{' at most' if len(angles) > 1 else ''}: {means}. {helps}"
        )
    return notes


def _slope(contact: Contact, translations: npt.NDArray[np.bool_]) -> float:
    """The angle [degrees] by which the normal leans to the tangential displacements; 0 at right angles.

    The weights of degrees of freedom are taken as those of right-angled axes. Weights of rotations are lever
    arms, and do not count beside translations (dof,). With the part of the normal :math:`P n` that is a
    combination of the tangential ones the angle is :math:`\\arcsin(|P n| / |n|)`.
    """
    sliding, normal = np.stack(contact.directions[:-1], axis=1), contact.normal
    if sliding[translations].any() and normal[translations].any():
        sliding, normal = sliding[translations], normal[translations]
    if not normal.any() or not sliding.any():
        return 0.0
    along = sliding @ np.linalg.lstsq(sliding, normal, rcond=None)[0]
    if np.abs(along - normal).max() <= TOLERANCES.same_direction * np.abs(normal).max():
        return 90.0
    sine = min(float(np.linalg.norm(along) / np.linalg.norm(normal)), 1.0)
    return float(np.degrees(np.arcsin(sine))) if sine > TOLERANCES.right_angle else 0.0


def _counts_twice(group: list[Contact]) -> bool:
    """Whether several contacts with one normal carry normal loads and have different friction directions."""
    carrying = [one for one in group if one.n_0 != 0.0 or one.k_v != 0.0]
    return len({tuple(map(axis_key, one.directions[:-1])) for one in carrying if one.mu > 0.0}) > 1
