"""Reads the [optimum] table of a scene: numbers to optimise, their bounds, and aims to minimise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fcm.model.scene import Aim, Optimum
from fcm.scene.address import overlap
from fcm.scene.draft import AT_REST, Draft, Number, number_in, only_force
from fcm.scene.errors import choices, kind, quoted, shown
from fcm.scene.keys import names
from fcm.scene.names import Names
from fcm.scene.options import LIMITS
from fcm.scene.rules import as_float
from fcm.scene.section import Section

WHAT = ("peak", "greatest")


def read_optimum(top: Section, draft: Draft, reported: Sequence[str]) -> Optimum | None:
    """Reads the [optimum] table; None without it, or after a mistake."""
    section = top.table("optimum", "") if "optimum" in top.data else None
    if section is None:
        return None
    section.only(*names("optimum"))
    before = section.mistakes.count
    if "response" not in top.data:
        section.wrong("", "needs a [response] with a range of frequencies, in which the peak is")
    numbers = varied_numbers(section, draft, "contact.shroud.n_0", LIMITS.chosen)
    aims = _aims(section, reported)
    bounds = _bounds(section, numbers, draft)
    if not all(aim.ends for aim in aims):  # at 0 there is no peak, and the greatest amplitude is 0
        _check_0(section, numbers, bounds, draft)
    if section.mistakes.count > before:
        return None
    return Optimum(tuple(number.key for number in numbers if number), tuple(bounds), tuple(aims))


def varied_numbers(
    section: Section, draft: Draft, example: str, most: int, refused: Mapping[str, str] | None = None
) -> list[Number | None]:
    """The numbers to vary; None in place of an unknown one, or of one refused with a reason."""
    keys = words_of(section, "vary", f'a list of numbers of the scene, as ["{example}"]')
    if len(keys) > most:
        section.wrong("vary", f"has {len(keys)} numbers; there can be {most}")
    found: list[Number | None] = []
    for i, key in enumerate(keys):
        path = f"{section.at('vary')}[{i}]"
        if refused and key in refused:
            section.mistakes.add(path, refused[key])
            found.append(None)
            continue
        number = number_in(draft, key, path, section.mistakes)
        before = [address for one in found if one for address in one.addresses]
        if number and any(overlap(a, b) for a in before for b in number.addresses):
            section.mistakes.add(path, "sets the same number as another one")
        found.append(number)
    return found


def words_of(section: Section, key: str, right: str) -> list[str]:
    """A string, or a list of strings, as a list."""
    if section.missing(key, right):
        return []
    value = section.data[key]
    words = [value] if isinstance(value, str) else value
    if not isinstance(words, list | tuple) or not words or not all(isinstance(one, str) for one in words):
        what = "an empty list" if isinstance(words, list | tuple) and not words else kind(value)
        section.wrong(key, f"must be {right}, is {what}")
        return []
    return list(words)


def _aims(section: Section, reported: Sequence[str]) -> list[Aim]:
    """Aims of the optimum, of which the greatest is minimised."""
    words = words_of(section, "minimise", 'what is to be least, as "peak.u", or a list of such')
    found = []
    for word in words:
        what, _, dof = word.partition(".")
        if what not in WHAT or not dof:
            section.wrong(
                "minimise", f"must be peak.NAME or greatest.NAME of a degree of freedom, is {quoted(word)}"
            )
        elif reported and not (named := Names(reported).find(dof)):
            section.wrong(
                "minimise",
                f"there is no degree of freedom {quoted(dof)} in the results, which have "
                f"{choices(reported)}; output in [response] adds others of the structure",
                dof,
                reported,
            )
        else:
            found.append(Aim(named if reported else dof, what == "greatest"))
    for i, aim in enumerate(found):
        if aim.dof in (one.dof for one in found[:i]):  # the greatest of it is its peak, or at an end
            section.wrong("minimise", f"names {quoted(aim.dof)} twice; once is right")
    return found


def _bounds(section: Section, numbers: list[Number | None], draft: Draft) -> list[tuple[float, float]]:
    """Bounds [from, to] of each number, from a list for each, a single list, or a table by keys."""
    value = section.data.get("bounds")
    if not numbers:
        return []
    if value is None:
        return [_of_sweep_or_from_0(section, number, draft) for number in numbers if number]
    pairs: Any = None
    if isinstance(value, Mapping):
        keys = words_of(section, "vary", "")
        for key in sorted(set(value) - set(keys)):
            section.wrong("bounds", f"{quoted(key)} is not among those that vary")
        pairs = [value.get(key) for key in keys]
    else:
        single = isinstance(value, list | tuple) and all(as_float(one) is not None for one in value)
        pairs = [value] if single else value if isinstance(value, list | tuple) else None
    if not isinstance(pairs, list | tuple) or len(pairs) != len(numbers):
        section.wrong(
            "bounds", f"must be [from, to] for each of the {len(numbers)} that vary, is {_said(value)}"
        )
        return []
    return [
        pair_of_bounds(section, number, pair) for number, pair in zip(numbers, pairs, strict=True) if number
    ]


def _check_0(
    section: Section, numbers: list[Number | None], bounds: list[tuple[float, float]], draft: Draft
) -> None:
    """Notes bounds that include 0 for the amplitude of the only force."""
    known = [number for number in numbers if number]
    for number, (low, high) in zip(known, bounds, strict=False):  # bounds are empty after a mistake
        if low <= 0.0 <= high and only_force(draft.parts, number):
            section.wrong("bounds", f"bounds of {number.key}: {AT_REST}; leave 0 out")


def _said(value: object) -> str:
    return f"a list of {len(value)}" if isinstance(value, list | tuple) else kind(value)


def pair_of_bounds(section: Section, number: Number, pair: object) -> tuple[float, float]:
    """Bounds (from, to) of one number."""
    path = f"bounds of {number.key}"
    ends = [as_float(one) for one in pair] if isinstance(pair, list | tuple) else []
    low, high = ends if len(ends) == 2 else (None, None)
    if low is None or high is None:
        section.wrong("bounds", f"{path} must be two numbers, [from, to], are {_said(pair)}")
        return (np.nan, np.nan)
    faults = [fault for end in (low, high) if (fault := number.rule.fault(end))]
    for fault in faults:
        section.wrong("bounds", f"{path}: {fault}")
    if not faults and not low < high:
        section.wrong("bounds", f"{path} must rise, are [{shown(low)}, {shown(high)}]")
    return (low, high)


def without_bounds(number: Number) -> str:
    """Message on a number that is 0 and has no bounds: no default bounds follow from it."""
    return f"give [from, to] for {number.key}, which is 0 in the scene"


def _of_sweep_or_from_0(section: Section, number: Number, draft: Draft) -> tuple[float, float]:
    """Default bounds of a number: those of its sweep, or else from 0 to `optimum_range` times its value."""
    for one in draft.swept:
        if set(one.addresses) <= set(number.addresses) and min(one.values) < max(one.values):
            return (min(one.values), max(one.values))
    values = [value / weight for value, weight in draft.present(number)]
    furthest = max(values, key=abs, default=0.0)
    if furthest == 0.0:
        section.wrong("bounds", f"missing; {without_bounds(number)}")
    return (
        (0.0, LIMITS.optimum_range * furthest) if furthest > 0.0 else (LIMITS.optimum_range * furthest, 0.0)
    )
