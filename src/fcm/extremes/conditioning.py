"""How far the equations of the path follower are from singular, along a curve."""

from __future__ import annotations

import numpy as np

from fcm.response import Curve
from fcm.response.balance import Balance
from fcm.response.law import UNKNOWNS, ClosedForm
from fcm.response.newton import amplitudes, scales
from fcm.response.structure import group_of, with_contact
from fcm.scene.model import FloatArray, Scene


def condition_number(scene: Scene, curve: Curve) -> float:
    """Greatest condition number of the Jacobian along a curve [-]; NaN if it has no points.

    By the unknowns and the frequency together, n by n + 1, so that a fold, where the square Jacobian is
    singular, is nothing special; in the coordinates of the path follower, dimensionless by the curve's size.
    """
    scene = with_contact(scene)
    at = np.flatnonzero(np.isfinite(curve.frequency))
    if at.size == 0:
        return float("nan")
    x, omega = _unknowns(scene, curve, at), curve.frequency[at]
    balance = Balance(group_of([scene]), ClosedForm())
    here = balance.evaluate(x, omega)
    low, high = scene.frequency_range
    scale = scales(x, amplitudes(x), np.full(at.size, high - low))
    matrix = np.concatenate((here.jacobian, here.by_omega[:, :, None]), axis=2)
    matrix *= scale[:, None, :] / scale[:, :-1, None]
    values = np.linalg.svd(matrix, compute_uv=False)
    return float((values[:, 0] / np.maximum(values[:, -1], np.finfo(np.float64).tiny)).max())


def _unknowns(scene: Scene, curve: Curve, at: np.ndarray) -> FloatArray:
    """Unknowns of the contacts from the displacements, (point, 5 contacts)."""
    displacement = curve.amplitude[at] * np.exp(1j * curve.phase[at])
    x = np.empty((at.size, len(scene.contacts), UNKNOWNS))
    for i, contact in enumerate(scene.contacts):
        u, v = displacement @ contact.tangential, displacement @ contact.normal
        x[:, i] = np.column_stack((u.real, u.imag, v.real, v.imag, curve.mean[at] @ contact.normal))
    return x.reshape(at.size, -1)
