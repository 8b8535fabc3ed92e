"""Replaces modes far above the range by a few with the same flexibility.

For p directions (of contacts and forces), many modes of high frequency act like p springs with some mass. The
replacement keeps the subspace of their static response to these directions, and of the static response to its
inertia (Ritz, Galerkin). This gives 2 p modes, whose flexibility has an error of the order
(omega / omega_high)^4 at every degree of freedom. Their damping is right for each mode, but the coupling
between them by damping is omitted. This error is of the order 2 zeta omega / omega_high times the small share
by which the flexibility varies.

Many contacts have many directions, but most of the structure's flexibility along them is small compared with
that of the contacts. With the contact springs k and the static response S of the high modes,

    k^(1/2) S^T S k^(1/2) = V diag(s) V^T,

and along the combination V_i k^(1/2) of directions the structure yields s_i times as much as the contacts.
The greatest s_i are kept, as many as the accuracy needs, and the directions of all forces.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fcm.contact.limits import BoolArray, FloatArray
from fcm.model.scene import Modal, Scene
from fcm.reduction.linear import change, contact_stiffnesses
from fcm.reduction.options import REDUCTION, ReductionOptions


def with_static_modes(
    scene: Scene, tolerance: float, highest: int = 1, options: ReductionOptions = REDUCTION
) -> tuple[Modal, float] | None:
    """Fewer modes for the scene, and the frequency above which they replace modes; None if nothing is saved.

    The error is estimated with springs for contacts, see `_linear_error`.
    """
    modal = scene.modal
    if modal.frequency.size < options.min_modes or tolerance <= 0.0 or not scene.contacts:
        return None
    count = modal.frequency.size
    for factor in options.range_factors:
        limit = factor * highest * scene.frequency_range[1]
        high = modal.frequency > limit
        if count - int(high.sum()) > options.max_remaining * count:
            return None
        choices = list(_choices(scene, high, options))
        part = options.max_remaining if len(choices) == 1 else options.max_remaining_of_many
        for directions in choices:
            fewer = condensed(modal, directions, high, options)
            if fewer.frequency.size > part * count:
                break
            if _linear_error(scene, replace(scene, modal=fewer)) < options.estimate_margin * tolerance:
                return fewer, limit
        if len(choices) > 1:  # a higher limit does not help: more combinations would be needed
            return None
    return None


def condensed(
    modal: Modal, directions: FloatArray, high: BoolArray, options: ReductionOptions = REDUCTION
) -> Modal:
    """The modes with those marked high replaced by their static response to directions (dof, direction)."""
    shapes = modal.shapes[high] / np.sqrt(modal.mass[high])[:, None]  # of modal mass 1
    w, damping = modal.frequency[high], modal.damping[high]
    # static responses, in coordinates whose sum of squares is the energy
    static = (shapes @ directions) / w[:, None]
    static = np.concatenate((_unit(static), _unit(_unit(static) / w[:, None] ** 2)), axis=1)
    left, singular, _ = np.linalg.svd(static, full_matrices=False)
    basis = left[:, singular > options.rank_tolerance * singular.max(initial=0.0)] / w[:, None]
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
    """The columns normalised to length 1, without those of length 0."""
    size = np.sqrt((columns * columns).sum(axis=0))
    unit: FloatArray = columns[:, size > 0.0] / size[size > 0.0]
    return unit


def _choices(scene: Scene, high: BoolArray, options: ReductionOptions) -> Iterator[FloatArray]:
    """Yields sets of directions (dof, direction) for the static response of the modes marked high.

    If there are few directions, this is the set of all. Otherwise each set has those of the forces, and more
    and more of the combinations of contact directions along which the modes yield most.
    """
    contacts, pushes = (np.array(d).T for d in (scene.directions_of_contacts(), scene.pushes()))
    every = contacts.shape[1] + pushes.shape[1]
    if 2 * every <= options.max_remaining * scene.modal.frequency.size - int((~high).sum()):
        yield np.concatenate((contacts, pushes), axis=1)
        return
    weighted = contacts * np.sqrt(contact_stiffnesses(scene))
    modal = scene.modal
    yields = (modal.shapes[high] @ weighted) / (np.sqrt(modal.mass) * modal.frequency)[high, None]
    order = np.linalg.eigh(yields.T @ yields)[1][:, ::-1]
    number = options.first_modes
    while number < contacts.shape[1]:
        yield np.concatenate((pushes, weighted @ order[:, :number]), axis=1)
        number = int(options.added_modes * number)


def _linear_error(full: Scene, fewer: Scene) -> float:
    """Greatest relative change of linear responses: with all contacts open, all stuck, and partly stuck.

    The partly stuck case models gradual slip from one contact to the next: springs are 0 in the first half of
    the contacts, grow over a quarter, and have their full stiffness in the rest.
    """
    springs = contact_stiffnesses(full)
    along = np.arange(springs.size) / springs.size
    in_part = np.clip(4.0 * along - 2.0, 0.0, 1.0)
    return max(change(full, fewer, springs * stuck) for stuck in (0.0, 1.0, in_part))
