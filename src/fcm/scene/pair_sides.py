"""Notes on node pairs that are reversed compared with the rest of their interface.

The first node of a pair is on the side that moves along the normal as the contact closes. Between two bodies,
or two sectors of a ring, all first nodes belong to the same one. A reversed pair opens where it should close.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from fcm.scene.errors import counted, several
from fcm.scene.node_pairs import pairs_by_contact
from fcm.structure.rigid_body import bodies


def notes_of_sides(drafts: Sequence[Mapping[str, Any]], K: Any) -> list[str]:
    """Notes on reversed pairs, by their normals (row,) between the bodies of the stiffness matrix K.

    For a ring, K is that of a sector, and the rows of normals are followed by those of the next sector.

    >>> import scipy.sparse
    >>> K = scipy.sparse.block_diag([np.ones((2, 2)), np.ones((2, 2))])
    >>> normals = [1.0, 0, -1, 0], [0.0, 1, 0, -1], [0.0, -1, 0, 1]
    >>> drafts = [{"name": f"c_{i}", "group": "c", "normal": np.array(n)} for i, n in enumerate(normals)]
    >>> notes_of_sides(drafts, K)[0].partition(". ")[0]
    'contact c: 1 of 3 pairs, "c_2", has its nodes exchanged, so that it opens where its neighbours close'
    """
    contacts, notes = pairs_by_contact(drafts), list[str]()
    if not any(len(pairs) > 2 for pairs in contacts.values()):
        return notes
    body = bodies(K)
    if len(drafts[0]["normal"]) > body.size:
        body = np.concatenate((body, body + body.max() + 1))
    for name, pairs in contacts.items():
        few = _fewer(pairs, body)
        if few:
            has = "has its nodes exchanged, so that it opens where its neighbours close"
            have = "have their nodes exchanged, so that they open where their neighbours close"
            notes.append(
                f"contact {name}: {len(few)} of {counted(len(pairs), 'pair')}, {several(few)}, "
                f"{has if len(few) == 1 else have}. Elsewhere the first node is on the other side"
            )
    return notes


def _fewer(pairs: Iterable[Mapping[str, Any]], body: np.ndarray) -> list[str]:
    """Names of the pairs from one body to another that are fewer than the pairs in the other direction."""
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
