"""Nonlinear modes against closed forms, energy, and the forced response near their resonance."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from fcm import load_scene
from fcm.branches.trace import traced
from fcm.continuation import Mark, Status
from fcm.harmonic_balance.contact_cycles import cycles, loops
from fcm.harmonic_balance.system import System
from fcm.nonlinear_modes.backbone import ModeError, linear_modes, nonlinear_mode, truncation
from fcm.nonlinear_modes.extended_periodic_motion import AutonomousProblem
from fcm.nonlinear_modes.forced_response import flanks, resonances, resonant_level
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene.load import scene_from_dict


def jenkins(zeta=0.02, amplitude=0.05):
    """One mass on a spring, a damper and a friction element that slips at the displacement 1."""
    return scene_from_dict(
        {
            "modal": {"dofs": ["u"], "frequency": [1.0], "damping": [zeta], "shapes": [[1.0]]},
            "contact": [
                {"name": "c", "tangential": "u", "normal": "u", "mu": 0.5, "k_u": 0.3, "k_v": 0.0, "n_0": 0.6}
            ],
            "force": [{"dof": "u", "amplitude": amplitude}],
            "response": {"frequency": [0.8, 1.4], "harmonics": 1},
        }
    )


def test_one_mass_on_a_friction_element_against_its_describing_function():
    zeta, k = 0.02, 0.3
    mode = nonlinear_mode(System(jenkins(zeta)), 1, (0.1, 50.0), 0.05)
    A = mode.amplitude
    part = np.arccos(np.clip(1.0 - 2.0 / A, -1.0, 1.0))
    stiff = np.where(A > 1.0, k / np.pi * (part - 0.5 * np.sin(2.0 * part)), k)
    loss = np.where(A > 1.0, 4.0 * k * (A - 1.0) / (np.pi * A**2), 0.0)
    omega = np.sqrt(1.0 + stiff)
    assert mode.path.status is Status.COMPLETE and A[-1] == pytest.approx(50.0)
    assert mode.omega == pytest.approx(omega, rel=1e-9)
    assert mode.damping == pytest.approx((2.0 * zeta * omega + loss) / (2.0 * omega**2), rel=1e-8)
    assert mode.path.where(Mark.PEAK).size == 1  # the greatest damping is a point
    assert mode.path.where(Mark.CORNER).size == 1  # and so is the onset of slip


@pytest.mark.parametrize("loaded", [False, True])
def test_jacobian_against_differences(loaded):
    scene = pressed({"u": 0.5, "v": 2.0}, 0.2) if loaded else load_scene("two-contacts").in_use()
    system = System(scene, (1, 2, 3))
    problem = AutonomousProblem(system, linear_modes(system, 2)[0])
    rng = np.random.default_rng(1)
    z = problem.start(np.log(1.0 if loaded else 2e-4))
    problem.evaluate_scale(z)
    unit = np.array(problem.scale)
    z += 0.05 * unit * rng.uniform(-1.0, 1.0, z.size)
    problem.evaluate(z)
    J = np.array(problem.jacobian)
    for _ in range(5):
        direction, residual = unit * rng.uniform(-1.0, 1.0, z.size), []
        for step in (1e-5, -1e-5):
            problem.evaluate(z + step * direction)
            residual.append(np.array(problem.residual))
        slope = (residual[0] - residual[1]) / 2e-5
        assert J @ direction == pytest.approx(slope, rel=1e-5, abs=1e-6 * np.abs(slope).max())


@pytest.mark.parametrize("number", [1, 2, 3])
def test_at_small_amplitude_it_is_the_linear_mode(number):
    system = System(load_scene("two-contacts").in_use(), (1, 2))
    mode = nonlinear_mode(system, number, (1e-9, 1e-8), 0.05)
    linear, k = system.linear, system.springs(stuck=True) * [1, 1, 0, 0]  # the platform has a gap
    K = np.diag(linear.natural**2) + (linear.ports * k) @ linear.ports.T
    assert mode.omega[0] == pytest.approx(np.sqrt(scipy.linalg.eigvalsh(K)[number - 1]), rel=1e-5)
    w, D = mode.omega[0], mode.damping[0]
    C = np.diag(2.0 * linear.damping * linear.natural - 2.0 * D * w)
    singular = scipy.linalg.svdvals(K - w * w * np.eye(3) + 1j * w * C)
    assert singular[-1] < 1e-12 * singular[0]


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3, 4, 5)])
def test_negative_damping_gives_what_friction_and_damping_take(harmonics):
    scene = load_scene("yang1998-n5").in_use()
    system = System(scene, harmonics)
    mode = nonlinear_mode(system, 1, (1.0, 30.0), 0.05)
    taken = cycles(system, mode.contacts, loops(system, mode.contacts))[1][
        :, 0, 3
    ]  # an integral over the cycle, not Fourier coefficients
    w, D = mode.omega[:, None, None], mode.damping[:, None, None]
    h = np.array(harmonics)[:, None]
    rate = 2.0 * D * w - 2.0 * system.linear.damping * system.linear.natural
    Q2 = (mode.amplitude[:, None, None] * np.abs(mode.Q)) ** 2
    given = (np.pi * h**2 * w * rate * Q2).sum(axis=(1, 2))
    slips = taken > 1e-6 * taken.max()
    assert slips.sum() > 20
    assert given[slips] == pytest.approx(taken[slips], rel=1e-8)


def test_amplitude_of_the_fundamental_is_the_modal_amplitude_by_the_mass():
    mode = nonlinear_mode(System(load_scene("beam").in_use(), (1, 3)), 1, (1e-5, 1e-3), 0.05)
    assert np.sum(np.abs(mode.Q[:, 0]) ** 2, axis=1) == pytest.approx(1.0, rel=1e-10)


def test_resonance_with_forces_is_that_of_the_response():
    """To the order of the damping ratio squared, and of how its share changes with the frequency."""
    scene = jenkins(zeta=0.002, amplitude=0.12)
    mode = nonlinear_mode(System(scene), 1, (0.1, 50.0), 0.05)
    found = resonances(mode)
    path = traced(System(scene)).branches.paths[0]
    u = np.hypot(path.z[:, 2], path.z[:, 3])
    top = u.argmax()
    assert found.amplitude.size == 1
    assert found.amplitude[0] == pytest.approx(u[top], rel=5e-3)
    assert found.omega[0] == pytest.approx(path.parameter[top], rel=5e-3)
    assert resonant_level(found)[0] == pytest.approx(1.0, rel=1e-8)
    # the flanks
    lower, upper = flanks(mode)[(mode.amplitude > 0.4) & (mode.amplitude < 0.9 * u[top])].T
    a = mode.amplitude[(mode.amplitude > 0.4) & (mode.amplitude < 0.9 * u[top])]
    assert lower == pytest.approx(np.interp(a, u[: top + 1], path.parameter[: top + 1]), rel=2e-2)
    assert upper == pytest.approx(np.interp(a, u[top:][::-1], path.parameter[top:][::-1]), rel=2e-2)


def test_error_by_harmonics_left_out_is_what_more_of_them_change():
    scene = load_scene("two-contacts").in_use()
    coarse, fine = (nonlinear_mode(System(scene, h), 1, (1e-5, 1e-3), 0.05) for h in ((1,), (1, 2, 3)))
    error, _ = truncation(coarse)
    at = np.log(coarse.amplitude)
    omega, D = (np.interp(at, np.log(fine.amplitude), x) for x in (fine.omega, fine.damping))
    off = np.maximum(abs(coarse.omega - omega) / omega, abs(coarse.damping - D) / coarse.damping.max())
    assert np.isfinite(error).all() and error.max() == pytest.approx(off.max(), rel=0.1)


def test_a_mode_that_cannot_be_begun_has_no_errors():
    """No motion is found at its least amplitude."""
    mode = nonlinear_mode(System(load_scene("two-contacts").in_use(), (1,)), 1, (1e-5, 1e-3), 0.05)
    none = np.empty(0)
    empty = replace(mode, path=mode.path.part(np.empty(0, dtype=np.intp)), omega=none, damping=none)
    error, contacts = truncation(empty)
    assert error.size == 0 and len(contacts) == 0


def test_a_mode_that_is_not_there():
    with pytest.raises(ModeError, match="no mode 2; the structure has the modes 1 to 1"):
        nonlinear_mode(System(jenkins()), 2, (0.1, 1.0), 0.05)


def test_two_contacts_that_begin_to_slip_at_once():
    """Twice one contact of half the stiffness and preload: the mode is that of the one."""
    data = {
        "modal": {"dofs": ["u"], "frequency": [1.0], "damping": [0.02], "shapes": [[1.0]]},
        "force": [{"dof": "u", "amplitude": 0.05}],
        "response": {"frequency": [0.8, 1.4]},
    }
    half = {"tangential": "u", "normal": "u", "mu": 0.5, "k_u": 0.15, "k_v": 0.0}
    data["contact"] = [half | {"name": "a", "n_0": 0.3}, half | {"name": "b", "n_0": 0.3 * (1.0 + 1e-11)}]
    both = nonlinear_mode(System(scene_from_dict(data)), 1, (0.1, 20.0), 0.05)
    one = nonlinear_mode(System(jenkins()), 1, (0.1, 20.0), 0.05)
    assert both.path.status is Status.COMPLETE
    slips = both.amplitude > 1.2
    at = np.log(both.amplitude[slips])
    assert both.damping[slips] == pytest.approx(np.interp(at, np.log(one.amplitude), one.damping), rel=5e-3)


def test_it_is_the_response_to_forces_that_do_what_its_negative_damping_does():
    """At its frequency, to modal forces of 2 D omega^2 a Q ahead by a quarter, an ordinary run is there."""
    scene = load_scene("yang1998-n5").in_use()
    mode = nonlinear_mode(System(scene), 1, (1.0, 30.0), 0.05)
    for i in range(5, mode.omega.size, 12):
        omega, a = mode.omega[i], mode.amplitude[i]
        pushed = np.linalg.solve(scene.modal.shapes, 2j * mode.damping[i] * omega**2 * a * mode.Q[i, 0])
        forces = [
            replace(force, direction=direction, amplitude=abs(F), phase=float(np.angle(1j * F)))
            for force, direction, F in zip(scene.forces, np.eye(2), pushed, strict=True)
        ]
        there = replace(scene, forces=tuple(forces), frequency_range=(0.98 * omega, omega))
        paths = traced(System(there)).branches.paths
        ends = np.concatenate([path.z[path.parameter == omega] for path in paths])
        off = np.abs(ends - mode.contacts[i]).max(axis=1) / a
        assert off.min() < 1e-8


def pressed(loads, n_0):
    """Two masses, whose contact leans, with a preload and under static loads (u, v)."""
    normal = {"u": 0.6, "v": 0.8}
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"],
                "frequency": [1.0, 2.5],
                "damping": [0.01, 0.01],
                "shapes": [[1.0, 0.0], [0.0, 1.0]],
            },
            "contact": [
                {
                    "name": "c",
                    "tangential": {"u": 0.8, "v": -0.6},
                    "normal": normal,
                    "mu": 0.4,
                    "k_u": 0.5,
                    "k_v": 0.7,
                    "n_0": n_0,
                }
            ],
            "force": [{"dof": "u", "amplitude": 1.0}],
            "load": [{"dof": dof, "force": force} for dof, force in loads.items()],
            "response": {"frequency": [0.5, 4.0], "harmonics": 3},
        }
    )


def test_what_loads_press_a_contact_with_is_a_preload_to_the_mode():
    """Loads that leave the contact without a tangential displacement: (u, v) at rest is along its normal."""
    w = 3.0
    rest = w * np.array([0.6, 0.8])
    loads = np.array([1.0, 2.5**2]) * rest + 0.7 * w * np.array([0.6, 0.8])
    loaded, preloaded = (
        nonlinear_mode(System(pressed(*one), (1, 2, 3)), 1, (0.1, 30.0), 0.05)
        for one in ((dict(zip("uv", loads.tolist(), strict=True)), 0.2), ({}, 0.2 + 0.7 * w))
    )
    at = np.log(preloaded.amplitude)
    for name in ("omega", "damping"):
        theirs, expected = (
            np.interp(at, np.log(loaded.amplitude), getattr(loaded, name)),
            getattr(preloaded, name),
        )
        assert np.abs(theirs - expected).max() < 2e-3 * expected.max()
    means = loaded.displacements()[1] - preloaded.displacements()[1][0]
    assert means[0] == pytest.approx(rest, rel=1e-9)
    assert loaded.contacts[0, :2] == pytest.approx([0.0, w], abs=1e-9)


@pytest.mark.parametrize("load", [0.25, -0.35, 2.0])
def test_a_mode_under_a_load_is_the_response_to_a_force_that_its_damping_needs(load):
    """Of one mass and one harmonic: at the mode's frequency, to the force 2 D omega^2 a. Its contact is
    sheared at rest, and slides there under the greatest load."""
    table = {
        "modal": {"dofs": ["u"], "frequency": [1.0], "damping": [0.02], "shapes": [[1.0]]},
        "contact": [
            {
                "name": "c",
                "tangential": "u",
                "normal": {"u": 0.2},
                "mu": 0.5,
                "k_u": 0.3,
                "k_v": 0.4,
                "n_0": 0.6,
            }
        ],
        "load": [{"dof": "u", "force": load}],
        "force": [{"dof": "u", "amplitude": 1.0}],
        "response": {"frequency": [0.8, 1.6], "harmonics": 1},
    }
    mode = nonlinear_mode(System(scene_from_dict(table)), 1, (0.01, 20.0), 0.05)
    assert mode.path.status is Status.COMPLETE
    X, mean = mode.displacements()
    for i in range(0, len(mode.omega), 20):
        needed = 2.0 * mode.damping[i] * mode.omega[i] ** 2 * mode.amplitude[i]
        table["force"][0]["amplitude"] = needed
        table["response"]["frequency"] = [float(mode.omega[i]), 1.001 * float(mode.omega[i])]
        curve = traced_curve(scene_from_dict(table), Request((1,), 1e-2))
        there = np.flatnonzero(np.abs(curve.frequency - mode.omega[i]) < 1e-9)
        amplitude, means = curve.amplitude[there, 0], curve.mean[there, 0]
        k = int(np.abs(amplitude - mode.amplitude[i]).argmin())
        assert amplitude[k] == pytest.approx(abs(X[i, 0, 0]), rel=1e-6)
        assert means[k] == pytest.approx(mean[i, 0], rel=1e-6, abs=1e-6 * mode.amplitude[i])
