"""Contacts that are foreseen to stay stuck, or open, over the whole range, and the check that they did.

Such a contact is a spring, or nothing, and needs no unknowns. It is foreseen where the linear responses,
with the other contacts glued and with them open, leave room for it, and where no solution at the ends of
the range is found on which it slips or closes: so no branch that begins there is missed. Afterwards every
point of the solution is looked at.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.law import UNKNOWNS, ClosedForm
from fcm.response.linear import linear_response, telling_frequencies
from fcm.response.start import linear_starts, starting_points
from fcm.response.structure import AnyArray, group_of
from fcm.scene.model import Contact, Scene

STUCK, OPEN = "E", "S"
FORESEEN = 0.1  # room that a contact must have before it slips or closes, relative to what it needs
ENOUGH = 0.02  # of the solution
TOGETHER = 50  # curves whose solutions at the ends are looked for at once
States = dict[int, str]  # number of a contact: STUCK or OPEN


def foreseen(curves: tuple[Scene, ...]) -> States:
    """Contacts that are stuck, or open, all along every one of the curves, as far as can be foreseen."""
    states = {i: STUCK if c.n_0 > 0.0 else OPEN for i, c in enumerate(curves[0].contacts) if c.n_0 != 0.0}
    if any((scene.modal.frequency == 0.0).any() for scene in curves):  # a gap may float to where it closes
        states = {i: state for i, state in states.items() if state == STUCK}
    for scene in curves:
        states = _by_linear_responses(scene, states)
        if not states:
            return {}
    for first in range(0, len(curves), TOGETHER):
        states = _by_starts(curves[first : first + TOGETHER], states)
    return states


def room(contact: Contact, state: str, u: AnyArray, v: AnyArray, v_mean: AnyArray) -> FloatArray:
    """By how much a contact is short of slipping or of closing, relative to what it needs, (point,).

    Complex amplitudes u, v and the mean v_mean at points. It sticks where mu n exceeds |k_u u -+ mu k_v v|,
    (23), (24): then its mean friction is 0 as well.
    """
    load = contact.n_0 + contact.k_v * v_mean
    limit, needed = load, contact.k_v * np.abs(v)
    if state == OPEN:
        limit = -load
    elif contact.mu > 0.0 and contact.k_u > 0.0:
        variation = contact.mu * contact.k_v * v
        limit = contact.mu * load
        needed = np.maximum(np.abs(contact.k_u * u - variation), np.abs(contact.k_u * u + variation))
    spare = np.divide(limit, needed, out=np.full(np.shape(needed), np.inf), where=needed > 0.0)
    return np.asarray(np.where(limit > 0.0, spare, 0.0) - 1.0, dtype=np.float64)


def _by_linear_responses(scene: Scene, states: States) -> States:
    """Those of the states that remain with the other contacts glued, and with them open."""
    contacts = scene.contacts
    while states:
        spacious = dict(states)
        for others in (1.0, 0.0) if len(states) < len(contacts) else (1.0,):
            springs = _springs(contacts, spacious, others)
            X = linear_response(scene, telling_frequencies(scene, springs), springs)
            for i, state in list(spacious.items()):
                u, v = X @ contacts[i].tangential, X @ contacts[i].normal
                if room(contacts[i], state, u, v, np.zeros(len(X))).min() < FORESEEN:
                    del spacious[i]
        if len(spacious) == len(states):
            break
        states = spacious
    return states


def _springs(contacts: tuple[Contact, ...], states: States, others: float) -> FloatArray:
    """Springs (2 contacts,) for contacts in their states, and a fraction of those of the others."""
    share = np.array([{STUCK: 1.0, OPEN: 0.0}.get(states.get(i, ""), others) for i in range(len(contacts))])
    k = np.array([(c.k_u if c.mu > 0.0 else 0.0, c.k_v) for c in contacts])
    springs: FloatArray = share[:, None] * k
    return springs.ravel()


def _by_starts(curves: tuple[Scene, ...], states: States) -> States:
    """Those of the states that every solution has which is found at an end of the range."""
    spacious = dict(states)
    for x in _starts(curves):
        for i, state in states.items():
            u, v = x[:, i, 0] + 1j * x[:, i, 1], x[:, i, 2] + 1j * x[:, i, 3]
            each = zip(curves, u, v, x[:, i, 4], strict=True)
            if min(float(room(scene.contacts[i], state, *motion)) for scene, *motion in each) < FORESEEN:
                spacious.pop(i, None)
    return spacious


def _starts(curves: tuple[Scene, ...]) -> Iterator[FloatArray]:
    """Solutions at the ends of the range, (curve, contact, 5); 0 where none is found."""
    balance = Balance(group_of(curves), ClosedForm())
    for end in range(2):
        omega = np.array([scene.frequency_range[end] for scene in curves])
        everything = balance.take(np.arange(len(curves)))
        for x, found in (starting_points(everything, omega), *linear_starts(everything, omega)):
            yield np.where(found[:, None], x, 0.0).reshape(len(curves), -1, UNKNOWNS)
