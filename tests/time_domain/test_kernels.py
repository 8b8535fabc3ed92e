"""Flows, first descents, measures and derivatives against what shares nothing with them."""

from __future__ import annotations

from dataclasses import replace
from threading import Thread

import numpy as np
import pytest
from scipy.linalg import expm

from fcm.scene import Contact, Force, Modal, Scene
from fcm.time_domain import simulate
from fcm.time_domain.contact_states import made
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import extremes_by, measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.integrator import first_descent_of
from fcm.time_domain.measures import Scan, SparseRows
from fcm.time_domain.options import FlowOptions, TimeOptions

from .cases import SCENES, one_mode, two_contacts, yang


def polynomial(*roots, scale=1.0):
    """Powers of scale * prod(root - x): (20,)."""
    p = np.zeros(20)
    p[: len(roots) + 1] = scale * np.polynomial.polynomial.polyfromroots(roots) * (-1.0) ** len(roots)
    return p


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-6])
@pytest.mark.parametrize("at", [0.1, 1.0 / 3.0, 0.5, 0.9])
def test_a_short_descent_is_not_missed(at, gap):
    """Two roots so near one another that no grid would see them, with others on the way."""
    p = polynomial(at, at + gap, 1.4, 1.5, -0.2)
    p *= np.sign(p[0])
    assert first_descent_of(p, 0.0) == pytest.approx(at, abs=1e-14 / gap)


def test_a_touch_is_no_descent():
    p = polynomial(0.5, 0.5)
    assert first_descent_of(p, 1e-15) is None
    assert first_descent_of(p - 1e-6 * np.eye(20)[0], 1e-15) == pytest.approx(0.499, abs=1e-9)


def test_first_descents_are_those_of_a_fine_grid():
    rng = np.random.default_rng(1)
    grid = np.linspace(0.0, 1.0, 20_001)
    found = 0
    for _ in range(300):
        p = rng.normal(size=20) * rng.choice([1.0, 3.0, 10.0]) ** np.arange(20) / 3.0
        p[0] = abs(p[0])
        values = np.polynomial.polynomial.polyval(grid, p)
        below = np.flatnonzero(values < -1e-9)
        at = first_descent_of(p, 1e-12)
        if below.size:
            found += 1
            assert at is not None and at <= grid[below[0]]
            assert abs(np.polynomial.polynomial.polyval(at, p)) < 1e-8 * np.abs(p).sum()
    assert found > 100


@pytest.mark.parametrize("omega", [0.3, 1.3, 7.0, 200.0])
@pytest.mark.parametrize(
    "scene", [yang(), one_mode(damping=0.0, frequency=0.0), two_contacts()], ids=lambda s: s.title
)
def test_flows_are_exponentials(scene, omega):
    """A march without an exit, with the forces, beside scipy's exponential of the whole matrix."""
    contacts = tuple(replace(c, n_0=1e9 if j else -1e9) for j, c in enumerate(scene.contacts))
    scene = replace(scene, contacts=contacts)
    system = EquationsOfMotion(scene, omega)
    motion = simulate(scene, omega, 0.73)
    states = np.asarray(motion.cycles[0].segments.states)[0]
    flow = made(system, states)
    n = system.size - 2
    a = np.zeros((n + 2, n + 2))
    a[:n, :n] = _logarithm_by_parts(system, states)
    a[system.p, n], a[system.p, n + 1] = (
        system.wave.real / scene.modal.mass,
        system.wave.imag / scene.modal.mass,
    )
    a[n, n + 1], a[n + 1, n] = omega, -omega
    y = np.zeros(n + 2)
    y[n - 1], y[n + 1] = 1.0, 1.0
    end = expm(a * motion.duration) @ y
    assert flow.step * omega <= 1.0 + 1e-12
    size = np.abs(end[: 2 * system.modes]).max()
    assert motion.end.q == pytest.approx(end[system.q], abs=1e-11 * size)
    assert motion.end.velocity == pytest.approx(end[system.p], abs=1e-11 * size * max(omega, 1.0))


def test_steps_hang_on_the_states_and_the_frequency_alone():
    """Lengths of segments are counted in steps: they mean the same, whatever was marched before."""
    scene, other = yang(5.0), yang(5.0)
    alone = simulate(scene, 1.3, 2).cycles[-1].segments
    simulate(other, 90.0, 2)  # forces that are faster than the structure: flows of shorter steps
    fine = made(EquationsOfMotion(other, 90.0), np.asarray(alone.states)[0])
    coarse = made(EquationsOfMotion(other, 1.3), np.asarray(alone.states)[0])
    assert fine.halved and not coarse.halved and fine.step < coarse.step
    after = simulate(other, 1.3, 2).cycles[-1].segments
    assert np.array_equal(np.asarray(after.length), np.asarray(alone.length))
    assert np.array_equal(np.asarray(after.y), np.asarray(alone.y))


