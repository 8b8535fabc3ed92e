"""The level of the forces followed with the exact motion, and what it passes."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from fcm.harmonic.system import System as Balanced
from fcm.motion import State, simulate
from fcm.orbit import OrbitProblem
from fcm.orbit.level import LevelProblem
from fcm.orbit.periodic import without_end
from fcm.orbit.raised import raised_at
from fcm.orbit.shooting import Shooting

from ..motion.cases import two_contacts, yang
from ..response.random_scenes import random_scene


def at_level(scene, level):
    """The scene with all its harmonic forces times a level."""
    return replace(scene, forces=tuple(replace(one, amplitude=level * one.amplitude) for one in scene.forces))


@pytest.mark.parametrize(("scene", "omega"), [(yang(), 1.3), (yang(0.0), 1.1), (two_contacts(), 1.7)])
def test_the_derivative_by_the_level_is_that_of_differences_of_the_forces(scene, omega):
    """Away from where the period closes, from a motion that slips."""
    x, level, step = LevelProblem(scene, omega).shooting.unknowns(simulate(scene, omega, 20).end), 0.9, 1e-6
    shot = Shooting(scene).residual(x, omega, level, by_level=True)
    gaps = [Shooting(at_level(scene, level + h)).residual(x, omega).gap for h in (0.0, step, -step)]
    assert shot.gap == pytest.approx(gaps[0], abs=1e-13 * np.abs(x).max())
    quotient = (gaps[1] - gaps[2]) / (2.0 * step)
    assert shot.by_parameter / shot.scale == pytest.approx(quotient / shot.scale, abs=1e-7)
    assert np.abs(quotient / shot.scale).max() > 0.1


def test_every_passing_of_the_level_1_is_a_motion():
    """Ten modes, hardly damped, above a contact: simulated, each of the three repeats after a period."""
    scene, omega = random_scene(3), 2.1490306
    found = raised_at(scene, Balanced(scene, (1,)), omega, (), without_end)
    m, free = scene.modal.mass.size, OrbitProblem(scene).free
    starts = np.zeros((len(found.motions), 2 * m + 1))
    starts[:, free] = [z[:-1] for z in found.motions]
    ends = [simulate(scene, omega, 1, State(x[:m], x[m : 2 * m], x[2 * m :])).end.q for x in starts]
    assert found.complete and len(starts) == 3
    assert np.array(ends) == pytest.approx(starts[:, :m], abs=1e-9 * np.abs(starts).max())
    assert min(np.abs(a - b).max() for a, b in combinations(starts, 2)) > 1e-3 * np.abs(starts).max()
