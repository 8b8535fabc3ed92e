"""Swept keys of a scene: their values, where in the scene they go, and the curves they make.

A key is the path of a number in the scene: "contact.shroud.n_0" (or "contact.0.n_0"), "force.u.amplitude"
(or "force.0.amplitude"), "modal.damping" (every mode) or "modal.damping.0", "modal.shapes.0.u", and the
weights of combinations, "contact.shroud.normal.v". Its values are a list; a range { from, to, count },
evenly spaced or with log = true; or draws { normal = [mean, deviation], count, seed } or { uniform = [low,
high], count, seed }.

Curves are the product of the keys, the last one fastest, except that keys drawn with the same count are
drawn together: 1000 draws of two keys are 1000 curves. Draws depend on the seed (0 when not given) and on
the key, so two keys with one seed are independent, and adding a key changes no other key's draws.

A name with a * stands for all that it matches: "contact.*.n_0" sets the preload of every contact. The keys of
one [[sweep.paired]] table go in step, and must have as many values each.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from math import prod
from typing import Any
from zlib import crc32

import numpy as np

from fcm.scene.address import Address, Addresses, overlap
from fcm.scene.errors import kind, quoted, shown
from fcm.scene.rules import ANY, RULES, Rule
from fcm.scene.section import Section

MOST_CURVES = 1_000_000

FORMS = (
    "a list of numbers, { from = , to = , count = }, "
    "{ normal = [mean, deviation], count = } or { uniform = [low, high], count = }"
)


@dataclass(frozen=True)
class Swept:
    """One key of a sweep; keys of one group go in step."""

    key: str
    addresses: tuple[Address, ...]
    values: tuple[float, ...]
    group: object


def read_sweep(top: Section, parts: Mapping[str, Any]) -> list[Swept]:
    """The swept keys with their values; `parts` are the drafts of modal, contact and force."""
    section = top.table("sweep", "") if "sweep" in top.data else None
    if section is None:
        return []
    addresses = Addresses(parts)
    found: list[Swept | None] = []
    for key in section.data:
        if key == "paired":
            found += _paired(section, addresses)
        else:
            found.append(_swept(section, key, addresses))
    swept = [one for one in found if one is not None]
    _note_overlaps(section, swept)
    count = prod(len(group[0].values) for group in _groups(swept))
    if count > MOST_CURVES:
        section.wrong("", f"asks for {count} curves; there can be {MOST_CURVES}")
    return swept


def combinations(swept: list[Swept]) -> Iterator[dict[str, float]]:
    """Values of each curve: the product in the order of the file, the last key fastest."""
    if not swept:
        return
    groups = _groups(swept)
    keys = [one.key for group in groups for one in group]
    for rows in product(*(zip(*(one.values for one in group), strict=True) for group in groups)):
        values = dict(zip(keys, (value for row in rows for value in row), strict=True))
        yield {one.key: values[one.key] for one in swept}


def _groups(swept: list[Swept]) -> list[list[Swept]]:
    groups: dict[object, list[Swept]] = {}
    for one in swept:
        groups.setdefault(one.group, []).append(one)
    return list(groups.values())


def _paired(section: Section, addresses: Addresses) -> list[Swept | None]:
    """The keys of each [[sweep.paired]] table, which go in step."""
    found: list[Swept | None] = []
    for number, table in enumerate(section.tables("paired")):
        keys = [_swept(table, key, addresses) for key in table.data]
        counts = {len(one.values) for one in keys if one is not None}
        if len(counts) > 1:
            each = " and ".join(map(str, sorted(counts)))
            table.wrong("", f"its keys go in step, but have {each} values")
        elif None not in keys:
            found += [replace(one, group=("paired", number)) for one in keys if one is not None]
    return found


def _swept(section: Section, key: str, addresses: Addresses) -> Swept | None:
    path = section.at(quoted(key))
    value = section.data[key]
    if isinstance(value, Mapping) and "." not in str(key) and not _FORM_KEYS & set(value):
        section.mistakes.add(path, 'put the whole key path in quotes, as in "contact.shroud.n_0" = [1, 2]')
        return None
    found = addresses.find(str(key), path, section.mistakes)
    if found and "/" in str(key):
        section.mistakes.add(path, "a file cannot hold a name with a slash; give its number, as in contact.0")
    values = _values(section, path, str(key), value)
    if values is None:
        return None
    if not found:
        return None
    _check(section, path, values, RULES[field_of(found[0])], listed=not isinstance(value, Mapping))
    drawn = isinstance(value, Mapping) and "from" not in value
    return Swept(str(key), found, tuple(values.tolist()), ("drawn", len(values)) if drawn else str(key))


def field_of(address: Address) -> str:
    """The name of the number's rule: the last word of its address that names one."""
    return next(str(word) for word in reversed(address) if word in RULES)


