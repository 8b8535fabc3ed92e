"""Nodes of two sets in pairs, and the plane between them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.frozen import Frozen
from fcm.mesh.mesh import FloatArray, IntArray, Mesh, MeshError

MOST_NAMED = 5  # nodes in a sentence


class PairingOptions(Frozen):
    """Tolerances for pairing nodes and fitting planes.

    Attributes
    ----------
    line_tolerance
        Extent across a line, relative to that along it, below which points lie on it and have no plane.
    normal_tolerance
        Component of a unit normal that is rounding.
    side_tolerance
        Distance along the normal, relative to the extent of the points, from which a side is known.
    """

    line_tolerance: float = 1e-6
    normal_tolerance: float = 1e-9
    side_tolerance: float = 1e-9


PAIRING = PairingOptions()


class Paired(Frozen):
    """Pairs (pair, 2) of nodes of one set and the nearest of another, with the distances `apart`.

    alone, other_alone: nodes of the first and the second set without a partner.
    """

    pairs: tuple[tuple[int, int], ...]
    apart: FloatArray  # (pair,)
    alone: tuple[int, ...]
    other_alone: tuple[int, ...]


def paired(mesh: Mesh, one: Sequence[int], other: Sequence[int], tolerance: float) -> Paired:
    """Pair each node of a set with the nearest node of another set, within a tolerance [length].

    Raises
    ------
    MeshError
        If a node is in both sets, two nodes have the same nearest one, or none has a partner.

    Examples
    --------
    >>> mesh = Mesh((1, 2, 7), np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0.1]]))
    >>> found = paired(mesh, [1, 2], [7], 0.5)
    >>> found.pairs, found.alone
    (((1, 7),), (2,))
    """
    from scipy.spatial import cKDTree  # only scenes with node sets need it

    shared = sorted(set(one) & set(other))
    if shared:
        raise MeshError(f"{_nodes(shared)} in both sets; each node belongs to one side")
    first, second = mesh.at(tuple(one)), mesh.at(tuple(other))
    distance, nearest = cKDTree(second).query(first)
    within = np.flatnonzero(distance <= tolerance)
    partners: dict[int, list[int]] = {}
    for i in within.tolist():
        partners.setdefault(int(nearest[i]), []).append(i)
    twice = {k: who for k, who in partners.items() if len(who) > 1}
    if twice:
        k, who = next(iter(twice.items()))
        more = f"; {len(twice)} nodes are wanted so" if len(twice) > 1 else ""
        which = _nodes([one[i] for i in who], verb=False)
        raise MeshError(
            f"{which} of the first set all have node {other[k]} of the second as the nearest{more}. "
            "Pair them in a file, lower the tolerance, or give the coarser set first"
        )
    if not within.size:
        raise MeshError(
            f"no node of the first set is within {tolerance:g} of the second; the nearest is "
            f"{float(distance.min()):.4g} away"
        )
    pairs = tuple((one[i], other[int(nearest[i])]) for i in within.tolist())
    taken = {pair[1] for pair in pairs}
    alone = tuple(one[i] for i in np.flatnonzero(distance > tolerance).tolist())
    return Paired(pairs, distance[within], alone, tuple(node for node in other if node not in taken))


def nearest_partners(mesh: Mesh, pairs: Sequence[tuple[int, int]]) -> list[int | None]:
    """For each pair, the second node of another pair that is nearest to its first node.

    None if no such node is nearer than the pair's own second node.

    >>> mesh = Mesh((1, 2, 7, 8), np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0], [1, 0, 0]]))
    >>> nearest_partners(mesh, [(1, 8), (2, 7)]), nearest_partners(mesh, [(1, 7), (2, 8)])
    ([7, 8], [None, None])
    """
    from scipy.spatial import cKDTree

    first, second = (mesh.at(side) for side in zip(*pairs, strict=True))
    distance, place = cKDTree(second).query(first)
    far = np.linalg.norm(first - second, axis=1) - distance
    size = float(np.ptp(np.concatenate((first, second)), axis=0).max())
    return [
        pairs[k][1] if beyond > PAIRING.side_tolerance * size and pairs[k][1] != pair[0] else None
        for pair, k, beyond in zip(pairs, place.tolist(), far.tolist(), strict=True)
    ]


class Plane(Frozen):
    """A plane through points: a unit normal and two directions in it at right angles, all (3,).

    off: greatest distance of a point from the plane [length]; size: greatest extent of the points.
    """

    normal: FloatArray
    first: FloatArray
    second: FloatArray
    centre: FloatArray
    off: float
    size: float


def fitted_plane(points: FloatArray) -> Plane:
    """The plane with the least sum of squared distances from points (point, 3); its directions by `across`.

    Raises
    ------
    MeshError
        If the points are fewer than three, or lie on a line.

    Examples
    --------
    >>> plane = fitted_plane(np.array([[0, 0, 1.0], [1, 0, 1], [0, 2, 1]]))
    >>> np.abs(plane.normal).tolist(), plane.first.tolist()
    ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    """
    if len(points) < 3:
        raise MeshError(f"a plane is fitted to three points at least, and there are {len(points)}")
    centre = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - centre, full_matrices=False)
    if sizes[1] <= PAIRING.line_tolerance * sizes[0]:
        raise MeshError("the points lie on a line, which is in no one plane")
    normal = np.where(np.abs(axes[2]) < PAIRING.normal_tolerance, 0.0, axes[2])
    first, second = across(normal)
    off, size = float(np.abs((points - centre) @ normal).max()), float(np.ptp(points, axis=0).max())
    return Plane(normal, first, second, centre, off, size)


def across(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors (3,) orthogonal to a normal and to each other.

    The first is nearest to one of the axes, the second is normal x first.

    >>> [one.tolist() for one in across(np.array([0.0, 0.0, 2.0]))]
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    """
    unit = normal / np.linalg.norm(normal)
    along = np.eye(3) - np.outer(unit, unit)
    first = along[int(np.linalg.norm(along, axis=1).round(9).argmax())]
    first = first / np.linalg.norm(first)
    second = np.cross(unit, first)
    first, second = (np.where(np.abs(x) < PAIRING.normal_tolerance, 0.0, x) for x in (first, second))
    return first, second


