"""The directions along which a contact slides: one, two at right angles in a plane, or none of a stop."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from fcm.model.scene import Contact, FloatArray, Scene
from fcm.rotational_dofs import is_rotation
from fcm.scene.errors import Mistakes, quoted, several
from fcm.scene.options import TOLERANCES
from fcm.scene.rules import as_float
from fcm.scene.section import Section

TWO = 'two directions at right angles, such as ["x", "y"], for one that slides in a plane'

Read = TypeVar("Read")


def read_directions(
    section: Section, read: Callable[[str], Read], part: Callable[[object, str], Read]
) -> dict[str, Read]:
    """The directions `tangential`, `normal`, and for a planar contact `second`, of the table of a contact.

    read takes what stands at a key, part a value of a list there; a list that is none of two is a mistake. A
    stop has its normal alone.
    """
    if is_stop(section):
        return {"normal": read("normal")}
    value = section.data.get("tangential")
    if not isinstance(value, list | tuple):
        return {key: read(key) for key in ("tangential", "normal")}
    if len(value) != 2:
        section.wrong("tangential", f"must be one direction, or {TWO}; is a list of {len(value)}")
        return {"normal": read("normal")}
    one, other = (part(item, f"tangential[{i}]") for i, item in enumerate(value))
    return {"tangential": one, "second": other, "normal": read("normal")}


def is_stop(section: Section) -> bool:
    """Whether a contact has no friction, and no direction along which friction would act.

    >>> from fcm.scene.errors import Mistakes
    >>> given = {"normal": "v", "mu": 0, "k_v": 5.0, "gap": 0.1}
    >>> [is_stop(Section(given | more, "contact[0]", Mistakes(""))) for more in ({}, {"tangential": "u"})]
    [True, False]
    """
    return "tangential" not in section.data and as_float(section.data.get("mu")) == 0.0


def check_axes(section: Section, directions: Mapping[str, Mapping[str, float]]) -> None:
    """Notes two directions, in axes of nodes, that are zero, not at right angles, or of different length."""
    one, other = (directions.get(key) for key in ("tangential", "second"))
    if not one or not other:
        return
    axes = sorted({*one, *other})
    a, b = (np.array([weights.get(axis, 0.0) for axis in axes]) for weights in (one, other))
    size = np.linalg.norm(a), np.linalg.norm(b)
    if not size[0] or not size[1]:
        section.wrong("tangential", "has a direction with only zero weights, so it moves nothing")
    elif abs(size[0] - size[1]) > TOLERANCES.written * max(size):
        section.wrong("tangential", "has directions " + _scales(float(size[1] / size[0])))
    elif abs(a @ b) > TOLERANCES.written * size[0] * size[1]:
        angle = np.degrees(np.arccos(min(abs(a @ b) / (size[0] * size[1]), 1.0)))
        section.wrong("tangential", f"must be {TWO}; these are {angle:.4g} degrees apart")


def check_plane(contact: Contact, dofs: Sequence[str], mistakes: Mistakes, where: str) -> None:
    """Notes two sliding directions of a contact that are parallel, or of different scale or unit."""
    one, other = contact.tangential, contact.second
    if other is None or not one.any() or not other.any():
        return
    name = f"the tangential directions of contact {quoted(contact.name)}"
    if axis_key(one) == axis_key(other):
        mistakes.add(where, f"{name} are one: no displacement distinguishes them; give {TWO}")
        return
    turns = [[is_rotation(dofs[int(d)]) for d in np.flatnonzero(direction)] for direction in (one, other)]
    if all(turns[0]) != all(turns[1]):
        about = quoted(dofs[int(np.flatnonzero(one if all(turns[0]) else other)[0])])
        mistakes.add(where, f"{name} are of different units: {about} is a rotation; give {TWO}")
        return
    sizes = [np.sort(np.abs(direction[direction != 0.0])) for direction in (one, other)]
    if sizes[0].size == sizes[1].size:
        ratio = sizes[1] / sizes[0]
        if (
            np.ptp(ratio) <= TOLERANCES.same_direction * ratio[0]
            and abs(ratio[0] - 1.0) > TOLERANCES.same_direction
        ):
            mistakes.add(where, f"{name} are {_scales(float(ratio[0]))}")


def notes_of_planes(scene: Scene) -> list[str]:
    """Notes on contacts whose two sliding directions share dofs without being at right angles."""
    oblique = [one.name for one in scene.contacts if _oblique(one)]
    if not oblique:
        return []
    names = several(oblique)
    contacts = "contact" if len(oblique) == 1 else "contacts"
    return [
        f"the two tangential directions of {contacts} {names} share degrees of freedom without being at "
        "right angles, if those are of right-angled axes. k_u and mu n are meant for two at right angles"
    ]


def _oblique(contact: Contact) -> bool:
    if contact.second is None:
        return False
    one, other = contact.tangential, contact.second
    return bool(abs(one @ other) > TOLERANCES.written * np.linalg.norm(one) * np.linalg.norm(other))


def _scales(ratio: float) -> str:
    return (
        f"of different scale, the second {ratio:.6g} times the first; both are displacements "
        "in the same unit, with weights of the same size"
    )


def axis_key(direction: FloatArray) -> bytes:
    """A key of a direction, which is the same for all directions that differ in sign and scale only."""
    largest: Any = direction[int(np.abs(direction).argmax())]
    return (
        (
            np.round(direction / largest / TOLERANCES.same_direction) * TOLERANCES.same_direction + 0.0
        ).tobytes()
        if largest
        else b""
    )
