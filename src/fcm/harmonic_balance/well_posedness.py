"""Points at which a rigid-body mode makes the motion undetermined, or no steady state.

Friction does not depend on the position of a mode adrift, so that the balance keeps its mean as it is at
rest. Where all contacts slip, nothing balances a mean force along this mode: the structure creeps. Contacts
that stick hold it by residual friction, unless this force makes them slip. Along the other rigid-body modes
the structure floats in its gaps while no closed contact carries load.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.contact_cycles import cycles, loops
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.structure.options import RIGID_BODY

BoolArray = npt.NDArray[np.bool_]
REASONS = {
    "pushed": "friction pushes the structure one way on average, along a rigid-body mode that nothing holds, "
    "so there is no steady state. Hold it by a contact along its normal, or by {}",
    "loaded": "the static loads push the structure on, along a rigid-body mode that friction alone holds at "
    "rest, so there is no steady state. Hold it by a contact along its normal, or by {}",
    "floating": "no closed contact holds the structure along a rigid-body mode: its place is not determined",
}


def undetermined(system: System, z: FloatArray, force: FloatArray) -> dict[str, BoolArray]:
    """Whether "pushed" and "floating" of REASONS apply at points z (point, unknown + 1), each (point,).

    force (point, unknown): contact forces, laid out as the unknowns. Empty without rigid-body modes.
    """
    if system.linear.natural.size == 0 or system.linear.natural.min() > 0.0:
        return {}
    blocks, forces = system.layout.blocks(z), system.layout.blocks(force)
    pushed, _ = _pushed(system, z, blocks, forces)
    return {"pushed": pushed, "floating": _floating(system, blocks, forces)}


def hold_unknown(system: System, z: FloatArray, force: FloatArray) -> BoolArray:
    """Points (point,) where it is unknown whether sticking contacts hold the structure or slip.

    z, force are those of `undetermined`. The stability of these points is unknown.
    """
    if not system.linear.adrift.any():
        return np.zeros(len(z), dtype=np.bool_)
    return _pushed(system, z, system.layout.blocks(z), system.layout.blocks(force))[1]


def _pushed(system: System, z: FloatArray, x: FloatArray, force: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Whether points are pushed along a mode adrift, and where this is unknown, each (point,).

    A point is pushed if mean friction and static loads on the mode do not balance and no sticking contact
    holds it. It is unknown whether contacts hold that would need more friction than they have left. x, force
    (point, contact, width) at points z (point, unknown + 1).
    """
    layout, linear = system.layout, system.linear
    d, first = layout.directions, layout.directions + layout.stride * system.harmonics.index(1)
    mean, size = np.zeros((2, len(force), linear.natural.size))
    for along in range(d - 1):
        ports, at = linear.ports[:, along::d], first + 2 * along
        mean += force[:, :, along] @ ports.T
        size += np.hypot(force[:, :, at], force[:, :, at + 1]) @ np.abs(ports).T
    mean -= linear.load
    least = system.options.rigid.friction_tolerance * size
    pushed: BoolArray = np.any(linear.adrift & (np.abs(mean) > least), axis=1)
    unknown, rows = np.zeros_like(pushed), np.flatnonzero(pushed)
    if rows.size:
        stuck = _sticking(system, z[rows])
        margin = np.where(stuck, _friction_margin(system, x[rows], force[rows]), 0.0)
        ports = linear.ports[linear.adrift].reshape(-1, layout.contacts, d)[:, :, :-1]
        for k, i in enumerate(rows):
            push, small = mean[i, linear.adrift], least[i, linear.adrift]
            free, _ = _balanced(ports, push, stuck[k].astype(float))
            pushed[i] = bool((np.abs(free) > small).any())
            left, share = _balanced(ports, push, margin[k])
            unknown[i] = not pushed[i] and bool((np.abs(left) > small).any() or share > 1.0)
    return pushed, unknown


def _sticking(system: System, z: FloatArray) -> BoolArray:
    """Contacts with friction that stick over the whole cycle (point, contact)."""
    rough = np.array([c.mu * c.k_u > 0.0 and c.law is None for c in system.scene.contacts], dtype=np.bool_)
    z = np.ascontiguousarray(z)
    words, _ = cycles(system, z, loops(system, z))
    sticking: BoolArray = (words == "E") & rough
    return sticking


def _friction_margin(system: System, x: FloatArray, force: FloatArray) -> FloatArray:
    """Least distance of friction from its limit over the cycle (point, contact); 0 beyond the limit."""
    layout, contacts = system.layout, system.scene.contacts
    d, harmonics = layout.directions, np.array(system.harmonics)
    samples = system.options.extremes.samples * int(harmonics.max())
    turn = np.exp(1j * np.outer(harmonics, 2.0 * np.pi * np.arange(samples) / samples))
    waves = force[:, :, d:].reshape(*force.shape[:2], harmonics.size, d, 2)
    complex_waves = waves[..., 0] + 1j * waves[..., 1]
    in_time = force[:, :, :d, None] + np.einsum("pchd,hs->pcds", complex_waves, turn).real
    mu, n_0 = np.array([c.mu for c in contacts]), np.array([c.n_0 for c in contacts])
    still = system.linear.counted * x[:, :, d - 1] + np.maximum(n_0, 0.0)
    load = in_time[:, :, d - 1] + still[:, :, None]
    distance = mu[:, None] * load - np.linalg.norm(in_time[:, :, :-1], axis=2)
    margin: FloatArray = np.maximum(distance.min(axis=2), 0.0)
    return margin


def _balanced(ports: FloatArray, push: FloatArray, weight: FloatArray) -> tuple[FloatArray, float]:
    """Distribute a push (mode,) over contacts by least squares; return the rest and the greatest share.

    ports (mode, contact, direction). The share of a contact is its friction relative to its weight
    (contact,).
    """
    ways = (ports * weight[:, None]).reshape(len(push), -1)
    taken = np.linalg.lstsq(ways, push, rcond=None)[0]
    share = np.linalg.norm(taken.reshape(len(weight), -1), axis=1)
    return push - ways @ taken, float(share.max(initial=0.0))


def _floating(system: System, x: FloatArray, force: FloatArray) -> BoolArray:
    """Whether a rigid-body mode that all contacts together would hold is free, as some carry no load."""
    contacts, linear = system.scene.contacts, system.linear
    k_v, n_0 = np.array([c.k_v for c in contacts]), np.array([c.n_0 for c in contacts])
    held = (linear.natural == 0.0) & ~linear.adrift
    ports = np.where(held[:, None], linear.normal, 0.0) * (k_v > 0.0)
    layout, j = system.layout, system.harmonics.index(1)
    mean = layout.directions - 1
    first = layout.directions + layout.stride * j + 2 * mean
    glued = np.abs(n_0) + k_v * (np.hypot(x[:, :, first], x[:, :, first + 1]) + np.abs(x[:, :, mean]))
    normal = force[:, :, mean] + linear.counted * x[:, :, mean] + np.maximum(n_0, 0.0)
    carrying = normal > system.options.rigid.load_tolerance * glued
    size = np.linalg.svd(ports[None] * carrying[:, None, :], compute_uv=False)
    largest = size.max(axis=1, initial=0.0, keepdims=True)
    floating: BoolArray = (size > RIGID_BODY.min_normal_motion * largest).sum(axis=1) < held.sum()
    return floating
