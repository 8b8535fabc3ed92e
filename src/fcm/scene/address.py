"""Finds the addresses in a scene of a key path such as "contact.shroud.n_0"."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from typing import Any

import numpy as np

from fcm.model.scene import Address
from fcm.scene.errors import Mistakes, choices, nearest, quoted, suggestion
from fcm.scene.options import MESSAGES
from fcm.scene.section import SYNONYMS

VECTORS = ("mass", "frequency", "damping")  # of the modal table
SCALE = "cyclic.mistuning.scale"
LEVEL = "level"  # force level: a factor on all amplitudes
TOTAL = "total"  # key of the totals of numbers given for each pair, if areas are given too
STOP = "stop"  # of a contact without friction, which has no tangential direction
_NO_FRICTION = "; as it has no tangential direction, it has no friction"
_OF_FRICTION = "mu", "k_u", "tangential"  # keys of a contact that a stop does not have
OF_SECTOR = re.compile(r"@\d+")  # suffix of the names of contacts of a mistuned ring
NUMBERS = {  # keys of numbers by kind of table
    "contact": ("n_0", "gap", "mu", "k_u", "k_v"),
    "force": ("amplitude", "phase"),
    "load": ("force",),
}


class Addresses:
    """The numbers of a scene that can be swept, by their key paths."""

    def __init__(self, parts: Mapping[str, Any]) -> None:
        self.parts = parts
        self.dofs = {dof: index for index, dof in enumerate(parts["modal"]["dofs"] or ())}
        self.numbers = dict(_numbers(parts))
        self.arrays = dict(_arrays(parts))

    def find(self, key: str, path: str, mistakes: Mistakes) -> tuple[Address, ...]:
        """The addresses of a key path; empty after a mistake, which is noted."""
        if "*" in key and key not in self.numbers:
            return self._matching(key, path, mistakes)
        address = self.numbers.get(key) or self._element(key)
        if address is not None:
            return (address,)
        if (members := self._members(key, path, mistakes)) is not None:
            return members
        if several := self._of_one_name(key):
            mistakes.add(path, several)
        elif not self._excused(key, path, mistakes):
            what = "there is no such number in the scene"
            hint = self._forces_meant() if key == LEVEL else self._other_word(key) or self._contact_meant(key)
            hint = self._stop_meant(key) or hint
            mistakes.add(path, what + (hint or suggestion(key, self.numbers) or self._those_there(key)))
        return ()

    def _of_one_name(self, key: str) -> str:
        """Message on a name that several forces, loads or contacts share, with their indices; or ''."""
        for kind, what in (
            ("force", "forces act at"),
            ("load", "loads act at"),
            ("contact", "contacts are named"),
        ):
            names = [draft["name"] for draft in self.parts[kind]]
            for name, count in Counter(names).items():
                rest = key.removeprefix(f"{kind}.{name}.")
                each = [f"{kind}.{i}.{rest}" for i, one in enumerate(names) if one == name]
                there = [one for one in each if one in self.numbers or self._element(one) is not None]
                if name and count > 1 and rest != key and there:
                    return f"{count} {what} {quoted(name)}; give the one that is meant: {choices(there)}"
        return ""

    def _stop_meant(self, key: str) -> str:
        """Hint for a number of friction of a stop, which has none; or ''."""
        label, _, field = key.rpartition(".")
        stops = [(i, one) for i, one in enumerate(self.parts["contact"]) if _lacks(one, field)]
        labels = {f"contact.{one}" for i, draft in stops for one in (i, draft["name"], draft.get("group"))}
        return _NO_FRICTION if label in labels else ""

    def _forces_meant(self) -> str:
        """Hint for the key of the force level, which is not swept: sweep the amplitudes, or use --level."""
        forces = [f"force.{draft['name'] or i}.amplitude" for i, draft in enumerate(self.parts["force"])]
        every = "force.*.amplitude" if len(forces) > 1 else "".join(forces)
        swept = f"; sweep {quoted(every)}, or follow" if forces else "; follow"
        return f"{swept} the level at one frequency by fcm respond --level FROM:TO --at F"

    def _other_word(self, key: str) -> str:
        """Hint with the right key path for a common synonym such as "preload"; or ''."""
        label, _, field = key.rpartition(".")
        meant = f"{label}.{SYNONYMS.get(field, field)}"
        there = meant != key and (meant in self.numbers or self._members(meant, "", Mistakes("")) is not None)
        return f"; did you mean {quoted(meant)}?" if there else ""

    def _contact_meant(self, key: str) -> str:
        """Hint for an unknown contact: the likely name, or the existing names; or ''."""
        kind, _, rest = key.partition(".")
        label, _, field = rest.rpartition(".")
        drafts = self.parts["contact"]
        names = list(dict.fromkeys(str(one.get("group") or one["name"] or i) for i, one in enumerate(drafts)))
        if kind != "contact" or field not in NUMBERS["contact"] or not names or label in names:
            return ""
        if close := nearest(label, names):
            return f"; did you mean {quoted(f'contact.{close}.{field}')}?"
        return f"; contacts are {choices(names)}, or * for all"

    def _those_there(self, key: str) -> str:
        """Hint with the numbers that have the same last key, or else those of contacts; or ''."""
        every = list({address: one for one, address in self.numbers.items()}.values())
        last = f".{key.rpartition('.')[2]}"
        same = [one for one in every if one.endswith(last)]
        found = same or [one for one in every if one.startswith("contact.")] or every
        there = "there is" if len(found) == 1 else "there are"
        return f"; {there} {choices(found, MESSAGES.groups)}" if found else ""

    def _matching(self, key: str, path: str, mistakes: Mistakes) -> tuple[Address, ...]:
        """The addresses that match a key path with a *: of contacts, forces and loads, or of all modes."""
        if (whole := self.numbers.get(key.removesuffix(".*"))) is not None:
            return (whole,)
        prefix, _, field = key.rpartition(".")
        labels = {
            (kind, index): f"{kind}.{draft['name'] or index}"
            for kind in NUMBERS
            for index, draft in enumerate(self.parts[kind])
        }
        matched = [at for at, label in labels.items() if fnmatchcase(label, prefix)]
        if not matched and prefix.startswith("contact.") and not self.parts["contact"] and mistakes.count:
            return ()  # the contacts could not be read, which is already reported
        if not matched:
            mistakes.add(path, f"nothing in the scene matches {quoted(prefix)}")
            return ()
        for kind, index in matched:
            draft = self.parts[kind][index]
            if field not in NUMBERS[kind] or not _has(draft, field):
                other = {"n_0": "gap", "gap": "n_0"}.get(field, "")
                hint = f"; it is given by {other}" if other in draft else _NO_FRICTION * _lacks(draft, field)
                mistakes.add(path, f"{quoted(labels[kind, index])} has no {quoted(field)} to sweep{hint}")
                return ()
        contacts = self._together(
            [index for kind, index in matched if kind == "contact"], field, path, mistakes
        )
        others = tuple((kind, index, field) for kind, index in matched if kind != "contact")
        return (*contacts, *others)

    def _members(self, key: str, path: str, mistakes: Mistakes) -> tuple[Address, ...] | None:
        """The addresses of a number of all contacts that one [[contact]] makes, for node pairs or sectors.

        None if there is no such group; empty after a mistake.
        """
        prefix, _, field = key.rpartition(".")
        drafts = enumerate(self.parts["contact"])
        same = [
            i
            for i, draft in drafts
            if prefix in {f"contact.{draft.get(key, '')}" for key in ("group", "of")} and _has(draft, field)
        ]
        if not same or field not in NUMBERS["contact"]:
            return None
        return self._together(same, field, path, mistakes)

    def _together(self, indices: list[int], field: str, path: str, mistakes: Mistakes) -> tuple[Address, ...]:
        """The addresses of a number of several contacts; empty after a mistake.

        For all pairs of a [[contact]] with areas, it is the address of their total.
        """
        drafts, found = self.parts["contact"], list[Address]()
        every = Counter(map(_of_one_table, drafts))
        here = Counter(_of_one_table(drafts[i]) for i in indices)
        for i in indices:
            draft, table = drafts[i], _of_one_table(drafts[i])
            if field not in draft.get(TOTAL, ()) or here[table] < every[table]:
                found.append(("contact", i, field))
            elif draft[TOTAL][field]:
                found.append(("contact", i, TOTAL, field))
            else:
                mistakes.add(
                    path,
                    f"the {field} of the pairs of contact {quoted(draft['group'])} add up to 0, so they "
                    f"cannot be scaled to another total. Give one {field}, which is shared by areas",
                )
                return ()
        return tuple(found)

    def _element(self, key: str) -> Address | None:
        """The address of a number in an array: the weight of a dof, or a mode's value at a dof; else None."""
        for prefix, address in self.arrays.items():
            rest = key.removeprefix(f"{prefix}.")
            if rest != key and rest in self.dofs:
                return (*address, self.dofs[rest])
            if rest != key and address[0] == "modal" and (index := _index(rest, len(self.dofs))) is not None:
                return (*address, index)
        return None

    def _of_matrices(self) -> bool:
        dofs = self.parts["modal"]["dofs"]
        return dofs is not None and "structure" in dofs.key

    def _of_ring(self, key: str) -> bool:
        """Whether it is a number of a mistuned ring that was not built because of another mistake."""
        mistuned = any("mistuning" in one for one in self.parts.get("cyclic", ()))
        known = key == SCALE or OF_SECTOR.sub("", key) in self.numbers
        return mistuned and not self.parts.get("whole") and known

    def _excused(self, key: str, path: str, mistakes: Mistakes) -> bool:
        """Whether a key needs no message "there is no such number", as a better one is or was noted."""
        if key.startswith("structure.") and self._of_matrices():
            ratios = '; the damping ratios of its modes are "modal.damping"'
            what = f"matrices and what is read with them cannot be swept{ratios if 'damping' in key else ''}"
            mistakes.add(path, what)
        elif key.startswith(("response.", "schedule.", "start.")):
            mistakes.add(path, "the range, the step and the schedule cannot be swept")
        elif key.endswith((".n_0", ".gap")) and (other := _other_load(key)) in self.numbers:
            mistakes.add(path, f"the contact is given by {other.rpartition('.')[2]}; sweep {quoted(other)}")
        elif key.partition(".")[0] in self.parts.get("unread", ()) or self._of_ring(key):
            return True  # the mistake in its table is already reported
        else:
            needed = (self.parts["modal"][part] for part in ("dofs", *VECTORS, "shapes"))
            return key.startswith("modal.") and any(part is None for part in needed)
        return True


