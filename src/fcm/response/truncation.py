"""What the single harmonic leaves out: the response to the harmonics 2, 3, ... of the exact loop."""

from __future__ import annotations

import numpy as np

from fcm.contact.harmonics import friction_harmonics, normal_harmonics
from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.displacement import displacements
from fcm.response.law import UNKNOWNS
from fcm.response.structure import ComplexArray, modal_compliance

ORDERS = np.arange(2, 9)  # harmonics whose response counts; the structure filters what is above
FAR = 10.0  # beyond this ratio of preload to load variation only the sign of the load matters


def truncation_error(balance: Balance, z: FloatArray) -> FloatArray:
    """Response to the higher harmonics relative to the fundamental, greatest over the degrees of freedom.

    z (point, unknown + 1), the frequency last; result (point,) [-]: sqrt(sum over k > 1 of |X_k|^2) / |X_1|,
    the numerator the greatest of all degrees of freedom, the denominator too.
    """
    x = z[:, :-1].reshape(z.shape[0], balance.group.contacts, UNKNOWNS)
    harmonics = _port_forces(balance, x)
    group, omega = balance.group, z[:, -1]
    square = np.zeros((z.shape[0], group.shapes.shape[2]))
    for k, force in zip(ORDERS, harmonics, strict=True):
        compliance, _ = modal_compliance(group, k * omega)
        modal = compliance * (group.ports @ force[..., None])[..., 0]
        square += np.abs((modal[:, None, :] @ group.shapes)[:, 0, :]) ** 2
    fundamental, _ = displacements(balance, z[:, :-1], omega)
    size = np.abs(fundamental).max(axis=1, initial=0.0)
    error: FloatArray = np.sqrt(square.max(axis=1, initial=0.0)) / np.where(size > 0.0, size, 1.0)
    return error


def _port_forces(balance: Balance, x: FloatArray) -> ComplexArray:
    """Harmonics of the contact forces on the ports, (order, point, 2 contacts)."""
    points, contacts = x.shape[:2]
    law = balance.law
    u, v = x[..., 0] + 1j * x[..., 1], x[..., 2] + 1j * x[..., 3]
    n0_bar, b_bar, phi = law.arguments(x)
    F = friction_harmonics(n0_bar.ravel(), b_bar.ravel(), phi.ravel(), ORDERS)
    load, variation = law.n_0 + law.k_v * x[..., 4], law.k_v * np.abs(v)
    inside = np.abs(load) < variation
    n0_star = np.where(inside, load / np.where(inside, variation, 1.0), FAR)
    N = normal_harmonics(n0_star.ravel(), ORDERS)
    k = ORDERS[:, None, None]
    out = np.empty((ORDERS.size, points, contacts, 2), dtype=np.complex128)
    out[..., 0] = (
        F.reshape(ORDERS.size, points, contacts) * np.exp(1j * k * np.angle(u)) * (law.k_u * np.abs(u))
    )
    out[..., 1] = N.reshape(ORDERS.size, points, contacts) * np.exp(1j * k * np.angle(v)) * variation
    return out.reshape(ORDERS.size, points, 2 * contacts)
