"""Disturbances of contacts in a plane over a period, against the equations integrated by another method."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import fcm
from fcm.stability.following_modes import PortModes
from fcm.stability.options import STABILITY
from fcm.stability.planar_monodromy import PlanarMonodromy
from fcm.stability.planar_sequence import PlanarSequence

OMEGA, MU, K_U, K_V = 1.1, 0.5, 1.3, 0.8
NATURAL, DAMPING = np.array([1.0, 1.3, 2.4]), np.array([0.05, 0.02, 0.1])
SHAPES = np.array([[1.0, 0.2, 0.3], [-0.3, 0.9, 0.4], [0.2, -0.5, 0.8]])  # (mode, port)
AWAY = 1e-7  # [rad] from where the load vanishes

MOTIONS = {  # u_x, u_y, v of harmonics 0 to 2, and n_0
    "P": ((0.0, 2.0, 0.1), (0.0, -1.8j, 0.0), (0.0, 0.1, 0.0), 1.0),
    "EP": ((0.0, 1.0, 0.2j), (0.0, 0.5j, 0.1), (0.0, 0.3j, 0.0), 1.0),
    "EPEP": ((0.0, 1.0, 0.2j), (0.0, 0.5j, 0.1), (0.0, 0.3j, 0.0), 2.0),
    "PS": ((0.0, 3.0, 0.3), (0.0, -2.0j, 0.2j), (0.0, 1.0, 0.0), 0.3),
    "EPS": ((0.0, 4.0, 0.2), (0.0, 0.1j, 0.3), (0.0, -3.0j, 0.0), 0.4),
    "EPSP": ((0.0, 1.0, 0.2), (0.0, 0.7j, 0.3), (0.0, 1.0j, 0.3), 0.2),
}


def followed(u_x, u_y, v, n_0, far=(), **options):
    """The sequence, and the matrix of the kernel."""
    X = np.array([u_x, u_y, v], dtype=complex)
    x = np.concatenate((X[:, 0].real, X[:, 1:].T.ravel().view(float)))
    contact = np.array([[MU, K_U, K_V, n_0]])
    sequence = PlanarSequence(contact, (1, 2), replace(STABILITY.planar, **options))
    assert sequence.find_events(x)
    which = np.isin(np.arange(len(NATURAL)), far)
    monodromy = PlanarMonodromy(PortModes(SHAPES, NATURAL, DAMPING, which), sequence)
    monodromy.follow(OMEGA)
    return monodromy.matrix()


def integrated(u_x, u_y, v, n_0):
    """Eigenvalues of what becomes of disturbances, by an implicit method with small steps."""
    loop = fcm.planar_loop(u_x, u_y, v, MU, K_U, K_V, n_0)
    h, X = np.arange(3), np.array([u_x, u_y, v], dtype=complex)
    m, ratio = len(NATURAL), MU * K_V / K_U
    Y = np.eye(2 * m + 2)
    first = loop.angles[0] if loop.angles.size else 0.0
    ends = [first, *(first + np.mod(loop.angles[1:] - first, 2.0 * np.pi)), first + 2.0 * np.pi]

    def known(theta):
        """(u_x, u_y, v)' and the radius."""
        rate = (1j * h * np.exp(1j * h * theta) * X).sum(axis=1).real
        return rate, loop.slip_limit(theta) / K_U

    def slopes(theta, y, state, ends):
        q, p, (s, w_y) = (part for part in np.split(y.reshape(2 * m + 2, -1), [m, 2 * m]))
        u, n = SHAPES[:, :2].T @ q, SHAPES[:, 2] @ q
        f, change = np.zeros_like(u), np.zeros((2, q.shape[1]))
        if state == "E":
            f = K_U * (u - np.array([s, w_y]))
        elif state == "P":
            e = loop.direction(np.clip(theta, ends[0] + 1e-9, ends[1] - 1e-9))
            across = np.array([-e[1], e[0]])
            rate, r = known(theta)
            left = across @ u - s
            f = K_U * (ratio * np.outer(e, n) + np.outer(across, left))
            change[0] = max(e @ rate[:2] - ratio * rate[2], 0.0) * left / r
            change[0] -= across @ rate[:2] / r * (e @ u - ratio * n)
        push = SHAPES[:, :2] @ f + np.outer(SHAPES[:, 2], K_V * n if state != "S" else 0.0 * n)
        own = (NATURAL[:, None] / OMEGA) ** 2 * q + 2.0 * (DAMPING * NATURAL)[:, None] / OMEGA * p
        return np.concatenate((p, -own - push / OMEGA**2, change)).ravel()

    before = loop.sequence[-1]
    around = loop.sequence[1:] + loop.sequence[:1]
    for state, following, begin, end in zip(loop.sequence, around, ends[:-1], ends[1:], strict=True):
        u, n = SHAPES[:, :2].T @ Y[:m], SHAPES[:, 2] @ Y[:m]
        rate, _ = known(begin)
        w = Y[2 * m :].copy()
        e = loop.direction(begin + (AWAY if state == "P" else -AWAY)) if "P" in (state, before) else u[:, 0]
        across = np.array([-e[1], e[0]])
        if state == "P" and before != "P":
            Y[2 * m :] = across @ (w if before == "E" else u), np.zeros(w.shape[1])
        elif state == "E" and before == "P":
            Y[2 * m :] = np.outer(e, e @ u - ratio * n) + np.outer(across, w[0])
        elif state == "E" and before == "S":
            Y[2 * m :] = u - np.outer(rate[:2] / rate[2], n)
        elif state == "S":
            Y[2 * m :] = 0.0
        a = begin + (AWAY if before == "S" and state == "P" else 0.0)
        b = end - (AWAY if following == "S" and state == "P" else 0.0)
        method = "LSODA" if state == "P" and "S" in (before, following) else "DOP853"
        found = solve_ivp(
            slopes, (a, b), Y.ravel(), method, args=(state, (begin, end)), rtol=1e-8, atol=1e-10
        )
        Y = found.y[:, -1].reshape(Y.shape)
        before = state
    return loop.sequence, np.linalg.eigvals(Y)


@pytest.mark.parametrize("sequence", MOTIONS)
def test_disturbances_against_another_method(sequence):
    shown, other = integrated(*MOTIONS[sequence])
    assert shown == sequence
    values = np.linalg.eigvals(followed(*MOTIONS[sequence]))
    for value in values[np.abs(values) > 1e-3]:
        assert np.abs(other - value).min() < 2e-6


@pytest.mark.parametrize("far", [(), (2,)])
@pytest.mark.parametrize("sequence", MOTIONS)
def test_disturbances_do_not_depend_on_the_steps(sequence, far):
    """Nor where a mode follows without delay, so that displacements jump as a contact closes."""
    fine = followed(*MOTIONS[sequence], far, tolerance=1e-9)
    assert followed(*MOTIONS[sequence], far) == pytest.approx(fine, abs=2e-6)
    assert followed(*MOTIONS[sequence], far, stages=4) == pytest.approx(fine, abs=2e-5)


def test_more_disturbances_than_are_followed_are_none():
    assert np.isnan(followed(*MOTIONS["P"], max_disturbances=5)).all()
