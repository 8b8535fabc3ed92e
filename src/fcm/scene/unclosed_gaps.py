r"""Questions gaps that no motion of the structure can close, mostly because of a wrong unit of length.

Without contact the relative displacement along a contact's normal is at most

.. math:: \sum_m |n^T \phi_m| \, |\phi_m^T f| / \min_\omega |\omega_m^2 - \omega^2 + i r_m \omega|

over the frequency range, with modes of mass 1 and their damping rates r_m. The bound is the greater of two:
with the modes for all contacts open, and with those for contacts stuck that are closed at rest, since these
may carry the motion to the gap.

A contact with k_v = 0 has the normal force max(n_0, 0) whatever the motion. So no motion closes it, either.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.model.question import Question
from fcm.model.scene import FloatArray, Scene
from fcm.scene.contact_springs import stuck_stiffness
from fcm.scene.contact_stiffness import SHORTER, are_sought, varies
from fcm.scene.errors import several
from fcm.scene.options import MESSAGES


def constant_loads(scene: Scene) -> tuple[str, ...]:
    """Names of the contacts with a constant normal force: k_v = 0 on every curve."""
    curves, contacts = scene.each_curve(), range(len(scene.contacts))
    constant = [
        all(one.contacts[i].k_v == 0.0 and one.contacts[i].law is None for one in curves) for i in contacts
    ]
    return tuple(one.name for one, is_constant in zip(scene.contacts, constant, strict=True) if is_constant)


def question_of_constant_loads(scene: Scene) -> list[str]:
    """A question about contacts that never carry load: k_v = 0, and no preload on any curve."""
    if are_sought(scene, ".n_0", ".k_v"):
        return []
    constant, curves = set(constant_loads(scene)), scene.each_curve()
    names = [
        one.name
        for i, one in enumerate(scene.contacts)
        if one.name in constant and all(curve.contacts[i].n_0 <= 0.0 for curve in curves)
    ]
    if not names:
        return []
    contacts, touches = (
        ("contacts", "they never touch") if len(names) > 1 else ("contact", "it never touches")
    )
    return [
        Question(
            f"{contacts} {several(names)}: is k_v = 0 right? The normal force is then n_0 whatever moves, "
            f"and here none, so that {touches}. A gap closes with k_v > 0; a constant load is n_0 > 0"
        )
    ]


def questions_of_gaps(scene: Scene) -> list[str]:
    """A question about gaps far beyond the motion, if the unit of length is given.

    There is none for rings, with static loads or initial friction, or if preloads, gaps or amplitudes are
    swept, optimised or fitted.
    """
    (length, _), contacts = scene.units, scene.contacts
    gap = np.array([max(-one.n_0 / one.k_v, 0.0) if one.k_v > 0.0 else 0.0 for one in contacts])
    if not length or scene.ring is not None or scene.strained or not scene.has_range or not gap.any():
        return []
    if varies(scene, ".n_0", ".gap", ".amplitude") or varies(scene, "level"):
        return []
    most = _amplitude_bounds(scene)
    far = np.flatnonzero((gap > MESSAGES.far_gap * most) & (most > 0.0))
    if not far.size:
        return []
    first = int(far[np.argmax(gap[far] / most[far])])
    said = f'contact "{contacts[first].name}": is a gap of {gap[first]:.6g} {length} (-n_0 / k_v) right?'
    meant = f". If it is in {SHORTER[length]}, divide it by 1000" if length in SHORTER else ""
    others = f". So of {far.size - 1} more" if far.size > 1 else ""
    return [
        Question(
            f"{said} Forces move its faces by {most[first]:.2g} {length} at most, so that it never closes"
            f"{meant}{others}"
        )
    ]


def _amplitude_bounds(scene: Scene) -> FloatArray:
    """Bounds (contact,) of the amplitude along the normals, if contacts with a gap stay open."""
    modal = scene.modal
    mass_one = modal.shapes / np.sqrt(modal.mass)[:, None]
    damping = 2.0 * modal.damping * modal.frequency
    normals = np.array([one.normal for one in scene.contacts]).T
    closed = tuple(one for one in scene.contacts if one.n_0 >= 0.0)
    stiffness = [np.diag(modal.frequency**2)]
    stiffness += [stuck_stiffness(replace(scene, contacts=closed))] if closed else []
    found = np.zeros(len(scene.contacts))
    for one in stiffness:
        squares, turn = np.linalg.eigh(one)
        shapes = turn.T @ mass_one
        size = _sizes(scene, shapes, np.sqrt(np.maximum(squares, 0.0)), damping @ turn**2)
        found = np.maximum(found, size @ np.abs(shapes @ normals))
    return found


def _sizes(scene: Scene, shapes: FloatArray, omega: FloatArray, rate: FloatArray) -> FloatArray:
    """Bounds (mode,) of the modal amplitudes from all forces over the frequency range."""
    size = np.zeros(omega.size)
    for force in scene.forces:
        low, high = (force.harmonic * end for end in scene.frequency_range)
        at = np.clip(omega, low, high)
        least = np.hypot(omega**2 - at**2, rate * at)
        push = (
            np.abs(shapes @ force.direction) * abs(force.amplitude) * (high / force.harmonic) ** force.power
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            size += np.where(push > 0.0, push / least, 0.0)
    return size
