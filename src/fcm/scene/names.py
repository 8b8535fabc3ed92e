"""Names of contacts and degrees of freedom: which are allowed, and which are the same."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cached_property
from unicodedata import normalize

from fcm.scene.errors import kind, quoted
from fcm.scene.options import LIMITS
from fcm.scene.section import Section

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")  # components 1 to 6 of Nastran
_AT_NODE = re.compile(r"(\d+)[:. ]?(r?[xyz]|[1-6])", re.IGNORECASE)


class Names(tuple[str, ...]):
    """The names of the degrees of freedom of a structure."""

    key = "modal.dofs"  # key of the scene that gives them

    @cached_property
    def _at_nodes(self) -> dict[str, str]:
        return {motion_of(name): name for name in self if motion_of(name)}

    @cached_property
    def place(self) -> dict[str, int]:
        """Index of each name."""
        return {name: number for number, name in enumerate(self)}

    def find(self, name: str) -> str:
        """The degree of freedom with a name, which may be written as 40x, 40:x or 40:1; empty if none.

        >>> Names(("40x", "tip")).find("40:1"), Names(("40x", "tip")).find("tip")
        ('40x', 'tip')
        >>> Names(("11", "tip")).find("1x"), Names(("1x", "tip")).find("11")  # "11" may be the eleventh row
        ('', '')
        """
        return name if name in self.place else self._at_nodes.get(motion_of(name), "")

    def of_node(self, number: str) -> str:
        """Hint on a number that is not a name but a node; else ''.

        >>> Names(("36x", "36z", "tip")).of_node("36"), Names(("36x", "tip")).of_node("3")
        ('; a number alone is no name: write "36x" or "36z"', '')
        """
        if not number.isdecimal() or number in self.place:
            return ""
        own = [name for name in self if name.startswith(number) and not name[len(number)].isdecimal()]
        return f"; a number alone is no name: write {' or '.join(map(quoted, own[:6]))}" if own else ""

    def held(self, name: str) -> str:
        """Hint on why a name may have no row; '' if there is no known reason."""
        return ""


class RowNames(Names):
    """The names of the rows of matrices."""

    key = "structure.dofs"

    def held(self, name: str) -> str:
        """Hint that a name made of node and direction may be held by a support; else ''.

        >>> RowNames(("40x", "tip")).held("1x"), RowNames(("40x", "tip")).held("q")
        ('; one that is held has no row', '')
        """
        return "; one that is held has no row" if motion_of(name) else ""


class RowNamesOfFiles(RowNames):
    """Row names that the files of the matrices give, in the order of the first file."""


def motion_of(name: str) -> str:
    """Node and direction of a name as `at_node`; empty for a number alone, which means a row."""
    return "" if name.isdecimal() else at_node(name)


def at_node(name: str) -> str:
    """The normalised form of a node and a direction, such as 40x; empty if the name has another form.

    >>> at_node("40:1"), at_node("40X"), at_node("40.1"), at_node("7ry"), at_node("tip")
    ('40x', '40x', '40x', '7ry', '')
    """
    match = _AT_NODE.fullmatch(name)
    if not match:
        return ""
    direction = match[2].lower()
    return match[1] + (DIRECTIONS[int(direction) - 1] if direction.isdecimal() else direction)


def checked_names(section: Section, names: object) -> tuple[str, ...] | None:
    """The names of degrees of freedom, checked to be printable strings, each once; None after a mistake."""
    if not isinstance(names, list | tuple) or not names:
        section.wrong("dofs", f"must be a list of at least one name, is {kind(names)}")
        return None
    for index, name in enumerate(names):
        if not isinstance(name, str):
            section.wrong(f"dofs[{index}]", f"must be a string, is {kind(name)}")
        elif fault := unfit_name(name) or starred(name):
            section.wrong(f"dofs[{index}]", fault)
    words = [name for name in names if isinstance(name, str)]
    for name, group in same_names(words):
        what = f"{quoted(name)} is there {len(group)} times{otherwise_written(group)}"
        section.wrong("dofs", f"{what}; each must be there once")
    for one, other in same_motions(words):
        section.wrong("dofs", f"{quoted(one)} and {quoted(other)} are the same; each must be there once")
    return tuple(words) if len(words) == len(names) else None


def unfit_name(name: str) -> str:
    """Fault of a name of a contact or a degree of freedom; empty if there is none.

    >>> unfit_name(""), unfit_name("tip"), unfit_name("x" * 101)
    ('"" is not a name that can be printed', '', 'is too long for a name: 101 bytes, of 100 at most')
    """
    if not name.strip() or not name.isprintable():
        return f"{quoted(name)} is not a name that can be printed"
    size = len(name.encode())
    return (
        f"is too long for a name: {size} bytes, of {LIMITS.longest_name} at most"
        if size > LIMITS.longest_name
        else ""
    )


def starred(name: str) -> str:
    """Fault of a name with a *, which in keys stands for several names; else ''.

    >>> starred("tip*"), starred("tip")
    ('"tip*" has a *, which stands for any letters in keys such as contact.*.n_0; write it without', '')
    """
    if "*" not in name:
        return ""
    means = "which stands for any letters in keys such as contact.*.n_0"
    return f"{quoted(name)} has a *, {means}; write it without"


def same_names(names: Iterable[str]) -> list[tuple[str, list[str]]]:
    """Names that occur more than once, when compared with composed Unicode characters, as in files.

    >>> same_names(["u", "v", "u"])
    [('u', ['u', 'u'])]
    """
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(name if name.isascii() else normalize("NFC", name), []).append(name)
    return [(name, group) for name, group in groups.items() if len(group) > 1]


def same_motions(names: Iterable[str]) -> list[tuple[str, str]]:
    """Pairs of different names for one motion of a node, which contacts could not distinguish.

    >>> same_motions(["40x", "40:2", "40:1", "tip"])
    [('40x', '40:1')]
    """
    first: dict[str, str] = {}
    motions = [(motion, name) for name in names if (motion := motion_of(name))]
    return [(one, name) for motion, name in motions if (one := first.setdefault(motion, name)) != name]


def otherwise_written(group: list[str]) -> str:
    """A remark on names that look the same but have differently composed Unicode characters; else ''."""
    return "" if len(set(group)) == 1 else " (in other Unicode characters)"
