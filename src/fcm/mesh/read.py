"""Read a mesh from a file; the ending of its name tells its kind."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np

from fcm.mesh.abaqus import read_abaqus
from fcm.mesh.mesh import Mesh, MeshError
from fcm.mesh.nastran_gmsh import read_gmsh, read_nastran
from fcm.quoting import quoted

COLUMNS = ("node", "x", "y", "z")


def read_coordinates(path: Path) -> Mesh:
    """Read the nodes of a CSV table node,x,y,z; the mesh has no elements.

    Raises
    ------
    MeshError
        With the first five faulty lines.
    """
    lines = path.read_text("utf-8-sig").splitlines()
    rows = [(number, line.partition("#")[0]) for number, line in enumerate(lines, 1)]
    rows = [(number, line) for number, line in rows if line.strip()]
    if not rows:
        raise MeshError("it is empty; its first line must name the columns node,x,y,z")
    heads = [word.strip().lower() for word in next(csv.reader([rows[0][1]]))]
    if any(heads.count(one) != 1 for one in COLUMNS):
        raise MeshError(f"line {rows[0][0]} must name the columns node,x,y,z; it names {', '.join(heads)}")
    places = [heads.index(one) for one in COLUMNS]
    nodes, xyz, faults = list[int](), list[list[float]](), list[str]()
    for number, line in rows[1:]:
        words = next(csv.reader([line]))
        try:
            if len(words) != len(heads):
                raise ValueError
            node, *where = (words[place].strip() for place in places)
            nodes.append(int(node))
            xyz.append([float(word) for word in where])
        except ValueError:
            faults.append(f"line {number}: {quoted(line.strip())} is not a node and three coordinates")
    if faults:
        raise MeshError(*faults[:5])
    return Mesh(tuple(nodes), np.array(xyz, dtype=np.float64).reshape(-1, 3))


_READERS: dict[str, Callable[[Path], Mesh]] = {
    ".inp": read_abaqus,
    ".bdf": read_nastran,
    ".nas": read_nastran,
    ".msh": read_gmsh,
    ".csv": read_coordinates,
}
ENDINGS = tuple(_READERS)


def read_mesh(path: Path) -> Mesh:
    """The nodes of a mesh with their own numbers, and its elements.

    Raises
    ------
    MeshError
        If the file is of an unknown kind, is damaged, or lacks the numbers of its nodes.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise MeshError(f"a mesh is a file that ends in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    try:
        mesh = reader(path)
    except UnicodeDecodeError:
        raise MeshError("it is no text in UTF-8; write it as text, not binary") from None
    if not mesh.nodes:
        raise MeshError("it holds no node")
    if not np.isfinite(mesh.xyz).all():
        raise MeshError("it has a node whose coordinates are no numbers")
    if len(mesh.place) < len(mesh.nodes):
        raise MeshError("it has two nodes of one number")
    return mesh
