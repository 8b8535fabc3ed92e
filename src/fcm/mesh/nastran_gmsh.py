"""Read meshes of Nastran and Gmsh: meshio reads the elements, this module the numbers of the nodes.

meshio keeps no numbers of nodes, but the order of the file. The file is refused if the coordinates that
meshio reads differ from those read here.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from fcm.mesh.mesh import FloatArray, Mesh, MeshError
from fcm.quoting import quoted

_EXPONENT = re.compile(r"(?<=[\d.])([+-]\d+)$")  # 1.5-3 of Nastran is 1.5e-3


def read_nastran(path: Path) -> Mesh:
    """The mesh of a bulk data file, whose GRID entries are in the basic coordinate system.

    Raises
    ------
    MeshError
        If a GRID is in another system, or meshio reads other nodes.
    """
    nodes, xyz = list[int](), list[list[float]]()
    lines = path.read_text("utf-8").splitlines()
    for number, line in enumerate(lines):
        if not line.upper().startswith("GRID"):
            continue
        fields = _fields(line, lines[number + 1] if number + 1 < len(lines) else "")
        try:
            if fields[1] not in ("", "0"):
                raise MeshError(
                    f"line {number + 1}: GRID {fields[0]} is in the coordinate system {fields[1]}; "
                    "write the nodes in the basic one"
                )
            nodes.append(int(fields[0]))
            xyz.append([float(_EXPONENT.sub(r"e\1", word)) if word else 0.0 for word in fields[2:5]])
        except (ValueError, IndexError) as error:
            if isinstance(error, MeshError):
                raise
            raise MeshError(
                f"line {number + 1}: {quoted(line.strip())} is no GRID that can be read"
            ) from None
    return _with_cells(path, nodes, xyz, "nastran")


def _fields(line: str, following: str) -> list[str]:
    """The fields of a GRID: its number, system and coordinates."""
    if "," in line:
        return [word.strip() for word in line.split(",")[1:6]] + [""] * 5
    if line[:8].rstrip().endswith("*"):
        whole = line[8:72].ljust(64) + following[8:72].ljust(64)
        return [whole[i : i + 16].strip() for i in range(0, 80, 16)]
    return [line[i : i + 8].strip() for i in range(8, 48, 8)]


def read_gmsh(path: Path) -> Mesh:
    """The mesh of a Gmsh file of version 2.2 or 4.1, as text.

    Raises
    ------
    MeshError
        If it is binary, of another version, or meshio reads other nodes.
    """
    text = path.read_bytes()
    head = re.search(rb"\$MeshFormat\s+(\S+)\s+(\d)", text)
    if head is None or head[2] != b"0":
        raise MeshError("it is no Gmsh file as text; write it with Mesh.Binary = 0")
    found = re.search(r"\$Nodes\s+(.*?)\$EndNodes", text.decode("utf-8"), re.S)
    if found is None:
        raise MeshError("it has no $Nodes")
    words, version = found[1].split(), head[1].decode()
    try:
        if version.startswith("2"):
            table = np.array(words[1:], dtype=np.float64).reshape(-1, 4)
            nodes, xyz = table[:, 0].astype(int).tolist(), table[:, 1:].tolist()
        elif version.startswith("4.1"):
            nodes, xyz = _by_entity(words)
        else:
            raise MeshError(f"it is of version {version}; write version 2.2 or 4.1")
    except (ValueError, IndexError) as error:
        if isinstance(error, MeshError):
            raise
        raise MeshError("its $Nodes are damaged") from None
    return _with_cells(path, nodes, xyz, "gmsh")


def _by_entity(words: list[str]) -> tuple[list[int], list[list[float]]]:
    """Nodes of version 4.1, which has for each entity first the numbers, then the coordinates."""
    nodes, xyz, at = list[int](), list[list[float]](), 4
    for _ in range(int(words[0])):
        count = int(words[at + 3])
        at += 4
        nodes += map(int, words[at : at + count])
        at += count
        xyz += np.array(words[at : at + 3 * count], dtype=np.float64).reshape(-1, 3).tolist()
        at += 3 * count
    return nodes, xyz


def _with_cells(path: Path, nodes: list[int], xyz: list[list[float]], kind: str) -> Mesh:
    """Mesh of given nodes with the elements that meshio finds."""
    own: FloatArray = np.array(xyz, dtype=np.float64).reshape(-1, 3)
    read = _read(path, kind)
    if read.points.shape != own.shape or not np.array_equal(read.points, own):
        raise MeshError("the numbers of its nodes are unknown: meshio reads other nodes")
    cells = tuple((str(one.type), np.asarray(one.data, dtype=np.intp)) for one in read.cells)
    return Mesh(tuple(nodes), own, cells)


def _read(path: Path, kind: str) -> Any:
    try:
        from meshio import gmsh, nastran
    except ModuleNotFoundError:
        raise MeshError("such a mesh is read by the package meshio: pip install meshio") from None
    try:
        return {"gmsh": gmsh, "nastran": nastran}[kind].read(path)
    except Exception as error:  # whatever meshio comes to, the file is at fault
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise MeshError(f"meshio cannot read it: {reason}") from None
