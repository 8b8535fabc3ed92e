"""The balanced equations, against the contact law marched in time and against linear structures."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.model.scene import Contact, Force, Modal, Scene
from fcm.response import trace

DOFS = ("a", "b", "c")


def scene(contacts, damping=0.02, span=(0.6, 2.0), phase=0.4) -> Scene:
    """Four modes on three degrees of freedom, two forces out of phase."""
    shapes = np.array([[0.9, 0.5, 0.3], [0.4, -0.8, 0.6], [-0.7, 0.2, 0.8], [0.1, 0.9, -0.5]])
    modal = Modal(
        DOFS, np.array([1.0, 0.8, 1.2, 1.0]), np.array([1.0, 1.6, 3.0, 7.0]), np.full(4, damping), shapes
    )
    forces = (Force(np.array([1.0, 0.0, 0.0]), 1.0, 0.0), Force(np.array([0.0, 1.0, 0.5]), 0.7, phase))
    return Scene("four modes", modal, tuple(contacts), forces, span, 0.05, harmonics=(1,))


def contact(name, tangential, normal, **values) -> Contact:
    defaults = {"mu": 0.4, "k_u": 1.0, "k_v": 1.5, "n_0": 0.8}
    return Contact(name, np.array(tangential), np.array(normal), **(defaults | values))


TWO = (
    contact("one", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
    contact("two", [0.0, 1.0, -1.0], [0.5, 0.0, 0.8], mu=0.7, n_0=-0.3, k_u=2.0),
)


def marched_force(u, v, mean_v, c, samples=4000, cycles=3):
    """Friction and normal force over the last cycle of u = Im(u e^it), v likewise about mean_v."""
    theta = np.linspace(0.0, 2.0 * np.pi, samples, endpoint=False)
    x = np.imag(u * np.exp(1j * theta))
    n = np.maximum(c.n_0 + c.k_v * (mean_v + np.imag(v * np.exp(1j * theta))), 0.0)
    f, history = 0.0, np.empty(samples)
    for _ in range(cycles):
        for i in range(samples):
            f = min(max(f + c.k_u * (x[i] - x[i - 1]), -c.mu * n[i]), c.mu * n[i])
            history[i] = f
    return theta, history, n - max(c.n_0, 0.0)


def fundamental(theta, values):
    """Complex amplitude F of the fundamental Im(F e^it)."""
    return 2.0 * np.mean(values * np.sin(theta)) + 2.0j * np.mean(values * np.cos(theta))


@pytest.mark.parametrize("at", [0.2, 0.45, 0.7])
def test_a_solution_balances_the_modes_with_the_marched_law(at):
    """m (w_i^2 - w^2 + 2 i zeta w_i w) q = Phi^T (external - contact), and the static balance of the mean."""
    case = scene(TWO)
    curve = trace(case, "table").curves[0]
    k = int(at * curve.points)
    X = curve.fundamental[k] * np.exp(1j * curve.phase[k])
    w, modal = curve.frequency[k], case.modal
    load = sum(f.direction * f.amplitude * np.exp(1j * f.phase) for f in case.forces).astype(complex)
    mean_load = np.zeros(3)
    for c in case.contacts:
        theta, friction, normal = marched_force(c.tangential @ X, c.normal @ X, c.normal @ curve.mean[k], c)
        load -= c.tangential * fundamental(theta, friction) + c.normal * fundamental(theta, normal)
        mean_load -= c.tangential * friction.mean() + c.normal * normal.mean()
    compliance = 1.0 / (modal.mass * (modal.frequency**2 - w**2 + 2j * modal.damping * modal.frequency * w))
    assert modal.shapes.T @ (compliance * (modal.shapes @ load)) == pytest.approx(X, abs=3e-3)
    static = modal.shapes.T @ ((modal.shapes @ mean_load) / (modal.mass * modal.frequency**2))
    assert static == pytest.approx(curve.mean[k], abs=3e-3)


def linear_response(case, springs, frequency):
    """Displacements with springs (direction, stiffness), by the modal impedance matrix."""
    modal = case.modal
    load = sum(f.direction * f.amplitude * np.exp(1j * f.phase) for f in case.forces)
    added = sum(k * np.outer(modal.shapes @ d, modal.shapes @ d) for d, k in springs)
    out = []
    for w in frequency:
        impedance = np.diag(
            modal.mass * (modal.frequency**2 - w**2 + 2j * modal.damping * modal.frequency * w)
        )
        out.append(modal.shapes.T @ np.linalg.solve(impedance + added, modal.shapes @ load))
    return np.array(out)


def check_linear(case, springs):
    curve = trace(case, "table").curves[0]
    assert curve.complete
    exact = linear_response(case, springs, curve.frequency)
    assert curve.fundamental * np.exp(1j * curve.phase) == pytest.approx(exact, rel=1e-8, abs=1e-12)


def test_stuck_contacts_are_springs():
    stuck = [replace(c, n_0=1e4) for c in TWO]
    springs = [(c.tangential, c.k_u) for c in TWO] + [(c.normal, c.k_v) for c in TWO]
    check_linear(scene(stuck), springs)


def test_open_contacts_do_nothing():
    check_linear(scene([replace(c, n_0=-1e4) for c in TWO]), [(np.zeros(3), 0.0)])


def test_a_scene_without_contacts_is_linear():
    check_linear(scene([]), [(np.zeros(3), 0.0)])


def test_a_closed_contact_without_friction_is_a_normal_spring():
    frictionless = [replace(c, mu=0.0, n_0=1e4) for c in TWO]
    check_linear(scene(frictionless), [(c.normal, c.k_v) for c in TWO])


def test_a_contact_without_stiffness_does_nothing():
    check_linear(scene([replace(c, k_u=0.0, k_v=0.0) for c in TWO]), [(np.zeros(3), 0.0)])


def test_one_of_two_equal_contacts_in_parallel_is_half_of_a_stiffer_one():
    """Two contacts of half the stiffness and preload at one place act as one."""
    whole = TWO[0]
    half = replace(whole, k_u=0.5, k_v=0.75, n_0=0.4)
    single = trace(scene([whole]), "closed-form").curves[0]
    double = trace(scene([replace(half, name="left"), replace(half, name="right")]), "closed-form").curves[0]
    for dof in DOFS:
        assert double.peaks[dof][:2] == pytest.approx(single.peaks[dof][:2], rel=1e-8)
