"""Motions on their mesh for ParaView, by meshio."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fcm.export.motions import labels_of
from fcm.export.rows import Rows
from fcm.mesh import Mesh
from fcm.model.scene import Scene
from fcm.results.motions import Motion


def write_vtu(motions: Sequence[Motion], scene: Scene, mesh: Mesh, path: Path) -> None:
    """Write displacements of all nodes as point data of a VTU file.

    Of each motion and harmonic there are the arrays NAME_h1_real and NAME_h1_imag (node, 3), and NAME_mean;
    with rotations, those of NAME_rotation_... as well. x = mean + Im((real + i imag) exp(i h omega t)).
    node_number (node,) has the numbers of the nodes, has_rows (node,) is 1 where the matrices have rows.
    Without elements, each node is a cell of its own.
    """
    import meshio

    rows = Rows.of(scene)
    nodes = np.array(mesh.nodes)
    data: dict[str, Any] = {
        "node_number": nodes.astype(np.int64),
        "has_rows": np.isin(nodes, rows.nodes).astype(np.int64),
    }
    for motion, name in zip(motions, labels_of(motions, scene.frequency_unit), strict=True):
        found = rows.by_node(rows.displacements(motion, scene), nodes)
        for kind, columns in (("", slice(0, 3)), ("_rotation", slice(3, 6)))[: 2 if rows.turn else 1]:
            part = np.ascontiguousarray(found[..., columns])
            data[f"{name}{kind}_mean"] = part[0].real
            for j, harmonic in enumerate(motion.harmonics, 1):
                data[f"{name}{kind}_h{harmonic}_real"] = part[j].real
                data[f"{name}{kind}_h{harmonic}_imag"] = part[j].imag
    cells: list[Any] = [(kind, places) for kind, places in mesh.cells]
    if not cells:
        cells = [("vertex", np.arange(len(nodes))[:, None])]
    meshio.write(path, meshio.Mesh(mesh.xyz, cells, point_data=data), file_format="vtu")