def test_the_step_of_a_mass_without_stiffness_is_the_same_for_all_frequencies_that_it_fits():
    scene = yang(5.0)
    free = Modal(scene.modal.dofs, scene.modal.mass, np.zeros(2), np.zeros(2), scene.modal.shapes)
    scene = replace(scene, modal=free, contacts=())
    steps = {
        omega: made(EquationsOfMotion(scene, omega), np.zeros(0, np.int8)).step
        for omega in (2.0, 2.1, 3.9, 4.0)
    }
    assert steps == {2.0: 0.5, 2.1: 0.25, 3.9: 0.25, 4.0: 0.25}


def _logarithm_by_parts(system, states):
    """The matrix of (q, q', f, n, 1), from the equations of motion as they are written."""
    m, c, modal = system.modes, len(system.contacts), system.scene.modal
    a = np.zeros((2 * m + 2 * c + 1, 2 * m + 2 * c + 1))

    def rates(y):
        q, p, f, n, one = y[:m], y[m : 2 * m], y[2 * m : 2 * m + c], y[2 * m + c : -1], y[-1]
        push = np.zeros(m)
        df = np.zeros(c)
        for j, (contact, state) in enumerate(zip(system.contacts, "SEPN", strict=False)):
            u, v = modal.shapes @ contact.tangential, modal.shapes @ contact.normal
            state = "SEPN"[states[j]]
            if state == "S":
                push += v * max(contact.n_0, 0.0) * one
                continue
            push -= u * f[j] + v * (n[j] + min(contact.n_0, 0.0) * one)
            slip = contact.mu * contact.k_v * (v @ p)
            df[j] = {"E": contact.k_u * (u @ p), "P": slip, "N": -slip}[state]
        dn = np.array([k.k_v * (modal.shapes @ k.normal @ p) for k in system.contacts])
        dp = push / modal.mass - 2.0 * modal.damping * modal.frequency * p - modal.frequency**2 * q
        return np.concatenate((p, dp, df, dn, [0.0]))

    for i in range(a.shape[0]):
        a[:, i] = rates(np.eye(a.shape[0])[i])
    return a


@pytest.mark.parametrize(("scene", "omega"), [(yang(), 1.3), (two_contacts(), 1.3), (yang(k_u=1e4), 1.1)])
def test_extremes_are_those_of_dense_samples(scene, omega):
    """Also where a stiff contact rings, and the velocity dips through zero within a step."""
    motion = simulate(scene, omega, 12)
    cycle = motion.cycles[-1]
    shapes = scene.modal.shapes
    rows = np.zeros((shapes.shape[1], cycle.system.size))
    rows[:, cycle.system.q] = shapes.T
    times = np.linspace(0.0, cycle.duration, 200_001)
    values = cycle.values(rows, times)
    found = measure(cycle)
    bend = (2.0 * np.pi / 200_000) ** 2 * 1e4 * np.abs(values).max()
    assert (found.greatest >= values.max(axis=0) - 1e-13).all()
    assert found.greatest == pytest.approx(values.max(axis=0), abs=bend)
    assert found.least == pytest.approx(values.min(axis=0), abs=bend)
    assert found.mean == pytest.approx(np.trapezoid(values, times, axis=0) / cycle.duration, abs=1e-8)


def test_the_least_of_a_row_is_where_it_is_said_to_be():
    motion = simulate(yang(90.0), 1.2, 3)
    cycle = motion.cycles[-1]
    assert isinstance(cycle, Cycle) and cycle.states == ("E",)
    row = np.zeros((1, cycle.system.size - 2))
    row[0, cycle.system.f] = -1.0
    scan = Scan(cycle.system.flows, SparseRows(row))
    (found,), (highest,) = extremes_by(scan, cycle.system, cycle.segments)
    step = cycle.duration / cycle.segments.length[0]
    assert found.segment == 0 and len(cycle.segments) == 1
    at = found.position * step
    whole = np.append(row, [[0.0, 0.0]], axis=1)
    assert cycle.values(whole, np.array([at]))[0, 0] == pytest.approx(found.value, rel=1e-12)
    dense = cycle.values(whole, np.linspace(0.0, cycle.duration, 10_001))[:, 0]
    assert found.value == pytest.approx(dense.min(), rel=1e-6) and found.value <= dense.min()
    assert highest.value == pytest.approx(dense.max(), rel=1e-6) and highest.value >= dense.max()


