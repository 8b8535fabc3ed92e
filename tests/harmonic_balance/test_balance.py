"""The balance of any harmonics against differences, and against its own equations written out."""

import numpy as np
import pytest

from fcm.harmonic_balance.prolongation import ForceLevelProblem
from fcm.harmonic_balance.system import System

from ..time_domain.cases import yang
from .scenes import isola_stuck, stuck_mean, up_to

SCENES = {"opens": yang(5.0), "gap": yang(-5.0), "two": stuck_mean(), "slips": isola_stuck()}
STEP = 1e-6


def some_motion(system, seed, size):
    """Displacements of every harmonic, those of the higher ones smaller, and a frequency of the range."""
    random = np.random.default_rng(seed)
    count = len(system.scene.contacts)
    decay = np.concatenate(([0.5, 0.5], np.repeat(1.0 / np.array(system.harmonics) ** 1.5, 4)))
    x = size * (random.normal(size=(count, decay.size)) * decay).ravel()
    return np.append(x, random.uniform(*system.scene.frequency_range))


@pytest.mark.parametrize("harmonics", [(1,), up_to(3), up_to(9), (1, 2, 9)], ids=str)
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("size", [0.3, 3.0, 30.0])
def test_derivatives_by_displacements_and_frequency(name, harmonics, size):
    system = System(SCENES[name], harmonics)
    balance = system.new_balance()
    n = balance.unknowns
    assert n == len(system.scene.contacts) * (2 + 4 * len(harmonics))
    for seed in range(5):
        z = some_motion(system, seed, size)
        balance.evaluate(z)
        jacobian = np.array(balance.jacobian)
        assert jacobian.shape == (n, n + 1)
        for j in range(n + 1):
            step = STEP * (size if j < n else 1.0) * np.eye(n + 1)[j]
            sides = []
            for sign in (1.0, -1.0):
                balance.evaluate(z + sign * step)
                sides.append(np.array(balance.residual))
            slope = (sides[0] - sides[1]) / (2.0 * step[j])
            unit = np.abs(jacobian[:, j]).max()
            assert jacobian[:, j] == pytest.approx(slope, abs=1e-5 * max(unit, 1.0))


@pytest.mark.parametrize("harmonics", [(1,), up_to(3)], ids=str)
def test_the_level_scales_the_external_forces(harmonics):
    """The derivative by the level is minus the answer to the forces, whatever the contacts do."""
    system = System(yang(5.0), harmonics)
    level = ForceLevelProblem(system.new_balance(), 1.1)
    z = np.append(some_motion(system, 0, 3.0)[:-1], 0.7)
    level.evaluate(z)
    column, residual = np.array(level.jacobian)[:, -1], np.array(level.residual)
    for other in (0.0, 1.0, 2.5):
        level.evaluate(np.append(z[:-1], other))
        assert np.array(level.residual) == pytest.approx(residual + (other - 0.7) * column, abs=1e-12)
    modal = system.scene.modal
    w = 1.1
    compliance = 1.0 / (modal.mass * (modal.frequency**2 - w**2 + 2j * modal.damping * modal.frequency * w))
    load = sum(f.direction * f.amplitude * np.exp(1j * f.phase) for f in system.scene.forces) / 1j
    X = modal.shapes.T @ (compliance * (modal.shapes @ load))  # of x = Re(X exp(i omega t))
    assert -column[2:6] == pytest.approx([X[0].real, X[0].imag, X[1].real, X[1].imag], rel=1e-12)
    assert np.all(column[:2] == 0.0) and np.all(column[6:] == 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_one_harmonic_by_the_closed_form_is_the_general_case(seed):
    """The kernel for any harmonics, given one, has the forces of the paper's closed form."""
    from fcm.contact.periodic.cycle import PeriodicContact
    from fcm.harmonic_balance.contact_law import laws_on_a_line

    for scene in SCENES.values():
        system = System(scene, (1,))
        z = some_motion(system, seed, 3.0)
        single, periodic = (system.new_balance() for _ in range(2))
        kernel = PeriodicContact([1], [1])
        periodic.laws = laws_on_a_line(kernel, scene.contacts)
        single.evaluate(z)
        periodic.evaluate(z)
        scale = np.abs(z[:-1]).max()
        assert np.array(single.residual) == pytest.approx(np.array(periodic.residual), abs=1e-9 * scale)
        assert np.array(single.jacobian) == pytest.approx(np.array(periodic.jacobian), rel=1e-6, abs=1e-7)
