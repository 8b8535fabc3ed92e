"""Meshes of other programs: nodes by their numbers, elements, sets of nodes; nodes of two sets in pairs."""

from fcm.mesh.mesh import Mesh, MeshError
from fcm.mesh.read import ENDINGS, read_mesh

__all__ = ["ENDINGS", "Mesh", "MeshError", "read_mesh"]
