r"""Derivatives of the balance and of reported displacements by any number of the scene, at fixed unknowns.

The forces of a contact law depend on its numbers only through the products k_u u, mu k_v v, mu n_0 and k_v v,
n_0. The derivatives by these come from the law itself, evaluated with stiffnesses of 1. With the structure's
modal displacements a = c q under the modal forces q = f - P F,

    dR = -d(P^T a) = -(dP^T a + P^T (dc q + c dq)),    dq = df - dP F - P dF

The derivatives of the structure's arrays by a number are sixth-order differences with a step of 0.3 %. They
are exact for linear dependence, and otherwise accurate to about 1e-12.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_law import Law
from fcm.harmonic_balance.dense_jacobian import unknown_positions
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.scene.draft import Number, number_of
from fcm.sensitivity.options import SENSITIVITY, SensitivityOptions
from fcm.structure.layout import layout_of
from fcm.structure.linear import Linear, linear_of

ComplexArray = npt.NDArray[np.complex128]

STENCIL = ((1, 0.75), (2, -0.15), (3, 1.0 / 60.0))  # central differences of sixth order, first derivative
ARRAYS = ("natural", "damping", "ports", "dofs", "force", "square", "load", "flexibility", "counted")


class Rates(Frozen):
    """Rates of a system by a number: of contact numbers, sliders and the structure's arrays.

    contact: rates of mu, k_u, k_v, n_0 (contact, 4). sliders: rates (port,) of the displacements at which
    contacts start unstressed.
    """

    contact: FloatArray
    sliders: FloatArray
    linear: Linear  # holds rates of the arrays of a structure
    system: System
    options: SensitivityOptions = SENSITIVITY

    def at(self, balance: Balance, z: FloatArray) -> tuple[FloatArray, ComplexArray]:
        """Rates of the residual (unknown,) and of reported displacements X (harmonic, dof), at fixed z.

        Some displacements are combinations of contact displacements, which are unknowns. Their rates only
        include the change of the combination. With the derivatives by the unknowns, they are complete at
        solutions.
        """
        balance.evaluate(z)
        return self.here(balance, z)

    def here(self, balance: Balance, z: FloatArray) -> tuple[FloatArray, ComplexArray]:
        """The rates of `at`, if the balance was last evaluated at z."""
        residual, displacements = self._without_sliders(balance, z)
        if self.sliders.any():
            residual[balance.layout.mean_at] += self.sliders
        return residual, displacements

    def _without_sliders(self, balance: Balance, z: FloatArray) -> tuple[FloatArray, ComplexArray]:
        if self._of_laws:
            return self._at_laws(balance, z)
        if self._of_forces:
            return self._at_forces(balance, z[-1])
        layout = balance.layout
        force = layout.complex_ports(np.asarray(balance.force))
        d_force = layout.complex_ports(self._forces(balance, z))
        if not balance.contacts:
            force = d_force = np.zeros((0, 1 + len(self.system.harmonics)), dtype=np.complex128)
        structure, rate, receptance = self.system.linear, self.linear, balance.receptance
        rows, displacements = (
            np.empty_like(force),
            np.empty((force.shape[1] - 1, structure.dofs.shape[1]), complex),
        )
        q = structure.load - structure.ports @ force[:, 0]
        dq = rate.load - (rate.ports @ force[:, 0] + structure.ports @ d_force[:, 0])
        da = rate.flexibility @ q + structure.flexibility @ dq
        rows[:, 0] = -(rate.ports.T @ (structure.flexibility @ q) + structure.ports.T @ da)
        for j, h in enumerate(self.system.harmonics):
            k = max(receptance.forced[j], 0)
            driven = float(receptance.forced[j] >= 0) * balance.load
            grown, d_grown = (one.force[k] + z[-1] ** 2 * one.square[k] for one in (structure, rate))
            q = driven * grown - structure.ports @ force[:, 1 + j]
            dq = driven * d_grown - rate.ports @ force[:, 1 + j] - structure.ports @ d_force[:, 1 + j]
            c = np.asarray(receptance.c_re)[j] + 1j * np.asarray(receptance.c_im)[j]
            a, da = c * q, self._compliance(c, h * z[-1]) * q + c * dq
            rows[:, 1 + j] = -(rate.ports.T @ a + structure.ports.T @ da)
            # for combinations of ports, the change of the ports' shapes enters with the opposite sign
            of_ports = np.asarray(balance.displacements.attached).T @ (rate.ports.T @ a)
            apart = np.asarray(balance.displacements.without_modes) > 0
            displacements[j] = rate.dofs.T @ a + np.where(apart, structure.dofs.T @ da, -of_ports)
        return layout.flat(rows), displacements

    @cached_property
    def _of_laws(self) -> bool:
        """Whether the number changes only contact laws, and not the structure."""
        return not any(getattr(self.linear, name).any() for name in ARRAYS)

    def _at_laws(self, balance: Balance, z: FloatArray) -> tuple[FloatArray, ComplexArray]:
        """The rates of `at` for a number of contacts alone: response to the rates of their forces."""
        structure, receptance, layout = self.system.linear, balance.receptance, balance.layout
        apart = np.asarray(balance.displacements.without_modes) > 0
        displacements = np.zeros((len(self.system.harmonics), structure.dofs.shape[1]), complex)
        if not balance.contacts:
            return np.zeros(balance.unknowns), displacements
        push = structure.ports @ layout.complex_ports(self._forces(balance, z))
        c = np.asarray(receptance.c_re) + 1j * np.asarray(receptance.c_im)
        a = np.column_stack((structure.flexibility @ push[:, 0], c.T * push[:, 1:]))
        displacements[:, apart] = -(a[:, 1:].T @ structure.dofs[:, apart])
        return layout.flat(structure.ports.T @ a), displacements

    @cached_property
    def _of_forces(self) -> bool:
        """Whether the number changes only the harmonic forces."""
        others = (getattr(self.linear, name) for name in ARRAYS if name not in ("force", "square"))
        return not self.contact.any() and not any(other.any() for other in others)

    def _at_forces(self, balance: Balance, omega: float) -> tuple[FloatArray, ComplexArray]:
        """The rates of `at` for a number that changes only forces: response to the rates of the forces."""
        structure, receptance = self.system.linear, balance.receptance
        residual = np.zeros(balance.unknowns)
        displacements = np.zeros((len(self.system.harmonics), structure.dofs.shape[1]), complex)
        for j, k in enumerate(np.asarray(receptance.forced).tolist()):
            if k < 0:
                continue
            c = np.asarray(receptance.c_re)[j] + 1j * np.asarray(receptance.c_im)[j]
            a = c * balance.load * (self.linear.force[k] + omega**2 * self.linear.square[k])
            displacements[j] = np.where(
                np.asarray(balance.displacements.without_modes) > 0, structure.dofs.T @ a, 0.0
            )
            if balance.contacts:
                of_ports, rows = structure.ports.T @ a, unknown_positions(balance)[1][j]
                residual[rows], residual[rows + 1] = -of_ports.real, -of_ports.imag
        return residual, displacements

    def _compliance(self, c: ComplexArray, w: float) -> ComplexArray:
        """The rate of c = 1 / (w_i^2 - w^2 + 2 i zeta_i w_i w)."""
        linear, rate = self.system.linear, self.linear
        damped = rate.damping * linear.natural + linear.damping * rate.natural
        return -c * c * (2.0 * linear.natural * rate.natural + 2j * w * damped)

    def _forces(self, balance: Balance, z: FloatArray) -> FloatArray:
        """Rates of the contact forces (unknown,), without the part that is counted to the structure."""
        found, normal = np.zeros(balance.unknowns), balance.directions - 1
        for i, rate in enumerate(self.contact):
            first = i * balance.width
            block = z[first : first + balance.width]
            if rate.any():
                found[first : first + balance.width] = rate @ law_rates(balance.laws[i], block, self.options)
            found[first + normal] -= self.linear.counted[i] * block[normal]
        return found


def law_rates(law: Law, x: FloatArray, options: SensitivityOptions = SENSITIVITY) -> FloatArray:
    """Derivatives of a contact's forces by mu, k_u, k_v, n_0, (4, width), at its unknowns x (width,)."""
    mu, k_u, k_v, n_0 = law.mu, law.k_u, law.k_v, law.n_0
    layout = layout_of(1, law.directions, (x.size // law.directions - 1) // 2)
    normal, mean = layout.of_normal, law.directions - 1
    unit = np.ascontiguousarray(np.where(normal, k_v, k_u) * x)  # with stiffnesses of 1
    load = unit * normal
    load[mean] += n_0
    law.k_u, law.k_v, law.mu = 1.0, 1.0, mu or options.friction
    law.evaluate(unit, 0)
    slope, force = np.array(law.tangent), np.array(law.force)
    law.mu = mu
    if mu == 0.0:
        law.evaluate(unit, 0)
        slope = np.array(law.tangent)
        by_mu = force / options.friction
    else:
        by_mu = slope @ load / mu
    law.k_u, law.k_v = k_u, k_v
    by_n_0 = slope[:, mean].copy()
    by_n_0[mean] -= float(n_0 > 0.0)  # the preload is in equilibrium with the structure at rest
    return np.stack((np.where(normal, 0.0, by_mu), slope @ (x * ~normal), slope @ (x * normal), by_n_0))


def growth_of(balance: Balance, X: ComplexArray) -> FloatArray:
    """Rate of each amplitude (dof,), if the last reported displacements have the rates X (harmonic, dof)."""
    displacements, harmonics = balance.displacements, np.asarray(balance.receptance.harmonics)
    now = np.asarray(displacements.re) + 1j * np.asarray(displacements.im)
    if harmonics.size == 1:
        size = np.abs(now[0])
        return np.where(size > 0.0, (np.conj(now[0]) * X[0]).real / np.where(size > 0.0, size, 1.0), 0.0)
    turned = np.exp(1j * harmonics[:, None, None] * np.asarray(displacements.angles)) * X[:, None]
    rates = turned.sum(axis=0).real  # rates of the greatest and of the least displacement
    growth: FloatArray = 0.5 * (rates[0] - rates[1])
    return growth


def rates_of(system: System, address: str, options: SensitivityOptions = SENSITIVITY) -> Rates:
    """The rates of a system by a number; if the number stands for several, their rates add up.

    Parameters
    ----------
    address : str
        The key path of the number as in [sweep], such as "contact.shroud.n_0".

    Raises
    ------
    SceneError
        If there is no such number.
    ValueError
        If the number changes which rigid-body motions the structure has.

    Examples
    --------
    >>> import numpy as np
    >>> import fcm
    >>> system = System(fcm.load_scene("yang1998-n5"))
    >>> z = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 1.2])
    >>> by_amplitude = rates_of(system, "force.u.amplitude")
    >>> by_amplitude.at(system.new_balance(), z)[0][2:].round(4).tolist()
    [0.0618, -1.1225, 0.0618, -1.1377]
    """
    number = number_of(system.scene, address)
    contact = np.zeros((len(system.scene.contacts), 4))
    total = {name: np.zeros_like(getattr(system.linear, name)) for name in ARRAYS}
    sliders = np.zeros(system.layout.ports)
    for one, value, weight in number.each(system.scene):
        contact += weight * (
            contact_numbers(one.put(system.scene, 1.0)) - contact_numbers(one.put(system.scene, 0.0))
        )
        for name, rate in _linear(system, one, value, options):
            total[name] = total[name] + weight * rate
        if system.scene.start is not None:
            step = options.number * (abs(value) or 1.0)
            around = {k: one.put(system.scene, value + k * step).sliders() for k in (-3, -2, -1, 1, 2, 3)}
            sliders += weight * sum(part / step * (around[k] - around[-k]) for k, part in STENCIL)
    structure = Linear(**total, adrift=system.linear.adrift, driven=system.linear.driven)
    return Rates(contact, sliders, structure, system, options)


def contact_numbers(scene: Scene) -> FloatArray:
    """mu, k_u, k_v, n_0 (contact, 4); each depends linearly on any number of a scene."""
    return np.array([(c.mu, c.k_u, c.k_v, c.n_0) for c in scene.contacts]).reshape(-1, 4)


_OF_LAW = ("mu", "k_u", "n_0", "gap")  # numbers of contacts that do not affect the structure's arrays


def changes_rigid_bodies(linear: Linear, number: Number, value: float) -> bool:
    """Whether a number at a value changes the rigid-body motions, so that rates by it are unknown."""
    address = number.addresses[0]
    of_modes = address[0] == "modal" and "damping" not in address
    of_contacts = address[0] == "contact" and address[-1] not in _OF_LAW and not value
    return bool((linear.natural == 0.0).any()) and (of_modes or of_contacts)


def _linear(
    system: System, number: Number, value: float, options: SensitivityOptions = SENSITIVITY
) -> Iterator[tuple[str, npt.NDArray[np.inexact]]]:
    """Yields name and derivative of each array of the structure that depends on the number."""
    kind, field = number.addresses[0][0], number.addresses[0][-1]
    rigid = bool((system.linear.natural == 0.0).any())
    if (kind == "contact" and field in _OF_LAW) or (field == "k_v" and not rigid):
        return
    if changes_rigid_bodies(system.linear, number, value):
        raise ValueError(f"{number.key} changes the rigid-body motions of the structure")
    step = options.number if field == "phase" else options.number * (abs(value) or 1.0)
    around = {k: linear_of(number.put(system.scene, value + k * step)) for k in (-3, -2, -1, 1, 2, 3)}
    for name in ARRAYS:
        yield (
            name,
            sum(
                weight / step * (getattr(around[k], name) - getattr(around[-k], name))
                for k, weight in STENCIL
            ),
        )
