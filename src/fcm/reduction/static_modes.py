"""Modes far above the range, replaced by a few that have their flexibility.

Seen from p directions (of contacts and forces), many modes of high frequency are no more than p springs
with some mass. Kept is the subspace of their static response to those directions, and of the static
response to the inertia of that (Ritz, Galerkin): 2 p modes whose flexibility errs by the order
(omega / omega_high)^4 at every degree of freedom. Their damping is right one by one, and not between them:
an error of the order 2 zeta omega / omega_high times the small share that the flexibility varies by.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.contact.limits import BoolArray, FloatArray
from fcm.model.scene import Modal, Scene
from fcm.reduction.linear import all_springs, linear_response, telling_frequencies
from fcm.reduction.options import REDUCTION

ABOVE = (2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0)  # times the range's end: where modes begin to be far above


def with_static_modes(scene: Scene, tolerance: float, highest: int = 1) -> tuple[Modal, float] | None:
    """Fewer modes for the scene, and the frequency above which they are replaced; None if it does not pay.

    The error is estimated on the structure with all contacts open, and with all of them stuck.
    """
    modal = scene.modal
    if modal.frequency.size < REDUCTION.fewest or tolerance <= 0.0 or not scene.contacts:
        return None
    directions = _directions(scene)
    for factor in ABOVE:
        limit = factor * highest * scene.frequency_range[1]
        fewer = condensed(modal, directions, modal.frequency > limit)
        if fewer.frequency.size > REDUCTION.pays * modal.frequency.size:
            return None
        if _linear_error(scene, replace(scene, modal=fewer)) < REDUCTION.margin * tolerance:
            return fewer, limit
    return None


def condensed(modal: Modal, directions: FloatArray, high: BoolArray) -> Modal:
    """The modes with those marked high replaced by their static response to directions (dof, direction)."""
    shapes = modal.shapes[high] / np.sqrt(modal.mass[high])[:, None]  # of modal mass 1
    w, damping = modal.frequency[high], modal.damping[high]
    # static responses, in coordinates whose sum of squares is the energy
    static = (shapes @ directions) / w[:, None]
    static = np.concatenate((_unit(static), _unit(_unit(static) / w[:, None] ** 2)), axis=1)
    left, singular, _ = np.linalg.svd(static, full_matrices=False)
    basis = left[:, singular > REDUCTION.independent * singular.max(initial=0.0)] / w[:, None]
    # in this basis the stiffness is 1: the eigenvalues of the mass are 1 / frequency^2
    value, vector = np.linalg.eigh(basis.T @ basis)
    frequency = 1.0 / np.sqrt(value)
    ritz = (basis @ vector) * frequency
    new_damping = (ritz**2 * (damping * w)[:, None]).sum(axis=0) / frequency
    low = ~high
    return Modal(
        dofs=modal.dofs,
        mass=np.concatenate((modal.mass[low], np.ones(frequency.size))),
        frequency=np.concatenate((modal.frequency[low], frequency)),
        damping=np.concatenate((modal.damping[low], new_damping)),
        shapes=np.concatenate((modal.shapes[low], ritz.T @ shapes)),
    )


def _unit(columns: FloatArray) -> FloatArray:
    """Columns of length 1; those of length 0 left out."""
    size = np.sqrt((columns * columns).sum(axis=0))
    unit: FloatArray = columns[:, size > 0.0] / size[size > 0.0]
    return unit


def _directions(scene: Scene) -> FloatArray:
    """Directions of all contacts, forces and loads as columns, (dof, direction)."""
    return np.array(scene.directions()).T


def _linear_error(full: Scene, fewer: Scene) -> float:
    """Greatest relative difference of the two linear responses, contacts all open and all stuck."""
    worst = 0.0
    for stuck in (0.0, 1.0):
        springs = stuck * all_springs(full)
        omega = telling_frequencies(fewer, springs)
        one, other = (linear_response(scene, omega, springs) for scene in (full, fewer))
        size = np.abs(one).max(axis=1)
        difference = np.abs(one - other).max(axis=1)
        worst = max(worst, float((difference / np.where(size > 0.0, size, 1.0)).max()))
    return worst
