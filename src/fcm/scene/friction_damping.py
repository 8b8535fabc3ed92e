r"""Estimate of the damping that friction can add to each resonance, with one harmonic and closed contacts.

A Jenkins element in harmonic motion of amplitude X is a stiffness and a damping force in phase with the
velocity, with cos(theta) = 1 - 2 mu n_0 / (k_u X):

.. math:: k_r = k_u \frac{\theta - \sin\theta\cos\theta}{\pi}, \qquad k_i = k_u \frac{\sin^2\theta}{\pi}.

Let phi be a mode of mass 1 and frequency omega of the structure with contact stiffnesses k_v and k_r. Its
damping ratio from friction is

.. math:: \zeta = \frac{1}{2 \omega^2} \sum_c k_i (\phi^T t_c)^2.

The estimate is the maximum over theta, which is the same for all contacts. For one degree of freedom it is
the greatest damping ratio of the nonlinear mode (Krack 2015) with one harmonic.

With this ratio and its own ratio zeta_0, the mode in resonance with the forces f and the contacts move by

.. math:: q = \frac{|\phi^T f|}{2 (\zeta + \zeta_0) \omega^2}, \qquad X_c = |\phi^T t_c|\, q,

and the preload that gives theta at a contact is n_0 = k_u X_c (1 - cos(theta)) / (2 mu). Along its normal n_c
the contact moves by |phi^T n_c| q. If k_v times this exceeds the preload, the contact would open, and the
estimate does not hold.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fcm.model.scene import FloatArray, Scene
from fcm.scene.contact_springs import along_contacts, closed_stiffness, sticking_stiffness
from fcm.scene.open_modes import stuck_modes
from fcm.scene.options import FRICTION_DAMPING, TOLERANCES
from fcm.units import UNIT


def friction_damping(scene: Scene) -> list[dict[str, Any]]:
    """The first elastic modes with all contacts stuck, and how much friction can damp each.

    `stuck` is the mode's frequency. `open_mode` is the number, from 1, of the mode without contacts whose
    shape is most alike, `open` its frequency and `mac` the modal assurance criterion. Each mode is followed
    by its shape as the contacts slip.

    `friction_damping` is the greatest ratio [-] that friction adds, and `by_contact` the share of each
    contact. `preload` gives the preload of each contact for this damping under the scene's forces. If these
    do not excite the mode, it is 0 and `excited` is false. `opens` lists the contacts that would open then.
    The result is empty without contacts.

    Examples
    --------
    >>> import fcm
    >>> one = friction_damping(fcm.load_scene("yang1998-n5"))[0]
    >>> round(one["open"], 4), round(one["stuck"], 4), round(one["friction_damping"], 3)
    (1.0, 1.4137, 0.046)
    """
    if not scene.contacts:
        return []
    import scipy.linalg  # which most runs do without
    from scipy.optimize import linear_sum_assignment

    modal, contacts = scene.modal, scene.contacts
    along, held, added = (
        along_contacts(scene, normal=False),
        closed_stiffness(scene),
        sticking_stiffness(scene),
    )
    owner = np.repeat(np.arange(len(contacts)), [len(one.directions) - 1 for one in contacts])
    mu, k_u, k_v = (np.array([getattr(one, name) for one in contacts]) for name in ("mu", "k_u", "k_v"))
    across = along_contacts(scene, normal=True)
    lossy = np.where(mu > 0.0, k_u, 0.0)[owner]
    per_force = np.divide(k_u, 2.0 * mu, out=np.zeros_like(mu), where=mu > 0.0)
    modes = stuck_modes(scene)
    followed = np.array([one.shape for one in modes]).T  # at the last theta
    most = min(2 * modes[-1].number + 2, modal.frequency.size) if modes else 0

    best, excited = np.zeros(len(modes)), np.zeros(len(modes), dtype=np.bool_)
    # for each mode and contact, at the mode's best theta
    ratio, preload, load = np.zeros((3, len(modes), len(contacts)))
    angles = np.geomspace(FRICTION_DAMPING.least_angle, np.pi, FRICTION_DAMPING.angles, endpoint=False)
    for theta in angles[::-1] if modes else ():
        k_r, k_i = (theta - np.sin(theta) * np.cos(theta)) / np.pi, np.sin(theta) ** 2 / np.pi
        squares, shapes = scipy.linalg.eigh(held + k_r * added, subset_by_index=[0, most - 1])
        same = linear_sum_assignment((followed.T @ shapes) ** 2, maximize=True)[1]
        followed = shapes[:, same]
        motion = np.abs(along.T @ followed)
        motion[motion <= TOLERANCES.displacement * motion.max(initial=0.0)] = 0.0
        for mode, square in enumerate(squares[same].tolist()):
            if square <= 0.0:
                continue
            shape, moved = followed[:, mode], motion[:, mode] ** 2
            loss = k_i * lossy * moved / (2.0 * square)
            if loss.sum() > best[mode]:
                best[mode] = loss.sum()
                ratio[mode] = np.bincount(owner, loss, len(contacts))
                omega = float(np.sqrt(square))
                own = float((modal.damping * modal.frequency) @ shape**2) / omega
                push = abs(_force_on(scene, shape / np.sqrt(modal.mass), omega))
                excited[mode] = push > 0.0
                size = push / (2.0 * (best[mode] + own) * square)
                amplitude = size * np.sqrt(np.bincount(owner, moved, len(contacts)))
                preload[mode] = per_force * amplitude * (1.0 - np.cos(theta))
                load[mode] = k_v * np.abs(across.T @ shape) * size
    unit = UNIT[scene.frequency_unit]
    return [
        {
            "open": float(modal.frequency[one.open_mode] / unit),
            "open_mode": one.open_mode + 1,
            "mac": one.mac,
            "stuck": one.frequency / unit,
            "friction_damping": float(best[mode]),
            "excited": bool(excited[mode]),
            "by_contact": {
                contact.name: float(part / best[mode]) if best[mode] else 0.0
                for contact, part in zip(contacts, ratio[mode], strict=True)
            },
            "preload": {
                contact.name: float(force) for contact, force in zip(contacts, preload[mode], strict=True)
            },
            "opens": [
                contact.name
                for contact, held, moved in zip(contacts, preload[mode], load[mode], strict=True)
                if moved > held > 0.0
            ],
        }
        for mode, one in enumerate(modes)
    ]


def _force_on(scene: Scene, shape: FloatArray, omega: float) -> complex:
    """The complex amplitude of the forces of harmonic 1 on a combination shape (mode,) of the modes.

    0 if it is rounding, which grows with the ratio of the greatest stiffness to that of the shape.
    """
    moved = shape @ scene.modal.shapes
    total, size = 0.0j, 0.0
    for one in scene.forces:
        if one.harmonic == 1:
            amplitude = one.amplitude * omega**one.power
            total += amplitude * float(one.direction @ moved) * complex(np.exp(1j * one.phase))
            size += abs(amplitude) * float(np.abs(one.direction).sum()) * float(np.abs(moved).max())
    stiffer = max(float(scene.modal.frequency.max()) / omega, 1.0) ** 2
    return total if abs(total) > TOLERANCES.shape * stiffer * size else 0.0j
