"""Node pairs with places from a mesh: { sets = , mesh = , tolerance = }, or { pairs = , mesh = }."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fcm.mesh import Mesh, MeshError, read_mesh
from fcm.mesh.pairing import (
    MOST_NAMED,
    PAIRING,
    Plane,
    across,
    beyond,
    fitted_plane,
    nearest_partners,
    outward,
    paired,
    side,
    turned,
)
from fcm.model.interface import FloatArray, Interface
from fcm.model.question import Question
from fcm.scene.errors import choices, counted, quoted
from fcm.scene.files import DataFileError, Files
from fcm.scene.keys import names
from fcm.scene.options import MESSAGES, TOLERANCES
from fcm.scene.pair_file import PairTable
from fcm.scene.rules import POSITIVE, as_float
from fcm.scene.section import Section, described

FITTED = "fitted"  # value of a direction that is taken from a fitted plane
AXES = ("x", "y", "z")
_WORDS = re.compile(r"[\s,;]+")


def pairs_of_sets(section: Section, files: Files) -> PairTable:
    """The pairs of nodes of two sets, or the nodes of one set at the ground; none after a mistake."""
    found = section.table("nodes", "")
    if found is None:
        return PairTable([])
    found.only(*names("contact.nodes"))
    before = section.mistakes.count
    mesh = _mesh(found, files)
    sets = _sets(found, files, mesh)
    tolerance = found.number("tolerance", POSITIVE) if len(sets) != 1 else 0.0
    if section.mistakes.count > before or mesh is None:
        return PairTable([])
    if len(sets) == 1:
        ((name, nodes),) = sets
        here = mesh.at(nodes)
        plane = _plane(section, mesh, nodes)
        interface = Interface(section.data.get("name", ""), here, here, (name,), plane=plane)
        said = [*_said_of_plane(section, interface, plane), *_said_of_side(section, mesh, nodes)]
        return PairTable([(str(node),) for node in nodes], interface=interface, said=tuple(said))
    (one, first), (other, second) = sets
    try:
        pairing = paired(mesh, first, second, tolerance)
    except MeshError as error:
        for fault in error.faults:
            found.wrong("sets", fault)
        return PairTable([])
    plane = _plane(section, mesh, pairing.pairs)
    a, b = zip(*pairing.pairs, strict=True)
    interface = Interface(
        section.data.get("name", ""),
        mesh.at(a),
        mesh.at(b),
        (one, other),
        mesh.at(pairing.alone) if pairing.alone else np.zeros((0, 3)),
        mesh.at(pairing.other_alone) if pairing.other_alone else np.zeros((0, 3)),
        plane,
    )
    text = (
        f"contact {quoted(interface.name)}: {counted(len(a), 'pair')}, {_places(pairing.apart, mesh.at(a))}"
    )
    for name, alone in ((one, pairing.alone), (other, pairing.other_alone)):
        if alone:
            text += f"; {counted(len(alone), 'node')} of {name} without a partner ({_some(alone)})"
    said = [text, *_said_of_plane(section, interface, plane)]
    said += _said_of_side(section, mesh, pairing.pairs, (one, other))
    return PairTable([tuple(map(str, pair)) for pair in pairing.pairs], interface=interface, said=tuple(said))


def _places(apart: FloatArray, first: FloatArray) -> str:
    """Clause on the distances of partners (pair,) and on the extent of the first nodes (pair, 3).

    It is in the unit of the coordinates, to reveal one that differs from that of the matrices.

    >>> corners = np.array([[150.0, 0.0, 2.0], [240.0, 20.0, 2.0]])
    >>> _places(np.zeros(2), corners)
    'of coincident nodes, over 90 by 20 of the coordinates'
    >>> _places(np.array([0.0, 0.2]), corners[:1])
    '0 to 0.2 apart'
    """
    ends = dict.fromkeys(f"{one:.3g}" for one in (apart.min(), apart.max()))
    said = f"{' to '.join(ends)} apart" if apart.max() > 0.0 else "of coincident nodes"
    reach = sorted(np.ptp(first, axis=0).tolist(), reverse=True)
    lengths = [f"{one:.3g}" for one in reach if one > TOLERANCES.placed * reach[0]]
    return said + (f", over {' by '.join(lengths)} of the coordinates" if lengths else "")


def with_places(section: Section, found: Section, table: PairTable, files: Files) -> PairTable:
    """Pairs of a file with the places of their nodes in a mesh, and notes on them."""
    found.only(*names("contact.nodes"))
    if "sets" in found.data:
        found.wrong("", "has both sets and pairs; give one of them")
    tolerance = found.number("tolerance", POSITIVE) if "tolerance" in found.data else np.inf
    mesh = _mesh(found, files)
    if mesh is None:
        return table
    words = dict.fromkeys(node for pair in table.pairs for node in pair)
    lacking = [node for node in words if not node.isdecimal() or int(node) not in mesh.place]
    if lacking:
        some = ", ".join(lacking[:MOST_NAMED]) + (", ..." if len(lacking) > MOST_NAMED else "")
        found.wrong("pairs", f"has nodes that the mesh has not: {some}")
        return table
    pairs = [tuple(map(int, pair)) for pair in table.pairs]
    name = section.data.get("name", "")
    first, second = mesh.at(tuple(pair[0] for pair in pairs)), mesh.at(tuple(pair[-1] for pair in pairs))
    couples = [(pair[0], pair[1]) for pair in pairs if len(pair) > 1]
    plane = _plane(section, mesh, couples or tuple(pair[0] for pair in pairs))
    interface = Interface(name, first, second, plane=plane)
    said = [*_said_of_places(name, table, first, second), *_said_of_plane(section, interface, plane)]
    if not couples:
        said += _said_of_side(section, mesh, tuple(pair[0] for pair in pairs))
        return replace(table, interface=interface, said=tuple(said))
    said += _said_of_side(section, mesh, couples)
    apart = np.linalg.norm(
        mesh.at(tuple(a for a, _ in couples)) - mesh.at(tuple(b for _, b in couples)), axis=1
    )
    high, far = float(apart.max()), couples[int(apart.argmax())]
    if high > tolerance:
        found.wrong("tolerance", f"nodes {far[0]} and {far[1]} are {high:.4g} apart, more than {tolerance:g}")
    text = f"contact {quoted(name)}: {counted(len(couples), 'pair')}, {_places(apart, first)}"
    others = [
        (pair, near) for pair, near in zip(couples, nearest_partners(mesh, couples), strict=True) if near
    ]
    if others:
        (one, other), near = others[0]
        many = "1 pair is" if len(others) == 1 else f"{len(others)} pairs are"
        text = Question(
            f"{text}. {many} not of nearest nodes: {near} is nearer to {one} than its partner {other}. "
            "Is a column of the file shifted?"
        )
    return replace(table, interface=interface, said=(text, *said))


def _said_of_places(name: str, table: PairTable, first: FloatArray, second: FloatArray) -> Iterator[Question]:
    """Question on coordinates of the file that are not on the line between a pair's nodes in the mesh."""
    if table.places is None:
        return
    along = second - first
    length = np.maximum(np.sum(along**2, axis=1), np.finfo(float).tiny)
    part = np.clip(np.sum((table.places - first) * along, axis=1) / length, 0.0, 1.0)
    off = np.linalg.norm(table.places - first - part[:, None] * along, axis=1)
    size = np.linalg.norm(np.ptp(np.concatenate((first, second)), axis=0)) or np.abs(first).max()
    wrong = np.flatnonzero(off > TOLERANCES.placed * size)
    if wrong.size:
        worst = int(off.argmax())
        there, meant = (", ".join(f"{x:g}" for x in where[worst]) for where in (table.places, first))
        many = "1 pair is" if wrong.size == 1 else f"{wrong.size} pairs are"
        yield Question(
            f"contact {quoted(name)}: by the coordinates of the file {many} not where the mesh has its "
            f"nodes. Node {table.pairs[worst][0]} is at {there} in the file, and at {meant} in the mesh, "
            "which is used. Are both in the same unit, and of the same nodes?"
        )


