"""Sentences on what was left out of a calculation: what, why, and what it changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.response.foreseen import OPEN, STUCK
from fcm.response.newton import CLOSE
from fcm.response.result import Response
from fcm.scene.model import Contact
from fcm.units import UNIT

if TYPE_CHECKING:
    from fcm.response.leave_out import Lighter

MOST_NAMES = 6  # of contacts in one sentence
Rooms = list[dict[int, float]]  # for each curve, by the number of a contact


def counted(count: int, what: str) -> str:
    """A number with its noun.

    >>> counted(1, "mode"), counted(2, "mode")
    ('1 mode', '2 modes')
    """
    return f"{count} {what}{'' if count == 1 else 's'}"


def named(contacts: Sequence[Contact], numbers: Sequence[int]) -> str:
    """Contacts by their names, or by their numbers, the first few of them."""
    names = [contacts[i].name or str(i) for i in numbers]
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"contact{'' if len(names) == 1 else 's'} {', '.join(names[:MOST_NAMES])}{more}"


def has_friction(contact: Contact) -> bool:
    """Whether a contact resists sliding."""
    return contact.mu > 0.0 and contact.k_u > 0.0


def on_modes(lighter: Lighter, shift: float) -> str:
    """What was replaced, with the bound that the check gives."""
    modal, fewer, unit = lighter.exact[0].modal, lighter.curves[0].modal, lighter.full[0].frequency_unit
    limit = lighter.above or 0.0
    high, few = (int((one.frequency > limit).sum()) for one in (modal, fewer))
    return (
        f"{counted(high, 'mode')} of {modal.frequency.size} above {limit / UNIT[unit]:.4g} {unit}: far above "
        f"the range, replaced by {few} with the same flexibility (changes the response by less than "
        f"{2.0 * shift:.1e}, twice the most at the points checked, peaks among them)"
    )


def on_contacts(lighter: Lighter, rooms: Rooms, again: int) -> list[str]:
    """The contacts without unknowns, with the room that they had on curves that were not solved again."""
    states = lighter.states
    return [
        _on_contacts(lighter, [i for i in states if states[i] == state], state, rooms, again)
        for state in sorted(set(states.values()))
    ]


def _on_contacts(lighter: Lighter, numbers: list[int], state: str, rooms: Rooms, again: int) -> str:
    contacts, one = lighter.full[0].contacts, len(numbers) == 1
    who = named(contacts, numbers)
    did, event = {STUCK: ("stuck", "slip"), OPEN: ("open", "close")}[state]
    if state == STUCK and not any(has_friction(contacts[i]) for i in numbers):
        did, event = "closed", "open"
    if not rooms:
        return f"{who}: foreseen to stay {did}, but not so: solved again with {'it' if one else 'them'}"
    share = max(1.0 / (1.0 + room[i]) for room in rooms for i in numbers)
    text = (
        f"{who}: {'stays' if one else 'stay'} {did} over the whole range, so without unknowns (no effect: at "
        f"every point at most {100.0 * share:.2g} % of what it takes to {event})"
    )
    curves = f"{again} of {again + len(rooms)} curves"
    return f"{text}; {curves}, where this is not so, solved again with all contacts" if again else text


def on_points(response: Response) -> list[str]:
    """Points and curves that were not traced and corrected as usual."""
    said = []
    if uncorrected := sum(curve.uncorrected for curve in response.curves):
        points = counted(uncorrected, "point")
        said.append(f"the last correction of {points}, which stay as they were traced, to {CLOSE:g}")
    if stiff := sum(curve.without_table for curve in response.curves):
        which = counted(stiff, "curve")
        said.append(f"the table, for {which} whose stiff contacts multiply its error: closed form")
    return said


def on_means(lighter: Lighter) -> list[str]:
    """Rigid-body modes whose mean no force depends on."""
    from fcm.response.rigid import settled

    adrift = max(int(np.count_nonzero(settled(scene)[1])) for scene in lighter.exact)
    if adrift == 0:
        return []
    what = counted(adrift, "rigid-body mode")
    return [f"the mean of {what}, given as 0: no contact holds it along its normal, so nothing depends on it"]
