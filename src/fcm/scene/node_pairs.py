"""Reads a [[contact]] over node pairs, which makes one contact for each pair."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from math import fsum, isnan, nan
from typing import Any

import numpy as np

from fcm.model.interface import Interface
from fcm.model.question import Question
from fcm.model.scene import FloatArray
from fcm.scene.errors import choices, counted, kind, nearest, quoted, several
from fcm.scene.files import DataFileError, Files
from fcm.scene.names import DIRECTIONS, Names
from fcm.scene.node_sets import FITTED, pairs_of_sets, with_places
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.pair_file import COORDINATES, NODES, NUMBERS, PairTable, read_numbers_of_pairs, read_pair_table
from fcm.scene.plane import is_stop
from fcm.scene.rules import ANY, POSITIVE, RULES
from fcm.scene.section import SYNONYMS, Section, described

Pair = tuple[str, ...]  # two nodes, or one in contact with the ground
EQUAL = "equal"  # value of areas that are all the same
SHARED = ("k_u", "k_v", "n_0")  # numbers that pairs share in proportion to their areas


def read_pairs(section: Section, files: Files) -> PairTable:
    """The node pairs of a contact, with the numbers that a file gives for them; empty after a mistake."""
    value = section.data["nodes"]
    if isinstance(value, Mapping):
        if "pairs" not in value:
            return pairs_of_sets(section, files)
        found = section.table("nodes", "")
        name = "" if found is None else found.text("pairs")
        table = _of_file(section, name, files) if name else PairTable([], unread=True)
        return table if found is None or table.unread else with_places(section, found, table, files)
    if not isinstance(value, str):
        return PairTable(_listed(section, value))
    table = _of_file(section, value, files)
    if table.places is None:
        return table
    if section.data.get("normal") == FITTED:
        section.wrong(
            "normal",
            "cannot be fitted to a file of pairs, whose places do not show the sides. Give a direction, or "
            "nodes = { pairs = , mesh = }",
        )
    interface = Interface(section.data.get("name", ""), table.places, table.places)
    return replace(table, interface=interface)


def _of_file(section: Section, value: str, files: Files) -> PairTable:
    """The pairs of a file; mistakes are noted."""
    try:
        with files.opened(value) as path:
            table = read_pair_table(path)
    except DataFileError as error:
        for fault in error.faults:
            section.wrong("nodes", fault)
        return PairTable([], unread=True)
    same = [pair for pair in table.pairs if len(set(pair)) < len(pair)]
    if same:
        section.wrong("nodes", f"{quoted(value)} has a pair of the same node twice, {same[0][0]}")
    given = [name for name in table.numbers if name != "area" and name in section.data]
    given += ["area"] if "area" in table.numbers and "areas" in section.data else []
    for name in given:
        key = "areas" if name == "area" else name
        section.wrong(key, f"is given here and as a column of {quoted(value)}; give it once")
    return _without_unused(section, value, table) if table.unused else table


def _without_unused(section: Section, value: str, table: PairTable) -> PairTable:
    """The pairs of a file with unknown columns: likely misspellings are mistakes, others are questioned."""
    known = (*NODES, *NUMBERS, *COORDINATES)
    lacking = [name for name in (*NUMBERS, *COORDINATES) if name not in table.numbers]
    for name in table.unused:
        word = SYNONYMS.get(name.casefold(), name)
        if word in known or nearest(word, lacking):
            section.wrong("nodes", f"{quoted(value)} has a column {quoted(name)}, of no meaning", word, known)
            return replace(table, unread=True)
    one = len(table.unused) == 1
    asked = (
        f"{section.at('nodes')}: {'is column' if one else 'are columns'} {choices(table.unused)} of "
        f"{quoted(value)} to be left out? Nothing is read from {'it' if one else 'them'}; what is read: "
        f"{', '.join(known)}"
    )
    return replace(table, said=(*table.said, Question(asked)))


def _listed(section: Section, value: Any) -> list[Pair]:
    """The pairs of a list in the scene."""
    if not isinstance(value, list | tuple) or not value:
        right = "a list of pairs such as [[40, 41], [50, 51]], a file, or { sets = , mesh = , tolerance = }"
        section.wrong("nodes", f"must be {right}, is {kind(value)}")
        return []
    if len(value) > 1 and not any(isinstance(item, list | tuple) for item in value):
        one, other = (described(item).removeprefix("the string ") for item in value[:2])
        more = ", ..." if len(value) > 2 else ""
        section.wrong(
            "nodes",
            f"may be pairs, or nodes that touch the ground: write [[{one}, {other}]{more}] or "
            f"[[{one}], [{other}]{more}]",
        )
        return []
    pairs = [_pair(section, index, item) for index, item in enumerate(value)]
    first: dict[frozenset[str], int] = {}
    for index, pair in enumerate(pairs):
        if pair and (before := first.setdefault(frozenset(pair), index)) < index:
            section.wrong(f"nodes[{index}]", f"is the same as nodes[{before}]; each is there once")
    return [pair for pair in pairs if pair] if all(pairs) else []


def _pair(section: Section, index: int, item: Any) -> Pair:
    nodes = item if isinstance(item, list | tuple) else [item]
    named = [isinstance(n, int | str) and not isinstance(n, bool) and str(n).strip() for n in nodes]
    right = 1 <= len(nodes) <= 2 and all(named)
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
    return direction_in(section, section.data[key], key)


def direction_in(section: Section, value: Any, key: str) -> dict[str, float]:
    """A value such as "x" or { x = 0.6, y = 0.8 } at a key, as weights; empty after a mistake."""
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
    """Notes, once for each node, the directions along which it has no degree of freedom."""
    if dofs is None:
        return
    needed = dict.fromkeys(one for weights in directions for one in weights)
    for node in dict.fromkeys(node for pair in pairs for node in pair):
        lacking = [quoted(one) for one in needed if not _at(dofs, node, one)]
        if lacking:
            what = f"node {node} has no degree of freedom along {', '.join(lacking)}"
            section.wrong("nodes", f"{what}; one that is held has no row")


def relative_displacement(weights: Mapping[str, float], pair: Pair, dofs: Names | None) -> FloatArray | None:
    """The relative displacement (dof,) of a pair along a direction; None if a node lacks the dof."""
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


def read_numbers(section: Section, table: PairTable, files: Files) -> dict[str, list[float]]:
    """mu, k_u, k_v, and n_0 or gap of each pair, from one number for all, a list, or a file.

    A total that pairs share by area is returned as the total for each pair: see `shares`.
    """
    count = len(table.pairs)
    load = load_key(section, table)
    found: dict[str, list[float]] = {}
    for key in ("mu", "k_u", "k_v", load):
        column = table.numbers.get(key)
        value = section.data.get(key)
        if column is not None:
            path = f"{section.at('nodes')} ({key})"
            found[key] = [section.checked(one, path, RULES[key]) for one in column]
        elif _is_list(value) or (isinstance(value, str) and number_in(value) is None):
            found[key] = _of_each(section, key, table, files)
        else:
            needed = key != load and not table.unread
            default = 0.0 if key == "k_u" and is_stop(section) else None
            number = section.number(key, RULES[key], default) if key in section.data or needed else nan
            found[key] = [number] * count
    return found


def _of_each(section: Section, key: str, table: PairTable, files: Files) -> list[float]:
    """The numbers of a list, or of a file, one for each pair; nan after a mistake."""
    value, count = section.data[key], len(table.pairs)
    nothing = [nan] * count
    if isinstance(value, str):
        try:
            with files.opened(value) as path:
                value = read_numbers_of_pairs(path, table.pairs)
        except DataFileError as error:
            for fault in _as_number(value, files) or error.faults:
                section.wrong(key, fault)
            return nothing
    numbers = section.numbers(value, section.at(key), RULES[key])
    if numbers is not None and count and len(numbers) != count:
        section.wrong(key, f"must have one number for each of {counted(count, 'pair')}, has {len(numbers)}")
        return nothing
    return nothing if numbers is None else [float(number) for number in numbers]


def _as_number(text: str, files: Files) -> list[str]:
    """Fault of a text that is meant as a number; empty if it is the name of a file."""
    is_file = not text[:1].isdigit() or (files.folder / text).exists()
    return [] if is_file else [f"{fault_of_number(text)}, without quotes and in the units of the scene"]


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple | np.ndarray)


def load_key(section: Section, table: PairTable) -> str:
    """The key, n_0 or gap, that the scene or a table of pairs gives; a mistake if both or neither."""
    given = [key for key in ("n_0", "gap") if key in section.data or key in table.numbers]
    if len(given) == 2:
        section.wrong("", "has both n_0 and gap; give one: gap means n_0 = -k_v * gap")
    elif not given and not table.unread:
        section.wrong("", "has neither n_0 nor gap; give one: gap means n_0 = -k_v * gap")
    return given[0] if given else "n_0"


def shares(section: Section, table: PairTable) -> list[dict[str, float]]:
    """Share by area of each pair in the numbers that are totals for all pairs; empty without areas.

    k_u, k_v and n_0 are totals unless given for each pair; mu and a gap are the same for all pairs.
    """
    count = len(table.pairs)
    areas = table.numbers.get("area")
    if "areas" in section.data:
        if "nodes" not in section.data:
            section.wrong("areas", "is of no use without nodes, whose areas they are")
            return [{}] * count
        if section.data["areas"] == EQUAL:
            return _shared(section, table, [1.0] * count)
        given = section.vector("areas", POSITIVE, 'a list of numbers, or "equal"')
        pairs = section.data["nodes"]
        known = count or (len(pairs) if _is_list(pairs) else 0)
        if given is not None and known and len(given) != known:
            section.wrong(
                "areas", f"must have one number for each of {counted(known, 'pair')}, has {len(given)}"
            )
        areas = None if given is None or len(given) != count else given.tolist()
    elif areas is not None and any(not area > 0.0 for area in areas):
        section.wrong("nodes", "its areas must be greater than 0")
        areas = None
    return [{}] * count if areas is None else _shared(section, table, areas)


def _shared(section: Section, table: PairTable, areas: list[float]) -> list[dict[str, float]]:
    """Share of each pair in the numbers that are totals, by known areas."""
    own = [*_own(section, table), *(["k_u"] if is_stop(section) else [])]
    parts = np.asarray(areas) / np.sum(areas)
    return [{key: float(part) for key in SHARED if key not in own} for part in parts]


def totals_of(section: Section, table: PairTable, numbers: Mapping[str, list[float]]) -> dict[str, float]:
    """Sums of those of k_u, k_v and n_0 that are given for each pair; empty without areas.

    If a total is changed, as by a sweep, the numbers of the pairs scale with it.
    """
    if "areas" not in section.data and "area" not in table.numbers:
        return {}
    return {key: fsum(numbers[key]) for key in _own(section, table) if key in numbers}


def _own(section: Section, table: PairTable) -> list[str]:
    """Keys among k_u, k_v and n_0 that are given for each pair: in a list, a file or a column."""
    return [key for key in SHARED if key in table.numbers or not _is_one(section.data.get(key))]


def _is_one(value: Any) -> bool:
    return not isinstance(value, str) and not _is_list(value)


def pairs_by_contact(drafts: Iterable[Mapping[str, Any]]) -> dict[str, list[Mapping[str, Any]]]:
    """The drafts of the pairs of each [[contact]] with node pairs, by its name."""
    found: dict[str, list[Mapping[str, Any]]] = {}
    for draft in drafts:
        if "group" in draft:
            found.setdefault(draft["group"], []).append(draft)
    return found


def notes_of_shares(drafts: Iterable[Mapping[str, Any]]) -> list[str]:
    """Notes on pairs with one number for all: a total shared by areas, or the same number for each pair."""
    said: dict[str, list[str]] = {}  # by sentence, the names of the contacts it applies to
    for name, pairs in pairs_by_contact(drafts).items():
        if share := pairs[0]["share"]:
            totals = _are([key for key in share if key in pairs[0]], "totals", "a total")
            said.setdefault(f"{totals}, which {len(pairs)} pairs share by their areas", []).append(name)
        elif len(pairs) > 1 and (same := [key for key in SHARED if _same(pairs, key)]):
            each = f"{_are(same, 'those', 'that')} of each of {len(pairs)} pairs"
            said.setdefault(f"{each}. With areas one number would be a total", []).append(name)
    return [
        f"{'contact' if len(names) == 1 else 'contacts'} {several(names)}: {text}"
        for text, names in said.items()
    ]


def _same(pairs: Sequence[Mapping[str, Any]], key: str) -> bool:
    """Whether a number is given, the same of all pairs, and not 0."""
    values = {pair[key] for pair in pairs if key in pair}
    return len(values) == 1 and values != {0.0}


def _are(keys: list[str], several: str, one: str) -> str:
    """Clause "a, b and c are ..." or "a is ..." on some keys."""
    if len(keys) < 2:
        return "".join(f"{key} is {one}" for key in keys)
    return f"{', '.join(keys[:-1])} and {keys[-1]} are {several}"