def with_fitted(section: Section, table: PairTable) -> Section:
    """The table of a contact with the value "fitted" replaced by directions.

    A fitted normal is that of the plane of the pairs. Fitted tangential directions are at right angles to the
    normal, which may be fitted or given.
    """
    normal, tangential = (section.data.get(key) for key in ("normal", "tangential"))
    data = dict(section.data)
    if normal == FITTED:
        data["normal"] = AXES[2]  # placeholder if there is no plane
        plane = None if table.interface is None else table.interface.plane
        if plane is not None:
            data["normal"] = _weights(plane.normal)
            _check_right_angle(section, tangential, plane)
        elif table.pairs and table.interface is None:
            section.wrong(
                "normal",
                "is fitted to pairs with nodes in a mesh. Write nodes = { sets = , mesh = , tolerance = } or "
                "{ pairs = , mesh = }",
            )
    if tangential == FITTED:
        along = _vector(data.get("normal"))
        if along is None:
            section.wrong(
                "tangential", "is fitted where normal is, or has weights of x, y, z; give a direction"
            )
            along = np.array([0.0, 0.0, 1.0])
        data["tangential"] = [_weights(one) for one in across(along)]
    return Section(data, section.path, section.mistakes)


def _check_right_angle(section: Section, tangential: Any, plane: Plane) -> None:
    """Notes a given tangential direction that is not in the fitted plane."""
    for one in tangential if isinstance(tangential, list | tuple) else [tangential]:
        along = _vector(one)
        if along is None:
            continue
        part = along - (along @ plane.normal) * plane.normal
        if np.linalg.norm(part) < (1.0 - TOLERANCES.square) * np.linalg.norm(along):
            angle = np.degrees(np.arccos(np.linalg.norm(part) / np.linalg.norm(along)))
            terms = ", ".join(f"{axis} = {x:.6g}" for axis, x in zip(AXES, part, strict=True))
            section.wrong(
                "tangential",
                f"is {angle:.3g} degrees out of the fitted plane; its part in it is {{ {terms} }}; "
                'or write "fitted"',
            )


