"""What was left out of a calculation put back into its results, and its effect on them measured."""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.displacement import displacements
from fcm.response.foreseen import States, room
from fcm.response.law import UNKNOWNS, ClosedForm, Law
from fcm.response.leave_out import Lighter
from fcm.response.newton import amplitudes, correct, scales
from fcm.response.points import extent
from fcm.response.regimes import regimes
from fcm.response.result import Curve, Response
from fcm.response.segment import correct_exactly
from fcm.response.structure import IntArray, group_of
from fcm.scene.model import Scene

MOST_CHECKED = 200  # points at which the response is compared with that of all modes
EACH_CHECKED = 8  # points of one curve, besides its peaks


def restored(response: Response, lighter: Lighter) -> Response:
    """The response with all contacts in it."""
    full = lighter.full
    if len(lighter.contacts) < len(full[0].contacts):
        response.contacts = tuple(c.name for c in full[0].contacts)
        for curve, scene in zip(response.curves, full, strict=True):
            _put_back(curve, scene, list(lighter.contacts))
    return response


def least_room(curve: Curve, scene: Scene, states: States) -> dict[int, float]:
    """Of contacts foreseen to be stuck or open, how far they are from not being so, at the least."""
    at = np.flatnonzero(np.isfinite(curve.frequency))
    x = _unknowns(curve, scene, at)
    u, v, v_mean = x[..., 0] + 1j * x[..., 1], x[..., 2] + 1j * x[..., 3], x[..., 4]
    each = {i: room(scene.contacts[i], state, u[:, i], v[:, i], v_mean[:, i]) for i, state in states.items()}
    return {i: float(spare.min(initial=np.inf)) for i, spare in each.items()}


def checked(response: Response, lighter: Lighter) -> float:
    """Shift of the response, relative, when points of the curves are corrected with all modes."""
    per_curve = max(min(EACH_CHECKED, MOST_CHECKED // len(response.curves)), 1)
    shifts = []
    for number in _spread(len(response.curves), MOST_CHECKED):
        curve, scene = response.curves[number], lighter.exact[number]
        at = _sample(curve, per_curve)
        if at.size and scene.contacts:
            shifts.append(_shift(curve, scene, at))
    return max(shifts, default=0.0)


def _put_back(curve: Curve, scene: Scene, traced: list[int]) -> None:
    """Give a curve the loops and regimes of the contacts that were not traced."""
    if curve.points == 0:
        traced, curve.loop, curve.regime = [], curve.loop[:, :0], curve.regime[:, :0]
    at = np.flatnonzero(np.isfinite(curve.frequency))
    group = group_of([scene])
    law = Law(group.mu, group.k_u, group.k_v, group.n_0, ClosedForm())
    loop = np.full((curve.frequency.size, len(scene.contacts), curve.loop.shape[-1]), np.nan)
    regime = np.full(loop.shape[:2], "", dtype=curve.regime.dtype)
    x = _unknowns(curve, scene, at)
    loop[at], regime[at] = law.loops(x), regimes(law, x)
    loop[:, traced], regime[:, traced] = curve.loop, curve.regime
    curve.loop, curve.regime = loop, regime


def _unknowns(curve: Curve, scene: Scene, at: IntArray) -> FloatArray:
    """Unknowns of all contacts at points of a curve, from its displacements, (point, contact, 5)."""
    X = curve.amplitude[at] * np.exp(1j * curve.phase[at])
    x = np.empty((at.size, len(scene.contacts), UNKNOWNS))
    for i, contact in enumerate(scene.contacts):
        u, v = X @ contact.tangential, X @ contact.normal
        x[:, i, :4] = np.column_stack((u.real, u.imag, v.real, v.imag))
        x[:, i, 4] = curve.mean[at] @ contact.normal
    return x


def _sample(curve: Curve, count: int) -> IntArray:
    """Points of a curve: those of the greatest amplitudes, and others spread evenly."""
    there = np.flatnonzero(np.isfinite(curve.frequency))
    if there.size == 0:
        return there
    highest = there[curve.amplitude[there].argmax(axis=0)]
    highest = highest[_spread(highest.size, count)]
    return np.union1d(highest, there[_spread(there.size, count)]).astype(np.intp)


def _spread(count: int, most: int) -> IntArray:
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(np.intp))


def _shift(curve: Curve, scene: Scene, at: IntArray) -> float:
    """Greatest relative shift of points by a correction with all modes, along the normal of the curve."""
    balance = Balance(group_of([scene]), ClosedForm())
    x = _unknowns(curve, scene, at).reshape(at.size, -1)
    z = np.column_stack((x, curve.frequency[at]))
    scale = scales(x, amplitudes(x), extent(balance, np.zeros(at.size, dtype=np.intp)))
    row = np.zeros_like(z)
    row[:, -1] = 1.0
    row = correct(balance, z, scale, row, iterations=1).tangent  # the tangent, to first order
    usable = np.isfinite(row).all(axis=1)  # not so in a fold itself
    row[~usable] = np.eye(z.shape[1])[-1]
    new = correct_exactly(balance, z, scale, row)
    X, _ = displacements(balance, new.z[:, :-1], new.z[:, -1])
    before = curve.amplitude[at] * np.exp(1j * curve.phase[at])
    # what the correction moved along the frequency counts as well, relative to the range
    moved = np.abs(new.z - z)[:, -1] / scale[:, -1]
    shift = np.abs(X - before).max(axis=1) / np.abs(X).max(axis=1) + moved
    return float(np.where(new.converged, shift, np.inf)[usable].max(initial=0.0))
