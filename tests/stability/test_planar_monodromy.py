"""Disturbances of contacts in a plane over a period, against the equations integrated by another method."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import fcm
from fcm.stability.options import STABILITY
from fcm.stability.planar_monodromy import PlanarMonodromy, PlanarSequence
from fcm.stability.quasi_static_modes import PortModes

OMEGA = 1.1
AWAY = 1e-7  # [rad] from where the load vanishes
NATURAL, DAMPING = np.array([1.0, 1.3, 2.4]), np.array([0.05, 0.02, 0.1])
SHAPES = np.array([[1.0, 0.2, 0.3], [-0.3, 0.9, 0.4], [0.2, -0.5, 0.8]])  # (mode, port)

# u_x, u_y, v of harmonics 0 to 2; and mu, k_u, k_v, n_0
LAW = 0.5, 1.3, 0.8
SLIPS = ((0.0, 2.0, 0.1), (0.0, -1.8j, 0.0), (0.0, 0.1, 0.0)), (*LAW, 1.0)
CATCHES_ONCE = ((0.0, 1.0, 0.2j), (0.0, 0.5j, 0.1), (0.0, 0.3j, 0.0)), (*LAW, 1.0)
CATCHES = ((0.0, 1.0, 0.2j), (0.0, 0.5j, 0.1), (0.0, 0.3j, 0.0)), (*LAW, 2.0)
OPENS = ((0.0, 3.0, 0.3), (0.0, -2.0j, 0.2j), (0.0, 1.0, 0.0)), (*LAW, 0.3)
OPENS_AND_CATCHES = ((0.0, 4.0, 0.2), (0.0, 0.1j, 0.3), (0.0, -3.0j, 0.0)), (*LAW, 0.4)
SLIPS_TWICE = ((0.0, 1.0, 0.2), (0.0, 0.7j, 0.3), (0.0, 1.0j, 0.3)), (*LAW, 0.2)
SLIDES_FREELY = ((0.0, 1.0, 0.1), (0.0, 0.5j, 0.0), (0.0, 2.0, 0.1)), (0.0, 1.3, 0.8, 0.5)
STICKS = ((0.0, 0.1, 0.0), (0.0, 0.1j, 0.0), (0.0, 0.1, 0.0)), (*LAW, 3.0)
STAYS_OPEN = ((0.0, 1.0, 0.0), (0.0, 1.0j, 0.0), (-9.0, 0.1, 0.0)), (*LAW, 3.0)
MOTIONS = {
    "P": SLIPS,
    "EP": CATCHES_ONCE,
    "EPEP": CATCHES,
    "PS": OPENS,
    "EPS": OPENS_AND_CATCHES,
    "EPSP": SLIPS_TWICE,
}
ALL = SLIPS, STICKS, CATCHES, OPENS, STAYS_OPEN, SLIDES_FREELY


def unknowns(some):
    """Of the motions (contact * coefficient,), and the numbers of the contacts."""
    X = [np.array(waves, dtype=complex) for waves, _ in some]
    blocks = [np.concatenate((one[:, 0].real, one[:, 1:].T.ravel().view(float))) for one in X]
    return np.concatenate(blocks), np.array([numbers for _, numbers in some])


def structure(contacts, modes, seed=3):
    shapes = np.random.default_rng(seed).uniform(-0.5, 0.5, (modes, 3 * contacts))
    return shapes, np.linspace(0.8, 4.0, modes), np.linspace(0.02, 0.1, modes)


def followed(some, far=(), modes=(SHAPES, NATURAL, DAMPING), poll=int, **options):
    """The kernel after a period of the motions of some contacts."""
    x, contact = unknowns(some)
    sequence = PlanarSequence(contact, (1, 2), replace(STABILITY.planar, **options))
    assert sequence.find_events(x)
    which = np.isin(np.arange(len(modes[1])), far)
    monodromy = PlanarMonodromy(PortModes(*modes, which), sequence, poll)
    monodromy.follow(OMEGA)
    return monodromy


class Slider:
    """A contact in its given motion, and what disturbances (column) of it do: s, or dw, is its memory."""

    def __init__(self, waves, numbers):
        (self.mu, self.k_u, self.k_v), self.X = numbers[:3], np.array(waves, dtype=complex)
        self.loop = fcm.planar_loop(*waves, *numbers)
        self.ratio, self.sequence = self.mu * self.k_v / self.k_u, self.loop.sequence
        self.angles = np.mod(self.loop.angles, 2.0 * np.pi) if len(self.sequence) > 1 else np.zeros(0)

    def at(self, theta):
        """Its state; and the angles between which it has that."""
        if not self.angles.size:
            return self.sequence, (-np.inf, np.inf)
        i = int(np.mod(theta - self.angles, 2.0 * np.pi).argmin())
        begin = theta - np.mod(theta - self.angles[i], 2.0 * np.pi)
        return self.sequence[i], (
            begin,
            begin + np.mod(self.angles[(i + 1) % self.angles.size] - begin, 2.0 * np.pi),
        )

    def rate(self, theta):
        h = np.arange(self.X.shape[1])
        return (1j * h * np.exp(1j * h * theta) * self.X).sum(axis=1).real

    def slip(self, theta, ends):
        e = self.loop.direction(np.clip(theta, ends[0] + 1e-9, ends[1] - 1e-9))
        return e, np.array([-e[1], e[0]])

    def forces(self, theta, d, memory, state, ends):
        """(3, column), and the rates of the memory (2, column)."""
        u, v, change = d[:2], d[2], np.zeros_like(memory)
        if state == "S":
            return np.zeros_like(d), change
        if state == "E" or self.mu == 0.0:
            f = self.k_u * (u - memory) if state == "E" else np.zeros_like(u)
            return np.concatenate((f, self.k_v * v[None])), change
        e, aside = self.slip(theta, ends)
        rate, r, left = self.rate(theta), self.loop.slip_limit(theta) / self.k_u, aside @ u - memory[0]
        change[0] = max(e @ rate[:2] - self.ratio * rate[2], 0.0) * left / r
        change[0] -= aside @ rate[:2] / r * (e @ u - self.ratio * v)
        f = self.k_u * (self.ratio * np.outer(e, v) + np.outer(aside, left))
        return np.concatenate((f, self.k_v * v[None])), change

    def after_event(self, theta, d, memory, before, state):
        """The memory as a state begins."""
        if state == "S" or self.mu == 0.0:
            return np.zeros_like(memory)
        if before == "S" and state == "E":
            rate = self.rate(theta)
            return d[:2] - np.outer(rate[:2] / rate[2], d[2])
        e = self.loop.direction(theta + (AWAY if state == "P" else -AWAY))
        aside = np.array([-e[1], e[0]])
        if state == "P":
            return np.stack((aside @ (memory if before == "E" else d[:2]), np.zeros(d.shape[1])))
        return np.outer(e, e @ d[:2] - self.ratio * d[2]) + np.outer(aside, memory[0])


def integrated(some, modes=(SHAPES, NATURAL, DAMPING)):
    """Eigenvalues of what becomes of disturbances, by another method with small steps."""
    shapes, natural, damping = modes
    m, sliders = len(natural), [Slider(*one) for one in some]
    size = 2 * m + 2 * len(sliders)
    Y = np.eye(size)
    events = np.sort(np.concatenate([one.angles for one in sliders]))
    first = events[0] if events.size else 0.0
    ends = np.append(events, first + 2.0 * np.pi) if events.size else np.array([0.0, 2.0 * np.pi])

    def slopes(theta, y, states):
        q, p, memory = (part for part in np.split(y.reshape(size, -1), [m, 2 * m]))
        d, w = (shapes.T @ q).reshape(len(sliders), 3, -1), memory.reshape(len(sliders), 2, -1)
        found = [one.forces(theta, d[k], w[k], *states[k]) for k, one in enumerate(sliders)]
        push = shapes @ np.concatenate([force for force, _ in found])
        own = (natural[:, None] / OMEGA) ** 2 * q + 2.0 * (damping * natural)[:, None] / OMEGA * p
        change = np.concatenate([change for _, change in found])
        return np.concatenate((p, -own - push / OMEGA**2, change)).ravel()

    for begin, end in pairwise(ends):
        d, middle = (shapes.T @ Y[:m]).reshape(len(sliders), 3, -1), 0.5 * (begin + end)
        a, b, hard = begin, end, False
        states = [one.at(middle) for one in sliders]
        for k, one in enumerate(sliders):
            (state, own), rows = states[k], slice(2 * m + 2 * k, 2 * m + 2 * k + 2)
            before, following = (
                (one.at(at)[0] for at in (own[0] - 1e-6, own[1] + 1e-6)) if one.angles.size else "--"
            )
            begins, stops = abs(own[0] - begin) < 1e-9, abs(own[1] - end) < 1e-9
            if begins:
                Y[rows] = one.after_event(begin, d[k], Y[rows], before, state)
            a += AWAY * (begins and before == "S" and state == "P")
            b -= AWAY * (stops and following == "S" and state == "P")
            hard |= state == "P" and one.mu > 0.0 and "S" in (before, following)
        columns = Y.T if hard else [Y.ravel()]  # a stiff one alone, as its Jacobian is smaller then
        method, args = "LSODA" if hard else "DOP853", (states,)
        found = [
            solve_ivp(slopes, (a, b), y, method, args=args, rtol=1e-8, atol=1e-10).y[:, -1] for y in columns
        ]
        Y = np.array(found).T if hard else found[0].reshape(size, size)
    return np.linalg.eigvals(Y)


@pytest.mark.slow
@pytest.mark.parametrize("sequence", MOTIONS)
def test_disturbances_against_another_method(sequence):
    (some,) = (MOTIONS[sequence],)
    assert fcm.planar_loop(*some[0], *some[1]).sequence == sequence
    values, other = np.linalg.eigvals(followed([some]).matrix()), integrated([some])
    for value in values[np.abs(values) > 1e-3]:
        assert np.abs(other - value).min() < 2e-6


@pytest.mark.slow
@pytest.mark.parametrize("some", [ALL, (STICKS, SLIPS), (OPENS_AND_CATCHES, STAYS_OPEN), (STICKS, STICKS)])
def test_disturbances_of_several_contacts_against_another_method(some):
    """In all states at once; contacts that stick or are open all the time among them."""
    modes = structure(len(some), 4)
    values, other = np.linalg.eigvals(followed(some, (), modes).matrix()), integrated(some, modes)
    assert len(values) >= 8
    for value in values[np.abs(values) > 1e-3]:
        assert np.abs(other - value).min() < 5e-6


@pytest.mark.parametrize("far", [(), (2,)])
@pytest.mark.parametrize("sequence", MOTIONS)
def test_disturbances_do_not_depend_on_the_steps(sequence, far):
    """Nor where a mode follows without delay, so that displacements jump as a contact closes."""
    some = [MOTIONS[sequence]]
    fine = followed(some, far, tolerance=1e-9).matrix()
    assert followed(some, far).matrix() == pytest.approx(fine, abs=2e-6)
    assert followed(some, far, stages=(5,)).matrix() == pytest.approx(fine, abs=2e-5)


@pytest.mark.parametrize("far", [(), (3, 4, 5)])
def test_disturbances_of_several_contacts_do_not_depend_on_the_steps(far):
    modes = structure(len(ALL), 6)
    fine = followed(ALL, far, modes, tolerance=1e-10).matrix()
    found = followed(ALL, far, modes).matrix()
    assert found == pytest.approx(fine, abs=0.05 * STABILITY.planar.tolerance)


def test_more_disturbances_than_are_followed_are_none():
    assert np.isnan(followed([SLIPS], max_disturbances=5).matrix()).all()


def test_contacts_that_mirror_one_another_take_no_more_steps_for_rounding_errors():
    """Their events are apart by these; apart, each would end a step."""
    modes = structure(5, 6)
    some = CATCHES, CATCHES, SLIPS, OPENS_AND_CATCHES, OPENS_AND_CATCHES
    waves = [np.array(one) for one, _ in some]
    off = [(1.0 + 1e-11 * (k in (0, 4))) * one for k, one in enumerate(waves)]
    exact, moved = (
        followed([(one, numbers) for one, (_, numbers) in zip(each, some, strict=True)], (), modes)
        for each in (waves, off)
    )
    assert moved.steps <= exact.steps + 1
    assert moved.matrix() == pytest.approx(exact.matrix(), abs=1e-6)


def test_each_event_may_interrupt():
    polled, modes = [], structure(len(ALL), 6)
    found = followed(ALL, (), modes, lambda: polled.append(1))
    assert len(polled) > 0.5 * found.events

    def interrupt():
        polled.pop()
        if len(polled) < 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        followed(ALL, (), modes, interrupt)
