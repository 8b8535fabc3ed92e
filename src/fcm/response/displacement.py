"""Displacements of every degree of freedom from the unknowns at the contacts."""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.law import UNKNOWNS
from fcm.response.springs import modal_answer
from fcm.response.structure import AnyArray, ComplexArray, modal_compliance


def displacements(balance: Balance, x: FloatArray, omega: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """Amplitude of the fundamental, x(t) = Im(X exp(i omega t)), and mean; both (point, dof)."""
    force, _ = balance.forces(x.reshape(x.shape[0], balance.group.contacts, UNKNOWNS))
    compliance, _ = modal_compliance(balance.group, omega)
    fundamental, mean = _modal_contact_force(balance, force)
    group = balance.group
    amplitude = modal_answer(group, compliance, group.force - fundamental)
    return _to_dofs(balance, amplitude), _to_dofs(balance, balance.static.answer(-mean))


def displacement_rates(
    balance: Balance, z: FloatArray, direction: FloatArray
) -> tuple[ComplexArray, ComplexArray]:
    """Amplitude of the fundamental and its rate along a curve, (point, dof).

    z and direction (point, unknown + 1) are points and tangents in the unknowns' own units.
    """
    x, omega = z[:, :-1], z[:, -1]
    blocks = (x.shape[0], balance.group.contacts, UNKNOWNS)
    force, tangent = balance.law.forces(x.reshape(blocks))
    d_force = (tangent @ direction[:, :-1].reshape(*blocks, 1))[..., 0]
    compliance, slope = modal_compliance(balance.group, omega)
    fundamental, _ = _modal_contact_force(balance, force)
    d_fundamental, _ = _modal_contact_force(balance, d_force)
    group = balance.group
    modal = modal_answer(group, compliance, group.force - fundamental)
    # of stiffness times modal = load the derivative, where the stiffness is 1 / compliance
    d_load = slope / compliance**2 * modal * direction[:, -1:] - d_fundamental
    return _to_dofs(balance, modal), _to_dofs(balance, modal_answer(group, compliance, d_load))


def amplitude_growth(balance: Balance, z: FloatArray, direction: FloatArray) -> FloatArray:
    """Rate of log amplitude of each degree of freedom along a curve, (point, dof)."""
    X, dX = displacement_rates(balance, z, direction)
    size = np.abs(X)
    safe = np.where(size > 0.0, size, 1.0)
    return np.where(size > 0.0, (np.conj(X / safe) * dX).real / safe, 0.0)


def _modal_contact_force(balance: Balance, force: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """Contact forces (point, contact, 6) on the modes: fundamental and mean, (point, mode)."""
    points, ports = force.shape[0], balance.group.ports
    pairs = (force[..., 0:4:2] + 1j * force[..., 1:4:2]).reshape(points, ports.shape[-1])
    fundamental: AnyArray = (ports @ pairs[..., None])[..., 0]
    mean = (ports @ force[..., 4:6].reshape(points, ports.shape[-1], 1))[..., 0]
    return fundamental, mean


def _to_dofs(balance: Balance, modal: AnyArray) -> AnyArray:
    dofs: AnyArray = (modal[:, None, :] @ balance.group.shapes)[:, 0, :]
    return dofs
