"""Reads the swept keys of a scene: their values, their addresses, and the curves that result.

A key is the path of a number in the scene: "contact.shroud.n_0" (or "contact.0.n_0"), "force.u.amplitude"
(or "force.0.amplitude"), "modal.damping" (every mode) or "modal.damping.0", "modal.shapes.0.u", and the
weights of combinations, "contact.shroud.normal.v". Its values are a list; a range { from, to, count },
evenly spaced or with log = true; or draws { normal = [mean, deviation], count, seed }, { uniform = [low,
high], count, seed } or { distribution = "lognorm", s = 0.2, scale = 0.4, count, seed }, any of scipy.stats
with its parameters.

The curves are all combinations of the values, the last key fastest. But random keys with the same count are
drawn together: 1000 draws of two keys make 1000 curves. The draws are independent (see `draws`) unless
[sweep.correlation] gives their correlation.

A name with a * stands for all names that it matches: "contact.*.n_0" sets the preload of every contact. The
keys of one [[sweep.paired]] table change in step, and must have equally many values.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from math import prod
from typing import Any

import numpy as np

from fcm import resources
from fcm.frozen import Frozen
from fcm.model.scene import Address
from fcm.scene.address import Addresses, overlap
from fcm.scene.draws import FORMS as DRAWN
from fcm.scene.draws import Correlation, Draws, read_correlation, read_draws
from fcm.scene.errors import kind, quoted, shown
from fcm.scene.options import LIMITS
from fcm.scene.rules import ANY, RULES, Rule
from fcm.scene.section import Section, angle_in

FORMS = (
    "a list of numbers, { from = , to = , count = }, "
    "{ normal = [mean, deviation], count = }, { uniform = [low, high], count = } "
    "or { distribution = , count = }"
)


class SweptKey(Frozen):
    """A swept key; keys of one group change together."""

    key: str
    addresses: tuple[Address, ...]
    values: tuple[float, ...]
    group: object
    draws: Draws | None = None

    @property
    def drawn(self) -> bool:
        """Whether its values are random draws, which are all equally likely."""
        return self.draws is not None


def read_sweep(top: Section, parts: Mapping[str, Any], others: Sequence[SweptKey] = ()) -> list[SweptKey]:
    """The swept keys with their values, after others, which come from another table.

    parts are the drafts of modal, contact and force.
    """
    section = top.table("sweep", "") if "sweep" in top.data else None
    if section is None:
        return list(others)
    addresses = Addresses(parts)
    found: list[SweptKey | None] = []
    correlation = read_correlation(section) if "correlation" in section.data else None
    correlated = () if correlation is None else correlation.keys
    for key in section.data:
        if key == "paired":
            found += _paired(section, addresses)
        elif key != "correlation":
            one = _swept(section, key, addresses, checked=key not in correlated)
            _note_repeated(section, quoted(key), [one])
            found.append(one)
    swept = [*others, *(one for one in found if one is not None)]
    if correlation is not None:
        swept = _correlated(section, swept, correlation)
    _note_overlaps(section, swept)
    count = curves_of(swept)
    if count > LIMITS.curves:
        section.wrong("", f"asks for {count} curves; there can be {LIMITS.curves}")
    elif count * LIMITS.bytes_of_curve > (free := section.mistakes.notices.memory()):
        section.wrong(
            "",
            f"asks for {count} curves, which take {resources.size(count * LIMITS.bytes_of_curve)} of memory "
            f"before they are traced, and {resources.size(free)} are free: "
            "sweep or draw fewer values at a time",
        )
    return swept


def curves_of(swept: Sequence[SweptKey]) -> int:
    """The number of curves of swept keys; 1 without a sweep."""
    return prod(len(group[0].values) for group in _groups(swept))


def combinations(swept: Sequence[SweptKey]) -> Iterator[dict[str, float]]:
    """Yields the values of each curve by key, in the order of the file with the last key fastest."""
    if not swept:
        return
    groups = _groups(swept)
    keys = [one.key for group in groups for one in group]
    for rows in product(*(zip(*(one.values for one in group), strict=True) for group in groups)):
        values = dict(zip(keys, (value for row in rows for value in row), strict=True))
        yield {one.key: values[one.key] for one in swept}


def _groups(swept: Sequence[SweptKey]) -> list[list[SweptKey]]:
    groups: dict[object, list[SweptKey]] = {}
    for one in swept:
        groups.setdefault(one.group, []).append(one)
    return list(groups.values())


def _paired(section: Section, addresses: Addresses) -> list[SweptKey | None]:
    """The keys of each [[sweep.paired]] table, which change in step."""
    found: list[SweptKey | None] = []
    for number, table in enumerate(section.tables("paired")):
        keys = [_swept(table, key, addresses) for key in table.data]
        counts = {len(one.values) for one in keys if one is not None}
        if len(counts) > 1:
            each = " and ".join(map(str, sorted(counts)))
            table.wrong("", f"its keys go in step, but have {each} values")
        elif None not in keys:
            _note_repeated(table, "", keys)
            found += [replace(one, group=("paired", number)) for one in keys if one is not None]
    return found


def _note_repeated(section: Section, key: str, keys: Sequence[SweptKey | None]) -> None:
    """Notes the first repeated combination of values of keys in step; random draws may repeat."""
    listed = [one.values for one in keys if one is not None and not one.drawn]
    rows = Counter(zip(*listed, strict=True)) if len(listed) == len(keys) else Counter[tuple[float, ...]]()
    again = next((row for row, count in rows.items() if count > 1), None)
    if again is not None:
        section.wrong(key, f"has {', '.join(map(shown, again))} more than once; each curve is traced once")


def _correlated(section: Section, swept: list[SweptKey], correlation: Correlation) -> list[SweptKey]:
    """The swept keys, with correlated draws in place of independent ones."""
    table = Section({}, section.at("correlation"), section.mistakes)
    draws = {one.key: one.draws for one in swept if one.draws is not None}
    before = section.mistakes.count
    for key in correlation.keys:
        if key not in section.data:
            table.wrong(
                "keys", f"{quoted(key)} is not swept", key, [k for k in section.data if "." in str(k)]
            )
        elif key not in draws and any(one.key == key for one in swept):
            table.wrong("keys", f"{quoted(key)} is not drawn: its values are given")
    counts = {draws[key].count for key in correlation.keys if key in draws}
    if len(counts) > 1:
        table.wrong(
            "keys", f"must be drawn equally often, but have {' and '.join(map(str, sorted(counts)))} draws"
        )
    if section.mistakes.count > before or any(key not in draws for key in correlation.keys):
        return swept
    values = correlation.values(draws)
    for key, own in values.items():
        found = next(one for one in swept if one.key == key)
        _check(section, section.at(quoted(key)), own, RULES[field_of(found.addresses[0])], listed=False)
    return [
        replace(one, values=tuple(values[one.key].tolist())) if one.key in values else one for one in swept
    ]


def _swept(section: Section, key: str, addresses: Addresses, checked: bool = True) -> SweptKey | None:
    path = section.at(quoted(key))
    value = section.data[key]
    if isinstance(value, Mapping) and "." not in str(key) and not _FORM_KEYS & set(value):
        section.mistakes.add(path, 'put the whole key path in quotes, as in "contact.shroud.n_0" = [1, 2]')
        return None
    found = addresses.find(str(key), path, section.mistakes)
    values = _values(section, path, str(key), value)
    if values is None:
        return None
    if not found:
        return None
    draws = values if isinstance(values, Draws) else None
    values = values.values() if isinstance(values, Draws) else values
    if checked:
        _check(section, path, values, RULES[field_of(found[0])], listed=not isinstance(value, Mapping))
    group = str(key) if draws is None else ("drawn", len(values))
    return SweptKey(str(key), found, tuple(values.tolist()), group, draws)


def field_of(address: Address) -> str:
    """The name of a number's rule: the last word of its address that has one."""
    return next(str(word) for word in reversed(address) if word in RULES)


