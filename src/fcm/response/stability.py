"""Stability of every point: Hill's method on the balanced equations, the mean included.

A small disturbance of a solution, delta(t) = d_mean(t) + Im(d(t) exp(i omega t)) in modal coordinates, obeys
the modal equations with the contact forces replaced by their tangent. With amplitudes that grow as
exp(lambda t) this is an eigenvalue problem of first order in (d, d'). A real exponent is zero exactly where
the Jacobian of the balance is singular, so stability changes at the folds, and elsewhere where a pair
of exponents crosses the imaginary axis.

Exponents are defined up to multiples of i omega, and of each family Hill's method gives several copies.
Only the slow one counts, |Im lambda| <= omega / 2: a friction force is that of a steady cycle, and its
tangent holds for amplitudes that change slowly against it. A slow drift, though, is resisted by the
contacts in proportion to its velocity; without this, structures free to drift would be called unstable.
"""

from __future__ import annotations

import numpy as np

from fcm.contact.drag import drift_resistance
from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.law import UNKNOWNS, Law
from fcm.response.slow import dense, following, some_modes, with_followers
from fcm.response.springs import among_contacts
from fcm.response.structure import BoolArray, Group

GROWTH = 1e-9  # a growth rate counts as positive above this fraction of the frequency
ZONE = 0.5  # of the frequency: half the distance between copies of an exponent
BLOCK = 4_000_000  # elements of the matrices that are held at a time


def stable_points(balance: Balance, z: FloatArray, linear: BoolArray) -> BoolArray:
    """Whether small disturbances of each point do not grow; z (point, unknown + 1).

    Where the response is linear (point,), every contact stuck or open, the structure is passive and needs
    no calculation.
    """
    stable = linear.copy()
    some = np.flatnonzero(~linear)
    stable[some] = _by_exponents(balance.take(some), z[some])
    return stable


def _by_exponents(balance: Balance, z: FloatArray) -> BoolArray:
    size = 6 * int((~following(balance.group, z[:, -1])).sum())
    step = max(BLOCK // size**2, 1)
    parts = [np.arange(first, min(first + step, z.shape[0])) for first in range(0, z.shape[0], step)]
    stable = [growth_rates(balance.take(part), z[part]) <= GROWTH * z[part, -1] for part in parts]
    return np.concatenate(stable) if stable else np.empty(0, dtype=bool)


def growth_rates(balance: Balance, z: FloatArray) -> FloatArray:
    """Greatest real part of the exponents at each point, (point,) [1/s in the scene's units]."""
    omega, points = z[:, -1], z.shape[0]
    _, each = balance.law.forces(z[:, :-1].reshape(points, balance.group.contacts, UNKNOWNS))
    group, each = among_contacts(balance.group, each)
    tangent, far = dense(each), following(group, omega)
    if far.any():
        tangent, group = with_followers(group, far, omega, tangent), some_modes(group, ~far)
    modes = group.frequency.shape[1]
    stiffness = _modal_tangent(group, tangent).reshape(points, modes, 3, modes, 3)
    damping = np.zeros((points, modes, 3, modes, 3))
    i = np.arange(modes)
    rate = 2.0 * group.damping * group.frequency  # 2 zeta w_i
    for part in range(3):
        damping[:, i, part, i, part] = rate
        stiffness[:, i, part, i, part] += group.frequency**2 - (omega[:, None] ** 2 if part < 2 else 0.0)
    damping[:, :, 2, :, 2] += _drag(group, balance.law, z)
    _let_drift(group, stiffness, damping, omega)
    # d/dt of Im(d exp(i omega t)) is Im((d' + i omega d) exp(i omega t)); i turns (Re, Im) by a right angle
    for row, column, sign in ((0, 1, -1.0), (1, 0, 1.0)):
        damping[:, i, row, i, column] = 2.0 * sign * omega[:, None]
        stiffness[:, i, row, i, column] += sign * rate * omega[:, None]
    size = 3 * modes
    matrix = np.zeros((points, 2 * size, 2 * size))
    # time in units of 1/omega, so that the matrix is as well scaled as the problem allows
    w = omega[:, None, None]
    matrix[:, :size, size:] = np.eye(size)
    matrix[:, size:, :size] = -stiffness.reshape(points, size, size) / w**2
    matrix[:, size:, size:] = -damping.reshape(points, size, size) / w
    exponents = np.linalg.eigvals(matrix)
    slow = np.abs(exponents.imag) <= ZONE
    growth: FloatArray = np.where(slow, exponents.real, -np.inf).max(axis=1) * omega
    return growth


def _drag(group: Group, law: Law, z: FloatArray) -> FloatArray:
    """Resistance of the contacts to mean velocities, by modes over the modal mass, (point, mode, mode).

    Each contact of the law answers with k_u / omega times its `drift_resistance`.
    """
    contacts = law.k_u.shape[1]
    arguments = law.arguments(z[:, :-1].reshape(z.shape[0], contacts, UNKNOWNS))
    each = drift_resistance(*(part.ravel() for part in np.broadcast_arrays(*arguments)))
    drag = each.reshape(z.shape[0], contacts) * law.k_u / z[:, -1:]
    tangential = group.ports[:, :, 0 : 2 * contacts : 2]
    resistance: FloatArray = (tangential * drag[:, None, :]) @ tangential.swapaxes(1, 2)
    return resistance / group.mass[:, :, None]


def _let_drift(group: Group, stiffness: FloatArray, damping: FloatArray, omega: FloatArray) -> None:
    """Nothing depends on the mean of a mode adrift: it is given exponents that decay, and no effect."""
    if not group.adrift.any():
        return
    stiffness[..., 2] = np.where(group.adrift[:, None, None, :], 0.0, stiffness[..., 2])
    i = np.arange(group.adrift.shape[1])
    stiffness[:, i, 2, i, 2] += np.where(group.adrift, omega[:, None] ** 2, 0.0)
    damping[:, i, 2, i, 2] += np.where(group.adrift, omega[:, None], 0.0)


def _modal_tangent(group: Group, tangent: FloatArray) -> FloatArray:
    """Tangent of the contact forces in modal coordinates over the modal mass, (point, 3 modes, 3 modes).

    The three parts of a mode are the real and the imaginary part of its amplitude and its mean.
    """
    modes, contacts = group.ports.shape[1], group.contacts
    ports = group.ports.reshape(-1, modes, contacts, 2)
    outward = _parts(ports, (0, 2), (1, 3), 4, 6) / group.mass[:, :, None, None, None]
    inward = _parts(ports, (0, 2), (1, 3), 4, 5)  # (curve, mode, 3, contact, 5)
    left = outward.reshape(-1, 3 * modes, 6 * contacts)
    right = inward.reshape(-1, 3 * modes, 5 * contacts)
    total: FloatArray = left @ tangent @ right.swapaxes(1, 2)
    return total


def _parts(
    ports: FloatArray, real: tuple[int, int], imaginary: tuple[int, int], mean: int, width: int
) -> FloatArray:
    """Modes on the unknowns (width 5) or forces (width 6) of each contact: real, imaginary and mean part."""
    out = np.zeros((*ports.shape[:2], 3, ports.shape[2], width))
    for direction in range(2):
        out[:, :, 0, :, real[direction]] = ports[..., direction]
        out[:, :, 1, :, imaginary[direction]] = ports[..., direction]
        if width == 6 or direction == 1:  # the mean of u is no unknown: no force depends on it
            out[:, :, 2, :, mean + direction if width == 6 else mean] = ports[..., direction]
    return out