def _check(section: Section, path: str, values: Any, rule: Rule, listed: bool) -> None:
    """Note the values that the number may not have: each of a list, the first of a range or of draws."""
    faulty = rule.faulty(values)[:, 0].tolist()
    faults = [(index, rule.fault(float(values[index]))) for index in (faulty if listed else faulty[:1])]
    for index, fault in faults:
        summary = f"{len(faulty)} of its {len(values)} values are not allowed; the first {fault}"
        section.mistakes.add(f"{path}[{index}]" if listed else path, fault if listed else summary)


def _note_overlaps(section: Section, swept: list[Swept]) -> None:
    for index, one in enumerate(swept):
        for other in swept[:index]:
            if any(overlap(mine, its) for mine in one.addresses for its in other.addresses):
                section.wrong(quoted(one.key), f"sets the same number as {quoted(other.key)}")


def _values(section: Section, path: str, key: str, value: object) -> Any:
    """The values of one key as an array; None after a mistake."""
    if isinstance(value, Mapping):
        return _from_table(Section(value, path, section.mistakes), key)
    if not isinstance(value, list | tuple | np.ndarray):
        what = shown(value) if isinstance(value, bool | int | float) else kind(value)
        section.mistakes.add(path, f"must be {FORMS}, is {what}")
        return None
    if not len(value):
        section.mistakes.add(path, "is an empty list; give at least one value")
        return None
    return section.numbers(value, path, ANY)


_FORM_KEYS = {"from", "to", "count", "log", "normal", "uniform", "seed"}


def _from_table(table: Section, key: str) -> Any:
    form = [word for word in ("from", "normal", "uniform") if word in table.data]
    if len(form) != 1:
        free = next((str(word) for word in table.data if word not in _FORM_KEYS), "")
        table.wrong("", f"must be {FORMS}", free, sorted(_FORM_KEYS))
        return None
    before = table.mistakes.count
    values = _range(table) if form == ["from"] else _draws(table, form[0], key)
    return values if table.mistakes.count == before else None


def _range(table: Section) -> Any:
    table.only("from", "to", "count", "log")
    low, high = table.number("from", ANY), table.number("to", ANY)
    log = table.data.get("log", False)
    if not isinstance(log, bool):
        table.wrong("log", f"must be true or false, is {kind(log)}")
    elif log and (low <= 0 or high <= 0):
        table.wrong("log", "needs from and to greater than 0")
    count = _integer(table, "count", 1)
    if not (np.isfinite([low, high]).all() and count) or (log and (low <= 0 or high <= 0)):
        return None
    values = np.geomspace(low, high, count) if log else np.linspace(low, high, count)
    return np.array([float(f"{value:.15g}") for value in values.tolist()])  # 0.3, not 0.30000000000000004


def _draws(table: Section, form: str, key: str) -> Any:
    table.only(form, "count", "seed")
    pair = table.vector(form, ANY)
    count = _integer(table, "count", 1)
    seed = _integer(table, "seed", 0, default=0)
    words = "[mean, deviation]" if form == "normal" else "[low, high]"
    if pair is not None and len(pair) != 2:
        table.wrong(form, f"must be two numbers, {words}, is a list of {len(pair)}")
    elif pair is not None and form == "normal" and pair[1] < 0:
        table.wrong(form, f"the deviation must be at least 0, is {pair[1]:g}")
    elif pair is not None and form == "uniform" and pair[1] < pair[0]:
        table.wrong(form, f"goes down: [{pair[0]:g}, {pair[1]:g}]; give the lower one first")
    elif pair is not None and count and seed is not None:
        generator = np.random.default_rng([seed, crc32(key.encode("utf-8", "replace"))])
        draw = generator.normal if form == "normal" else generator.uniform
        return draw(float(pair[0]), float(pair[1]), count)
    return None


def _integer(table: Section, key: str, least: int, default: int | None = None) -> int | None:
    """A whole number; None after a mistake."""
    if key not in table.data and default is not None:
        return default
    if table.missing(key, "a whole number"):
        return None
    value = table.data[key]
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        what = shown(value) if isinstance(value, bool | int | float) else kind(value)
        table.wrong(key, f"must be a whole number of at least {least}, is {what}")
        return None
    if key == "count" and value > MOST_CURVES:
        table.wrong(key, f"{shown(value)} is too many; there can be {MOST_CURVES} curves")
        return None
    return value