def replaced(tree: Any, address: Address, value: float) -> Any:
    """The tree with a number replaced; branches that do not lead to it are shared, not copied.

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
    """Whether two addresses share a number: one contains the other; a total contains those of its pairs."""
    one, other = (tuple(step for step in address if step != TOTAL) for address in (one, other))
    return one[: len(other)] == other[: len(one)]


def _of_one_table(draft: Mapping[str, Any]) -> tuple[str, str]:
    """Identifies the [[contact]] table of a contact: its name, and the sector of a mistuned ring."""
    name: str = draft["name"]
    return draft.get("group", name), name.removeprefix(draft["of"]) if "of" in draft else ""


def _numbers(parts: Mapping[str, Any]) -> Iterator[tuple[str, Address]]:
    """Yields key path and address of each number, and of each whole vector of the modal table."""
    for key in VECTORS:
        values = parts["modal"][key]
        if values is not None:
            yield f"modal.{key}", ("modal", key)
            yield from ((f"modal.{key}.{index}", ("modal", key, index)) for index in range(len(values)))
    if parts.get("cyclic"):
        yield "cyclic.engine_order", ("cyclic", 0, "engine_order")
    if parts.get("whole"):  # of a mistuned ring
        yield "cyclic.engine_order", ("whole", 0, "engine_order")
        yield SCALE, ("whole", 0, "scale")
    for draft in parts["base"]:
        yield from ((f"base.{key}", ("base", 0, key)) for key in ("acceleration", "phase") if key in draft)
    for kind, keys in NUMBERS.items():
        for prefix, index, draft in _named(parts, kind):
            yield from ((f"{prefix}.{key}", (kind, index, key)) for key in keys if _has(draft, key))


def _has(draft: Mapping[str, Any], key: str) -> bool:
    """Whether a contact, force or load has a number or direction; a stop has none of friction."""
    return key in draft and not _lacks(draft, key)


def _lacks(draft: Mapping[str, Any], key: str) -> bool:
    """Whether a contact is a stop and a number or direction is of friction, which a stop does not have."""
    return STOP in draft and key in _OF_FRICTION


def _arrays(parts: Mapping[str, Any]) -> Iterator[tuple[str, Address]]:
    """Yields key path and address of each array over the dofs."""
    shapes = None if parts.get("cyclic") or parts.get("whole") else parts["modal"]["shapes"]
    for index in range(0 if shapes is None else len(shapes)):
        yield f"modal.shapes.{index}", ("modal", "shapes", index)
    if parts.get("whole"):
        return
    for kind, keys in (("contact", ("tangential", "normal")), ("force", ("dof",)), ("load", ("dof",))):
        for prefix, index, draft in _named(parts, kind):
            if "second" in draft:  # the two sliding directions of a planar contact are numbered
                yield f"{prefix}.tangential.0", (kind, index, "tangential")
                yield f"{prefix}.tangential.1", (kind, index, "second")
                yield f"{prefix}.normal", (kind, index, "normal")
            else:
                yield from ((f"{prefix}.{key}", (kind, index, key)) for key in keys if _has(draft, key))


def _named(parts: Mapping[str, Any], kind: str) -> Iterator[tuple[str, int, dict[str, Any]]]:
    """Yields the key prefix, index and draft of each part: by its index, then by a unique name."""
    names = [draft["name"] for draft in parts[kind]]
    for index, draft in enumerate(parts[kind]):
        if "of" not in draft:  # contacts of the sectors of a mistuned ring are addressed only by name
            yield f"{kind}.{index}", index, draft
    for index, draft in enumerate(parts[kind]):
        if names[index] and names.count(names[index]) == 1:
            yield f"{kind}.{names[index]}", index, draft


def _index(text: str, count: int) -> int | None:
    right = text.isascii() and text.isdecimal() and len(text) < 9 and int(text) < count
    return int(text) if right else None


def _other_load(key: str) -> str:
    return key[:-4] + (".gap" if key.endswith(".n_0") else ".n_0")
