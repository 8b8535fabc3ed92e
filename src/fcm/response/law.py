"""The contact in harmonic balance: forces and their tangent for given amplitudes and means (section 4).

Unknowns of a contact: Re u, Im u, Re v, Im v, v_mean. Forces on the structure's ports, with the sign of
the displacement they resist: friction fundamental (2), normal fundamental (2), friction mean, normal mean.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from fcm.contact.fourier import fourier_gradients
from fcm.contact.limits import FloatArray
from fcm.contact.normal import normal_coefficients, normal_gradients
from fcm.response.structure import IntArray

UNKNOWNS, FORCES = 5, 6  # of one contact
SMALLEST = 1e-150  # amplitudes below this count as this in a division


class Coefficients(Protocol):
    """A source of F (3, ...) and dF (3, 3, ...) by (n0_bar, b_bar, phi): a table, or the closed form."""

    def gradients(
        self, n0_bar: FloatArray, b_bar: FloatArray, phi: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Coefficients and derivatives as `fcm.fourier_gradients` gives them."""


class ClosedForm:
    """The exact coefficients in the place of a table."""

    gradients = staticmethod(fourier_gradients)


class Law:
    """Forces of contacts; parameters (curve or 1, contact)."""

    def __init__(
        self, mu: FloatArray, k_u: FloatArray, k_v: FloatArray, n_0: FloatArray, coefficients: Coefficients
    ) -> None:
        self.mu, self.k_u, self.k_v, self.n_0 = mu, k_u, k_v, n_0
        self.coefficients = coefficients
        # a spring without stiffness carries nothing: the divisor then does not matter
        self.ratio = mu / np.where(k_u > 0.0, k_u, 1.0)  # mu / k_u
        self.rough = np.flatnonzero(((mu > 0.0) & (k_u > 0.0)).any(axis=0))  # contacts with friction
        self.elastic = np.flatnonzero((k_v > 0.0).any(axis=0))  # contacts with a normal force

    def arguments(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n0_bar, b_bar, phi) of each contact, from x (curve, contact, 5)."""
        a = np.maximum(np.hypot(x[..., 0], x[..., 1]), SMALLEST)
        b = np.hypot(x[..., 2], x[..., 3])
        phi = np.arctan2(
            x[..., 3] * x[..., 0] - x[..., 2] * x[..., 1], x[..., 2] * x[..., 0] + x[..., 3] * x[..., 1]
        )
        scale = self.ratio / a
        return scale * (self.n_0 + self.k_v * x[..., 4]), scale * self.k_v * b, phi

    def loops(self, x: FloatArray) -> FloatArray:
        """(curve, contact, 5): n0_bar, b_bar, phi of each contact's loop, its a, and the force k_u a."""
        a = np.hypot(x[..., 0], x[..., 1])
        return np.stack((*self.arguments(x), a, self.k_u * a), axis=-1)

    def forces(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces (curve, contact, 6) and their tangent (curve, contact, 6, 5) at x (curve, contact, 5)."""
        force = np.zeros((*x.shape[:-1], FORCES))
        tangent = np.zeros((*x.shape[:-1], FORCES, UNKNOWNS))
        for part, some in ((Law._normal, self.elastic), (Law._friction, self.rough)):
            if some.size == self.k_u.shape[1]:
                part(self, x, force, tangent)
            elif some.size:
                self._of_some(part, some, x, force, tangent)
        return force, tangent

    def _of_some(
        self, part: Callable[..., None], some: IntArray, x: FloatArray, force: FloatArray, tangent: FloatArray
    ) -> None:
        """A part of the forces of those contacts that have it."""
        mu, k_u, k_v, n_0 = (p[:, some] for p in (self.mu, self.k_u, self.k_v, self.n_0))
        forces, tangents = force[:, some], tangent[:, some]
        part(Law(mu, k_u, k_v, n_0, self.coefficients), x[:, some], forces, tangents)
        force[:, some], tangent[:, some] = forces, tangents

    def _normal(self, x: FloatArray, force: FloatArray, tangent: FloatArray) -> None:
        """(28) to (31): k_v b (N_b + N_s sin), less the preload that the structure at rest balances."""
        v = x[..., 2:4]
        b = np.hypot(v[..., 0], v[..., 1])
        load = self.n_0 + self.k_v * x[..., 4]
        variation = self.k_v * b
        open_or_closed = np.where(load > 0.0, 2.0, -2.0)  # beyond +-1 only the sign matters
        inside = np.abs(load) < variation
        n0_star = np.where(inside, load / np.where(inside, variation, 1.0), open_or_closed)
        (N_b, N_s), (dN_b, dN_s) = normal_coefficients(n0_star), normal_gradients(n0_star)
        direction = v / np.maximum(b, SMALLEST)[..., None]
        pulsating = variation * N_b - np.maximum(self.n_0, 0.0)
        # closed throughout, without the preload: it may be far larger than what is left
        closed = self.k_v * x[..., 4] + np.minimum(self.n_0, 0.0)
        steady = np.where(load > 0.0, closed, -np.maximum(self.n_0, 0.0))
        force[..., 2:4] = (self.k_v * N_s)[..., None] * v
        force[..., 5] = np.where(inside, pulsating, steady)
        # v dN_s = direction dN_s (dv_mean - n0_star db)
        along = (self.k_v * dN_s)[..., None] * direction
        tangent[..., 2:4, 2:4] = -(along * n0_star[..., None])[..., None] * direction[..., None, :]
        tangent[..., 2, 2] += self.k_v * N_s
        tangent[..., 3, 3] += self.k_v * N_s
        tangent[..., 2:4, 4] = along
        tangent[..., 5, 2:4] = (self.k_v * 0.5 * dN_s)[..., None] * direction
        tangent[..., 5, 4] = self.k_v * dN_b

    def _friction(self, x: FloatArray, force: FloatArray, tangent: FloatArray) -> None:
        """(27) with the phase of u restored: k_u u (F_s + i F_c), and the mean k_u a F_b."""
        u, v = x[..., 0:2], x[..., 2:4]
        n0_bar, b_bar, phi = self.arguments(x)
        F, dF = self.coefficients.gradients(n0_bar, b_bar, phi)
        a = np.maximum(np.hypot(u[..., 0], u[..., 1]), SMALLEST)
        b = np.maximum(np.hypot(v[..., 0], v[..., 1]), SMALLEST)
        along_u, along_v = u / a[..., None], v / b[..., None]
        # a times the derivatives of n0_bar, b_bar, phi by the unknowns
        d = np.zeros((3, *x.shape))
        d[0, ..., 0:2] = -n0_bar[..., None] * along_u
        d[0, ..., 4] = self.ratio * self.k_v
        d[1, ..., 0:2] = -b_bar[..., None] * along_u
        d[1, ..., 2:4] = (self.ratio * self.k_v)[..., None] * along_v
        d[2, ..., 0], d[2, ..., 1] = along_u[..., 1], -along_u[..., 0]
        turn = (a / b)[..., None] * along_v
        d[2, ..., 2], d[2, ..., 3] = -turn[..., 1], turn[..., 0]
        # (3, curve, contact, 5): a dF by the unknowns
        dF_b, dF_s, dF_c = (dF[:, :, ..., None] * d[None]).sum(axis=1)
        F_b, F_s, F_c = F
        k_u = self.k_u
        force[..., 0] = k_u * (F_s * u[..., 0] - F_c * u[..., 1])
        force[..., 1] = k_u * (F_s * u[..., 1] + F_c * u[..., 0])
        force[..., 4] = k_u * a * F_b
        k = k_u[..., None]
        tangent[..., 0, :] = k * (along_u[..., 0:1] * dF_s - along_u[..., 1:2] * dF_c)
        tangent[..., 1, :] = k * (along_u[..., 1:2] * dF_s + along_u[..., 0:1] * dF_c)
        tangent[..., 4, :] = k * dF_b
        tangent[..., 4, 0:2] += (k_u * F_b)[..., None] * along_u
        tangent[..., 0, 0] += k_u * F_s
        tangent[..., 1, 1] += k_u * F_s
        tangent[..., 0, 1] -= k_u * F_c
        tangent[..., 1, 0] += k_u * F_c
