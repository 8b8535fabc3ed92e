"""Checks that the contents of a MATLAB 5 file agree with its tags, on which scipy's reader relies.

Each element begins with its type and its number of bytes, or with both in one word and four bytes of data.
A matrix consists of elements: class and flags, size, name, and then what its class requires.
Source: MATLAB, MAT-File Format, version 5 (The MathWorks), tables 1-1 and 1-3.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Collection, Iterator
from math import prod
from typing import NamedTuple

from fcm.scene.files import UnreadableError

NUMBERS = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8}  # bytes of a number by its type
CHARACTERS = {1: 1, 2: 1, 3: 2, 4: 2, 16: 1, 17: 2, 18: 4}
INT8, INT32, UINT32, MATRIX, COMPRESSED = 1, 5, 6, 14, 15  # types
CELL, STRUCT, CHAR, SPARSE, FULL = 1, 2, 4, 5, range(6, 16)  # classes
COMPLEX = 8  # flag
HEAD, TAG, SMALL = 128, 8, 4  # bytes


class Element(NamedTuple):
    """One element of a file: its type and its bytes."""

    kind: int
    content: memoryview


def check_tags(content: bytes, wanted: Collection[str], largest: int) -> None:
    """Raise ValueError if a wanted array, or any element before it, contradicts its tag."""
    order = {b"\x00\x01IM": "<", b"\x01\x00MI": ">"}.get(content[HEAD - 4 : HEAD])
    if order is None:
        return  # another version, or no MATLAB file: the reader reports it
    for one in _elements(memoryview(content)[HEAD:], order):
        if one.kind == COMPRESSED:
            for inner in _elements(_unpacked(one.content, largest), order):
                _check_matrix(inner, order, wanted)
        else:
            _check_matrix(one, order, wanted)


def _elements(content: memoryview, order: str) -> Iterator[Element]:
    """Yields the consecutive elements."""
    place = 0
    while len(content) - place >= TAG:
        kind, size = struct.unpack_from(f"{order}II", content, place)
        small = kind >> 16
        begin = place + (SMALL if small else TAG)
        kind, size = (kind & 0xFFFF, small) if small else (kind, size)
        if (small and size > SMALL) or begin + size > len(content):
            raise UnreadableError("it is damaged: an element is longer than there is room")
        yield Element(kind, content[begin : begin + size])
        padding = 0 if kind == COMPRESSED else -size % TAG
        place = place + TAG if small else begin + size + padding


def _check_matrix(one: Element, order: str, wanted: Collection[str] | None) -> None:
    """Check a matrix unless its name is not wanted: such matrices are never read."""
    if one.kind != MATRIX:
        raise UnreadableError("it is damaged: there is an element of no type that there is")
    if not len(one.content):
        return
    flags, size, name, *parts = (*_elements(one.content, order),)
    head = (flags.kind, len(flags.content), size.kind, len(size.content) % 4, name.kind)
    if head != (UINT32, 8, INT32, 0, INT8):
        raise UnreadableError("it is damaged: a matrix does not begin with its class, size and name")
    if wanted is not None and bytes(name.content).decode("latin-1") not in wanted:
        return
    (word,) = struct.unpack_from(f"{order}I", flags.content)
    if word & 0xFF == STRUCT:
        raise UnreadableError(of_struct(bytes(name.content).decode("latin-1")))
    count = prod(struct.unpack(f"{order}{len(size.content) // 4}i", size.content))
    if not _fits(word & 0xFF, bool(word >> 8 & COMPLEX), count, parts):
        raise UnreadableError("it is damaged: an array is no numbers or names, or not as many as it says")
    for part in parts:
        if part.kind == MATRIX:
            _check_matrix(part, order, None)


def of_struct(name: str) -> str:
    """Sentence that a variable is a struct, which is not read."""
    shown = f'"{name}"' if name else "a part of an array"
    return f"{shown} is a struct: save its fields as variables of their own, in MATLAB by save -struct"


def _fits(kind: int, is_complex: bool, count: int, parts: list[Element]) -> bool:
    """Whether a matrix has the parts that its class requires."""
    kinds = [part.kind for part in parts]
    if kind == CELL:
        return kinds == [MATRIX] * count
    if kind == CHAR:
        return len(parts) == 1 and kinds[0] in CHARACTERS and _holds(parts[0], CHARACTERS, count)
    if kind == SPARSE:
        return kinds[:2] == [INT32, INT32] and len(parts) == 3 + is_complex and set(kinds) <= set(NUMBERS)
    numeric = kind in FULL and len(parts) == 1 + is_complex and set(kinds) <= set(NUMBERS)
    return numeric and all(_holds(part, NUMBERS, count) for part in parts)


def _holds(part: Element, sizes: dict[int, int], count: int) -> bool:
    # a character may take several units of UTF-8 or UTF-16
    exact = len(part.content) == count * sizes[part.kind]
    return exact or (part.kind in (16, 17) and len(part.content) >= count * sizes[part.kind] >= 0)


def _unpacked(content: memoryview, largest: int) -> memoryview:
    packed = zlib.decompressobj()
    found = packed.decompress(content, largest)
    if packed.unconsumed_tail:
        raise MemoryError
    return memoryview(found)
