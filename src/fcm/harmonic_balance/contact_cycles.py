"""Hysteresis loops, states over a cycle and loads of the contacts at points of traced paths."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from fcm.contact.loop import sequences
from fcm.frozen import Frozen
from fcm.harmonic_balance.options import MIN_AMPLITUDE
from fcm.harmonic_balance.reported_quantities import joined
from fcm.harmonic_balance.residual import cycles_of
from fcm.harmonic_balance.system import System
from fcm.model.scene import Contact, FloatArray

NO_STATE = 3  # pads the states of a cycle
OPEN = 2  # the state of separation
LETTERS = np.array(["E", "P", "S", "", "N"])  # by state; negative slip is -1, the last

IntArray = npt.NDArray[np.intp]
ComplexArray = npt.NDArray[np.complex128]


class ContactRecord(Frozen):
    """Loops, states and loads of the contacts at points.

    loop (point, contact, 5), see `loops`; words (point, contact) and contact_loads (point, contact, 4), see
    `cycles`.
    """

    loop: FloatArray
    words: npt.NDArray[np.str_]
    contact_loads: FloatArray

    @classmethod
    def at(cls, system: System, z: FloatArray) -> ContactRecord:
        """The record at points z (point, unknown + 1)."""
        loop = loops(system, z)
        return cls(loop, *cycles(system, z, loop))

    @classmethod
    def joined(cls, parts: Sequence[ContactRecord]) -> ContactRecord:
        """Concatenate the records of several sets of points."""
        return cls(
            *(joined([getattr(one, name) for one in parts]) for name in ("loop", "words", "contact_loads"))
        )

    def part(self, rows: IntArray) -> ContactRecord:
        """The record of some of the points."""
        return ContactRecord(self.loop[rows], self.words[rows], self.contact_loads[rows])

    def with_rows(self, after: IntArray, other: ContactRecord) -> ContactRecord:
        """The record with each point of other inserted after a point of this one."""
        at, words = after + 1, self.words.astype(np.result_type(self.words, other.words))
        return ContactRecord(
            np.insert(self.loop, at, other.loop, axis=0),
            np.insert(words, at, other.words, axis=0),
            np.insert(self.contact_loads, at, other.contact_loads, axis=0),
        )


def loops(system: System, z: FloatArray) -> FloatArray:
    """Loops of the fundamental (point, contact, 5): n0_bar, b_bar, phi, amplitude a, and force k_u a.

    All five are NaN for a contact law of one's own. In a plane the first three are NaN, and a is the greater
    half-axis of the ellipse.
    """
    layout, j = system.layout, system.harmonics.index(1)
    normal = layout.directions - 1
    first = layout.directions + layout.stride * j
    out = np.zeros((z.shape[0], len(system.scene.contacts), 5))
    for i, (contact, x) in enumerate(zip(system.scene.contacts, _blocks(system, z), strict=True)):
        if contact.law is not None:  # its loop is unknown
            out[:, i] = np.nan
            continue
        V = x[:, first + 2 * normal] + 1j * x[:, first + 2 * normal + 1]
        if contact.second is not None:  # no loop; the greatest displacement of the ellipse
            out[:, i, :3] = np.nan
            out[:, i, 3] = _greatest(*(x[:, first + p] + 1j * x[:, first + p + 1] for p in (0, 2)))
            out[:, i, 4] = contact.k_u * out[:, i, 3]
            continue
        U = x[:, first] + 1j * x[:, first + 1]
        a = np.abs(U)
        stiffness = contact.k_u if contact.k_u > 0.0 else 1.0
        ratio = contact.mu / (stiffness * np.maximum(a, MIN_AMPLITUDE))
        out[:, i, 0] = ratio * (contact.n_0 + contact.k_v * x[:, normal])
        out[:, i, 1] = ratio * contact.k_v * np.abs(V)
        out[:, i, 2] = np.angle(V * np.conj(U))
        out[:, i, 3], out[:, i, 4] = a, contact.k_u * a
    return out


def cycles(system: System, z: FloatArray, loop: FloatArray) -> tuple[npt.NDArray[np.str_], FloatArray]:
    """States of each contact over a cycle (point, contact), such as "SPEN", and its loads.

    A contact without friction is closed, "E", open, "S", or both in turn, "SE". The loads (point, contact, 4)
    are the greatest normal force, the greatest friction force, the slip path, and the energy that
    friction dissipates. loop is that of `loops`.
    """
    words, harmonics = [], system.harmonics
    contact_loads = np.zeros((len(system.scene.contacts), z.shape[0], 4))
    for i, (c, state) in enumerate(_solved_contacts(system, z, contact_loads)):
        if c.law is not None:
            words.append(np.full(z.shape[0], "", dtype="<U1"))
        elif c.mu * c.k_u == 0.0:
            words.append(_without_friction(state))
        elif harmonics != (1,) or system.scene.planar:
            words.append(_letters_of(state))
        else:
            words.append(sequences(*loop[:, i, :3].T))
    each = np.stack(words, axis=1) if words else np.empty((z.shape[0], 0), dtype="<U6")
    return each, contact_loads.swapaxes(0, 1)


def contact_loads_along(system: System, z: FloatArray) -> FloatArray:
    """The contact loads (point, contact, 4) of `cycles`, without the states."""
    contact_loads = np.zeros((len(system.scene.contacts), z.shape[0], 4))
    for _ in _solved_contacts(system, z, contact_loads):
        pass
    return np.ascontiguousarray(contact_loads.swapaxes(0, 1))


def _solved_contacts(
    system: System, z: FloatArray, contact_loads: FloatArray
) -> Iterator[tuple[Contact, npt.NDArray[np.intc]]]:
    """Yield each contact with the states of its cycle (point, piece); fill contact_loads.

    contact_loads is (contact, point, 4). The array of states is overwritten for the next contact. A contact
    without friction has no slider: its slip path is 0.
    """
    laws, z = system.exact_laws(system.harmonics), np.ascontiguousarray(z)
    most = max((law.state.shape[0] for law in laws), default=0)
    state = np.empty((z.shape[0], most), dtype=np.intc)
    for i, c in enumerate(system.scene.contacts):
        state[:] = NO_STATE
        cycles_of(laws[i], z, i * system.layout.width, state, contact_loads[i])
        if c.mu * c.k_u == 0.0 and c.law is None:
            contact_loads[i, :, 2] = 0.0
        yield c, state


def _greatest(U: ComplexArray, V: ComplexArray) -> FloatArray:
    """The greater half-axis of the ellipse that two perpendicular displacements describe.

    >>> _greatest(np.array([3.0, 1.0 + 0j]), np.array([4.0j, 1.0]))
    array([4.        , 1.41421356])
    """
    return 0.5 * (np.abs(U + 1j * V) + np.abs(U - 1j * V))


def _letters_of(state: npt.NDArray[np.intc]) -> npt.NDArray[np.str_]:
    """Words (point,) of states (point, piece)."""
    longest = int((state != NO_STATE).sum(axis=1).max(initial=1))
    letters = np.ascontiguousarray(LETTERS[state[:, :longest]])
    words: npt.NDArray[np.str_] = letters.view(f"<U{longest}")[:, 0]
    return words


def _without_friction(state: npt.NDArray[np.intc]) -> npt.NDArray[np.str_]:
    """Words (point,) of states (point, piece) of a contact without friction."""
    opens = (state == OPEN).any(axis=1)
    closes = ((state != OPEN) & (state != NO_STATE)).any(axis=1)
    return np.where(opens & closes, "SE", np.where(closes, "E", "S"))


def _blocks(system: System, z: FloatArray) -> FloatArray:
    """Blocks of the unknowns of each contact, (contact, point, width)."""
    return system.layout.blocks(z).swapaxes(0, 1)
