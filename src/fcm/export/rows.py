"""Displacements of every row of a structure, and the place of each row on a mesh."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.mesh import Mesh
from fcm.model.ring import NEXT
from fcm.model.scene import Scene
from fcm.results.motions import ComplexArray, ResponseMotion
from fcm.scene.errors import choices, counted
from fcm.scene.linear import HIDDEN
from fcm.scene.names import DIRECTIONS, at_node, motion_of

IntArray = npt.NDArray[np.intp]


class ExportError(ValueError):
    """Raised when motions cannot be exported; the message says why."""


class StructureRows(Frozen):
    """The rows of a structure, by their names, with a node and a direction where the name says them.

    names (row,); node (row,), -1 where there is none; direction (row,) from 0 for x to 5 for rz.
    """

    names: tuple[str, ...]
    places: IntArray  # (row,) among the degrees of freedom of the scene
    node: IntArray
    direction: IntArray

    @staticmethod
    def of(scene: Scene) -> StructureRows:
        """The rows of a scene that was loaded with every row.

        >>> import fcm
        >>> rows = StructureRows.of(fcm.load_scene("blade", every_row=True))
        >>> rows.names[0], int(rows.node[0]), int(rows.direction[0])
        ('2x', 2, 0)
        """
        names = [(i, name) for i, name in enumerate(scene.modal.dofs) if not name.startswith((HIDDEN, NEXT))]
        words = [at_node(name) if motion_of(name) else "" for _, name in names]
        letters = [word.lstrip("0123456789") for word in words]
        node = [int(word.removesuffix(end)) if word else -1 for word, end in zip(words, letters, strict=True)]
        direction = [DIRECTIONS.index(end) if end else -1 for end in letters]
        return StructureRows(
            tuple(name for _, name in names),
            np.array([i for i, _ in names], dtype=np.intp),
            np.array(node, dtype=np.intp),
            np.array(direction, dtype=np.intp),
        )

    @property
    def nodes(self) -> IntArray:
        """The nodes that have rows, ascending."""
        return np.unique(self.node[self.node >= 0])

    def displacements(self, motion: ResponseMotion, scene: Scene) -> ComplexArray:
        """Displacements (1 + harmonic, row) of a motion of a curve of the scene, the mean first."""
        curve = scene.each_curve()[motion.curve]
        assert motion.modal is not None  # rings are refused before
        unit = motion.modal / np.sqrt(curve.modal.mass)[:, None]
        found: ComplexArray = unit.T @ curve.modal.shapes[:, self.places]
        return found

    def by_node(self, values: ComplexArray, nodes: Sequence[int] | IntArray) -> ComplexArray:
        """Values (..., row) as values (..., node, 6) at some nodes; 0 where a node has no row.

        >>> rows = StructureRows(("7y",), np.array([0]), np.array([7]), np.array([1]))
        >>> rows.by_node(np.array([2.0 + 0j]), [3, 7]).real.tolist()[1]
        [0.0, 2.0, 0.0, 0.0, 0.0, 0.0]
        """
        numbers = np.asarray(nodes)
        order = np.argsort(numbers)
        there = np.isin(self.node, numbers)
        out = np.zeros((*values.shape[:-1], numbers.size, len(DIRECTIONS)), dtype=np.complex128)
        place = order[np.searchsorted(numbers, self.node[there], sorter=order)]
        out[..., place, self.direction[there]] = values[..., there]
        return out

    @property
    def turn(self) -> bool:
        """Whether any row is a rotation."""
        return bool((self.direction > 2).any())


def check_nodes(rows: StructureRows) -> None:
    """Raise ExportError if no row belongs to a node."""
    if not rows.nodes.size:
        raise ExportError(
            'no degree of freedom is named by a node and a direction, as "40x"; the first are '
            f"{choices(rows.names[:3])}. Name them so in dofs"
        )


def check_mesh(rows: StructureRows, mesh: Mesh, name: str) -> list[str]:
    """Notes on how the rows of a structure match a mesh.

    Raises
    ------
    ExportError
        If the structure has no nodes, or none that the mesh has.
    """
    check_nodes(rows)
    lacking = rows.nodes[~np.isin(rows.nodes, mesh.nodes)]
    which = ", ".join(str(node) for node in lacking[:3].tolist())
    there = rows.nodes.size - lacking.size
    if not there:
        raise ExportError(
            f"{name} has none of the {counted(lacking.size, 'node')} of the structure, "
            f"which begin with {which}: it is the mesh of another structure"
        )
    said = []
    if lacking.size:
        said.append(
            f"{name} has {there} of the {rows.nodes.size} nodes of the structure. "
            f"The motion of the other {counted(lacking.size, 'node')} "
            f"({which}{', ...' if lacking.size > 3 else ''}) is left out"
        )
    without = len(mesh.nodes) - there
    if without:
        have = f"{counted(without, 'node')} of {len(mesh.nodes)} {'have' if without > 1 else 'has'} no row"
        said.append(
            f"{name}: {have}, as they are held or left out: displacement 0, and 0 in the array has_rows"
        )
    unnamed = int((rows.node < 0).sum())
    if unnamed:
        said.append(f"{counted(unnamed, 'row')} without a node and a direction: not on the mesh")
    if mesh.lacking:
        said.append(f"{name}: elements of type {choices(mesh.lacking)} are left out; their nodes are there")
    return said


LIBRARIES = {".vtu": "meshio", ".h5": "h5py", ".hdf5": "h5py"}


def check_library(ending: str) -> None:
    """Raise ExportError if the package that writes this kind of file is not installed."""
    package = LIBRARIES.get(ending)
    if package is not None and find_spec(package) is None:
        raise ExportError(f"a {ending} file is written by the package {package}: pip install {package}")