def _vector(value: Any) -> np.ndarray[Any, Any] | None:
    """A direction such as "x" or weights of x, y, z, as (3,); None if it is invalid or zero."""
    terms = {value: 1.0} if isinstance(value, str) else value
    if not isinstance(terms, Mapping) or not terms or not set(terms) <= set(AXES):
        return None
    numbers = [as_float(terms.get(axis, 0.0)) for axis in AXES]
    found = np.array([np.nan if one is None else one for one in numbers])
    return found if np.isfinite(found).all() and found.any() else None


def _plane(section: Section, mesh: Mesh, pairs: Sequence[tuple[int, int]] | tuple[int, ...]) -> Plane | None:
    """The fitted plane of pairs or of nodes at the ground; None if no fitted normal is requested.

    Its normal points from the first side to the second, or out of the structure of nodes at the ground.
    """
    if section.data.get("normal") != FITTED:
        return None
    nodes = [one for one in pairs if isinstance(one, int)]
    couples = [one for one in pairs if not isinstance(one, int)]
    try:
        if nodes:
            return outward(fitted_plane(mesh.at(tuple(nodes))), mesh, nodes)
        a, b = zip(*couples, strict=True)
        return turned(fitted_plane(0.5 * (mesh.at(a) + mesh.at(b))), mesh, couples)
    except MeshError as error:
        section.wrong("normal", f"cannot be fitted: {error}; give a direction")
        return None


def _said_of_plane(section: Section, interface: Interface, plane: Plane | None) -> list[str]:
    """Note on the fitted normal and the flatness of the pairs; or a question on a given normal that leans."""
    if plane is None or section.data.get("normal") != FITTED:
        return _said_of_lean(section, interface)
    near = int(np.abs(plane.normal).argmax())
    angle = np.degrees(np.arccos(min(float(np.abs(plane.normal[near])), 1.0)))
    terms = " ".join(
        f"{weight:+.4g} {axis}" for axis, weight in zip(AXES, plane.normal, strict=True) if weight
    )
    text = f"contact {quoted(interface.name)}: normal {terms}, {angle:.3g} degrees from {AXES[near]}"
    return [f"{text}; its nodes are within {plane.off:.3g} of their plane, {plane.size:.4g} wide"]


def _said_of_lean(section: Section, interface: Interface) -> list[str]:
    """Question on a given normal that leans relative to that of the flat face of the pairs."""
    along = _vector(section.data.get("normal"))
    try:
        plane = fitted_plane(0.5 * (interface.first + interface.second))
    except MeshError:
        return []
    if along is None or plane.off > MESSAGES.flat_face * plane.size:
        return []
    angle = np.degrees(np.arccos(min(float(abs(along @ plane.normal) / np.linalg.norm(along)), 1.0)))
    if angle <= MESSAGES.leaning_normal:
        return []
    return [
        Question(
            f"contact {quoted(interface.name)}: its normal leans by {angle:.2g} degrees from that of the "
            'plane in which its nodes lie. Is it meant? normal = "fitted" takes that of the plane'
        )
    ]


