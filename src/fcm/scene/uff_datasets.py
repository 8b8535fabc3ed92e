"""Reads the datasets of a universal file (.uff, .unv), each with its lines.

A dataset stands between two marks, lines with -1 in columns 1 to 6, and begins with its number. Two rules
prevent taking contents for the end mark. The first line of a binary dataset (58b) says how many lines of text
and how many bytes follow. A -1 among the lines of text at the head of a dataset is text, unless the next
dataset or the end of the file follows it.
Source: SDRC I-DEAS Test Data Universal File Format, as published by the University of Cincinnati.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from fcm.scene.errors import quoted
from fcm.scene.files import DataFileError
from fcm.scene.number_text import number_in

HEADS = {"55": 5, "56": 5, "57": 5, "58": 5, "151": 7, "2414": 8}  # lines of text after the number
AT_NODES = 1  # location of the data of a dataset 2414
MOST_ASCII_LINES = 50  # greatest number of lines of text in a binary dataset; 58b has 11
BYTES = {2: 4, 4: 8, 5: 8, 6: 16}  # bytes of an ordinate, by the data type of dataset 58
BIG_ENDIAN = 2  # code of this byte order in a binary dataset
SINGLE = (2, 5)  # data types with abscissae of single precision
_MARK = re.compile(rb" {0,4}-1[ \t\r]*")
_ANY_MARK = re.compile(rb"^ {0,4}-1[ \t\r]*$", re.MULTILINE)
_BINARY = re.compile(rb"\s*(\d+)[bB]((?:\s+\d+)*)\s*")
_END = re.compile(rb"[ \t\r\n]*-1[ \t\r]*(?:\n|\Z)")  # end mark after the bytes of a binary dataset
_ANY_END = re.compile(rb" {4}-1[ \t\r]*(?:\n\s*-1[ \t\r]*(?:\n|\Z)|\s*\Z)")  # an end mark and what follows it
_NOTHING = b" \t\r\n\x00\x1a"  # characters between datasets, and with which some programs fill up a file


class Dataset(NamedTuple):
    """One dataset: its number such as "55" or "58b", its lines, and the line number of the first.

    For a binary dataset these are the lines before the bytes (payload).
    """

    kind: str
    lines: tuple[str, ...]
    first: int
    payload: bytes = b""
    big_endian: bool = False

    def integers(self, line: int) -> list[int]:
        """The whole numbers of a line, in columns of ten or separated; empty if it has other words."""
        text = self.lines[line] if line < len(self.lines) else ""
        words = text.split()
        if any(len(word) > 10 for word in words):
            words = [word for at in range(0, len(text), 10) if (word := text[at : at + 10].strip())]
        right = all(re.fullmatch(r"[-+]?\d{1,10}", word, re.ASCII) for word in words)
        return [int(word) for word in words] if right else []

    def at_nodes(self) -> bool:
        """Whether the data of a dataset 2414 are at nodes, by its second line with a single whole number."""
        alone = [found[0] for at in range(HEADS["2414"]) if len(found := self.integers(at)) == 1]
        return alone[1:2] == [AT_NODES]

    def definition(self) -> int:
        """Index of the line of a dataset 55 or 2414 with six whole numbers that define the data; -1 if none.

        Blank lines before it count as additional to the lines of text of the format.
        """
        first = HEADS.get(self.kind, 0)
        blank = 0
        for at, line in enumerate(self.lines):
            if at >= first and len(self.integers(at)) == 6:
                return at
            blank += not line.strip()
            if at >= first + blank:
                return -1
        return -1


class _Text:
    """The bytes of a file, line by line."""

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.at = 0  # position of the next line
        self.number = 1  # number of the next line

    def __bool__(self) -> bool:
        return self.at < len(self.content)

    def peeked(self) -> bytes:
        """The next line, without moving on."""
        end = self.content.find(b"\n", self.at)
        return self.content[self.at : end if end >= 0 else len(self.content)]

    def line(self) -> bytes:
        """The next line, moving on past it."""
        found = self.peeked()
        self.to(self.at + len(found) + 1)
        return found

    def to(self, place: int) -> None:
        """Moves on to a position."""
        self.number += self.content.count(b"\n", self.at, place)
        self.at = place

    def ended(self) -> bool:
        """Whether a mark or the end of the file comes next, after blank lines."""
        rest = re.compile(rb"\s*").match(self.content, self.at)
        at = rest.end() if rest else self.at
        begin = self.content.rfind(b"\n", self.at, at) + 1 or self.at
        end = self.content.find(b"\n", at)
        line = self.content[begin : end if end >= 0 else len(self.content)]
        return not line.strip(_NOTHING) or bool(_MARK.fullmatch(line))


def system_of(every: Iterable[Dataset]) -> tuple[float, float] | None:
    """The units of length [m] and force [N] of dataset 164, which has factors from SI to these; or None."""
    for one in every:
        words = one.lines[1].split()[:2] if one.kind == "164" and len(one.lines) > 1 else []
        numbers = [number_in(word) for word in words]
        if len(numbers) == 2 and all(number is not None and number > 0.0 for number in numbers):
            length, force = (float(number or 1.0) for number in numbers)
            return 1.0 / length, 1.0 / force
    return None


def read_datasets(path: Path) -> list[Dataset]:
    """Reads all datasets of a file.

    Raises
    ------
    DataFileError
        If the file is cut off within a dataset, or has text outside of datasets.
    """
    content = path.read_bytes().removeprefix(b"\xef\xbb\xbf")
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise DataFileError(f"{quoted(path.name)} cannot be read: it is text in UTF-16: save it as UTF-8")
    text = _Text(content if b"\n" in content else content.replace(b"\r", b"\n"))
    found: list[Dataset] = []
    while text:
        line, number = text.line(), text.number - 1
        if not line.strip(_NOTHING):
            continue
        if not _MARK.fullmatch(line):
            if not found and not _ANY_MARK.search(text.content):
                return []
            what = "is outside of the datasets, which begin and end with a line of -1"
            shown = quoted(line.decode("latin-1").strip(), 20)
            raise DataFileError(f"{quoted(path.name)} cannot be read: line {number}, {shown}, {what}")
        while text and not text.peeked().strip():
            text.line()
        if text and not _MARK.fullmatch(text.peeked()):
            found.append(_dataset(text, path))
    return found


def _dataset(text: _Text, path: Path) -> Dataset:
    """Reads the dataset whose number comes next, up to past its end mark."""
    number, head = text.number, text.line()
    binary = _BINARY.fullmatch(head)
    words = [int(word) if len(word) < 12 else 0 for word in (binary[2].split() if binary else ())]
    kind = f"{binary[1].decode()}b" if binary else head.decode("latin-1").strip()
    lines: list[str] = []
    first = text.number
    if len(words) >= 4:  # byte order, number format, lines of text, bytes
        order, _, ascii_lines, size = words[:4]
        while text and len(lines) < min(ascii_lines, MOST_ASCII_LINES):
            lines.append(_decoded(text.line()))
        found = Dataset(kind, tuple(lines), first)
        if past := _past_bytes(text, size, _bytes_of(found)):
            payload = text.content[text.at : text.at + size]
            text.to(past)
            return found._replace(payload=payload, big_endian=order == BIG_ENDIAN)
    while text and len(words) < 4:
        line = text.line()
        if _MARK.fullmatch(line) and (len(lines) >= HEADS.get(kind, 0) or text.ended()):
            return Dataset(kind, tuple(lines), first)
        lines.append(_decoded(line))
    what = f"line {number}, it is cut off within a dataset {quoted(kind, 6)}, without a -1 behind"
    raise DataFileError(f"{quoted(path.name)} cannot be read: {what}")


def _past_bytes(text: _Text, *sizes: int) -> int:
    """Position after the end mark of a binary dataset; 0 if there is no mark.

    sizes: possible numbers of bytes, as stated in the file and as its points need. If no mark follows
    either, as after a conversion of line ends, the file is searched for the mark.
    """
    for size in sizes:
        if end := _END.match(text.content, text.at + size):
            return end.end()
    if end := _ANY_END.search(text.content, text.at):
        return text.content.index(b"-1", end.start()) + 2
    return 0


def _bytes_of(one: Dataset) -> int:
    """The number of bytes of the points of a dataset 58b, by its seventh line: type, points, spacing."""
    kind, points, even = [*map(_whole, (one.lines[6] if len(one.lines) > 6 else "").split()[:3]), 0, 0, 0][:3]
    return points * (BYTES.get(kind, 0) + (0 if even else 4 if kind in SINGLE else 8))


def _whole(word: str) -> int:
    return int(word) if word.isdecimal() and len(word) < 12 else 0


def _decoded(line: bytes) -> str:
    return line.decode("latin-1").rstrip("\r")
