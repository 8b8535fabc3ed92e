"""Modes far above the range, replaced by a few that have their flexibility.

Seen from p directions (of contacts and forces), many modes of high frequency are no more than p springs with
some mass. Kept is the subspace of their static response to those directions, and of the static response to
the inertia of that (Ritz, Galerkin). These are 2 p modes whose flexibility has an error of the order
(omega / omega_high)^4 at every degree of freedom. Their damping is right one by one, but not between
them. The error is of the order 2 zeta omega / omega_high times the small share by which the flexibility
varies.

Many contacts have as many directions, and most of the flexibility between them is small beside that of the
contacts themselves. With their springs k and the static response S of the high modes to their directions,

    k^(1/2) S^T S k^(1/2) = V diag(s) V^T,

and along a combination V_i k^(1/2) of the directions the structure yields s_i of what the contacts do. As
many of the greatest are kept as the accuracy needs, and the directions of all forces.
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
    """Fewer modes for the scene, and the frequency above which they are replaced; None if it does not pay.

    The error is estimated on the structure with springs for contacts, see `_linear_error`.
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
        if len(choices) > 1:  # what is missing are combinations, at any limit
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
    """Columns of length 1; those of length 0 left out."""
    size = np.sqrt((columns * columns).sum(axis=0))
    unit: FloatArray = columns[:, size > 0.0] / size[size > 0.0]
    return unit


def _choices(scene: Scene, high: BoolArray, options: ReductionOptions) -> Iterator[FloatArray]:
    """Directions (dof, direction) to which the modes marked high may answer: all where these are few, else
    those of the forces and more and more of the combinations along which these modes yield most."""
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
    """Greatest relative change of the linear responses: contacts all open, all stuck, and in part.

    Where contacts begin to slip, the friction changes gradually from one to the next. So the springs in part
    are 0 in the first half of the contacts, grow over a quarter, and are whole in the rest.
    """
    springs = contact_stiffnesses(full)
    along = np.arange(springs.size) / springs.size
    in_part = np.clip(4.0 * along - 2.0, 0.0, 1.0)
    return max(change(full, fewer, springs * stuck) for stuck in (0.0, 1.0, in_part))
