"""Matrices of the equations of motion in time that do not depend on the states of the contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, HeldContact, Scene, has_friction

if TYPE_CHECKING:
    from fcm.time_domain.equations_of_motion import EquationsOfMotion


class Matrices(NamedTuple):
    """The matrices of a scene that do not depend on the states of its contacts.

    Parameters
    ----------
    modal : tuple of arrays
        Squares of the modes' frequencies; 2 zeta omega_0; the steady forces, the forces of sin and cos of
        each harmonic (2 waves, mode), and those that grow as omega^2 (2 waves, mode), all over the modal
        masses.
    ports : tuple of arrays (contact, mode)
        Shapes of u and of v, then the same over the modal masses.
    law : array (5, contact)
        mu, k_u, k_v, n_0, and whether the contact can exert friction.
    springs : tuple of arrays (spring, mode)
        Shapes along which springs act, and the same times stiffness over the modal masses.
    harmonics : tuple of int (waves,)
        Harmonics of the forces, the first is 1.
    """

    modal: tuple[FloatArray, ...]
    ports: tuple[FloatArray, ...]
    law: FloatArray
    springs: tuple[FloatArray, ...]
    harmonics: tuple[int, ...]


def matrices_of(system: EquationsOfMotion) -> Matrices:
    """The `Matrices` of a system, which are the same at every frequency."""
    modal, c = system.scene.modal, system.contacts
    law = np.array([[k.mu, k.k_u, k.k_v, k.n_0, has_friction(k)] for k in c]).reshape(len(c), 5).T
    return Matrices(
        (
            modal.frequency**2,
            2.0 * modal.damping * modal.frequency,
            system.steady / modal.mass,
            *(sines_and_cosines(one) / modal.mass for one in (system.constant, system.square)),
        ),
        (system.tangential, system.normal, system.tangential / modal.mass, system.normal / modal.mass),
        law,
        (system.stretch, system.pull),
        system.harmonics,
    )


def sines_and_cosines(wave: npt.NDArray[np.complex128]) -> FloatArray:
    """Factors of sin and cos in Im(wave exp(i h theta)), in turn: (2 waves, mode) of wave (waves, mode)."""
    parts: FloatArray = np.stack((wave.real, wave.imag), axis=1)
    return parts.reshape(-1, wave.shape[-1])


def held_as_springs(scene: Scene) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Springs and steady forces that replace the held contacts.

    Returns the shapes of the springs (spring, mode), these times stiffness over modal masses, and the steady
    modal forces.
    """
    modal, steady = scene.modal, np.zeros(scene.modal.mass.size)
    stretch, stiffness = list[FloatArray](), list[float]()
    for one in scene.held:
        contact = one.contact
        along, across = modal.shapes @ contact.tangential, modal.shapes @ contact.normal
        if one.open:  # the preload is missing
            steady += across * max(contact.n_0, 0.0)
            continue
        steady -= across * min(contact.n_0, 0.0)  # a gap does not press
        stretch, stiffness = [*stretch, across], [*stiffness, contact.k_v]
        if has_friction(contact):
            steady += along * (contact.k_u * one.rest)
            stretch, stiffness = [*stretch, along], [*stiffness, contact.k_u]
    shapes = np.array(stretch).reshape(len(stretch), -1 if stretch else modal.mass.size)
    return shapes, shapes * np.array(stiffness)[:, None] / modal.mass, steady


def held_limits(system: EquationsOfMotion) -> FloatArray:
    """Rows for the slip limit (or gap) of each held contact, and for its margins on either side.

    The rows act on the state vector without the forces' angle, (3 held, linear).
    """
    rows = [_limits_of(system, one) for one in system.scene.held]
    return np.array(rows).reshape(3 * len(rows), system.linear)


def _limits_of(system: EquationsOfMotion, one: HeldContact) -> list[FloatArray]:
    """The three limit rows of one held contact."""
    load, force = held_forces(system, one)
    if one.open:
        return [-load] * 3
    if not has_friction(one.contact):
        return [load] * 3
    limit = one.contact.mu * load
    return [limit, limit - force, limit + force]


def held_rows(system: EquationsOfMotion) -> FloatArray:
    """Rows for the normal forces of all held contacts, then for their friction forces: (2 held, d - 2)."""
    pairs = [held_forces(system, one) for one in system.scene.held]
    loads, forces = ([pair[i] for pair in pairs] for i in (0, 1))
    return np.array(loads + forces).reshape(2 * len(pairs), system.linear)


def held_forces(system: EquationsOfMotion, one: HeldContact) -> tuple[FloatArray, FloatArray]:
    """Rows of the state vector for the normal and friction force of a contact held closed."""
    contact, shapes = one.contact, system.scene.modal.shapes
    load, force = np.zeros((2, system.linear))
    load[system.q], load[-1] = contact.k_v * (shapes @ contact.normal), contact.n_0
    if has_friction(contact):
        force[system.q], force[-1] = contact.k_u * (shapes @ contact.tangential), -contact.k_u * one.rest
    return load, force
