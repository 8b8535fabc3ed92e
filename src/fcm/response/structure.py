"""The linear structure seen from its contacts: receptances of many curves at once, modes summed out.

Every array has a leading axis of curves, of length 1 where all curves share the value; a curve is any
scene, so that a sweep may change any number. Real pairs, not complex numbers, carry the amplitudes:
x(t) = Im(X exp(i omega t)), so that sin(omega t) is 1 and cos(omega t) is i.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.response.rigid import settled
from fcm.scene.model import Contact, FloatArray, Scene

AnyArray = npt.NDArray[Any]  # real or complex
ComplexArray = npt.NDArray[np.complex128]
IntArray = npt.NDArray[np.intp]
BoolArray = npt.NDArray[np.bool_]


LEAST_DAMPING = 1e-9  # twice the damping ratio of an undamped mode exactly at its own frequency


@dataclass(frozen=True)
class Group:
    """Curves of one layout (modes, degrees of freedom, contacts) as arrays; see `group_of`."""

    mass: FloatArray  # (curve, mode)
    frequency: FloatArray  # (curve, mode)
    damping: FloatArray  # (curve, mode)
    shapes: FloatArray  # (curve, mode, dof)
    ports: FloatArray  # (curve, mode, 2 contacts): modes on u_1, v_1, u_2, v_2, ...
    force: ComplexArray  # (curve, mode)
    mu: FloatArray  # (curve, contact)
    k_u: FloatArray
    k_v: FloatArray
    n_0: FloatArray
    adrift: BoolArray  # (curve, mode) rigid-body modes that no closed contact holds
    springs: FloatArray  # (curve, mode, 2 held): modes on contacts that act as springs, as in ports
    k_springs: FloatArray  # (curve, 2 held)
    low: FloatArray  # (curve,) the frequency range
    high: FloatArray

    def take(self, index: IntArray) -> Group:
        """The curves of an index, in its order; shared arrays stay shared."""
        parts = (getattr(self, f.name) for f in fields(self))
        return Group(*(part if part.shape[0] == 1 else part[index] for part in parts))

    @property
    def contacts(self) -> int:
        return int(self.mu.shape[1])


@dataclass(frozen=True)
class Spring(Contact):
    """A contact that acts as a spring along its tangent and one along its normal, and needs no unknowns."""

    held: bool = True


def group_of(scenes: Sequence[Scene]) -> Group:
    """Stack scenes that have the same modes, degrees of freedom and contacts by name."""
    modals, adrift = zip(*(settled(s) for s in scenes), strict=True)
    scenes = [s if s.modal is m else replace(s, modal=m) for s, m in zip(scenes, modals, strict=True)]
    modes = modals[0].frequency.size
    group = Group(
        mass=_stack([m.mass for m in modals]),
        frequency=_stack([m.frequency for m in modals]),
        damping=_stack([m.damping for m in modals]),
        shapes=_stack([m.shapes for m in modals]),
        ports=_stack([_ports(s) for s in scenes]),
        force=_stack([_modal_force(s) for s in scenes]),
        mu=_stack([np.array([c.mu for c in s.contacts]) for s in scenes]),
        k_u=_stack([np.array([c.k_u for c in s.contacts]) for s in scenes]),
        k_v=_stack([np.array([c.k_v for c in s.contacts]) for s in scenes]),
        n_0=_stack([np.array([c.n_0 for c in s.contacts]) for s in scenes]),
        adrift=_stack(list(adrift)),
        springs=np.zeros((1, modes, 0)),
        k_springs=np.zeros((1, 0)),
        low=_stack([np.array(s.frequency_range[0]) for s in scenes]),
        high=_stack([np.array(s.frequency_range[1]) for s in scenes]),
    )
    return _with_springs(group, [i for i, c in enumerate(scenes[0].contacts) if isinstance(c, Spring)])


def _with_springs(group: Group, held: list[int]) -> Group:
    """The group with some of its contacts as springs."""
    if not held:
        return group
    others = [i for i in range(group.contacts) if i not in held]
    pairs = group.ports.reshape(*group.ports.shape[:2], group.contacts, 2)
    k_u, k_v = np.broadcast_arrays(np.where(group.mu > 0.0, group.k_u, 0.0), group.k_v)
    k = np.stack((k_u, k_v), axis=-1)[:, held]
    return replace(
        group,
        ports=pairs[:, :, others].reshape(*pairs.shape[:2], -1),
        springs=pairs[:, :, held].reshape(*pairs.shape[:2], -1),
        k_springs=k.reshape(k.shape[0], -1),
        **{name: getattr(group, name)[:, others] for name in ("mu", "k_u", "k_v", "n_0")},
    )


def _stack(parts: list[AnyArray]) -> AnyArray:
    """One array for each curve, or a single one where they are all equal."""
    first = parts[0]
    if all(part is first or np.array_equal(part, first) for part in parts):
        return first[None]
    return np.stack(parts)


def with_contact(scene: Scene) -> Scene:
    """The scene; one without contacts gets one that carries nothing, for the path to follow."""
    if unknown_contacts(scene):
        return scene
    along = np.sum([np.abs(force.direction) for force in scene.forces], axis=0)
    nothing = Contact("", along, along, mu=0.0, k_u=0.0, k_v=0.0, n_0=0.0)
    return replace(scene, contacts=(*scene.contacts, nothing))


def unknown_contacts(scene: Scene) -> int:
    """Number of contacts that are no springs."""
    return sum(not isinstance(contact, Spring) for contact in scene.contacts)


def _ports(scene: Scene) -> FloatArray:
    directions = [d for c in scene.contacts for d in (c.tangential, c.normal)]
    stacked = np.array(directions, dtype=np.float64).reshape(len(directions), len(scene.modal.dofs))
    return scene.modal.shapes @ stacked.T


def _modal_force(scene: Scene) -> ComplexArray:
    total = np.zeros(len(scene.modal.dofs), dtype=np.complex128)
    for force in scene.forces:
        total += force.direction * force.amplitude * np.exp(1j * force.phase)
    return scene.modal.shapes @ total


def modal_compliance(group: Group, omega: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """1 / (m (w_i^2 - omega^2 + 2 i zeta w_i omega)) of each mode, and its derivative by omega."""
    w = omega[:, None]
    natural = group.frequency
    # the difference of squares as a product: exact next to an undamped resonance
    stiffness = (natural - w) * (natural + w) + 2j * (group.damping * natural * w)
    if not stiffness.all():  # nothing damps a mode that is excited at its own frequency
        stiffness = np.where(stiffness == 0.0, 1j * LEAST_DAMPING * natural**2, stiffness)
    compliance: AnyArray = 1.0 / (group.mass * stiffness)
    slope: AnyArray = compliance * (2.0 * w - 2j * (group.damping * natural)) / stiffness
    return compliance, slope


def receptance(group: Group, weights: AnyArray) -> AnyArray:
    """Sum of the modes' weights over the contact ports, (curve, port, port)."""
    return between(group.ports, weights, group.ports)


def between(left: AnyArray, weights: AnyArray, right: AnyArray) -> AnyArray:
    """Sum of the modes' weights (curve, mode) between directions (curve, mode, left or right)."""
    total: AnyArray = (left.swapaxes(1, 2) * weights[:, None, :]) @ right
    return total


def to_ports(group: Group, modal: AnyArray) -> AnyArray:
    """Modal coordinates (curve, mode) to displacements of the ports (curve, port)."""
    ports: AnyArray = (modal[:, None, :] @ group.ports)[:, 0, :]
    return ports
