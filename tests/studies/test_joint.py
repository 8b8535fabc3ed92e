"""The lap joint of the study with twenty pairs: its matrices, its stuck modes, its first bending mode."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.continuation import Status
from fcm.harmonic_balance.system import System
from fcm.nonlinear_modes.backbone import nonlinear_mode, truncation
from fcm.nonlinear_modes.options import NonlinearModeOptions, TruncationOptions
from fcm.scene.load import load_scene

from .joint import Beams, glued, matrices, mesh, preloads, slender, stuck, write

PAIRS = 10, 2  # along and across the joint
BEAMS = Beams()


@pytest.fixture(scope="module")
def made():
    return mesh(BEAMS, *PAIRS)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return load_scene(write(tmp_path_factory.mktemp("joint"), *PAIRS, harmonics=1)).in_use()


@pytest.fixture(scope="module")
def mode(scene):
    return nonlinear_mode(System(scene, (1,)), 7, (3e-6, 6e-4), scene.max_step)


def test_mass_springs_and_loads_are_those_of_the_beams(made):
    K, M = matrices(BEAMS, made)
    area = (BEAMS.lap[1] - BEAMS.lap[0]) * BEAMS.width
    for direction in np.eye(3):
        moved = np.tile(direction, len(made.nodes))
        mass = BEAMS.density * BEAMS.length * BEAMS.width * BEAMS.height
        assert moved @ M @ moved == pytest.approx(mass, rel=1e-6)  # places have nine digits
        assert moved @ K @ moved == pytest.approx(2.0 * BEAMS.hung, rel=1e-4)
    assert preloads(BEAMS, made).sum() == pytest.approx(3.0 * BEAMS.bolt_force)
    assert made.areas.sum() == pytest.approx(area)


def test_glued_it_bends_as_one_free_beam(made):
    """In both planes, as that of Euler and Bernoulli; shear takes a little, the springs at its ends give."""
    assert glued(BEAMS, made) == pytest.approx(slender(BEAMS), rel=0.01)


def test_at_small_amplitude_the_pairs_are_springs(made, mode):
    assert mode.omega[0] / (2.0 * np.pi) == pytest.approx(stuck(BEAMS, made)[0], rel=1e-4)


def test_the_mode_is_followed_as_its_contacts_slip_one_after_the_other(mode):
    """In few points: slip of one contact among many turns neither frequency nor damping."""
    assert mode.path.status is Status.COMPLETE and mode.amplitude[-1] == pytest.approx(6e-4)
    assert mode.omega[-1] < 0.85 * mode.omega[0] and mode.damping.max() > 100.0 * mode.damping[0]
    assert mode.amplitude.size < 100


def test_forces_that_do_what_its_negative_damping_does_balance_it(mode):
    system = mode.system
    scene, shapes = system.scene, system.linear.dofs
    for i in range(5, mode.omega.size, 15):
        omega = mode.omega[i]
        modal = 2j * mode.damping[i] * omega**2 * mode.amplitude[i] * mode.Q[i, 0]
        pushed = np.linalg.lstsq(shapes, modal)[0]
        assert shapes @ pushed == pytest.approx(modal, abs=1e-9 * np.abs(modal).max())
        forces = [
            replace(scene.forces[0], direction=direction, amplitude=abs(F), phase=float(np.angle(1j * F)))
            for direction, F in zip(np.eye(pushed.size), pushed, strict=True)
        ]
        balance = System(replace(scene, forces=tuple(forces)), (1,)).new_balance()
        z = np.ascontiguousarray(mode.contacts[i])
        balance.evaluate(z)
        # the soft springs yield 5e-5 m/N to what rounding makes of mean forces
        assert np.abs(balance.residual).max() < 1e-5 * np.abs(z[:-1]).max()


@pytest.mark.slow
def test_the_error_of_many_unknowns_is_told_at_a_few_points_as_more_harmonics_change_it(scene):
    mode, finer = (
        nonlinear_mode(System(scene, harmonics), 7, (3e-6, 2e-5), 0.1) for harmonics in ((1,), (1, 2, 3))
    )
    error, contact_loads = truncation(
        mode,
        NonlinearModeOptions(truncation=TruncationOptions(many_unknowns=1, min_points=3, time_fraction=0.0)),
    )
    told = np.flatnonzero(np.isfinite(error))
    assert told.size == 3 < mode.omega.size and told[-1] == mode.omega.size - 1
    assert np.array_equal(np.isfinite(contact_loads).all(axis=(1, 2)), np.isfinite(error))
    at = np.log(mode.amplitude[told])
    omega, damping = (np.interp(at, np.log(finer.amplitude), one) for one in (finer.omega, finer.damping))
    off = np.abs(damping - mode.damping[told]) / mode.damping.max()
    off = np.maximum(off, np.abs(omega / mode.omega[told] - 1.0))
    assert error[told] == pytest.approx(off, rel=0.1, abs=1e-3)