@pytest.mark.parametrize("name", sorted(SCENES))
def test_no_sample_is_beyond_the_extremes(name):
    for cycle in simulate(SCENES[name], 1.3, 3).cycles:
        found, system = measure(cycle), cycle.system
        rows = np.zeros((system.scene.modal.shapes.shape[1], system.size))
        rows[:, system.q] = system.scene.modal.shapes.T
        dense = cycle.values(rows, np.linspace(0.0, cycle.duration, 20_001))
        size = np.abs(dense).max()
        assert np.all(found.greatest >= dense.max(axis=0) - 1e-12 * size)
        assert np.all(found.least <= dense.min(axis=0) + 1e-12 * size)
        assert found.greatest == pytest.approx(dense.max(axis=0), abs=1e-5 * size)
        assert found.least == pytest.approx(dense.min(axis=0), abs=1e-5 * size)


def test_flows_that_were_used_longest_ago_make_room():
    """The motion is the same with room for eight flows as with room for all."""
    scene = two_contacts()
    whole = simulate(scene, 1.3, 20)
    few = TimeOptions(flows=FlowOptions(max_bytes=1.0))
    little = simulate(replace(scene), 1.3, 20, options=few)  # a scene of its own, with flows of its own
    assert whole.cycles[0].system.flows.count > 8 == little.cycles[0].system.flows.count
    assert np.array_equal(whole.end.q, little.end.q)
    assert measure(little.cycles[-1]).amplitude == pytest.approx(
        whole.measures(last=1)[0].amplitude, rel=1e-15
    )


@pytest.mark.parametrize(("n_0", "omega"), [(90.0, 1.2), (40.0, 0.9)])
def test_a_stuck_contact_is_bounded_from_its_limits(n_0, omega):
    """The bound is below both distances from the limits of friction on dense samples, by little."""
    cycle = simulate(yang(n_0), omega, 3).cycles[-1]
    system = cycle.system
    assert cycle.states == ("E",)
    times = np.linspace(0.0, cycle.duration, 20_001)
    values = cycle.values(np.eye(system.size), times)
    mu = system.contacts[0].mu
    f, n = values[:, system.f][:, 0], n_0 + values[:, system.n][:, 0]
    room = min((mu * n - f).min(), (mu * n + f).min())
    assert room - 0.02 * mu * n.max() < cycle.segments.held(0) <= room


def stuck_structure(modes=20):
    """Enough components for many steps to be made at once, and two contacts that stick."""
    rng = np.random.default_rng(5)
    unit = np.eye(5)
    modal = Modal(
        tuple(f"x{i}" for i in range(5)),
        np.ones(modes),
        np.sort(rng.uniform(1.0, 40.0, modes)),
        np.full(modes, 0.01),
        rng.normal(size=(modes, 5)) / np.sqrt(modes),
    )
    contacts = tuple(Contact(f"c{j}", unit[2 * j], unit[2 * j + 1], 0.4, 1.0, 1.0, 1e6) for j in range(2))
    return Scene("stuck", modal, contacts, (Force(unit[4], 3.0, 0.3),), (0.5, 3.0), 0.05)


def test_a_long_stuck_motion_of_a_large_structure_is_measured_as_on_samples():
    """Two hundred steps in one segment, beside samples and Gauss quadrature of them."""
    omega = 1.1
    cycle = simulate(stuck_structure(), omega, 2).cycles[-1]
    assert len(cycle.segments) == 1 and cycle.segments.length[0] > 200.0
    rows = cycle.system.displaced
    assert rows.span > 0
    found, shapes = measure(cycle), cycle.system.scene.modal.shapes
    whole = np.zeros((shapes.shape[1], cycle.system.size))
    whole[:, cycle.system.q] = shapes.T
    x, weight = np.polynomial.legendre.leggauss(400)
    times = 0.5 * cycle.duration * (x + 1.0)
    values, share = cycle.values(whole, times), 0.5 * weight[:, None]
    size = np.abs(values).max()
    assert found.mean == pytest.approx((share * values).sum(axis=0), abs=1e-12 * size)
    wave = 2.0 * (share * values * np.exp(1j * (0.5 * np.pi - omega * times))[:, None]).sum(axis=0)
    assert found.fundamental * np.exp(1j * found.phase) == pytest.approx(wave, abs=1e-12 * size)
    dense = cycle.values(whole, np.linspace(0.0, cycle.duration, 40_001))
    assert (found.greatest >= dense.max(axis=0) - 1e-13 * size).all()
    assert found.greatest == pytest.approx(dense.max(axis=0), abs=1e-5 * size)
    assert found.least == pytest.approx(dense.min(axis=0), abs=1e-5 * size)


def test_the_flows_of_a_scene_are_made_once_in_a_thread():
    """Every system of a scene has the same; an equal scene has its own, and another thread."""
    scene = yang()
    flows = EquationsOfMotion(scene, 1.3).flows
    assert EquationsOfMotion(scene, 0.9).flows is flows
    others = []
    one = Thread(target=lambda: others.append(EquationsOfMotion(scene, 1.3).flows))
    one.start()
    one.join()
    assert others[0] is not flows
    assert EquationsOfMotion(replace(scene), 1.3).flows is not flows
