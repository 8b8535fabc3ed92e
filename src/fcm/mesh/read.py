"""A mesh from a file of one of the kinds that are known, by the end of its name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from fcm.mesh.abaqus import read_abaqus
from fcm.mesh.coordinates import read_coordinates
from fcm.mesh.mesh import Mesh, MeshError
from fcm.mesh.nastran_gmsh import read_gmsh, read_nastran

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
        If the file is of no kind that is known, damaged, or does not say the numbers of its nodes.
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
