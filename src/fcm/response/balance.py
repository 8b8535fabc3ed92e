"""Harmonic balance of the mean and the fundamental, condensed to the contacts.

The modes are summed into the receptance G(omega) between the contact ports, so that the unknowns are the
relative displacements of the contacts alone, whatever the number of modes:

    x = x_external(omega) - G(omega) f(x),    v_mean = -G(0) f_mean(x)

In this form the residual has the unit of a displacement, and the Jacobian is 1 + G df/dx.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.law import FORCES, UNKNOWNS, Coefficients, Law
from fcm.response.springs import seen
from fcm.response.static import Static, static_of
from fcm.response.structure import AnyArray, Group, IntArray


@dataclass(frozen=True)
class Evaluation:
    """Residual and derivatives at one point of each curve; unknowns flattened to (curve, 5 contacts)."""

    residual: FloatArray  # (curve, unknown)
    jacobian: FloatArray  # (curve, unknown, unknown)
    by_omega: FloatArray  # (curve, unknown)


class Balance:
    """The balanced equations of a group of curves."""

    def __init__(self, group: Group, coefficients: Coefficients, static: Static | None = None) -> None:
        self.group = group
        self.coefficients = coefficients
        self.law = Law(group.mu, group.k_u, group.k_v, group.n_0, coefficients)
        self.static = static_of(group) if static is None else static

    def take(self, index: IntArray) -> Balance:
        """The same equations for some of the curves."""
        return Balance(self.group.take(index), self.coefficients, self.static.take(index))

    def forces(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces of the contacts and their tangent, as `Law.forces`, less those counted to the structure."""
        force, tangent = self.law.forces(x)
        if self.static.counted is not None:
            force[..., 5] -= self.static.counted * x[..., 4]
            tangent[..., 5, 4] -= self.static.counted
        return force, tangent

    def evaluate(self, x: FloatArray, omega: FloatArray, load: FloatArray | float = 1.0) -> Evaluation:
        """Residual, Jacobian and derivative by omega at x (curve, 5 contacts), omega (curve,).

        load multiplies the external force.
        """
        curves, contacts = x.shape[0], self.group.contacts
        force, tangent = self.forces(x.reshape(curves, contacts, UNKNOWNS))
        G, dG, external, d_external = seen(self.group, omega)
        factor = np.asarray(load).reshape(-1, 1)
        flat = force.reshape(curves, contacts * FORCES)
        matrix = self.real_matrix(G)
        residual = x + (matrix @ flat[..., None])[..., 0] - _real_vector(factor * external, contacts)
        by_omega = self._harmonic_force(dG, force) - _real_vector(factor * d_external, contacts)
        blocks = matrix.reshape(curves, contacts * UNKNOWNS, contacts, FORCES).swapaxes(1, 2) @ tangent
        jacobian = blocks.swapaxes(1, 2).reshape(curves, x.shape[1], x.shape[1])
        jacobian += np.eye(x.shape[1])
        return Evaluation(residual, jacobian, by_omega)

    def by_load(self, omega: FloatArray) -> FloatArray:
        """Derivative of the residual by the load factor."""
        return -_real_vector(seen(self.group, omega).external, self.group.contacts)

    def linear(self, omega: FloatArray, stuck: FloatArray) -> FloatArray:
        """Response with springs for contacts: the fraction stuck (curve, contact) of k_u and k_v acts."""
        contacts = self.group.contacts
        G, _, external, _ = seen(self.group, omega)
        springs = np.stack((self.group.k_u * stuck, self.group.k_v * stuck), axis=-1)
        matrix = np.eye(2 * contacts) + G * springs.reshape(springs.shape[0], 1, -1)
        ports = np.linalg.solve(matrix, external[..., None])[..., 0]
        return _real_vector(ports, contacts)

    def real_matrix(self, G: AnyArray) -> FloatArray:
        """G as a real matrix from the six forces of each contact to its five unknowns."""
        contacts = self.group.contacts
        G = G.reshape(-1, contacts, 2, contacts, 2)
        static = self.static.receptance.reshape(-1, contacts, 2, contacts, 2)
        matrix = np.zeros((G.shape[0], contacts, UNKNOWNS, contacts, FORCES))
        matrix[:, :, 0:4:2, :, 0:4:2] = matrix[:, :, 1:4:2, :, 1:4:2] = G.real
        matrix[:, :, 1:4:2, :, 0:4:2] = G.imag
        matrix[:, :, 0:4:2, :, 1:4:2] = -G.imag
        matrix[:, :, 4, :, 4:6] = static[:, :, 1, :, :]
        return matrix.reshape(G.shape[0], contacts * UNKNOWNS, contacts * FORCES)

    def _harmonic_force(self, G: AnyArray, force: FloatArray) -> FloatArray:
        """G times the fundamental of the forces, as unknowns; zero in the means."""
        amplitude = force[..., 0:4:2] + 1j * force[..., 1:4:2]
        flat = amplitude.reshape(amplitude.shape[0], G.shape[-1], 1)
        return _real_vector((G @ flat)[..., 0], self.group.contacts)


def _real_vector(ports: AnyArray, contacts: int) -> FloatArray:
    """Complex ports (curve, 2 contacts) as unknowns (curve, 5 contacts) with zero means."""
    out = np.zeros((ports.shape[0], contacts, UNKNOWNS))
    pairs = ports.reshape(ports.shape[0], contacts, 2)
    out[..., 0:4:2], out[..., 1:4:2] = pairs.real, pairs.imag
    return out.reshape(ports.shape[0], contacts * UNKNOWNS)
