"""What is left unbalanced at the points of a response, from the modal equations written out once more.

The solver condenses the equations to the contacts. Here they are those of every mode, for the displacements
that a response reports, with the contact forces (27), (29) and (31) from the public functions of one contact:

    m_i (w_i^2 - omega^2 + 2 i zeta_i w_i omega) q_i + (contact forces on mode i) - (external forces) = 0
    m_i w_i^2 mean q_i + (mean contact forces on mode i) = 0
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.contact import fourier_coefficients, normal_coefficients
from fcm.model.scene import Contact, FloatArray, Modal, Scene
from fcm.response import Curve

ComplexArray = npt.NDArray[np.complex128]
BALANCED = 1e-9  # of the forces on a mode: less counts as balanced
CORRECTED = 1e-13  # of the displacements: to this a point of a response is corrected
TINY = float(np.finfo(np.float64).tiny)
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Unbalanced:
    """Greatest over the modes, at each point of a curve (point,), relative to the forces on the mode."""

    force: FloatArray  # what is unbalanced
    tolerance: FloatArray  # what a change of CORRECTED in displacements and forces is worth


def unbalanced(scene: Scene, curve: Curve) -> Unbalanced:
    """Unbalanced modal forces at the points of a curve, relative [-].

    The unit is, for each mode, the sum of the sizes of the external and the contact forces on it. Stiff
    contacts turn the last digits of a displacement into a force, and no residual can be without: `tolerance`.
    A displacement is the difference of forces over a stiffness, so its last digits may be theirs.

    Raises
    ------
    ValueError
        If the displacements do not determine the modes: more modes than degrees of freedom.
    """
    modal = scene.modal
    at = np.flatnonzero(np.isfinite(curve.frequency))
    x = curve.fundamental[at] * np.exp(1j * curve.phase[at])
    inverse = _inverse(modal.shapes)
    q, q_mean = x @ inverse, curve.mean[at] @ inverse
    dynamic, static = _stiffness(modal, curve.frequency[at])
    total, mean = dynamic * q, static * q_mean
    unit = np.zeros(q.shape)
    for force in scene.forces:
        growth = curve.frequency[at][:, None] ** force.power
        on_mode = growth * (modal.shapes @ force.direction * force.amplitude * np.exp(1j * force.phase))
        total, unit = total - on_mode, unit + np.abs(on_mode)
    for load in scene.loads:
        pushed = modal.shapes @ load.direction * load.force
        mean, unit = mean - pushed, unit + np.abs(pushed)
    for contact in scene.contacts:
        along, across = modal.shapes @ contact.tangential, modal.shapes @ contact.normal
        f_u, f_v, f_b, f_n = contact_forces(contact, x, curve.mean[at])
        total = total + np.outer(f_u, along) + np.outer(f_v, across)
        mean = mean + np.outer(f_b, along) + np.outer(f_n, across)
        unit += np.outer(np.abs(f_u) + np.abs(f_b), np.abs(along))
        unit += np.outer(np.abs(f_v) + np.abs(f_n), np.abs(across))
    unit = np.where(unit > 0.0, unit, 1.0)
    left = np.maximum(np.abs(total), np.abs(mean)) / unit
    moved = np.abs(q) + np.abs(q_mean) + unit / np.maximum(np.abs(dynamic), TINY)
    # the last digit of the frequency, next to a resonance that hardly anything damps
    digit = EPS * 2.0 * modal.mass * curve.frequency[at][:, None] ** 2 * np.abs(q)
    tolerance = (_last_digits(scene, moved) + digit) / unit
    return Unbalanced(left.max(axis=1, initial=0.0), tolerance.max(axis=1, initial=0.0))


def _inverse(shapes: FloatArray) -> FloatArray:
    """From displacements to modes, (dof, mode), whatever the units of the modes."""
    size = np.abs(shapes).max(axis=1, keepdims=True)
    if np.linalg.matrix_rank(shapes / size) < shapes.shape[0]:
        raise ValueError("the displacements do not determine the modes, so the residual is not known")
    inverse: FloatArray = np.linalg.pinv(shapes / size) / size.T
    return inverse


def _stiffness(modal: Modal, omega: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """Dynamic stiffness of each mode at each frequency, (point, mode), and the static one, (mode,)."""
    w, natural = omega[:, None], modal.frequency
    dynamic: ComplexArray = (natural - w) * (natural + w) + 2j * modal.damping * natural * w
    return modal.mass * dynamic, modal.mass * natural**2


def _last_digits(scene: Scene, moved: FloatArray) -> FloatArray:
    """Forces on each mode by a relative change of CORRECTED in such displacements and in the preload."""
    total = np.zeros_like(moved)
    for contact in scene.contacts:
        along, across = (np.abs(scene.modal.shapes @ d) for d in (contact.tangential, contact.normal))
        f_u, f_n = contact.k_u * (moved @ along), contact.k_v * (moved @ across) + max(contact.n_0, 0.0)
        # friction follows its spring, or the normal force if it slips
        total += np.outer(f_u + contact.mu * f_n, along) + np.outer(f_n, across)
    return CORRECTED * total


def contact_forces(
    contact: Contact, x: ComplexArray, mean: FloatArray
) -> tuple[ComplexArray, ComplexArray, FloatArray, FloatArray]:
    """Fundamental and mean of friction (27) and normal force (29), (31) for displacements (point, dof).

    In the order friction, normal force, mean friction, mean normal force less the preload at rest; x(t) is
    mean + Im(x exp(i omega t)).
    """
    u, v = x @ contact.tangential, x @ contact.normal
    a, b = np.abs(u), np.abs(v)
    load = contact.n_0 + contact.k_v * (mean @ contact.normal)
    variation = contact.k_v * b
    moves = variation > 0.0
    n_b, n_s = normal_coefficients(np.where(moves, load / np.where(moves, variation, 1.0), 0.0))
    f_v = np.where(moves, contact.k_v * n_s, 0.0) * v
    f_n = np.where(moves, variation * n_b, np.maximum(load, 0.0)) - max(contact.n_0, 0.0)
    stiff = contact.k_u * a
    slides = (stiff > 0.0) & (contact.mu > 0.0)
    ratio = np.where(slides, contact.mu, 0.0) / np.where(slides, stiff, 1.0)
    f_b, f_s, f_c = fourier_coefficients(ratio * load, ratio * variation, np.angle(v) - np.angle(u))
    return contact.k_u * u * (f_s + 1j * f_c) * slides, f_v, stiff * f_b * slides, f_n
