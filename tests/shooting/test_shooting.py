"""The residual of a period, and its derivatives by the state and by the frequency."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.scene import Contact, Force, Modal, Scene
from fcm.shooting import Shooting, periodic
from fcm.shooting.period_derivative import displacement_rates
from fcm.shooting.residual import Shot
from fcm.time_domain import simulate
from fcm.time_domain.equations_of_motion import EquationsOfMotion

from ..time_domain.cases import SCENES, one_mode, two_contacts, yang

CASES = [
    ("n_0 = 5", 1.3), ("n_0 = 0", 1.1), ("n_0 = -2", 0.9), ("one mode", 1.1), ("two contacts", 1.3),
    ("three harmonics", 0.9),
]  # fmt: skip


def many(modes=40, contacts=3):
    """Enough components, by default, for matrices to be multiplied by BLAS."""
    rng = np.random.default_rng(3)
    dofs = 2 * contacts + 1
    unit = np.eye(dofs)
    modal = Modal(
        tuple(f"x{i}" for i in range(dofs)),
        np.ones(modes),
        np.sort(rng.uniform(1.0, 9.0, modes)),
        np.full(modes, 0.02),
        rng.normal(size=(modes, dofs)) / np.sqrt(modes),
    )
    made = tuple(
        Contact(f"c{j}", unit[2 * j], unit[2 * j + 1], 0.4, 1.0, 1.0, 0.1 * j) for j in range(contacts)
    )
    return Scene("many", modal, made, (Force(unit[-1] + 0.3 * unit[1], 10.0, 0.4),), (0.8, 3.0), 0.05)


def relative(shot, rates):
    """Rates of the state in units of the motion."""
    return rates / shot.scale


@pytest.mark.parametrize(("name", "omega"), CASES)
def test_the_derivative_by_the_frequency_is_that_of_differences(name, omega):
    """Also where the period does not close: 20 cycles after rest."""
    problem = Shooting(SCENES[name])
    for cycles in (20, 200):
        x = problem.unknowns(simulate(SCENES[name], omega, cycles).end)
        shot, step = problem.residual(x, omega), 1e-6 * omega
        ahead, behind = problem.residual(x, omega + step), problem.residual(x, omega - step)
        assert ahead.sequence == behind.sequence
        quotient = (ahead.closure - behind.closure) / (2.0 * step)
        assert omega * relative(shot, shot.by_parameter) == pytest.approx(
            omega * relative(shot, quotient), abs=1e-7
        )


@pytest.mark.parametrize(("modes", "contacts"), [(40, 3), (12, 2), (9, 1), (4, 1), (3, 1)])
def test_the_derivatives_of_many_modes(modes, contacts):
    """By BLAS, by four rows at once with and without rows and columns left over, and one by one."""
    scene, omega = many(modes, contacts), 1.5
    problem = Shooting(scene)
    x = problem.unknowns(simulate(scene, omega, 10).end)
    shot = problem.residual(x, omega)
    assert len(shot.segments) > 4
    quotient = (problem.residual(x, omega + 1e-6).closure - problem.residual(x, omega - 1e-6).closure) / 2e-6
    assert relative(shot, shot.by_parameter) == pytest.approx(relative(shot, quotient), abs=1e-6)
    way = np.random.default_rng(0).normal(size=x.size) * shot.scale
    quotient = (
        problem.residual(x + 1e-6 * way, omega).closure - problem.residual(x - 1e-6 * way, omega).closure
    ) / 2e-6
    assert relative(shot, shot.by_state @ way) == pytest.approx(relative(shot, quotient), abs=1e-5)


def test_the_derivative_by_the_frequency_without_contact_is_known():
    """q = 1 / (1 - omega^2 + 2 i zeta omega), of which the residual's root must follow the change."""
    scene = replace(one_mode(damping=0.05), contacts=())

    def start(omega):
        wave = np.exp(0.3j) / (1.0 - omega**2 + 0.1j * omega)
        return np.array([wave.imag, omega * wave.real])

    problem, omega, step = Shooting(scene), 1.2, 1e-5
    shot = problem.residual(start(omega), omega)
    change = np.linalg.solve(shot.by_state, -shot.by_parameter)
    assert shot.residual < 1e-13
    assert change == pytest.approx((start(omega + step) - start(omega - step)) / (2.0 * step), rel=1e-7)


def test_flows_of_another_frequency_are_used_on():
    """The motion does not depend on which frequencies were there before; above all rates too."""
    scene = two_contacts()
    used = EquationsOfMotion(scene, 0.7)
    for omega in (0.7, 1.3, 60.0, 1.3):
        used = used.at(omega)
        orbit = periodic(scene, omega)
        x = np.concatenate((orbit.state.q, orbit.state.velocity, orbit.state.friction))
        assert Shot(used, x).residual < 1e-11
    assert used.flows.count > 4


@pytest.mark.parametrize("preload", [90.0, 130.0])
def test_a_contact_that_always_sticks_has_the_friction_that_is_wanted(preload):
    scene, omega = yang(preload), 1.2
    problem = Shooting(scene)
    orbit = periodic(scene, omega)
    shot = problem.residual(problem.unknowns(orbit.state), omega)
    step = np.linalg.solve(shot.by_state, -shot.closure)
    shot = problem.residual(shot.x + step, omega)
    assert shot.residual < 1e-10
    u = scene.modal.shapes.T @ shot.state.q
    assert shot.state.friction[0] == pytest.approx(u[0])  # k_u = 1, w = 0


def instants(segments, duration, count, rng):
    """Places (segment, position) in no order, several of them in one step, and their times."""
    start, length = (np.asarray(x)[: len(segments)] for x in (segments.start, segments.length))
    lasts = np.append(start[1:], duration) - start
    k = rng.choice(np.flatnonzero(lasts > 1e-3 * duration), count)
    share = rng.choice(rng.uniform(0.05, 0.95, count // 4), count) + rng.uniform(0.0, 1e-3, count)
    return np.column_stack((k, share * length[k])), start[k] + share * lasts[k]


@pytest.mark.parametrize(("name", "omega"), CASES)
def test_the_change_along_a_direction_is_the_difference_of_two_motions(name, omega):
    """At many instants, several of them in one step."""
    scene, rng, h = SCENES[name], np.random.default_rng(1), 1e-6
    problem, state = Shooting(scene), periodic(scene, omega).state
    shot = problem.residual(problem.unknowns(state), omega)
    places, times = instants(shot.segments, shot.duration, 40, rng)
    way, rate, order = rng.normal(size=shot.x.size) * shot.scale, 0.3 * omega, np.argsort(times)
    rows = np.eye(shot.system.size)[: shot.system.modes]
    ends = [
        Shot(EquationsOfMotion(scene, omega + e * rate), shot.x + e * way).cycle.values(rows, times[order])
        for e in (-h, h)
    ]
    found = displacement_rates(shot.system, shot.segments, places, way, rate)[order]
    expected = (ends[1] - ends[0]) / (2.0 * h)
    assert found == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())
