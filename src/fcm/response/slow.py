"""Modes that follow a slow disturbance without delay, taken out of the stability of a point.

The exponents that decide are slow, |Im lambda| <= omega / 2. A mode far above the excitation answers a
contact force that changes so slowly as it answers a steady one, with its compliance at omega: exactly where
an exponent is zero, at the folds, and with an error of the order (omega / w_i)^2 of that mode's flexibility
where a pair of exponents crosses. So hundreds of modes cost no more than the few near the excitation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.contact.limits import BoolArray, FloatArray
from fcm.response.balance import Balance
from fcm.response.law import ClosedForm
from fcm.response.structure import Group, modal_compliance, receptance

FAR = 6.0  # times the excitation: modes above follow without delay
MANY = 24  # modes; fewer are all kept


def following(group: Group, omega: FloatArray) -> BoolArray:
    """Which modes follow without delay at all of the frequencies omega (point,)."""
    if group.frequency.shape[1] <= MANY or omega.size == 0:
        return np.zeros(group.frequency.shape[1], dtype=bool)
    far: BoolArray = np.logical_and.reduce(group.frequency > FAR * omega[:, None], axis=0)
    far[group.frequency.min(axis=0).argmin()] = False  # at least one that does not
    return far


def some_modes(group: Group, which: BoolArray) -> Group:
    """The structure with some of its modes."""
    names = ("mass", "frequency", "damping", "shapes", "ports", "force", "adrift", "springs")
    return replace(group, **{name: getattr(group, name)[:, which] for name in names})


def with_followers(group: Group, far: BoolArray, omega: FloatArray, tangent: FloatArray) -> FloatArray:
    """Tangent of the contact forces (point, 6 contacts, 5 contacts) by the motion of the others alone."""
    fast = Balance(some_modes(group, far), ClosedForm())
    compliance, _ = modal_compliance(fast.group, omega)
    flexibility = fast.real_matrix(receptance(fast.group, compliance))
    size = tangent.shape[1]
    softened = np.linalg.solve(np.eye(size) + tangent @ flexibility, tangent)
    return np.asarray(softened, dtype=np.float64)


def dense(tangent: FloatArray) -> FloatArray:
    """Tangents of each contact (point, contact, 6, 5) as one matrix, (point, 6 contacts, 5 contacts)."""
    points, contacts, forces, unknowns = tangent.shape
    out = np.zeros((points, contacts, forces, contacts, unknowns))
    i = np.arange(contacts)
    out[:, i, :, i, :] = tangent.swapaxes(0, 1)
    return out.reshape(points, contacts * forces, contacts * unknowns)
