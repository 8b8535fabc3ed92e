"""Reads files for contacts over node pairs: pairs with their numbers, or one number for each pair."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import field, replace
from pathlib import Path

import numpy as np

from fcm.frozen import Frozen
from fcm.model.interface import FloatArray, Interface
from fcm.scene.errors import choices, quoted
from fcm.scene.files import DataFileError
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.options import MESSAGES

_COMMA = re.compile(r"\d+,\d+", re.ASCII)
# node numbers as written by numpy, and by pandas in a column with empty cells
_FLOAT = re.compile(r"\d+\.\d*(e[+]?\d{1,2})?", re.ASCII | re.IGNORECASE)
NODES = ("node", "other")  # columns of the two nodes; other is empty for a contact with the ground
NUMBERS = ("area", "mu", "k_u", "k_v", "n_0", "gap")
COORDINATES = ("x", "y", "z")


class PairTable(Frozen):
    """Node pairs, and the data that a file gives for each.

    numbers: (pair,) by column; unused: names of columns that are not read; places: coordinates (pair, 3) in
    the file; interface: places of both nodes; said: notes; unread: whether the file could not be read, so
    that its numbers are unknown.
    """

    pairs: list[tuple[str, ...]]
    numbers: dict[str, list[float]] = field(default_factory=dict)
    unused: tuple[str, ...] = ()
    places: FloatArray | None = None
    interface: Interface | None = None
    said: tuple[str, ...] = ()
    unread: bool = False


def read_pair_table(path: Path) -> PairTable:
    """The pairs of a CSV file, whose first line names its columns.

    The columns are node, other, and any of area, mu, k_u, k_v, n_0, gap, x, y, z.

    Raises
    ------
    DataFileError
        If lines are wrong; the message lists them, each with its fault and what would be right.
    """
    lines = list(_lines(path))
    if not lines:
        raise DataFileError(f"{quoted(path.name)} is empty; its first line must name its columns: node,other")
    written = [word.strip() for word in lines[0][1]]
    known = {*NODES, *NUMBERS, *COORDINATES}
    header = [lower if (lower := word.casefold()) in known else word for word in written]
    missing = [name for name in NODES if name not in header]
    twice = [name for name in dict.fromkeys(header) if header.count(name) > 1]
    if missing or twice:
        what = f"has no column {choices(missing)}" if missing else f"has two columns {choices(twice)}"
        raise DataFileError(
            f"{quoted(path.name)}, line {lines[0][0]}: {what}; it names {choices(header)}, "
            "and names have commas between, as node,other,n_0"
        )
    faults: list[str] = []
    where = list(COORDINATES) if set(COORDINATES) <= set(header) else []
    places: list[list[float]] = []
    table = PairTable([], {name: [] for name in header if name in NUMBERS}, _unused(header))
    first: dict[frozenset[str], int] = {}  # line of each pair, regardless of the order of its nodes
    for number, words in lines[1:]:
        if len(words) != len(header):
            has = f"line {number} has {len(words)} {'entry' if len(words) == 1 else 'entries'}"
            faults.append(f"{has}; the first line names {len(header)}, with commas between")
            continue
        row = dict(zip(header, (word.strip() for word in words), strict=True))
        if not row["node"]:
            faults.append(f"line {number}: has no node")
        pair = tuple(_node(row[name]) for name in NODES if row[name])
        if (before := first.setdefault(frozenset(pair), number)) < number:
            which = f"pair {', '.join(pair)}" if len(pair) > 1 else f"node {', '.join(pair)}"
            faults.append(f"line {number}: {which} is on line {before} already; each is there once")
        table.pairs.append(pair)
        for name, values in table.numbers.items():
            value = number_in(row[name])
            if value is None:
                faults.append(f"line {number}: {name}: {fault_of_number(row[name])}")
            else:
                values.append(value)
        found = [number_in(row[name]) for name in where]
        places.append([0.0 if value is None else value for value in found])
        faults += [
            f"line {number}: {name}: {fault_of_number(row[name])}"
            for name, value in zip(where, found, strict=True)
            if value is None
        ]
    if not table.pairs and not faults:
        faults.append("holds no pair of nodes behind its first line")
    if faults:
        raise DataFileError(*(f"{quoted(path.name)}, {fault}" for fault in faults[: MESSAGES.faults]))
    return replace(table, places=np.array(places)) if where else table


def _unused(header: Sequence[str]) -> tuple[str, ...]:
    known = (*NODES, *NUMBERS, *COORDINATES)
    return tuple(name for name in header if name not in known)


def read_numbers_of_pairs(path: Path, pairs: Sequence[tuple[str, ...]]) -> list[float]:
    """A number for each pair, from lines with one number each in order, or with a node and its number.

    With nodes, each pair gets the number of its first node, or else that of its other node.
    """
    rows: list[list[str]] = []
    faults: list[str] = []
    commas = list[str]()  # words that may be numbers with decimal commas
    for number, words in _lines(path):
        commas += [",".join(words)] if _COMMA.fullmatch(",".join(words)) else []
        words = [word for one in words for word in one.split()]
        value = number_in(words[-1]) if words else None
        if len(words) not in (1, 2) or (rows and len(rows[0]) != len(words)):
            faults.append(f"line {number}: must be a number, or a node and a number, as all others")
        elif value is None:
            faults.append(f"line {number}: {fault_of_number(words[-1])}")
        else:
            rows.append(words)
    if rows and len(commas) == len(rows):
        one, point = commas[0], commas[0].replace(",", ".")
        what = f"{quoted(one)} may be a number with a decimal comma, or a node and its number"
        faults.append(f"{what}, and so may all others: write {point}, or {one.replace(',', ' ')}")
    if faults:
        raise DataFileError(*(f"{quoted(path.name)}, {fault}" for fault in faults[: MESSAGES.faults]))
    values = [number_in(words[-1]) or 0.0 for words in rows]
    if not rows or len(rows[0]) == 1:
        if len(values) != len(pairs):
            raise DataFileError(f"{quoted(path.name)} has {len(values)} numbers for {len(pairs)} pairs")
        return values
    of_node = dict(zip((_node(words[0]) for words in rows), values, strict=True))
    if len(of_node) < len(rows):
        raise DataFileError(f"{quoted(path.name)} has two numbers for one node")
    known = {node for pair in pairs for node in pair}
    stray = [node for node in of_node if node not in known] if pairs else []
    if stray:
        how_many = "1 row" if len(stray) == 1 else f"{len(stray)} rows"
        raise DataFileError(
            f"{quoted(path.name)} has {how_many} of nodes that are in no pair, "
            f"the first of node {quoted(stray[0])}"
        )
    found = [next((node for node in pair if node in of_node), None) for pair in pairs]
    lacking = [pair[0] for pair, node in zip(pairs, found, strict=True) if node is None]
    if lacking:
        raise DataFileError(f"{quoted(path.name)} has no number for the pair of node {choices(lacking)}")
    return [of_node[node] for node in found if node is not None]


def _node(word: str) -> str:
    """The name of a node; a whole number written as a float is reduced to its digits.

    >>> _node("111.0"), _node("1.11e+02"), _node("111"), _node("1.5"), _node("tip")
    ('111', '111', '111', '1.5', 'tip')
    """
    value = float(word) if _FLOAT.fullmatch(word) else 0.5
    return str(int(value)) if value.is_integer() else word


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yields the number and words of each line, without blank lines and comments after #."""
    try:
        text = path.read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise DataFileError(f"{quoted(path.name)} is no text in UTF-8; save it as that") from None
    for number, line in enumerate(text.splitlines(), 1):
        body = line.partition("#")[0]
        if body.strip():
            yield number, next(csv.reader([body]))
