"""A mass with rigid Coulomb friction, as Den Hartog (1931) solved it: the limit of ever stiffer contacts.

With tau = omega t, r = omega / omega_0 and forces over the exciting one, the mass that moves down follows

    r^2 x'' + x = cos tau + F,    x = F + Q cos tau + A cos(tau / r) + B sin(tau / r),    Q = 1 / (1 - r^2)

and half a period later the same with the other sign. If it never stops in between, the conditions x = x_0,
x' = 0 at the one turn and x = -x_0, x' = 0 at the other give x_0 = sqrt(Q^2 - (F U)^2).
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import fsolve

import fcm
from fcm.harmonic_balance.stiff_contacts import too_stiff
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.shooting.initial_orbits import solution_at

SAID = (
    r"the k_u of contact (\w+) is .*\. Try (\S+), nearly rigid, and half of that to see how much it matters"
)
FRICTION = 0.5  # over the amplitude of the force


def without_stops(r):
    """x_0 over the static displacement."""
    U = np.sin(np.pi / r) / (r * (1.0 + np.cos(np.pi / r)))
    return np.sqrt(1.0 / (1.0 - r * r) ** 2 - (FRICTION * U) ** 2)


def with_stops(r):
    """x_0 where the mass rests at each turn until the force overcomes friction; and the angle of that rest.

    It is released where cos tau_1 - x_0 = -F, and comes to rest at tau_2 < tau_1 + pi.
    """

    def motion(tau, tau_1, x_0):
        Q, s = 1.0 / (1.0 - r * r), (tau - tau_1) / r
        A, B = x_0 - FRICTION - Q * np.cos(tau_1), r * Q * np.sin(tau_1)
        place = FRICTION + Q * np.cos(tau) + A * np.cos(s) + B * np.sin(s)
        return place, -Q * np.sin(tau) - A / r * np.sin(s) + B / r * np.cos(s)

    def missing(z):
        x_0, tau_1, tau_2 = z
        place, speed = motion(tau_2, tau_1, x_0)
        return [np.cos(tau_1) - x_0 + FRICTION, place + x_0, speed]

    x_0, tau_1, tau_2 = fsolve(missing, [1.3, 0.65, 3.6], xtol=1e-13)
    between = np.linspace(tau_1, tau_2, 1000)[1:-1]
    assert (motion(between, tau_1, x_0)[1] < 0.0).all() and 0.0 < tau_1 + np.pi - tau_2 < np.pi
    return x_0, tau_1 + np.pi - tau_2


def scene(k_u, r=0.6):
    bundled = fcm.load_scene("den-hartog")
    contact = replace(bundled.contacts[0], k_u=k_u)
    return replace(bundled, contacts=(contact,), curves=(), frequency_range=(r, r + 0.01))


def exact(k_u, r):
    return solution_at(scene(k_u, r), r).measure.amplitude[0]


@pytest.mark.parametrize("r", [0.6, 0.7, 0.8])
def test_the_exact_motion_comes_to_the_closed_form(r):
    """By the root of the stiffness: the contact's spring turns the mass round in a time of that order."""
    rigid, k_u = without_stops(r), (1e4, 1e6)
    amplitude = [exact(k, r) for k in k_u]
    off = [rigid - each for each in amplitude]
    assert off[0] / off[1] == pytest.approx(10.0, rel=0.02) and 0.0 < off[1] < 1e-3 * rigid
    assert (10.0 * amplitude[1] - amplitude[0]) / 9.0 == pytest.approx(rigid, rel=2e-5)


def test_with_stops_too():
    """There the mass rests before it turns, and the spring of the contact counts by its compliance."""
    rigid, rest = with_stops(0.5)
    assert rest > 0.1 and rigid != pytest.approx(without_stops(0.5), rel=1e-2)
    assert exact(1e4, 0.5) == pytest.approx(rigid, rel=1e-4)
    assert exact(1e2, 0.5) == pytest.approx(rigid, rel=2e-2)


def test_more_and_more_harmonics_come_to_it():
    """Of a force that jumps the displacements of harmonic h are as 1 / h^3; the mass turns at the jump."""
    r, stiff = 0.7, 1e4
    true = exact(stiff, r)
    off = []
    for highest in (5, 15, 45):
        curve = trace(scene(stiff, r), harmonics=list(range(1, highest + 1, 2))).curves[0]
        (at,) = np.flatnonzero(curve.frequency == r)
        off.append(abs(curve.amplitude[at, 0] / true - 1.0))
    assert off[0] < 0.05 and off[1] < 0.4 * off[0] and off[2] < 0.4 * off[1]
    assert true == pytest.approx(without_stops(r), rel=0.01)


def test_the_bundled_curves_come_to_it():
    curves = trace(fcm.load_scene("den-hartog")).curves
    assert all(curve.complete and not curve.folds for curve in curves)
    for r in (0.6, 0.7, 0.8):
        off = [1.0 - np.interp(r, c.frequency, c.amplitude[:, 0]) / without_stops(r) for c in curves]
        assert off[0] > off[1] > off[2] > 0.0 and off[2] < 0.03


def test_what_is_said_of_a_contact_too_stiff_is_as_rigid_as_it_says():
    assert not too_stiff(System(scene(1e4)))
    said = re.search(SAID, too_stiff(System(scene(1e12))))
    assert said and said[1] == "wall"
    for r in (0.6, 0.7, 0.8):
        assert exact(float(said[2]), r) == pytest.approx(without_stops(r), rel=1e-3)


@pytest.mark.parametrize("k_u", [1e13, 1e15, 1e17])
def test_of_a_force_on_what_is_held_the_compliance_of_the_contact_moves(k_u):
    """Its spring moves by 1 / k_u; what rounding makes of the preload is far more than the normal motion."""
    bundled = fcm.load_scene("yang1998-n5")
    contact = replace(bundled.contacts[0], k_u=k_u)
    curve = trace(replace(bundled, contacts=(contact,), forces=bundled.forces[:1])).curves[0]
    assert curve.complete
    assert curve.amplitude[:, 0] * k_u == pytest.approx(1.0, rel=1e-9)
