"""A table of coordinates: a CSV file with the columns node, x, y, z."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from fcm.mesh.mesh import Mesh, MeshError

COLUMNS = ("node", "x", "y", "z")


def read_coordinates(path: Path) -> Mesh:
    """The nodes of a table; it has no elements.

    Raises
    ------
    MeshError
        With the line that is wrong, and what is wrong there.
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
            faults.append(f"line {number}: {line.strip()!r} is not a node and three coordinates")
    if faults:
        raise MeshError(*faults[:5])
    return Mesh(tuple(nodes), np.array(xyz, dtype=np.float64).reshape(-1, 3))
