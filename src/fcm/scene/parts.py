"""Contacts, forces and range of a scene."""

from __future__ import annotations

from math import nan
from typing import Any

from fcm.scene.errors import quoted
from fcm.scene.modal import UNITS
from fcm.scene.model import NO_RANGE, Contact, Force
from fcm.scene.names import Names, same_names, unfit_name
from fcm.scene.rules import FRACTION, POSITIVE, RULES, SHORTEST_STEP, step_fault
from fcm.scene.section import Section

Dofs = Names | None
NARROWEST = 1e-10  # relative width of a range: its points are still some 1e5 roundings apart
MAX_STEP = 0.05  # longest step along a curve when the scene names none


def read_contacts(top: Section, dofs: Dofs) -> list[dict[str, Any]]:
    """The contacts as read, in the words of the file."""
    sections = top.tables("contact")
    drafts = [_contact(section, dofs) for section in sections]
    for name, group in same_names(draft["name"] for draft in drafts if draft["name"]):
        written = "" if len(set(group)) == 1 else " (in other Unicode characters)"
        top.wrong(
            "contact", f"{len(group)} contacts are named {quoted(name)}{written}; a name must be there once"
        )
    return drafts


def _contact(section: Section, dofs: Dofs) -> dict[str, Any]:
    name = section.text("name")
    if name:
        section.path += f" {quoted(name)}"
    if isinstance(section.data.get("name"), str) and (fault := unfit_name(name)):
        section.wrong("name", fault)
    section.only("name", "tangential", "normal", "mu", "k_u", "k_v", "n_0", "gap")
    draft: dict[str, Any] = {key: section.number(key, RULES[key]) for key in ("mu", "k_u", "k_v")}
    load = _load(section)
    return draft | {
        "name": name,
        "tangential": section.weights("tangential", dofs),
        "normal": section.weights("normal", dofs),
        load: section.number(load, RULES[load]) if load in section.data else nan,
    }


def _load(section: Section) -> str:
    """Which of preload and gap the contact is given by."""
    given = [key for key in ("n_0", "gap") if key in section.data]
    if len(given) == 2:
        section.wrong("", "has both n_0 and gap; give one: gap means n_0 = -k_v * gap")
    elif not given:
        section.wrong("", "has neither n_0 nor gap; give one: gap means n_0 = -k_v * gap")
    return given[0] if given else "n_0"


def contact_of(draft: dict[str, Any]) -> Contact:
    """The contact of what was read: a gap becomes the preload -k_v * gap."""
    n_0 = draft["n_0"] if "n_0" in draft else -draft["k_v"] * draft["gap"]
    for key in ("tangential", "normal"):
        draft[key].flags.writeable = False
    numbers = {key: draft[key] for key in ("name", "tangential", "normal", "mu", "k_u", "k_v")}
    return Contact(n_0=n_0 + 0.0, **numbers)  # + 0.0: a zero without its sign


def read_forces(top: Section, dofs: Dofs) -> list[dict[str, Any]]:
    """The forces as read, in the words of the file; `name` is the dof of a force on one."""
    if not top.data.get("force", ()) and isinstance(top.data.get("force", ()), list | tuple):
        top.wrong("force", "missing; without a [[force]] the response is zero")
    return [_force(section, dofs) for section in top.tables("force")]


def _force(section: Section, dofs: Dofs) -> dict[str, Any]:
    section.only("dof", "amplitude", "phase")
    dof = section.data.get("dof")
    return {
        "name": dof if isinstance(dof, str) else "",
        "dof": section.weights("dof", dofs),
        "amplitude": section.number("amplitude", RULES["amplitude"]),
        "phase": section.number("phase", RULES["phase"], default=0.0),
    }


def force_of(draft: dict[str, Any]) -> Force:
    """The force of what was read."""
    draft["dof"].flags.writeable = False
    return Force(direction=draft["dof"], amplitude=draft["amplitude"], phase=draft["phase"])


def response_table(top: Section) -> Section | None:
    """The [response] table; None where there is none, which only a scene with a schedule may do without."""
    if "response" not in top.data and top.data.get("schedule"):
        return None
    section = top.table("response", "a [response] table with frequency = [from, to]")
    if section is not None:
        section.only("frequency", "max_step", "output")
    return section


def read_response(top: Section, section: Section | None, unit: str) -> tuple[tuple[float, float], float]:
    """The range of frequencies [rad/s], nan if there is none but a schedule, and the longest step."""
    if section is None:
        return NO_RANGE, MAX_STEP
    step = section.number("max_step", FRACTION, default=MAX_STEP)
    if step < SHORTEST_STEP:  # and not nan, which is a mistake already
        section.wrong("max_step", step_fault(step))
    if "frequency" not in section.data and top.data.get("schedule"):
        return NO_RANGE, step
    ends = section.vector("frequency", POSITIVE)
    if ends is None:
        return NO_RANGE, step
    if len(ends) != 2:
        section.wrong("frequency", f"must be two numbers, [from, to], is a list of {len(ends)}")
        return NO_RANGE, step
    low, high = (float(end) * UNITS[unit] for end in ends)
    if low >= high:
        order = "goes down" if low > high else "is empty"
        section.wrong("frequency", f"{order}: [{ends[0]:g}, {ends[1]:g}]; give the lower one first")
    elif high - low < NARROWEST * high:
        what = f"its ends differ by {(high - low) / high:.0e} of themselves, and must by {NARROWEST:g}"
        section.wrong("frequency", f"is too narrow to follow a curve through: {what} or more")
    return (low, high), step
