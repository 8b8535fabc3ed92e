"""Read input files of CalculiX and Abaqus: *NODE, *ELEMENT, *NSET, *INCLUDE; others are ignored."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fcm.mesh.mesh import Mesh, MeshError
from fcm.quoting import quoted

_SHAPES = {  # by the name of an element, which letters for its formulation may follow
    "C3D4": ("tetra", 4), "C3D10": ("tetra10", 10), "C3D8": ("hexahedron", 8), "C3D20": ("hexahedron20", 20),
    "C3D6": ("wedge", 6), "C3D15": ("wedge15", 15), "S3": ("triangle", 3), "S6": ("triangle6", 6),
    "S4": ("quad", 4), "S8": ("quad8", 8), "M3D3": ("triangle", 3), "M3D4": ("quad", 4),
    "CPS3": ("triangle", 3), "CPE3": ("triangle", 3), "CPS4": ("quad", 4), "CPE4": ("quad", 4),
    "CPS6": ("triangle6", 6), "CPE6": ("triangle6", 6), "CPS8": ("quad8", 8), "CPE8": ("quad8", 8),
    "B31": ("line", 2), "B32": ("line3", 3), "T3D2": ("line", 2), "T3D3": ("line3", 3),
}  # fmt: skip
_KIND = re.compile("(" + "|".join(sorted(_SHAPES, key=len, reverse=True)) + r")[A-Z]*5?", re.ASCII)


class _Deck:
    """Contents of a deck read so far."""

    def __init__(self) -> None:
        self.xyz: dict[int, list[float]] = {}
        self.elements: dict[str, list[list[int]]] = {}
        self.sets: dict[str, dict[int, None]] = {}
        self.lacking: dict[str, None] = {}


def read_abaqus(path: Path) -> Mesh:
    """Read the mesh of a flat input file: one without *INSTANCE, which numbers nodes by part.

    Raises
    ------
    MeshError
        With the faulty line and its fault.
    """
    deck = _Deck()
    for keyword, options, where, rows in _blocks(path):
        if keyword == "INSTANCE":
            raise MeshError(
                f"{where}: *INSTANCE numbers nodes by part; write the input flat, as "
                "*PREPRINT, MODEL=YES or your mesher does"
            )
        if keyword == "NODE":
            _nodes(deck, options, where, rows)
        elif keyword == "ELEMENT":
            _elements(deck, options, where, rows)
        elif keyword == "NSET":
            _set(deck, options, where, rows)
    place = {node: i for i, node in enumerate(deck.xyz)}
    cells = []
    for shape, elements in deck.elements.items():
        unknown = next((node for one in elements for node in one if node not in place), None)
        if unknown is not None:
            raise MeshError(f"an element has node {unknown}, of which it gives no coordinates")
        cells.append((shape, np.array([[place[node] for node in one] for one in elements], dtype=np.intp)))
    xyz = np.array(list(deck.xyz.values()), dtype=np.float64).reshape(-1, 3)
    sets = {name: tuple(found) for name, found in deck.sets.items()}
    return Mesh(tuple(deck.xyz), xyz, tuple(cells), sets, tuple(deck.lacking))


def _blocks(
    path: Path, within: tuple[Path, ...] = ()
) -> Iterator[tuple[str, dict[str, str], str, list[list[str]]]]:
    """Yield each keyword with its options, its line, and the words of its data lines.

    Comments may be in any encoding. `within` are the files that include this one.
    """
    if path.resolve() in within:
        raise MeshError("its files include one another")
    keyword, options, where, rows = "", dict[str, str](), "", list[list[str]]()
    for number, line in enumerate(path.read_text("utf-8", errors="replace").splitlines(), 1):
        if line.startswith("**") or not line.strip():
            continue
        if not line.startswith("*"):
            rows.append([word.strip() for word in line.split(",")])
            continue
        if keyword:
            yield keyword, options, where, rows
        head, *more = (word.strip() for word in line[1:].split(","))
        pairs = (word.partition("=") for word in more if word)
        options = {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
        keyword, where, rows = head.upper(), f"line {number}", []
        if within:
            where = f"{path.name}, {where}"
        if keyword == "INCLUDE":
            inner = path.parent / options.get("INPUT", "")
            if not inner.is_file():
                raise MeshError(f"{where}: includes {quoted(inner.name)}, which is not there")
            yield from _blocks(inner, (*within, path.resolve()))
            keyword = ""
    if keyword:
        yield keyword, options, where, rows


def _nodes(deck: _Deck, options: dict[str, str], where: str, rows: list[list[str]]) -> None:
    found: list[int] = []
    for row in rows:
        try:
            node, xyz = int(row[0]), [float(word) if word else 0.0 for word in row[1:4]]
        except ValueError:
            raise MeshError(
                f"{where}: *NODE has the line {quoted(','.join(row))}: a node has a number and coordinates"
            ) from None
        if node in deck.xyz:
            raise MeshError(f"{where}: node {node} is given a second time")
        deck.xyz[node] = [*xyz, *[0.0] * (3 - len(xyz))]
        found.append(node)
    if "NSET" in options:
        deck.sets.setdefault(options["NSET"].upper(), {}).update(dict.fromkeys(found))


def _elements(deck: _Deck, options: dict[str, str], where: str, rows: list[list[str]]) -> None:
    kind = options.get("TYPE", "").upper()
    match = _KIND.fullmatch(kind)
    if match is None:
        deck.lacking[kind or "without a type"] = None
        return
    shape, count = _SHAPES[match[1]]
    words = [word for row in rows for word in row if word]
    try:
        numbers = np.array([int(word) for word in words]).reshape(-1, 1 + count)
    except ValueError:
        raise MeshError(
            f"{where}: *ELEMENT of type {kind} has {count} nodes behind each number; these lines do not"
        ) from None
    deck.elements.setdefault(shape, []).extend(numbers[:, 1:].tolist())


def _set(deck: _Deck, options: dict[str, str], where: str, rows: list[list[str]]) -> None:
    name = options.get("NSET", "").upper()
    found = deck.sets.setdefault(name, {})
    try:
        if "GENERATE" in options:
            for row in rows:
                first, last, *step = (int(word) for word in row if word)
                found.update(dict.fromkeys(range(first, last + 1, step[0] if step else 1)))
            return
        for word in (word for row in rows for word in row if word):
            others = deck.sets.get(word.upper())
            found.update(others if others is not None else {int(word): None})
    except ValueError:
        raise MeshError(
            f"{where}: *NSET {name} must hold numbers of nodes, or names of sets before it"
        ) from None
