"""Questions contact directions that do not have length 1, which scales stiffness and friction."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from math import hypot, isclose
from typing import NamedTuple

from fcm.model.question import Question
from fcm.model.scene import FloatArray
from fcm.rotational_dofs import is_rotation
from fcm.scene.errors import bare, quoted, several
from fcm.scene.names import Names, motion_of
from fcm.scene.options import TOLERANCES

Weights = Mapping[str, float]
_AXIS = re.compile(r"(.*[\d_:. ]u?)([xyz])", re.IGNORECASE)  # a node, and a translation of it


class GivenDirections(NamedTuple):
    """The directions of a contact as given in the scene: weights of dofs, or of axes at its nodes."""

    contact: str
    load: str  # n_0 or gap
    weights: Mapping[str, Weights]  # by tangential, second and normal
    dofs: Names
    node: str = ""  # one of the nodes, if weights are those of axes


def of_dofs(directions: Mapping[str, FloatArray | None], dofs: Names) -> dict[str, Weights]:
    """The weights of directions over degrees of freedom, without zeros, by their names."""
    return {
        key: {dofs[i]: float(one[i]) for i in one.nonzero()[0].tolist()}
        for key, one in directions.items()
        if one is not None
    }


def questions_of_lengths(contacts: Iterable[GivenDirections]) -> list[str]:
    """A question on the first contact with a direction that is not of length 1; it names the others.

    >>> blade = Names(("7x", "7y", "7z"))
    >>> given = GivenDirections("tip", "n_0", {"normal": {"x": 1.0, "y": 1.0}}, blade, "7")
    >>> (question,) = questions_of_lengths([given])
    >>> print(question[:70])
    contact "tip": is normal = { x = 1, y = 1 } meant? Its length is 1.414
    >>> questions_of_lengths([given._replace(weights={"normal": {"x": 0.6, "y": 0.8}})])
    []
    """
    asked = [(one.contact, said) for one in contacts if (said := _said(one))]
    if not asked:
        return []
    (first, said), others = asked[0], [name for name, _ in asked[1:]]
    also = f". The same of {several(others)}" if others else ""
    return [Question(f"contact {quoted(first)}: {said}{also}")]


def _said(contact: GivenDirections) -> str:
    """The question on the directions of a contact; empty if all have length 1."""
    said = []
    for key, number in (("tangential", "k_u"), ("normal", "k_v")):
        weights = contact.weights.get(key, {})
        length = _length(weights, contact.dofs, contact.node)
        if not length or isclose(length, 1.0, rel_tol=TOLERANCES.written):
            continue
        both = [weights]
        if key == "tangential" and "second" in contact.weights:
            both.append(contact.weights["second"])
        changes = f"{length**2:.6g} times {number}"
        if key == "tangential":
            changes += f" and {length:.6g} times mu"
        else:
            of_load = length if contact.load == "n_0" else 1.0 / length
            changes += f", {of_load:.6g} times {contact.load} and {1.0 / length:.6g} times mu"
        said.append(
            f"is {key} = {_written(both)} meant? Its length is {length:.6g}, so that the contact acts as one "
            f"of length 1 with {changes}. {_written(both, length)} is of length 1"
        )
    return "; ".join(said)


def _length(weights: Weights, dofs: Names, node: str = "") -> float:
    """The length of a direction; 0 if it is unknown.

    It is known for weights at one node, or of the relative motion of two. The weights of rotations are lever
    arms, and do not count. If a node has no row along an axis, a direction may lack that component, so that
    a length below 1 is unknown. It is also unknown for names without an axis: their degrees of freedom may
    not be perpendicular, and a weight such as 0.2 may be a lever arm.

    >>> dofs = Names(("1x", "1y", "1z", "1rz", "2x", "u", "v"))
    >>> _length({"1x": 1.0, "2x": -1.0}, dofs), _length({"1x": 3.0, "1y": 4.0, "1rz": 9.0}, dofs)
    (1.0, 5.0)
    >>> _length({"1x": 0.5, "2x": 0.5}, dofs), _length({"u": 1.0, "v": 1.0}, dofs)
    (0.0, 0.0)
    >>> _length({"1x": 0.5}, dofs), _length({"2x": 0.5}, dofs), _length({"2x": 2.0}, dofs)
    (0.5, 0.0, 2.0)
    >>> _length({"n1_ux": 0.3, "n1_uy": 0.4}, Names(("n1_ux", "n1_uy", "n1_uz")))
    0.5
    """
    at: dict[str, dict[str, float]] = {}  # weights by node and axis
    for name, weight in weights.items():
        if node:
            match = _AXIS.fullmatch(f"{node}_{name}")
        elif (match := _AXIS.fullmatch(motion_of(name) or name)) is None and not is_rotation(name):
            return 0.0
        if match:
            at.setdefault(match[1], {})[match[2].lower()] = weight
    if not at:
        return 0.0
    first, *others = at.values()
    opposite = {axis: -weight for axis, weight in first.items()}
    if len(others) > 1 or (others and others[0] != opposite):
        return 0.0
    length = hypot(*first.values())
    names = [(f"{one}{axis}", f"{node or one}{axis}") for one in at for axis in "xyz"]
    complete = all(dofs.find(name) or dofs.find(other) for name, other in names)
    return length if complete or length >= 1.0 else 0.0


def _written(directions: Sequence[Weights], length: float = 1.0) -> str:
    """Directions divided by a length, as written in a scene."""
    each = [
        f"{{ {', '.join(f'{bare(name)} = {weight / length:.6g}' for name, weight in one.items())} }}"
        for one in directions
    ]
    return each[0] if len(each) == 1 else f"[{', '.join(each)}]"
