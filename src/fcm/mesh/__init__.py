"""Meshes of other programs: numbered nodes, elements and node sets; pairing of the nodes of two sets."""

from fcm.mesh.mesh import Mesh, MeshError
from fcm.mesh.read import ENDINGS, read_mesh

__all__ = ["ENDINGS", "Mesh", "MeshError", "read_mesh"]