def side(mesh: Mesh, pairs: Sequence[tuple[int, int]], direction: FloatArray) -> float:
    """Distance along a direction (3,) by which the second side of pairs lies beyond the first [length].

    It is measured between the mean centres of the elements at the nodes, or, without elements, between the
    mean positions of the nodes.

    >>> mesh = Mesh((1, 2), np.array([[0.0, 0, 0], [0, 0, 0.1]]))
    >>> side(mesh, [(1, 2)], np.array([0.0, 0.0, 1.0]))
    0.1
    """
    first, second = (np.array([mesh.place[node] for node in one]) for one in zip(*pairs, strict=True))
    begin, end = _middle(mesh, first), _middle(mesh, second)
    if begin is None or end is None:
        begin, end = mesh.xyz[first].mean(axis=0), mesh.xyz[second].mean(axis=0)
    return float((end - begin) @ direction)


def beyond(mesh: Mesh, nodes: Sequence[int], direction: FloatArray) -> float:
    """Distance along a direction (3,) by which nodes lie beyond the centre of their elements [length].

    It is 0 without elements.
    """
    places = np.array([mesh.place[node] for node in nodes])
    inner = _middle(mesh, places)
    return 0.0 if inner is None else float((mesh.xyz[places].mean(axis=0) - inner) @ direction)


def outward(plane: Plane, mesh: Mesh, nodes: Sequence[int]) -> Plane:
    """The plane with its normal pointing out of the elements at some nodes.

    Raises
    ------
    MeshError
        If the mesh has no elements there, or they lie in the plane.
    """
    out = beyond(mesh, nodes, plane.normal)
    return _with_side(plane, out, "the elements of the mesh do not show it", "out of the structure")


def turned(plane: Plane, mesh: Mesh, pairs: Sequence[tuple[int, int]]) -> Plane:
    """The plane with the normal from the first side of pairs to the second; see `side`.

    Raises
    ------
    MeshError
        If nothing shows the sides.
    """
    along = side(mesh, pairs, plane.normal)
    what = "neither gaps nor elements of the mesh show it"
    return _with_side(plane, along, what, "from the first set to the second")


def _with_side(plane: Plane, along: float, what: str, way: str) -> Plane:
    """The plane, reversed if `along` is negative; MeshError if `along` is too small to show a side."""
    if abs(along) <= PAIRING.side_tolerance * plane.size:
        raise MeshError(
            f"which side is which is unknown: {what}. Give the normal, as "
            f"{{ x = {plane.normal[0]:.6g}, y = {plane.normal[1]:.6g}, z = {plane.normal[2]:.6g} }} "
            f"or its opposite: it points {way}"
        )
    if along > 0.0:
        return plane
    return Plane(-plane.normal, plane.first, -plane.second, plane.centre, plane.off, plane.size)


def _middle(mesh: Mesh, places: IntArray) -> FloatArray | None:
    """Mean centre of the elements at some nodes; None without elements."""
    found = [mesh.xyz[cells[np.isin(cells, places).any(axis=1)]].mean(axis=1) for _, cells in mesh.cells]
    centres = np.concatenate([*found, np.zeros((0, 3))])
    if not len(centres):
        return None
    middle: FloatArray = centres.mean(axis=0)
    return middle


def _nodes(nodes: Sequence[int], verb: bool = True) -> str:
    """Nodes in words, as "node 3 is", "nodes 3, 4 are"; without the verb "nodes 3, 4".

    >>> _nodes([3]), _nodes([3, 4]), _nodes([3, 4], verb=False)
    ('node 3 is', 'nodes 3, 4 are', 'nodes 3, 4')
    """
    named = ", ".join(map(str, nodes[:MOST_NAMED])) + (", ..." if len(nodes) > MOST_NAMED else "")
    ending = f" {'is' if len(nodes) == 1 else 'are'}" if verb else ""
    return f"node{'' if len(nodes) == 1 else 's'} {named}{ending}"
