"""Contacts that act as springs, condensed: the structure with them, seen from the other contacts.

A contact that sticks throughout is a spring k_u along its tangent and k_v along its normal, and needs no
unknowns. With M the receptance between springs and M_p that between springs and ports, a force on the ports
meets the reactions R = (1/k + M)^-1 M_p, and the receptance between the ports is G - M_p^T R.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.structure import (
    AnyArray,
    ComplexArray,
    Group,
    between,
    modal_compliance,
    receptance,
    to_ports,
)


class Seen(NamedTuple):
    """The structure under harmonic forces, seen from its contact ports, and derivatives by omega."""

    G: ComplexArray  # (curve, port, port) displacements by forces
    dG: ComplexArray
    external: ComplexArray  # (curve, port) displacements by the external forces
    d_external: ComplexArray


def seen(group: Group, omega: FloatArray) -> Seen:
    """The structure seen from its contact ports at omega (curve,)."""
    compliance, slope = modal_compliance(group, omega)
    if group.k_springs.shape[1] == 0:
        external = to_ports(group, compliance * group.force), to_ports(group, slope * group.force)
        return Seen(receptance(group, compliance), receptance(group, slope), *external)
    ports, springs, k = group.ports, group.springs, group.k_springs[:, :, None]
    count = ports.shape[2]
    curves = max(ports.shape[0], group.force.shape[0])
    loads = np.concatenate(
        [np.broadcast_to(part, (curves, *part.shape[1:])) for part in (ports, group.force[:, :, None])],
        axis=2,
    )
    M_p, dM_p = between(springs, compliance, loads), between(springs, slope, loads)
    reaction = np.linalg.solve(_stiffened(group, compliance), k * M_p)
    back = reaction[:, :, :count].swapaxes(1, 2)
    both = between(ports, compliance, loads) - back @ M_p
    d_both = between(ports, slope, loads) - back @ dM_p - dM_p[:, :, :count].swapaxes(1, 2) @ reaction
    d_both += back @ between(springs, slope, springs) @ reaction
    return Seen(both[:, :, :count], d_both[:, :, :count], both[:, :, count], d_both[:, :, count])


def among_contacts(group: Group, tangent: FloatArray) -> tuple[Group, FloatArray]:
    """The springs as contacts again, after the others, with the tangents (point, contact, 6, 5) of all."""
    if group.k_springs.shape[1] == 0:
        return group, tangent
    k = group.k_springs.reshape(group.k_springs.shape[0], -1, 2)
    of_springs = np.zeros((*k.shape[:2], *tangent.shape[2:]))
    for part in range(2):
        of_springs[:, :, part, part] = k[:, :, 0]
        of_springs[:, :, 2 + part, 2 + part] = k[:, :, 1]
    of_springs[:, :, 5, 4] = k[:, :, 1]
    none = np.zeros((1, k.shape[1]))
    names = ("mu", "k_u", "k_v", "n_0")
    together = replace(
        group,
        ports=_beside(group.ports, group.springs),
        springs=group.springs[:, :, :0],
        k_springs=group.k_springs[:, :0],
        **{name: np.concatenate(_alike(getattr(group, name), none), axis=1) for name in names},
    )
    return together, np.concatenate(_alike(tangent, of_springs), axis=1)


def modal_answer(group: Group, compliance: ComplexArray, load: AnyArray) -> AnyArray:
    """Modal coordinates under modal loads (curve, mode), springs included."""
    free: AnyArray = compliance * load
    if group.k_springs.shape[1] == 0:
        return free
    elongation = group.springs.swapaxes(1, 2) @ free[..., None]
    reaction = np.linalg.solve(_stiffened(group, compliance), group.k_springs[:, :, None] * elongation)
    answer: AnyArray = free - compliance * (group.springs @ reaction)[..., 0]
    return answer


def _stiffened(group: Group, compliance: ComplexArray) -> ComplexArray:
    """1 + k M, so that a spring may have no stiffness."""
    M: ComplexArray = between(group.springs, compliance, group.springs)
    return group.k_springs[:, :, None] * M + np.eye(M.shape[1])


def _beside(one: AnyArray, other: AnyArray) -> AnyArray:
    """Directions (curve, mode, direction) of two arrays in one."""
    return np.concatenate(_alike(one, other), axis=2)


def _alike(one: AnyArray, other: AnyArray) -> tuple[AnyArray, AnyArray]:
    """Two arrays with as many curves each."""
    curves = max(one.shape[0], other.shape[0])
    return np.broadcast_to(one, (curves, *one.shape[1:])), np.broadcast_to(other, (curves, *other.shape[1:]))
