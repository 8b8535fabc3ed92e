"""A contact over a list of node pairs: one contact for each pair, all of the same numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import isnan
from typing import Any

import numpy as np

from fcm.scene.errors import kind, quoted
from fcm.scene.model import FloatArray
from fcm.scene.names import DIRECTIONS, Names
from fcm.scene.rules import ANY, POSITIVE
from fcm.scene.section import Section, described

Pair = tuple[str, ...]  # two nodes, or one that touches the ground


def read_pairs(section: Section) -> list[Pair]:
    """The pairs of nodes; empty after a mistake."""
    value = section.data["nodes"]
    if not isinstance(value, list | tuple) or not value:
        section.wrong("nodes", f"must be a list of pairs such as [[40, 41], [50, 51]], is {kind(value)}")
        return []
    if len(value) == 2 and not any(isinstance(item, list | tuple) for item in value):
        one, other = (described(item).removeprefix("the string ") for item in value)
        section.wrong(
            "nodes",
            f"may be one pair, or two nodes that touch the ground: write [[{one}, {other}]], "
            f"or [[{one}], [{other}]]",
        )
        return []
    pairs = [_pair(section, index, item) for index, item in enumerate(value)]
    return [pair for pair in pairs if pair] if all(pairs) else []


def _pair(section: Section, index: int, item: Any) -> Pair:
    nodes = item if isinstance(item, list | tuple) else [item]
    right = 1 <= len(nodes) <= 2 and all(isinstance(n, int | str) and not isinstance(n, bool) for n in nodes)
    if not right:
        section.wrong(
            f"nodes[{index}]", "must be two nodes, or one that touches the ground, as [40, 41] or [40]"
        )
        return ()
    if len(nodes) == 2 and str(nodes[0]) == str(nodes[1]):
        section.wrong(f"nodes[{index}]", f"is the same node twice, {nodes[0]}")
        return ()
    return tuple(str(node) for node in nodes)


def read_direction(section: Section, key: str) -> dict[str, float]:
    """A direction such as "x" or { x = 0.6, y = 0.8 }, as weights; empty after a mistake."""
    if section.missing(key, "a direction of the nodes, as x or { x = 0.6, y = 0.8 }"):
        return {}
    value = section.data[key]
    terms = {value: 1.0} if isinstance(value, str) else value
    if not isinstance(terms, Mapping) or not terms or not set(map(str, terms)) <= set(DIRECTIONS):
        section.wrong(key, f"must be one of {', '.join(DIRECTIONS)}, or a table of weights of them")
        return {}
    path = section.at(key)
    weights = {name: section.checked(item, f"{path}.{name}", ANY) for name, item in terms.items()}
    return {} if any(map(isnan, weights.values())) else weights


def check_nodes(
    section: Section, directions: Iterable[Mapping[str, float]], pairs: Iterable[Pair], dofs: Names | None
) -> None:
    """Note each node that cannot move along some of the directions, once."""
    if dofs is None:
        return
    needed = dict.fromkeys(one for weights in directions for one in weights)
    for node in dict.fromkeys(node for pair in pairs for node in pair):
        lacking = [quoted(one) for one in needed if not _at(dofs, node, one)]
        if lacking:
            section.wrong("nodes", f"node {node} has no degree of freedom along {', '.join(lacking)}")


def along(weights: Mapping[str, float], pair: Pair, dofs: Names | None) -> FloatArray | None:
    """The relative displacement of a pair along a direction; None where it has none."""
    if dofs is None or not weights:
        return None
    found = np.zeros(len(dofs))
    for direction, weight in weights.items():
        for node, sign in zip(pair, (1.0, -1.0), strict=False):
            name = _at(dofs, node, direction)
            if not name:
                return None
            found[dofs.place[name]] += sign * weight
    return found


def _at(dofs: Names, node: str, direction: str) -> str:
    """The degree of freedom of a node along a direction; empty if it has none."""
    return dofs.find(f"{node}{direction}") or dofs.find(f"{node}_{direction}")


def read_shares(section: Section, count: int) -> list[float]:
    """The share of each pair in the total preload, by areas; 1 for each where no areas are given."""
    if "areas" not in section.data:
        return [1.0] * count
    if "nodes" not in section.data:
        section.wrong("areas", "is of no use without nodes, whose areas they are")
        return [1.0] * count
    if "gap" in section.data:
        section.wrong("areas", "share a total preload n_0; a gap is the same for all")
    areas = section.vector("areas", POSITIVE)
    if areas is None:
        return [1.0] * count
    pairs = section.data["nodes"]
    if isinstance(pairs, list | tuple) and len(areas) != len(pairs):
        section.wrong("areas", f"must have one number for each of the {len(pairs)} pairs, has {len(areas)}")
    if len(areas) != count:
        return [1.0] * count
    return [float(area) for area in areas / areas.sum()]
