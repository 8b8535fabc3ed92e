"""Where a key path such as "contact.shroud.n_0" is in a scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from fcm.scene.errors import Mistakes, quoted

Address = tuple[str | int, ...]  # of a number, or of a vector whose numbers are all set
VECTORS = ("mass", "frequency", "damping")  # of the modal table


class Addresses:
    """The numbers of a scene that can be swept, by their key paths."""

    def __init__(self, parts: Mapping[str, Any]) -> None:
        self.parts = parts
        self.dofs = {dof: index for index, dof in enumerate(parts["modal"]["dofs"] or ())}
        self.numbers = dict(_numbers(parts))
        self.arrays = dict(_arrays(parts))

    def find(self, key: str, path: str, mistakes: Mistakes) -> Address | None:
        """The address of a key path; None after a mistake."""
        address = self.numbers.get(key) or self._element(key)
        if address is None and not self._excused(key, path, mistakes):
            mistakes.add(path, "there is no such number in the scene to sweep", key, self.numbers)
        return address

    def _element(self, key: str) -> Address | None:
        """A number in an array: a dof's weight, or a mode's value at a dof."""
        for prefix, address in self.arrays.items():
            rest = key.removeprefix(f"{prefix}.")
            if rest != key and rest in self.dofs:
                return (*address, self.dofs[rest])
            if rest != key and address[0] == "modal" and (index := _index(rest, len(self.dofs))) is not None:
                return (*address, index)
        return None

    def _excused(self, key: str, path: str, mistakes: Mistakes) -> bool:
        """Keys with a better explanation than that they are not there."""
        if key.startswith(("response.", "schedule.", "start.")):
            mistakes.add(path, "the range, the step and the schedule cannot be swept")
        elif key.endswith((".n_0", ".gap")) and (other := _other_load(key)) in self.numbers:
            mistakes.add(path, f"the contact is given by {other.rpartition('.')[2]}; sweep {quoted(other)}")
        else:
            return key.startswith("modal.") and any(part is None for part in self.parts["modal"].values())
        return True


def replaced(tree: Any, address: Address, value: float) -> Any:
    """The tree with a number replaced; what is not on the way to it is shared.

    >>> replaced({"contact": [{"mu": 0.4}, {"mu": 0.5}]}, ("contact", 1, "mu"), 0.6)
    {'contact': [{'mu': 0.4}, {'mu': 0.6}]}
    """
    if not address:
        return np.full_like(tree, value) if isinstance(tree, np.ndarray) else value
    copy = tree.copy()
    if isinstance(tree, np.ndarray):
        copy[address] = value
    else:
        copy[address[0]] = replaced(tree[address[0]], address[1:], value)
    return copy


def overlap(one: Address, other: Address) -> bool:
    """Whether two addresses share a number: one is within the other."""
    return one[: len(other)] == other[: len(one)]


def _numbers(parts: Mapping[str, Any]) -> Iterator[tuple[str, Address]]:
    """Key paths that are a number each, or a whole vector of the modal table; names go before indices."""
    for key in VECTORS:
        values = parts["modal"][key]
        if values is not None:
            yield f"modal.{key}", ("modal", key)
            yield from ((f"modal.{key}.{index}", ("modal", key, index)) for index in range(len(values)))
    for kind, keys in (("contact", ("n_0", "gap", "mu", "k_u", "k_v")), ("force", ("amplitude", "phase"))):
        for prefix, index, draft in _named(parts, kind):
            yield from ((f"{prefix}.{key}", (kind, index, key)) for key in keys if key in draft)


def _arrays(parts: Mapping[str, Any]) -> Iterator[tuple[str, Address]]:
    """Key paths of arrays over the dofs."""
    shapes = parts["modal"]["shapes"]
    for index in range(0 if shapes is None else len(shapes)):
        yield f"modal.shapes.{index}", ("modal", "shapes", index)
    for kind, keys in (("contact", ("tangential", "normal")), ("force", ("dof",))):
        for prefix, index, _ in _named(parts, kind):
            yield from ((f"{prefix}.{key}", (kind, index, key)) for key in keys)


def _named(parts: Mapping[str, Any], kind: str) -> Iterator[tuple[str, int, dict[str, Any]]]:
    """Each contact or force by its index, then by its name where that is the only one."""
    names = [draft["name"] for draft in parts[kind]]
    for index, draft in enumerate(parts[kind]):
        yield f"{kind}.{index}", index, draft
    for index, draft in enumerate(parts[kind]):
        if names[index] and names.count(names[index]) == 1:
            yield f"{kind}.{names[index]}", index, draft


def _index(text: str, count: int) -> int | None:
    right = text.isascii() and text.isdecimal() and len(text) < 9 and int(text) < count
    return int(text) if right else None


def _other_load(key: str) -> str:
    return key[:-4] + (".gap" if key.endswith(".n_0") else ".n_0")
