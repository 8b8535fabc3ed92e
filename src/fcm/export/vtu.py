"""Motions on their mesh for ParaView, by meshio."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fcm.export.motions import labels_of
from fcm.export.rows import IntArray, StructureRows
from fcm.mesh import Mesh
from fcm.model.scene import FloatArray, Scene
from fcm.results.contact_states import contact_states
from fcm.results.motions import ResponseMotion


def write_vtu(motions: Sequence[ResponseMotion], scene: Scene, mesh: Mesh, path: Path) -> None:
    """Write displacements of all nodes as point data of a VTU file.

    Each motion has the arrays NAME_mean (node, 3), and for each harmonic NAME_h1_real and NAME_h1_imag
    (node, 3). Rotations have NAME_rotation_... likewise. x = mean + Im((real + i imag) exp(i h omega t)).
    node_number (node,) has the numbers of the nodes, has_rows (node,) is 1 where the matrices have rows.
    Without elements, each node is a cell of its own.

    The contacts have NAME_energy and NAME_slip_path in a cycle and NAME_greatest_normal_force, each (node,)
    with 0 at nodes without contact. NAME_state is an index into `fcm.results.contact_states.STATES`, -1
    without contact. A node of several contacts has the sum of energies and forces, the longest slip path and
    the highest state. The nodes of one side of a contact share its energy and force.
    """
    import meshio

    rows = StructureRows.of(scene)
    nodes = np.array(mesh.nodes)
    data: dict[str, Any] = {
        "node_number": nodes.astype(np.int64),
        "has_rows": np.isin(nodes, rows.nodes).astype(np.int64),
    }
    share = _shares(scene, rows, nodes)
    for motion, name in zip(motions, labels_of(motions, scene.frequency_unit), strict=True):
        found = rows.by_node(rows.displacements(motion, scene), nodes)
        for kind, columns in (("", slice(0, 3)), ("_rotation", slice(3, 6)))[: 2 if rows.turn else 1]:
            part = np.ascontiguousarray(found[..., columns])
            data[f"{name}{kind}_mean"] = part[0].real
            for j, harmonic in enumerate(motion.harmonics, 1):
                data[f"{name}{kind}_h{harmonic}_real"] = part[j].real
                data[f"{name}{kind}_h{harmonic}_imag"] = part[j].imag
        if motion.contact_loads is not None:
            data |= {f"{name}_{what}": values for what, values in _at_nodes(motion, share).items()}
    cells: list[Any] = [(kind, places) for kind, places in mesh.cells]
    if not cells:
        cells = [("vertex", np.arange(len(nodes))[:, None])]
    meshio.write(path, meshio.Mesh(mesh.xyz, cells, point_data=data), file_format="vtu")


def _shares(scene: Scene, rows: StructureRows, nodes: IntArray) -> FloatArray:
    """Weights (contact, node) of each node's motion in the motion of its side of a contact.

    The weights of a side add up to 1 at most, whatever the weights of rows are.
    """
    found = np.zeros((len(scene.contacts), nodes.size))
    for of_contact, contact in zip(found, scene.contacts, strict=True):
        along = contact.normal if contact.normal.any() else contact.tangential
        weights = rows.by_node(along[rows.places].astype(np.complex128), nodes).real
        size = np.linalg.norm(weights, axis=-1)
        same_side = weights @ weights[size.argmax()] > 0.0
        total = max(size[same_side].sum(), size[~same_side].sum())
        of_contact[:] = size / total if total > 0.0 else 0.0
    return found


def _at_nodes(motion: ResponseMotion, share: FloatArray) -> dict[str, FloatArray]:
    """The loads and states of the contacts at the nodes that they join."""
    assert motion.contact_loads is not None
    normal, _, slip, energy = motion.contact_loads.T
    state, joined = contact_states(motion.states), share > 0.0
    return {
        "energy": energy @ share,
        "slip_path": np.where(joined, slip[:, None], 0.0).max(axis=0),
        "greatest_normal_force": normal @ share,
        "state": np.where(joined, state[:, None], -1).max(axis=0),
    }
