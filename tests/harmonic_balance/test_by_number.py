"""Derivatives of a solution by any number of its scene, against differences of solutions."""

import numpy as np
import pytest

from fcm.branches.force_level import solutions
from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene
from fcm.scene.draft import number_of
from fcm.scene.errors import SceneError
from fcm.sensitivity.parameter_derivatives import growth_of, rates_of

KEYS = (
    "contact.shroud.n_0", "contact.*.mu", "contact.0.k_u", "contact.0.k_v", "force.u.amplitude",
    "force.1.phase", "modal.damping", "modal.frequency.1", "modal.mass", "modal.shapes.0.u",
    "contact.0.tangential.u", "contact.0.tangential.v", "contact.0.normal.u",
    "level",
)  # fmt: skip


def solved(system, z):
    newton = Newton(system.new_balance())
    newton.problem.evaluate_scale(z)
    newton.scale[:], newton.z[:] = newton.problem.scale, z
    newton.row[:] = np.eye(z.size)[-1]
    assert newton.correct(1.0)
    return np.array(newton.z), newton.problem


def reported(problem, z, direction):
    problem.evaluate(z)
    problem.evaluate_outputs(z, direction)
    return np.array(problem.output), np.array(problem.growth)


def by_differences(scene, harmonics, key, z):
    """The derivative of the amplitudes, of fourth order in the step."""
    moved = number_of(scene, key).each(scene)
    step = 1e-3 * max(abs(value) or 1.0 for _, value, _ in moved)

    def at(shift):
        values = {one.addresses[0]: value + shift * weight for one, value, weight in moved}
        system = System(scene.draft.curve(scene, {}, values), harmonics)
        there, problem = solved(system, z)
        return reported(problem, there, np.zeros(z.size))[0]

    return (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step)


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3)])
@pytest.mark.parametrize("omega", [1.1, 1.3])
def test_a_solution_moves_with_every_number_of_the_scene_as_its_differences_do(harmonics, omega):
    scene = load_scene("yang1998-n5")
    system = System(scene, harmonics)
    z, problem = solved(system, solutions(system, omega).solutions[-1])
    problem.evaluate(z)
    jacobian = np.array(problem.jacobian)[:, :-1]
    for key in KEYS:
        residual, displacement = rates_of(system, key).at(problem, z)
        direction = np.append(-np.linalg.solve(jacobian, residual), 0.0)
        rate = reported(problem, z, direction)[1] + growth_of(problem, displacement)
        expected = by_differences(scene, harmonics, key, z)
        assert rate == pytest.approx(expected, rel=1e-6, abs=1e-9 * abs(expected).max()), key


def test_what_is_no_number_of_the_scene_and_what_has_no_derivative_are_refused(free_scene):
    with pytest.raises(SceneError, match=r"contact\.shroud\.n_1"):
        rates_of(System(load_scene("yang1998-n5")), "contact.shroud.n_1")
    with pytest.raises(ValueError, match="rigid-body"):
        rates_of(System(free_scene), "modal.frequency.0")


@pytest.fixture
def free_scene():
    from fcm.scene.load import scene_from_dict

    modal = {"dofs": ["u", "v"], "frequency": [0.0, 2.0], "damping": [0.0, 0.01], "shapes": [[1, 1], [1, -1]]}
    contact = {"name": "c", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    force = {"dof": "u", "amplitude": 1.0}
    response = {"frequency": [0.5, 1.0]}
    return scene_from_dict({"modal": modal, "contact": [contact], "force": [force], "response": response})