def _said_of_side(
    section: Section,
    mesh: Mesh,
    pairs: Sequence[tuple[int, int]] | tuple[int, ...],
    sides: tuple[str, str] = ("its first nodes", "the others"),
) -> list[str]:
    """Question on a given normal with the wrong sense.

    It should point from the first side of pairs to the second, or out of the body of nodes at the ground.
    There is no question if neither places nor elements show the sides.
    """
    along = _vector(section.data.get("normal"))
    if along is None or not pairs:
        return []
    couples = [one for one in pairs if not isinstance(one, int)]
    nodes = [one for one in pairs if isinstance(one, int)]
    far = side(mesh, couples, along) if couples else beyond(mesh, nodes, along)
    ends = mesh.at(tuple(node for pair in couples for node in pair) or tuple(nodes))
    size = float(np.ptp(ends, axis=0).max()) * float(np.linalg.norm(along))
    if far >= -PAIRING.side_tolerance * size:
        return []
    points = f"from {sides[1]} to {sides[0]}" if couples else "into the elements at its nodes"
    where = "they part" if couples else "these leave the ground"
    return [
        Question(
            f"contact {quoted(section.data.get('name', ''))}: its normal points {points}, so that it presses "
            f"where {where}: is it meant? The other way it would be the opposite"
        )
    ]


def _weights(direction: np.ndarray[Any, Any]) -> dict[str, float]:
    return {axis: float(x) for axis, x in zip(AXES, direction, strict=True) if x}


def _mesh(found: Section, files: Files) -> Mesh | None:
    name = found.text("mesh")
    if not name:
        return None
    try:
        with files.opened(name) as path:
            try:
                return read_mesh(path)
            except MeshError as error:
                raise DataFileError(*(f"{quoted(name)}: {fault}" for fault in error.faults)) from None
    except DataFileError as error:
        for fault in error.faults:
            found.wrong("mesh", fault)
    return None


def _sets(found: Section, files: Files, mesh: Mesh | None) -> list[tuple[str, tuple[int, ...]]]:
    """The names and nodes of one or two sets; none after a mistake."""
    value = found.data.get("sets")
    if isinstance(value, str):
        value = [value]
    right = (
        isinstance(value, list | tuple) and 1 <= len(value) <= 2 and all(isinstance(x, str) for x in value)
    )
    if not right:
        what = "missing" if value is None else f"is {described(value)}"
        found.wrong("sets", f'{what}; give two sets, as ["LEFT", "RIGHT"], or one that touches the ground')
        return []
    assert value is not None
    each = [(name, _set(found, name, files, mesh)) for name in value]
    return [(name, nodes) for name, nodes in each if nodes] if all(nodes for _, nodes in each) else []


def _set(found: Section, name: str, files: Files, mesh: Mesh | None) -> tuple[int, ...]:
    """The nodes of a set of the mesh, or of a file of node numbers; none after a mistake."""
    if mesh is None:
        return ()
    nodes = mesh.sets.get(name.upper())
    if nodes is None and not (files.folder / name).is_file():
        there = f"its sets are {choices(list(mesh.sets))}" if mesh.sets else "it has no sets"
        found.wrong("sets", f"{quoted(name)} is no set of the mesh, and no file: {there}", name, mesh.sets)
        return ()
    if nodes is None:
        nodes = _of_file(found, name, files)
    elif not nodes:
        found.wrong("sets", f"{quoted(name)} is empty")
    lacking = [node for node in nodes if node not in mesh.place]
    if lacking:
        found.wrong("sets", f"{quoted(name)} has nodes that the mesh has not: {_some(lacking)}")
        return ()
    return tuple(dict.fromkeys(nodes))


def _of_file(found: Section, name: str, files: Files) -> tuple[int, ...]:
    """The node numbers in a file, with any separators; lines of keywords and comments are skipped."""
    nodes: list[int] = []
    try:
        with files.opened(name) as path:
            for number, line in enumerate(path.read_text("utf-8-sig").splitlines(), 1):
                body = line.partition("#")[0].strip()
                if body.startswith("*"):
                    continue
                for word in filter(None, _WORDS.split(body)):
                    if not word.isdecimal():
                        raise DataFileError(
                            f"{quoted(name)}, line {number}: {quoted(word)} is no number of a node"
                        )
                    nodes.append(int(word))
            if not nodes:
                raise DataFileError(f"{quoted(name)} holds no node")
    except DataFileError as error:
        for fault in error.faults:
            found.wrong("sets", fault)
        return ()
    return tuple(nodes)


def _some(nodes: Sequence[int]) -> str:
    return ", ".join(map(str, nodes[:MOST_NAMED])) + (", ..." if len(nodes) > MOST_NAMED else "")
