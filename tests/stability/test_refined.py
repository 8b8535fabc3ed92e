"""Classifications in doubt: of light impacts, whose multipliers come slowly to those of the exact motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.branches.trace import traced
from fcm.harmonic_balance.residual_spectrum import enriched_harmonics
from fcm.scene import Contact, Force, Modal, Scene, load_scene
from fcm.shooting import periodic
from fcm.stability.multipliers import Multipliers
from fcm.stability.rebalanced import Rebalancing

from ..harmonic_balance.truth import state
from .test_balanced_motions import only, system


def impacts(frequency, damping, shapes, contact, pushed):
    """One contact of a tangential and a normal degree of freedom, mu, k_u, k_v, n_0."""
    modal = Modal(
        ("u", "v"), np.ones(len(frequency)), np.array(frequency), np.array(damping), np.array(shapes)
    )
    axes = np.eye(2)
    force = Force(axes[pushed], 1.0, 0.0)
    return Scene("impacts", modal, (Contact("c", axes[0], axes[1], *contact),), (force,), (0.5, 3.0), 0.05)


ONE_MODE = impacts([1.0], [0.0396], [[0.178, -1.24]], (0.0104, 9.97, 14.16, -0.3), 0)
TWO_MODES = impacts(
    [1.0, 2.2068],
    [0.010356, 0.0043],
    [[0.3086, 2.1875], [0.6168, -2.3066]],
    (0.0935, 0.1418, 1.972, -5.777),
    1,
)
FOUR_MODES = impacts(
    [1.0, 1.65852, 3.25401, 3.7308],
    [0.04446, 0.01065, 0.01622, 0.02916],
    [[-0.3129, 0.14039], [-1.6088, 1.2205], [-1.94042, 1.48304], [-0.07922, -1.72049]],
    (0.4489, 3.72894, 4.89631, -1.93406),
    0,
)

TOUCHING = impacts(  # its normal motion is 3 % of the tangential
    [1.0, 3.0635, 3.1222],
    [0.044844, 0.0078936, 0.0077645],
    [[0.94722, 0.10045], [-0.71854, 1.5813], [0.21626, 0.86487]],
    (0.6515, 6.9317, 16.506, -0.47859),
    0,
)


def judged(scene, omega, highest):
    """The classification of the balanced solution, and whether the exact motion beside it is stable."""
    of = system(scene, highest)
    z = only(scene, omega, highest)
    orbit = periodic(scene, omega, state(of, z))
    balance = of.new_balance()
    balance.evaluate_outputs(z, np.zeros_like(z))
    np.testing.assert_allclose(orbit.measure.amplitude, np.asarray(balance.output), rtol=0.02)
    return Multipliers(of, omega).classify(z), orbit.stable


@pytest.mark.parametrize(("scene", "omega", "highest"), [(ONE_MODE, 1.129, 4), (FOUR_MODES, 0.9953, 9)])
def test_light_impacts_that_any_start_leads_to_are_not_called_unstable(scene, omega, highest):
    classified, true = judged(scene, omega, highest)
    assert true
    assert classified.stable == 1.0


def test_a_pair_about_to_meet_at_minus_one_is_not_called_stable():
    classified, true = judged(TWO_MODES, 2.1997, 3)
    assert not true
    assert classified.stable != 1.0


def test_a_decay_that_further_harmonics_make_a_growth_is_not_called_stable():
    """Ten harmonics have a multiplier of -0.96, twenty by their own forces -0.98; the exact motion flips."""
    classified, true = judged(FOUR_MODES, 0.76054, 10)
    assert not true
    assert classified.stable != 1.0


@pytest.mark.parametrize(("omega", "highest"), [(0.6231, 15), (0.625, 15), (0.6209, 12), (0.625, 12)])
def test_a_small_normal_motion_that_is_not_yet_what_it_will_be_is_not_called_stable(omega, highest):
    """Amplitudes err by 1e-4 of the greatest; the exact motion flips with a multiplier of about -2."""
    classified, true = judged(TOUCHING, omega, highest)
    assert not true
    assert classified.stable != 1.0


def test_a_verdict_in_doubt_is_that_of_forces_of_another_level():
    of, twice = (system(scene, 4) for scene in (ONE_MODE, _doubled(ONE_MODE)))
    z = only(_doubled(ONE_MODE), 1.129, 4)
    of_level, of_forces = (Multipliers(one, 1.129) for one in (of, twice))
    assert of_level.classify(z).growth == pytest.approx(of_forces.classify(z).growth, abs=1e-8)
    assert of_level.further is not None


def _doubled(scene):
    (force,) = scene.forces
    return replace(scene, forces=(replace(force, amplitude=2.0 * force.amplitude),))


def test_a_solution_with_many_harmonics_takes_few_jacobians():
    """Against the equations themselves: but for what the balanced harmonics lacked, they are solved."""
    scene = load_scene("blade").each_curve()[0]
    of = system(scene, 1)
    path, finer = traced(of).branches.paths[0], Multipliers(of, scene.frequency_range[1]).finer
    refined = Rebalancing(of, enriched_harmonics([1]))
    assert refined.balance.unknowns >= 300
    found = taken = 0
    for z in path.z[::20]:
        finer.at(z)
        if finer.shift == 0.0:  # nothing slips
            continue
        before = refined.newton.evaluations
        there = refined.rebalance(z, finer.x)
        if there is None:
            continue
        found, taken = found + 1, taken + refined.newton.evaluations - before
        refined.homotopy.evaluate(there)
        assert np.abs(np.asarray(refined.homotopy.residual) / there[:-1].max()).max() < 1e-10
    assert found > 5
    assert taken <= 2 * found, (taken, found)
