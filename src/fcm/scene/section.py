"""Reads one table of a scene: checks its keys and their types, and notes mistakes with their paths."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import nan, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.model.scene import FloatArray
from fcm.scene.errors import Mistakes, bare, choices, kind, nearest, quoted, shown
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.options import MESSAGES
from fcm.scene.rules import ANY, Rule, as_float

if TYPE_CHECKING:
    from fcm.scene.names import Names

Part = dict[str, Any]  # draft of a table: its values as read, with the keys of the file
Parts = dict[str, Any]  # drafts of a scene by table: modal, contact, force, ...


SYNONYMS = {  # common other names of keys
    "k_t": "k_u", "kt": "k_u", "k_tau": "k_u", "k_n": "k_v", "kn": "k_v", "friction": "mu", "preload": "n_0",
    "clearance": "gap", "n0": "n_0", "k": "stiffness", "m": "mass", "modal_mass": "mass",
    "modal_masses": "mass", "generalized_mass": "mass",
}  # fmt: skip


class Section:
    """A table with its path; its readers note a mistake and return a placeholder, so that reading goes on."""

    def __init__(self, data: Mapping[str, Any], path: str, mistakes: Mistakes) -> None:
        self.data = data
        self.path = path
        self.mistakes = mistakes

    def at(self, key: str) -> str:
        """The path of a key of this table."""
        return f"{self.path}.{key}" if self.path else key

    def wrong(self, key: str, what: str, word: str = "", among: Iterable[str] = ()) -> None:
        """Adds a mistake at a key."""
        self.mistakes.add(self.at(key) if key else self.path, what, word, among)

    def only(self, *known: str) -> None:
        """Notes every unknown key, with the likely one, or with all known keys if they are few."""
        for key in self.data:
            if key in known:
                continue
            word = SYNONYMS.get(str(key), str(key))
            few = 0 < len(known) <= MESSAGES.known_keys and not nearest(word, known)
            there = f"; known here: {', '.join(map(quoted, known))}" if few else ""
            self.wrong(bare(key), f"unknown key{there}", word, known)

    def missing(self, key: str, right: str) -> bool:
        """Whether the key is missing, which is noted as a mistake."""
        if key in self.data:
            return False
        self.wrong(key, f"missing; give {right}")
        return True

    def number(self, key: str, rule: Rule, default: float | None = None) -> float:
        """A number within the rule; the default when there is none; nan after a mistake."""
        if key not in self.data and default is not None:
            return default
        if self.missing(key, "a number"):
            return nan
        return self.checked(self.data[key], self.at(key), rule)

    def checked(self, value: object, path: str, rule: Rule) -> float:
        """The value as a number within the rule; nan after a mistake."""
        number = as_float(value)
        if number is None:
            self.mistakes.add(path, f"must be a number, is {described(value)}{written_as(value)}")
            return nan
        fault = rule.fault(number)
        if fault:
            self.mistakes.add(path, fault)
        return nan if fault else number

    def angle(self, key: str, default: float | None = None) -> float:
        """An angle [rad], given in rad, or in degrees as "45deg"."""
        value = self.data.get(key)
        if not isinstance(value, str):
            return self.number(key, ANY, default)
        angle = angle_in(value)
        if angle is None:
            what = f"must be a number, is the string {quoted(value)}"
            number = number_in(value.rstrip("\u00b0 "))
            asked = "45" if number is None or "\u00b0" not in value else f"{number:.12g}"
            self.wrong(key, f'{what}; degrees are written "{asked}deg"')
        return nan if angle is None else angle

    def text(self, key: str, default: str | None = None) -> str:
        """A string; empty after a mistake."""
        if key not in self.data and default is not None:
            return default
        if self.missing(key, "a string"):
            return ""
        value = self.data[key]
        if isinstance(value, str):
            return value
        self.wrong(key, f"must be a string, is {described(value)}")
        return ""

    def vector(self, key: str, rule: Rule, right: str = "a list of numbers") -> FloatArray | None:
        """A list of numbers; None after a mistake."""
        if self.missing(key, right):
            return None
        return self.numbers(self.data[key], self.at(key), rule, right)

    def numbers(
        self, value: object, path: str, rule: Rule, right: str = "a list of numbers"
    ) -> FloatArray | None:
        """The value as an array of numbers within the rule; None after a mistake."""
        if isinstance(value, np.ndarray) and (value.ndim != 1 or value.dtype.kind not in "iuf"):
            value = value.tolist()
        if not isinstance(value, list | tuple | np.ndarray):
            self.mistakes.add(path, f"must be {right}, is {described(value)}")
            return None
        array = np.array(value if isinstance(value, np.ndarray) else _floats(value), dtype=np.float64)
        faulty = rule.faulty(array)[:, 0].tolist()
        for index in faulty:
            self.checked(value[index], f"{path}[{index}]", rule)
        return None if faulty else array

    def table(self, key: str, right: str) -> Section | None:
        """A table within this one; None when it is missing or not a table."""
        if key not in self.data:
            self.wrong(key, f"missing; give {right}")
            return None
        value = self.data[key]
        if isinstance(value, Mapping):
            return Section(value, self.at(key), self.mistakes)
        many = isinstance(value, list) and value and isinstance(value[0], dict)
        hint = f"; there is one of it: write [{key}]" if many else ""
        self.wrong(key, f"must be a table, is {described(value)}{hint}")
        return None

    def tables(self, key: str) -> list[Section]:
        """A list of tables, empty when the key is missing; those that are not tables are left out."""
        value = self.data.get(key, [])
        if not isinstance(value, list | tuple):
            self.wrong(key, f"must be a list of tables, is {described(value)}; write [[{self.at(key)}]]")
            return []
        sections = []
        for index, item in enumerate(value):
            path = f"{self.at(key)}[{index}]"
            if isinstance(item, Mapping):
                sections.append(Section(item, path, self.mistakes))
            else:
                self.mistakes.add(path, f"must be a table, is {described(item)}; write [[{self.at(key)}]]")
        return sections

    def weights(self, key: str, dofs: Names | None) -> FloatArray | None:
        """A degree of freedom, or a table of weights, as an array over the dofs; None after a mistake."""
        if self.missing(key, f"a degree of freedom, or a combination such as {_combination(dofs)}"):
            return None
        return self.weights_in(self.data[key], key, dofs)

    def weights_in(self, value: object, key: str, dofs: Names | None) -> FloatArray | None:
        """Weights over the dofs from a value at a key: a name or a table; None after a mistake."""
        if not isinstance(value, str | Mapping):
            self.wrong(key, f"must be a degree of freedom or a table of weights, is {described(value)}")
            return None
        terms = {value: 1.0} if isinstance(value, str) else self._terms(key, value)
        if terms is None or dofs is None or not self._known(key, terms, dofs):
            return None
        found = np.zeros(len(dofs))
        for dof, weight in terms.items():
            found[dofs.place[dofs.find(dof)]] += weight
        return found

    def _terms(self, key: str, value: Mapping[str, Any]) -> dict[str, float] | None:
        before = self.mistakes.count
        terms = {str(dof): self._weight(key, dof, item) for dof, item in value.items()}
        if not terms:
            self.wrong(key, "is an empty combination; name at least one degree of freedom")
        elif not any(terms.values()):
            self.wrong(key, "has only zero weights, so it moves nothing")
        return terms if self.mistakes.count == before else None

    def _weight(self, key: str, dof: object, item: object) -> float:
        path = f"{self.at(key)}.{bare(dof)}"
        if isinstance(item, Mapping):
            self.mistakes.add(path, "must be a number, is a table; put a name with a dot in quotes")
            return nan
        return self.checked(item, path, ANY)

    def _known(self, key: str, terms: Iterable[str], dofs: Names) -> bool:
        unknown = [dof for dof in terms if not dofs.find(dof)]
        for dof in unknown:
            what = f"unknown degree of freedom {quoted(dof)}"
            if of_node := dofs.of_node(dof):
                self.wrong(key, f"{what}{of_node}")
            else:
                self.wrong(key, f"{what}; {dofs.key} are {choices(dofs)}{dofs.held(dof)}", dof, dofs)
        return not unknown


def angle_in(text: str) -> float | None:
    """The angle [rad] of a text in degrees; None for another text.

    >>> angle_in("180deg"), angle_in("180"), angle_in("north")
    (3.141592653589793, None, None)
    """
    degrees = number_in(text.removesuffix("deg").rstrip()) if text.endswith("deg") else None
    return None if degrees is None else radians(degrees)


def _combination(dofs: Names | None) -> str:
    """An example of weights, with names of the scene.

    >>> from fcm.scene.names import Names
    >>> _combination(Names(("u", "2x"))), _combination(None)
    ('{ u = 1.0, "2x" = -1.0 }', '{ tip = 1.0, neighbour = -1.0 }')
    """
    two = list(dofs)[:2] if dofs is not None and len(dofs) > 1 else ["tip", "neighbour"]
    return "{{ {} = 1.0, {} = -1.0 }}".format(*map(bare, two))


def written_as(value: object) -> str:
    """Hint on what to write in place of a string that is nearly a number; else ''.

    >>> written_as("0.4"), written_as("0,4"), written_as("x")
    ('; write 0.4', '; it has a decimal comma: write 0.4', '')
    """
    text = value.strip() if isinstance(value, str) else ""
    number = number_in(text)
    if number is not None:
        return f"; write {shown(number)}"
    fault = fault_of_number(text).removeprefix(quoted(text))
    return f"; it{fault}" if ": write " in fault else ""


def _floats(values: Sequence[object]) -> list[float]:
    """The values as numbers, nan for values that are not numbers."""
    numbers = (as_float(value) for value in values)
    return [nan if number is None else number for number in numbers]


def described(value: object) -> str:
    """The kind of a value, and the value when it is short."""
    if isinstance(value, bool | int | float):
        return shown(value)
    return f"the string {shown(value)}" if isinstance(value, str) else kind(value)