def _check(section: Section, path: str, values: Any, rule: Rule, listed: bool) -> None:
    """Notes values that the rule does not allow: all of a list, the first of a range or of draws."""
    faulty = rule.faulty(values)[:, 0].tolist()
    faults = [(index, rule.fault(float(values[index]))) for index in (faulty if listed else faulty[:1])]
    for index, fault in faults:
        summary = f"{len(faulty)} of its {len(values)} values are not allowed; the first {fault}"
        section.mistakes.add(f"{path}[{index}]" if listed else path, fault if listed else summary)


def _note_overlaps(section: Section, swept: list[SweptKey]) -> None:
    for index, one in enumerate(swept):
        for other in swept[:index]:
            if any(overlap(mine, its) for mine in one.addresses for its in other.addresses):
                section.wrong(quoted(one.key), f"sets the same number as {quoted(other.key)}")


def _values(section: Section, path: str, key: str, value: object) -> Any:
    """The values of one key as an array, or as `Draws`; None after a mistake."""
    if isinstance(value, Mapping):
        return _from_table(Section(value, path, section.mistakes), key)
    if not isinstance(value, list | tuple | np.ndarray):
        what = shown(value) if isinstance(value, bool | int | float) else kind(value)
        section.mistakes.add(path, f"must be {FORMS}, is {what}")
        return None
    if not len(value):
        section.mistakes.add(path, "is an empty list; give at least one value")
        return None
    return section.numbers([_angle_or(one) for one in value] if key.endswith(".phase") else value, path, ANY)


def _angle_or(value: object) -> object:
    """The angle [rad] of a text in degrees, such as "30deg"; another value as it is."""
    angle = angle_in(value) if isinstance(value, str) else None
    return value if angle is None else angle


_FORM_KEYS = {"from", "to", "count", "log", "seed", *DRAWN}


def draws_in(table: Section, key: str) -> Draws | None:
    """The `Draws` of random values of a key; None after a mistake."""
    form = [word for word in DRAWN if word in table.data]
    if len(form) != 1:
        table.wrong("", "must be { normal = [mean, deviation], count = }, { uniform = [low, high], count = } "
                    "or { distribution = , count = }")  # fmt: skip
        return None
    return read_draws(table, form[0], key, _integer)


def _from_table(table: Section, key: str) -> Any:
    form = [word for word in ("from", *DRAWN) if word in table.data]
    if len(form) != 1:
        free = next((str(word) for word in table.data if word not in _FORM_KEYS), "")
        table.wrong("", f"must be {FORMS}", free, sorted(_FORM_KEYS))
        return None
    before = table.mistakes.count
    values = _range(table) if form == ["from"] else read_draws(table, form[0], key, _integer)
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
    if key == "count" and value > LIMITS.curves:
        table.wrong(key, f"{shown(value)} is too many; there can be {LIMITS.curves} curves")
        return None
    return value
