"""Multipliers by the sequence of states beside those of the differentiated motion, with its saltations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.model.scene import HeldContact
from fcm.shooting import Shooting, periodic
from fcm.shooting.periodic_orbit import converged
from fcm.time_domain import simulate

from ..harmonic_balance.strips import strip
from ..time_domain.cases import SCENES, yang

CASES = [
    (SCENES["n_0 = 5"], 1.3),
    (SCENES["n_0 = 0"], 1.1),
    (SCENES["n_0 = -2"], 0.9),
    (SCENES["one mode"], 1.1),
    (SCENES["two contacts"], 1.3),
    (SCENES["two contacts"], 2.3),
    (yang(0.0), 0.745),  # unstable
    (yang(-2.0, mu=0.0), 1.2),  # impacts without friction
    (yang(5.0, k_v=0.0), 1.2),  # a constant load
    (yang(100.0), 0.9),  # stuck
    (strip(4), 1.15),
    (strip(12), 1.15),  # by changes of rank two
]


def differentiated(shot):
    """Eigenvalues of the derivative of the state after the periods, in units of the motion."""
    return np.linalg.eigvals(shot.derivative * shot.scale / shot.scale[:, None])


def matched(values, others):
    """Greatest distance of values from those of others, each of which is taken once."""
    left, most = list(others), 0.0
    for value in sorted(values, key=abs, reverse=True):
        nearest = min(left, key=lambda one: abs(one - value))
        left.remove(nearest)
        most = max(most, abs(nearest - value))
    return most


@pytest.mark.parametrize(("scene", "omega"), CASES)
def test_they_are_the_eigenvalues_of_the_differentiated_motion(scene, omega):
    problem = Shooting(scene)
    shot = problem.residual(problem.unknowns(periodic(scene, omega).state), omega)
    assert shot.multipliers.size == shot.derivative.shape[0]
    assert matched(shot.multipliers, differentiated(shot)) < 2e-7  # of those near 0, the root of rounding


def test_those_of_two_periods_are_squares_of_those_of_one():
    scene, omega = yang(0.0), 0.745
    problem = Shooting(scene)
    once = problem.residual(problem.unknowns(periodic(scene, omega).state), omega)
    twice = Shooting(scene, 2).residual(once.x, omega)
    assert matched(twice.multipliers, once.multipliers**2) < 1e-7


def test_a_contact_that_is_held_is_a_spring_of_the_disturbances():
    """Beside the same contact, computed, which sticks with so much preload: that has a multiplier 1 more."""
    scene, omega = SCENES["two contacts"], 1.3
    first = replace(scene.contacts[0], n_0=50.0)
    whole = replace(scene, contacts=(first, scene.contacts[1]))
    held = replace(scene, contacts=scene.contacts[1:], held=(HeldContact(0, first, open=False),))
    start = simulate(whole, omega, 60).end
    shot, _ = converged(Shooting(whole).residual(Shooting(whole).unknowns(start), omega))
    x = np.delete(shot.x, 6)
    other, _ = converged(Shooting(held).residual(x, omega))
    assert matched(other.other_multipliers, shot.other_multipliers) < 1e-8
