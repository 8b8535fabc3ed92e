"""Reads contacts, forces, units and the frequency range of a scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import replace
from functools import partial
from math import nan
from typing import Any

from fcm.model.scene import NO_RANGE, Contact, Force
from fcm.scene.address import STOP, TOTAL
from fcm.scene.direction_lengths import GivenDirections, of_dofs, questions_of_lengths
from fcm.scene.errors import nearest, quoted, shown
from fcm.scene.files import Files
from fcm.scene.keys import names
from fcm.scene.names import Names, same_names, starred, unfit_name
from fcm.scene.node_pairs import (
    SHARED,
    check_nodes,
    direction_in,
    load_key,
    read_direction,
    read_numbers,
    read_pairs,
    relative_displacement,
    shares,
    totals_of,
)
from fcm.scene.node_sets import with_fitted
from fcm.scene.options import LIMITS
from fcm.scene.pair_file import PairTable
from fcm.scene.plane import check_axes, is_stop, read_directions
from fcm.scene.rules import FRACTION, POSITIVE, RULES, harmonics_fault, step_fault
from fcm.scene.section import Section
from fcm.units import UNIT

Dofs = Names | None
ONE = "give a range, and a single frequency within it by --at"


def read_contacts(top: Section, dofs: Dofs, files: Files) -> list[dict[str, Any]]:
    """The drafts of the contacts, with the keys of the file."""
    sections = top.tables("contact")
    given: list[GivenDirections] = []
    drafts = [draft for section in sections for draft in _contacts(section, dofs, files, given)]
    files.noted.extend(questions_of_lengths(given))
    tables = [section.data.get("name") for section in sections]
    again = same_names(name for name in tables if isinstance(name, str) and name)
    # pairs of tables with the same name have the same names too, which is not reported for each
    for name, group in again or same_names(draft["name"] for draft in drafts if draft["name"]):
        written = "" if len(set(group)) == 1 else " (in other Unicode characters)"
        top.wrong(
            "contact", f"{len(group)} contacts are named {quoted(name)}{written}; a name must be there once"
        )
    return drafts


def _contacts(
    section: Section, dofs: Dofs, files: Files, given: list[GivenDirections]
) -> list[dict[str, Any]]:
    """The drafts of one [[contact]]: one contact, or one for each of its node pairs.

    Its directions are appended to given.
    """
    name = section.text("name")
    if name:
        section.path += f" {quoted(name)}"
    if isinstance(section.data.get("name"), str) and (fault := unfit_name(name) or starred(name)):
        section.wrong("name", fault)
    section.only(*names("contact"))
    if "nodes" not in section.data:
        alone = PairTable([])
        shares(section, alone)
        no_k_u = 0.0 if is_stop(section) else None
        draft: dict[str, Any] = {
            key: section.number(key, RULES[key], default)
            for key, default in (("mu", None), ("k_u", no_k_u), ("k_v", None))
        }
        load = load_key(section, alone)
        draft[load] = section.number(load, RULES[load]) if load in section.data else nan
        found = read_directions(
            section,
            lambda key: section.weights(key, dofs),
            lambda value, key: section.weights_in(value, key, dofs),
        )
        if dofs is not None:
            given.append(GivenDirections(name, load, of_dofs(found, dofs), dofs))
        return [_with_tangential(draft | {"name": name} | found)]
    table = read_pairs(section, files)
    section = with_fitted(section, table)
    numbers, parts = read_numbers(section, table, files), shares(section, table)
    totals = totals_of(section, table, numbers)
    directions = read_directions(section, partial(read_direction, section), partial(direction_in, section))
    check_nodes(section, directions.values(), table.pairs, dofs)
    check_axes(section, directions)
    if dofs is not None and table.pairs:
        load = "gap" if "gap" in numbers else "n_0"
        given.append(GivenDirections(name, load, directions, dofs, table.pairs[0][0]))
    files.noted.extend(table.said)
    if table.interface is not None:
        files.interfaces.append(replace(table.interface, nodes=tuple(table.pairs)))
    return [
        _with_tangential(
            {key: values[i] for key, values in numbers.items()}
            | {"name": f"{name}_{i + 1}", "group": name, "share": parts[i], TOTAL: totals, "sum": totals}
            | {key: relative_displacement(weights, pair, dofs) for key, weights in directions.items()}
        )
        for i, pair in enumerate(table.pairs)
    ]


def _with_tangential(draft: dict[str, Any]) -> dict[str, Any]:
    """The contact as read; that of a stop has a tangential direction on which no force acts: the normal."""
    if "tangential" in draft:
        return draft
    return draft | {"tangential": None if draft["normal"] is None else draft["normal"].copy(), STOP: True}


def unread_tables(top: Section, parts: Mapping[str, Any]) -> tuple[str, ...]:
    """Tables that could not be read completely: with a misspelt key, or with parts whose name is missing.

    A key path to a number in such a table is not a mistake of its own.
    """
    hidden = [table for key in top.data if key not in names("") and (table := nearest(str(key), names("")))]
    for table, key in (("contact", "name"), ("force", "dof"), ("load", "dof")):
        written = top.data.get(table, ())
        drafts = parts[table]
        named = {draft[name] for draft in drafts for name in ("name", "group") if name in draft}
        if not isinstance(written, list | tuple) or not all(
            isinstance(one, Mapping)
            and (isinstance(one.get(key), Mapping) or _is_one_of(one.get(key), named))
            for one in written
        ):
            hidden.append(table)
    return tuple(hidden)


def _is_one_of(given: object, named: Set[str]) -> bool:
    """Whether a value of any type is one of the names."""
    return isinstance(given, str) and given in named


def contact_of(draft: dict[str, Any]) -> Contact:
    """The `Contact` made from a draft that was read; a gap becomes the preload -k_v * gap."""
    for key in ("tangential", "second", "normal"):
        if key in draft:
            draft[key].flags.writeable = False
    share, total = draft.get("share", {}), draft.get(TOTAL, {})
    factor = {key: total[key] / draft["sum"][key] for key in total if draft["sum"][key]} | share
    numbers = {key: draft[key] * factor.get(key, 1.0) for key in SHARED if key in draft}
    n_0 = numbers.pop("n_0") if "n_0" in numbers else -numbers["k_v"] * draft["gap"]
    numbers |= {key: draft[key] for key in ("name", "tangential", "second", "normal", "mu") if key in draft}
    return Contact(n_0=n_0 + 0.0, **numbers)  # + 0.0 turns -0.0 into 0.0


def read_forces(top: Section, dofs: Dofs, solved: bool) -> list[dict[str, Any]]:
    """The drafts of the forces, with the keys of the file; `name` is the dof of a force on a single one."""
    if "force" not in top.data and ("base" in top.data or not solved):
        return []
    if not top.data.get("force", ()) and isinstance(top.data.get("force", ()), list | tuple):
        top.wrong("force", "missing; without a [[force]] the response is zero")
    return [_force(section, dofs) for section in top.tables("force")]


def _force(section: Section, dofs: Dofs) -> dict[str, Any]:
    section.only(*names("force"))
    dof = section.data.get("dof")
    return {
        "name": dof if isinstance(dof, str) else "",
        "dof": section.weights("dof", dofs),
        "amplitude": section.number("amplitude", RULES["amplitude"]),
        "phase": section.angle("phase", default=0.0),
        "power": _power(section),
        "harmonic": _harmonic(section),
    }


def _power(section: Section) -> int:
    """The power of omega that a force is proportional to."""
    law = section.data.get("proportional_to")
    if law is not None and law != "omega^2":
        section.wrong("proportional_to", f'must be "omega^2", is {quoted(law)}')
    return 0 if law is None else 2


def _harmonic(section: Section) -> int:
    """The harmonic of the frequency at which a force acts."""
    value = section.data.get("harmonic", 1)
    whole = isinstance(value, int) and not isinstance(value, bool)
    if not whole or not 1 <= value <= LIMITS.harmonics:
        what = quoted(value) if isinstance(value, str) else value
        section.wrong("harmonic", f"must be a whole number from 1 to {LIMITS.harmonics}, is {what}")
        return 1
    return int(value)


def force_of(draft: dict[str, Any]) -> Force:
    """The `Force` made from a draft that was read."""
    draft["dof"].flags.writeable = False
    numbers = {key: draft[key] for key in ("amplitude", "phase", "power", "harmonic")}
    return Force(direction=draft["dof"], **numbers)


def note_of_harmonics(forces: Sequence[Force]) -> list[str]:
    """Note on forces at harmonics other than 1, which harmonic balance always includes.

    >>> import numpy as np
    >>> note_of_harmonics([Force(np.ones(1), 1.0, 0.0, harmonic=3)])
    ['force: at harmonic 3 of the frequency, which is balanced whatever harmonics are asked for']
    """
    found = sorted({force.harmonic for force in forces})
    if found in ([], [1]):
        return []
    which = f"harmonic {found[0]}" if len(found) == 1 else f"harmonics {', '.join(map(str, found))}"
    verb = "is" if len(found) == 1 else "are"
    return [f"force: at {which} of the frequency, which {verb} balanced whatever harmonics are asked for"]


def read_units(top: Section) -> tuple[str, str]:
    """The units of length and force; empty if not given."""
    section = top.table("units", "") if "units" in top.data else None
    if section is None:
        return "", ""
    section.only(*names("units"))
    found = [section.text(key, "") for key in ("length", "force")]
    for key, text in zip(("length", "force"), found, strict=True):
        if key in section.data and isinstance(section.data[key], str) and (fault := unfit_name(text)):
            section.wrong(key, fault)
    return found[0], found[1]


def response_table(top: Section, solved: bool) -> Section | None:
    """The [response] table; None if there is none.

    It is optional for a scene with a schedule, and for one that is not to be solved.
    """
    if "response" not in top.data and (top.data.get("schedule") or not solved):
        return None
    section = top.table("response", "a [response] table with frequency = [from, to]")
    if section is not None:
        section.only(*names("response"))
    return section


def read_response(top: Section, section: Section | None, unit: str) -> tuple[tuple[float, float], float]:
    """The frequency range [rad/s], nan if there is none or after a mistake, and the longest step."""
    if section is None:
        return NO_RANGE, LIMITS.longest_step
    step = section.number("max_step", FRACTION, default=LIMITS.longest_step)
    if step < LIMITS.shortest_step:  # False for nan, which is already a mistake
        section.wrong("max_step", step_fault(step))
    if "frequency" not in section.data and top.data.get("schedule"):
        return NO_RANGE, step
    ends = section.vector("frequency", POSITIVE, f"two numbers, [from, to], in {unit}")
    if ends is None:
        return NO_RANGE, step
    if len(ends) != 2:
        section.wrong("frequency", f"must be two numbers, [from, to], is a list of {len(ends)}")
        return NO_RANGE, step
    low, high = (float(end) * UNIT[unit] for end in ends)
    if low >= high:
        order, what = ("goes down", "give the lower one first") if low > high else ("is empty", ONE)
        section.wrong("frequency", f"{order}: [{ends[0]:g}, {ends[1]:g}]; {what}")
    elif high - low < LIMITS.narrowest * high:
        what = f"its ends differ by {(high - low) / high:.0e} of themselves, and must by {LIMITS.narrowest:g}"
        section.wrong("frequency", f"is too narrow to follow a curve through: {what} or more")
    return (low, high), step


def read_harmonics(section: Section | None) -> tuple[tuple[int, ...] | None, float | None]:
    """The harmonics of the balance, and the accuracy from which to choose them; None if not given."""
    if section is None:
        return None, None
    accuracy = section.number("accuracy", FRACTION) if "accuracy" in section.data else None
    if "harmonics" not in section.data:
        return None, accuracy
    given = section.data["harmonics"]
    chosen = tuple(given) if isinstance(given, list) else (1,)
    if isinstance(given, int) and not isinstance(given, bool) and 0 < given <= LIMITS.harmonics:
        chosen = tuple(range(1, given + 1))
    elif not isinstance(given, list) or harmonics_fault(chosen):
        wanted = f"a number from 1 to {LIMITS.harmonics}, or a list of them such as [1, 2, 3, 9]"
        section.wrong("harmonics", f"must be {wanted}, rising, the first of them 1; is {shown(given)}")
    if accuracy is not None:
        section.wrong("accuracy", "chooses the harmonics; give it or harmonics, not both")
    return chosen, accuracy
