"""A scene at one frequency as a linear system for each combination of contact states.

The state vector is

    y = (q, q', f, n, sin(theta), cos(theta), 1),    d = 2 modes + 2 contacts + 3 numbers,

with the modal displacements and velocities q, q', the friction forces f, the changes n = k_v v of the
normal loads from their preloads, and the phase angle theta = omega t of the forces. Then y' = A y in every
combination of states, forcing and preload included. The forces of the contacts are states of their own:
k_u (u - w) of a stiff contact, computed from displacements, would lose as many digits as it is stiffer than
the structure.
"""

from __future__ import annotations

import numpy as np

from fcm.scene.model import Contact, FloatArray, Scene
from fcm.simulate.errors import SimulationError
from fcm.simulate.flow import Flow

STICK, POSITIVE, NEGATIVE, OPEN = "E", "P", "N", "S"


class System:
    """The linear systems of a scene at an excitation frequency omega [rad/s], made when first visited."""

    def __init__(self, scene: Scene, omega: float) -> None:
        if not (np.isfinite(omega) and omega > 0.0):
            raise SimulationError(f"the frequency is {omega:g}; a simulation needs one that is positive")
        self.scene, self.omega = scene, float(omega)
        self.contacts = scene.contacts
        modal = scene.modal
        m, c = modal.mass.size, len(scene.contacts)
        self.modes, self.size = m, 2 * m + 2 * c + 3
        self.q, self.p = slice(0, m), slice(m, 2 * m)
        self.f, self.n = slice(2 * m, 2 * m + c), slice(2 * m + c, 2 * m + 2 * c)
        self.tangential = np.array([modal.shapes @ k.tangential for k in scene.contacts]).reshape(c, m)
        self.normal = np.array([modal.shapes @ k.normal for k in scene.contacts]).reshape(c, m)
        self.preload = np.array([contact.n_0 for contact in scene.contacts])
        self.sine, self.cosine = _modal_force(scene)
        self._flows: dict[str, Flow] = {}

    @property
    def period(self) -> float:
        """Period of the force [s]."""
        return 2.0 * np.pi / self.omega

    def loads(self, y: FloatArray) -> FloatArray:
        """Normal loads n_0 + k_v v of the contacts, negative while they are open: (contact,)."""
        return self.preload + y[self.n]

    def flow(self, states: str) -> Flow:
        """The exact motion in a combination of states, one letter of EPNS for each contact."""
        flow = self._flows.get(states)
        if flow is None:
            rows, owners = self._exits(states)
            matrix = self.matrix(states)
            flow = self._flows[states] = Flow(matrix, self._rate(matrix), rows, owners)
        return flow

    def matrix(self, states: str) -> FloatArray:
        """The matrix A of y' = A y, (d, d)."""
        modal, m = self.scene.modal, self.modes
        a = np.zeros((self.size, self.size))
        a[self.q, self.p] = np.eye(m)
        a[self.p, self.q] = -np.diag(modal.frequency**2)
        a[self.p, self.p] = -np.diag(2.0 * modal.damping * modal.frequency)
        a[self.p, -3], a[self.p, -2] = self.sine / modal.mass, self.cosine / modal.mass
        a[-3, -2], a[-2, -3] = self.omega, -self.omega
        for j, (contact, state) in enumerate(zip(self.contacts, states, strict=True)):
            self._add_contact(a, j, contact, state)
        return a

    def _add_contact(self, a: FloatArray, j: int, contact: Contact, state: str) -> None:
        f, n = self.f.start + j, self.n.start + j
        push_u, push_v = self.tangential[j] / self.scene.modal.mass, self.normal[j] / self.scene.modal.mass
        a[n, self.p] = contact.k_v * self.normal[j]
        if state == OPEN:
            a[self.p, -1] += push_v * max(contact.n_0, 0.0)  # the preload that is missing
            return
        a[self.p, -1] -= push_v * min(contact.n_0, 0.0)  # a gap is not pressed
        a[self.p, f], a[self.p, n] = -push_u, -push_v
        if state == STICK:
            a[f, self.p] = contact.k_u * self.tangential[j] if has_friction(contact) else 0.0
        else:
            a[f, self.p] = (1.0 if state == POSITIVE else -1.0) * contact.mu * a[n, self.p]

    def _rate(self, a: FloatArray) -> float:
        """A bound of the rates [1/s] at which the motion changes: no frequency of it is higher."""
        loads = slice(self.f.start, self.n.stop)
        root = np.sqrt(self.scene.modal.mass)
        with np.errstate(over="ignore", invalid="ignore"):
            stiffness = -a[self.p, self.q] - a[self.p, loads] @ a[loads, self.p]
            stiffness *= root[:, None] / root
        if not np.isfinite(stiffness).all():
            raise SimulationError("the stiffness overflows; use units in which its numbers are smaller")
        damping = 2.0 * self.scene.modal.damping * self.scene.modal.frequency
        structure = np.sqrt(np.linalg.norm(stiffness, 2)) + np.abs(damping).max(initial=0.0)
        return float(max(structure, self.omega))

    def _exits(self, states: str) -> tuple[FloatArray, list[tuple[int, str]]]:
        """Rows g of y that stay positive while the states last, and where each leads when it does not.

        The conditions are (9), (10), (13) to (16), free of division: E lasts while mu n - f and mu n + f
        are positive, P and N while their slip velocity times +-k_u and n are, S while -n is.
        """
        rows: list[FloatArray] = []
        owners: list[tuple[int, str]] = []

        def add(j: int, leads_to: str, **parts: float) -> None:
            rows.append(self._row(j, **parts))
            owners.append((j, leads_to))

        for j, (contact, state) in enumerate(zip(self.contacts, states, strict=True)):
            mu, k_u, k_v = contact.mu, contact.k_u, contact.k_v
            if state == STICK and has_friction(contact):
                add(j, POSITIVE, n=mu, f=-1.0)
                add(j, NEGATIVE, n=mu, f=1.0)
            elif state in (POSITIVE, NEGATIVE):
                sign = 1.0 if state == POSITIVE else -1.0
                add(j, STICK, u_rate=sign * k_u, v_rate=-mu * k_v)
            if state == OPEN:
                add(j, STICK, n=-1.0)
            elif state != STICK or not has_friction(contact):
                add(j, OPEN, n=1.0)
        return np.array(rows).reshape(len(rows), self.size), owners

    def _row(
        self, j: int, f: float = 0.0, n: float = 0.0, u_rate: float = 0.0, v_rate: float = 0.0
    ) -> FloatArray:
        row = np.zeros(self.size)
        row[self.f.start + j], row[self.n.start + j], row[-1] = f, n, n * self.contacts[j].n_0
        row[self.p] = u_rate * self.tangential[j] + v_rate * self.normal[j]
        return row


def has_friction(contact: Contact) -> bool:
    """Whether the contact can exert friction at all; without, it is never more than closed or open."""
    return contact.mu > 0.0 and contact.k_u > 0.0


def _modal_force(scene: Scene) -> tuple[FloatArray, FloatArray]:
    """Modal amplitudes of sin(theta) and of cos(theta)."""
    total = np.zeros(len(scene.modal.dofs), dtype=np.complex128)
    for force in scene.forces:
        total += force.direction * force.amplitude * np.exp(1j * force.phase)
    modal = scene.modal.shapes @ total
    return modal.real.copy(), modal.imag.copy()
