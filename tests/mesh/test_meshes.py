"""Meshes of other programs: nodes keep the numbers that the file gives them, or the file is refused."""

import meshio
import numpy as np
import pytest

from fcm.mesh import MeshError, read_mesh

INP = """*HEADING
*NODE, NSET=all
 30, 0.0, 0.0, 0.0
 7, 1.0, 0.0
** a remark
12, 0.0, 1.0, 0.0
*INCLUDE, INPUT=more.inp
*ELEMENT, TYPE=C3D4, ELSET=E
1, 30, 7, 12, 4
*ELEMENT, TYPE=SPRINGA
2, 30, 7
*NSET, NSET=low, GENERATE
7, 12, 5
*NSET, NSET=both
low, 30
*MATERIAL, NAME=steel
1, 2, 3
"""
CORNERS = {30: (0.0, 0.0, 0.0), 7: (1.0, 0.0, 0.0), 12: (0.0, 1.0, 0.0), 4: (0.0, 0.0, 1.5e-3)}
SMALL = "".join(f"GRID    {n:<8}{'':8}{x:<8}{y:<8}{z:<8.6f}\n" for n, (x, y, z) in CORNERS.items())
LARGE = "".join(
    f"GRID*   {n:<16}{'':16}{x:<16}{y:<16}\n*       {z:<16.8f}\n" for n, (x, y, z) in CORNERS.items()
)
FREE = "".join(f"GRID,{n},,{x},{y},{z}\n" for n, (x, y, z) in CORNERS.items())
TETRA = "CTETRA  1       1       30      7       12      4       \n"
GMSH2 = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
30 0 0 0
7 1 0 0
12 0 1 0
4 0 0 0.0015
$EndNodes
$Elements
1
1 4 2 0 1 30 7 12 4
$EndElements
"""
GMSH4 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
2 4 4 30
3 1 0 3
30
7
12
0 0 0
1 0 0
0 1 0
3 2 0 1
4
0 0 0.0015
$EndNodes
$Elements
1 1 1 1
3 1 4 1
1 30 7 12 4
$EndElements
"""


def files():
    yield "a.inp", INP
    for name, grids in (("small", SMALL), ("large", LARGE), ("free", FREE)):
        yield f"{name}.bdf", f"SOL 103\nCEND\nBEGIN BULK\n{grids}{TETRA}ENDDATA\n"
    yield "two.msh", GMSH2
    yield "four.msh", GMSH4
    rows = "".join(f"{n},{x},{y},{z}\n" for n, (x, y, z) in CORNERS.items())
    yield "xyz.csv", f"node, x, y, z  # of a test\n{rows}"


@pytest.mark.parametrize("name, text", list(files()))
def test_nodes_keep_their_numbers(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    (tmp_path / "more.inp").write_text("*NODE\n4, 0.0, 0.0, 1.5E-3\n")
    mesh = read_mesh(tmp_path / name)
    assert sorted(mesh.nodes) == sorted(CORNERS)
    assert np.array_equal(mesh.at((30, 7, 12, 4)), np.array([CORNERS[n] for n in (30, 7, 12, 4)]))
    if name != "xyz.csv":
        ((kind, places),) = mesh.cells
        assert kind == "tetra" and [mesh.nodes[i] for i in places[0]] == [30, 7, 12, 4]
    if name == "a.inp":
        assert mesh.sets == {"ALL": (30, 7, 12), "LOW": (7, 12), "BOTH": (7, 12, 30)}
        assert mesh.lacking == ("SPRINGA",)


def test_a_remark_may_be_in_any_coding(tmp_path):
    (tmp_path / "a.inp").write_bytes("** Fu\xdf der Schaufel\n*NODE\n1, 0, 0, 0.5\n".encode("latin-1"))
    assert read_mesh(tmp_path / "a.inp").xyz.tolist() == [[0.0, 0.0, 0.5]]


def test_elements_of_two_orders_are_those_of_meshio(tmp_path):
    """The order of the nodes of an element is that of VTK, as meshio has it of the same file."""
    lines = [f"{n}, {n}.0, {n * n % 7}.0, {n % 5}.0" for n in range(1, 21)]
    text = "*NODE\n" + "\n".join(lines)
    text += "\n*ELEMENT, TYPE=C3D10\n1, 1,2,3,4,5,6,7,8,9,10\n*ELEMENT, TYPE=C3D20R\n"
    text += "2, " + ",".join(map(str, range(1, 16))) + ",\n16,17,18,19,20\n"
    (tmp_path / "a.inp").write_text(text)
    mesh, other = read_mesh(tmp_path / "a.inp"), meshio.read(tmp_path / "a.inp")
    assert [(kind, places.tolist()) for kind, places in mesh.cells] == [
        (one.type, one.data.tolist()) for one in other.cells
    ]


WRONG = {
    "a.inp": {
        "*NODE\n1, 0, 0, 0\n1, 1, 0, 0\n": "node 1 is given a second time",
        "*NODE\n1, 0, 0, zero\n": "a node has a number and coordinates",
        "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3\n": "has 4 nodes behind each number",
        "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=B31\n1, 1, 2\n": "node 2, of which it gives no coordinates",
        "*INSTANCE, NAME=a\n": "numbers nodes by part",
        "*INCLUDE, INPUT=there.inp\n": 'includes "there.inp", which is not there',
        "*HEADING\nnothing\n": "it holds no node",
        "*NODE\n1, 0, 0, 0\n*NSET, NSET=a\nb\n": "*NSET A must hold numbers of nodes",
    },
    "a.csv": {
        "node,x,y\n1,0,0\n": "must name the columns node,x,y,z",
        "node,x,y,z\n1,0,0\n": 'line 2: "1,0,0" is not a node and three coordinates',
        "node,x,y,z\n1,0,0,nan\n": "whose coordinates are no numbers",
        "node,x,y,z\n1,0,0,0\n1,0,0,1\n": "two nodes of one number",
    },
    "a.bdf": {
        "BEGIN BULK\nGRID,1,5,0.,0.,0.\nENDDATA\n": "is in the coordinate system 5",
        "GRID,1,,0.,0.,0.\n": "meshio cannot read it",
    },
    "a.msh": {
        "$MeshFormat\n4.1 1 8\n$EndMeshFormat\n": "no Gmsh file as text",
        "$MeshFormat\n3.0 0 8\n$EndMeshFormat\n$Nodes\n1\n$EndNodes\n": "write version 2.2 or 4.1",
    },
    "a.stl": {"solid\n": "a mesh is a file that ends in .inp"},
}


@pytest.mark.parametrize(
    "name, text, said", [(n, t, s) for n, all_of in WRONG.items() for t, s in all_of.items()]
)
def test_what_is_no_mesh_is_said(tmp_path, name, text, said):
    (tmp_path / name).write_text(text)
    with pytest.raises(MeshError) as caught:
        read_mesh(tmp_path / name)
    assert said in str(caught.value)
