"""Notes on pairs of nodes that are the other way round than the rest of their interface.

The first node of a pair is on the side that moves along the normal as the contact closes. Where two bodies
meet, all first nodes belong to one of them. A pair with its nodes exchanged opens where it should close.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from fcm.scene.errors import counted, several


def notes_of_sides(drafts: Iterable[Mapping[str, Any]], K: Any) -> list[str]:
    """Notes on the pairs of groups, whose normals (row,) lead from one body of a stiffness matrix to another.

    >>> import scipy.sparse
    >>> K = scipy.sparse.block_diag([np.ones((2, 2)), np.ones((2, 2))])
    >>> normals = [1.0, 0, -1, 0], [0.0, 1, 0, -1], [0.0, -1, 0, 1]
    >>> drafts = [{"name": f"c_{i}", "group": "c", "normal": np.array(n)} for i, n in enumerate(normals)]
    >>> notes_of_sides(drafts, K)[0].partition(". ")[0]
    'contact c: 1 of 3 pairs, "c_2", has its nodes exchanged, so that it opens where its neighbours close'
    """
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for draft in drafts:
        if "group" in draft and draft["normal"] is not None:
            groups.setdefault(draft["group"], []).append(draft)
    if not any(len(pairs) > 2 for pairs in groups.values()):
        return []
    from scipy.sparse.csgraph import connected_components

    body = connected_components(abs(K), directed=False)[1]
    notes = []
    for name, pairs in groups.items():
        few = _fewer(pairs, body)
        if few:
            has = "has its nodes exchanged, so that it opens where its neighbours close"
            have = "have their nodes exchanged, so that they open where their neighbours close"
            notes.append(
                f"contact {name}: {len(few)} of {counted(len(pairs), 'pair')}, {several(few)}, "
                f"{has if len(few) == 1 else have}. Elsewhere the first node is on the other body"
            )
    return notes


def _fewer(pairs: Iterable[Mapping[str, Any]], body: np.ndarray) -> list[str]:
    """The pairs that lead from one body to another where more lead back; of each two bodies."""
    ways: dict[tuple[int, int], list[str]] = {}
    for pair in pairs:
        ends = {*body[pair["normal"] > 0.0].tolist()}, {*body[pair["normal"] < 0.0].tolist()}
        if len(ends[0]) == len(ends[1]) == 1 and ends[0] != ends[1]:
            ways.setdefault((*ends[0], *ends[1]), []).append(str(pair["name"]))
    return [
        name
        for (one, other), names in ways.items()
        if len(names) < len(ways.get((other, one), ()))
        for name in names
    ]
